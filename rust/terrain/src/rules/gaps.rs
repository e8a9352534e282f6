//! Rule: a single cell that was not seen has the height of the ground on both sides of it. Else a line of cells that the camera missed
//! before a box looks like the shadow below an edge.

use geometry::same_level;

use crate::Terrain;

/// So many cells of a row are looked at together first.
const TOGETHER: usize = 16;

/// Keeps its buffer.
#[derive(Debug, Clone, Default)]
pub(super) struct Gaps {
    closed: Vec<(usize, f32)>,
}

impl Gaps {
    pub(super) fn apply(&mut self, terrain: &mut Terrain) {
        let (cols, floor_m) = (terrain.cols, terrain.needs.limits.floor_m);
        let heights_m = &mut terrain.height_m;
        self.closed.clear();
        // Not a number: unknown, no ground.
        let between = |a: f32, b: f32| {
            same_level(f64::from((a - b).abs()), 0.0, floor_m).then_some(0.5 * (a + b))
        };
        let end = heights_m.len().saturating_sub(cols);
        for first in (cols..end).step_by(cols.max(1)) {
            let [below, here, above] =
                [first - cols, first, first + cols].map(|first| &heights_m[first..first + cols]);
            // Not short-circuited: most of what is unknown lies among its like.
            let known = |a: f32, b: f32| !a.is_nan() & !b.is_nan();
            let is_gap = |col: usize| {
                let beside = known(here[col - 1], here[col + 1]) | known(below[col], above[col]);
                here[col].is_nan() & beside
            };
            let last = cols.saturating_sub(1);
            for begin in (1..last).step_by(TOGETHER) {
                let together = begin..(begin + TOGETHER).min(last);
                if !together.clone().fold(false, |any, col| any | is_gap(col)) {
                    continue;
                }
                for col in together.filter(|&col| is_gap(col)) {
                    let closed = between(here[col - 1], here[col + 1]);
                    if let Some(height) = closed.or_else(|| between(below[col], above[col])) {
                        self.closed.push((first + col, height));
                    }
                }
            }
        }
        for &(index, height) in &self.closed {
            heights_m[index] = height;
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn a_line_of_single_cells_is_closed_and_a_wider_one_and_one_at_a_step_are_not() {
        let mut floor = Floor::new();
        floor.paint([0.5, -0.5], [0.55, 0.5], Surface::Unknown);
        floor.paint([0.8, -0.5], [0.9, 0.5], Surface::Unknown);
        floor.paint([-2.0, -2.0], [-0.5, 2.0], Surface::Floor(0.04));
        floor.paint([-0.55, -0.5], [-0.5, 0.5], Surface::Unknown);
        let terrain = floor.after("gaps");
        let level_m = |x_m: f64| terrain.level_m(cell(&terrain, x_m, 0.025));
        assert_eq!(level_m(0.525), Some(0.0));
        assert_eq!((level_m(0.825), level_m(-0.525)), (None, None));
    }
}
