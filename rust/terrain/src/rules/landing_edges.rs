//! Rule: where a level on which stairs lie ends before unseen ground, it has an edge. It is stepped on over the edges of its stairs only:
//! the way there from unseen ground may be as high as a wall.

use geometry::{same_level, two_levels};

use crate::{Sight, Terrain, cells::beside};

/// The cells on the levels of stairs, with those stairs' heights. Reused.
#[derive(Debug, Clone, Default)]
pub(super) struct LandingEdges {
    cells: Vec<(usize, f32)>,
    reached: Vec<bool>,
}

impl LandingEdges {
    /// Finds the cells beside what was not seen, of stairs on another level than the robot's, and of the floor that goes on from them:
    /// where a landing was recognised only in part, the map knows more of it.
    pub(super) fn apply(&mut self, terrain: &mut Terrain, sight: &Sight<'_>) {
        let (heights_m, cols) = (terrain.height_m.as_slice(), terrain.cols);
        let (robot_m, floor_m) = (
            sight.stand.height_m as f32,
            terrain.needs.limits.floor_m as f32,
        );
        let another = |height_m: f32| two_levels(height_m, robot_m, floor_m);
        let stairs = terrain.stairs.cells().map(|cell| (cell, heights_m[cell]));
        self.cells.clear();
        self.cells
            .extend(stairs.filter(|&(_, height_m)| another(height_m)));
        self.reached.clear();
        self.reached.resize(heights_m.len(), false);
        for &(cell, _) in &self.cells {
            self.reached[cell] = true;
        }
        let mut next = 0;
        let mut edges = 0;
        while let Some(&(cell, level_m)) = self.cells.get(next) {
            let mut ends = false;
            for beside in beside(cell, cols, heights_m.len()) {
                let height_m = heights_m[beside];
                ends |= height_m.is_nan();
                let goes_on = same_level(height_m, level_m, floor_m) && another(height_m);
                if goes_on && !self.reached[beside] {
                    self.reached[beside] = true;
                    self.cells.push((beside, level_m));
                }
            }
            if ends {
                self.cells.swap(edges, next);
                edges += 1;
            }
            next += 1;
        }
        for &(cell, _) in &self.cells[..edges] {
            terrain.mark_edge(cell);
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell, stair};

    #[test]
    fn a_landing_ends_where_nothing_was_seen_also_where_the_map_knows_more_of_it_than_its_stair() {
        let mut floor = Floor::new();
        floor.stairs.stairs = vec![stair(0.5, 0.1, 0.04, 0.6)];
        floor.paint([0.5, -0.3], [0.8, 0.3], Surface::Floor(0.04));
        floor.paint([0.8, -0.3], [1.5, 0.3], Surface::Unknown);
        let terrain = floor.after("landing_edges");
        let is_edge = |x_m: f64| terrain.edge[cell(&terrain, x_m, 0.025)];
        assert!(is_edge(0.775) && terrain.any_edge);
        assert!(!is_edge(0.675) && !is_edge(0.825) && !is_edge(0.475));
    }
}
