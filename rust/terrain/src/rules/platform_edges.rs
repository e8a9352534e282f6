//! Rule: where the level that the robot stands on is raised over something, what was not seen beside it is no ground: there it ends.

mod further_ground;

use geometry::{Cell, same_level};
use mapping::Surface;
use settings::{NOT_NEGATIVE, settings, within};

use crate::{Sight, StandingAt, Terrain, cells::around};
use further_ground::FurtherGround;

settings! {
    /// Where the level that the robot stands on ends.
    pub struct PlatformEdgesConfig("navigation.terrain.platform_edges") {
        /// The robot stands on a raised level when something known, or the goal, lies lower than it by more than so many times `max_step`.
        raised: f64 = 2.0, "1", NOT_NEGATIVE;
        /// From so many cells on a lower level is believed.
        lower_cells: usize = 12, "1", within(1.0, 1.0e6);
        /// Ground whose height differs from the robot's by no more than so many times `max_step` is of its level.
        level: f64 = 2.0, "1", NOT_NEGATIVE;
        /// Unseen cells between ground on both sides are ground when they are no more than this: single pixels that the camera missed. A
        /// gap into which a foot fits is seen into from where its edge matters.
        gap: usize = 2, "1", within(0.0, 20.0);
    }
}

/// The ground of the level that the robot stands on. Reused.
#[derive(Debug, Clone, Default)]
pub(super) struct PlatformEdges {
    ground: Vec<bool>,
    gaps: Vec<usize>,
    further: FurtherGround,
}

impl PlatformEdges {
    /// Marks what ends the level on which the robot stands. Around itself it sees no ground: there it has its own, unless it stands on a
    /// stair.
    pub(super) fn apply(
        &mut self,
        terrain: &mut Terrain,
        sight: &Sight<'_>,
        config: &PlatformEdgesConfig,
    ) {
        if !is_raised(terrain, sight, config) {
            return;
        }
        let stand = &sight.stand;
        let start = terrain.index_at(stand.at_m);
        let on_tread = start.is_some_and(|start| terrain.stairs.covers(start));
        let blind_m = if on_tread {
            0.0
        } else {
            terrain.settings.blind
        };
        let tolerance_m = config.level * terrain.settings.max_step;
        self.find_ground(terrain, sight, (tolerance_m, blind_m));
        self.close_gaps(terrain, stand, config.gap);
        let raised_m = config.raised * terrain.settings.max_step;
        let lower = (raised_m, lowest_told_m(sight), config.lower_cells);
        self.further.find(terrain, &self.ground, lower);
        let size = [terrain.cols, self.ground.len() / terrain.cols.max(1)];
        for (index, &ground) in self.ground.iter().enumerate() {
            let unseen = !ground && terrain.height_m[index].is_nan() && !terrain.blocked[index];
            let seen = (&*terrain, sight.view);
            let ends = |next| self.ground[next] || self.further.ends_at(next, index, seen);
            if unseen && around(index, 1, size).any(ends) {
                terrain.mark_edge(index);
                terrain.open[index] = true;
            }
        }
    }

    fn find_ground(
        &mut self,
        terrain: &mut Terrain,
        sight: &Sight<'_>,
        (tolerance_m, blind_m): (f64, f64),
    ) {
        let (view, stand) = (sight.view, &sight.stand);
        let on_level = |height_m: f32| same_level(f64::from(height_m), stand.height_m, tolerance_m);
        let (lattice, cols) = (&view.lattice, view.cells.cols());
        for row in 0..view.cells.rows() {
            let away_m = |axis: usize, at: usize| {
                let center_m = lattice.center_of(Cell::new(at as i32, at as i32));
                center_m[axis] - stand.at_m[axis]
            };
            let dy = away_m(1, row);
            if dy.abs() > blind_m {
                continue;
            }
            for col in 0..cols {
                let index = row * cols + col;
                let height = &mut terrain.height_m[index];
                if height.is_nan() && terrain.unknown[index] && !terrain.edge[index] {
                    let dx = away_m(0, col);
                    if dx.abs() <= blind_m && geometry::hypot(dx, dy) <= blind_m {
                        *height = stand.ground_m([dx, dy]) as f32;
                    }
                }
            }
        }
        let cells = view.cells.values().iter();
        let cells = cells.zip(&terrain.height_m).zip(&terrain.unknown);
        self.ground.clear();
        self.ground
            .extend(cells.map(|((surface, height), &unknown)| {
                // Floor that was seen too rarely to be an edge is ground all the same.
                let rarely = height.is_nan()
                    && !unknown
                    && matches!(*surface, Surface::Floor(height_m) if on_level(height_m));
                rarely || on_level(*height)
            }));
    }

    fn close_gaps(&mut self, terrain: &mut Terrain, stand: &StandingAt, widest: usize) {
        let cols = terrain.cols;
        let rows = self.ground.len() / cols.max(1);
        self.gaps.clear();
        for row in 0..rows {
            for col in 0..cols {
                let index = row * cols + col;
                if !self.ground[index] {
                    continue;
                }
                for (stride, at) in [(1, col), (cols, row)] {
                    if at == 0 || self.ground[index - stride] {
                        continue;
                    }
                    // A gap ends here.
                    let most = (widest + 1).min(at);
                    let before = (2..=most).find(|n| self.ground[index - n * stride]);
                    let gap = (1..before.unwrap_or(1)).map(|n| index - n * stride);
                    let unseen =
                        |&cell: &usize| terrain.unknown[cell] && terrain.height_m[cell].is_nan();
                    self.gaps.extend(gap.filter(unseen));
                }
            }
        }
        for &index in &self.gaps {
            self.ground[index] = true;
            terrain.height_m[index] = stand.height_m as f32;
        }
    }
}

/// Whether something known, or the goal, lies lower than the robot stands.
fn is_raised(terrain: &Terrain, sight: &Sight<'_>, config: &PlatformEdgesConfig) -> bool {
    let below_m = sight.stand.height_m - config.raised * terrain.settings.max_step;
    let lower = |height: &&f32| f64::from(**height) < below_m;
    lowest_told_m(sight) < below_m
        || terrain.height_m.iter().filter(lower).count() >= config.lower_cells
}

/// Height of the lowest stair or of the goal, m.
fn lowest_told_m(sight: &Sight<'_>) -> f64 {
    let heights = sight.stairs.stairs.iter().map(stairs::Stair::height_m);
    heights.chain(sight.goal_m).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    /// The robot on a platform 0.2 m high of which the far side was not seen.
    fn platform() -> Floor {
        let mut floor = Floor::new();
        floor.stand.height_m = 0.2;
        floor.paint([-2.0, -2.0], [2.0, 2.0], Surface::Unknown);
        floor.paint([-0.5, -0.5], [0.5, 0.5], Surface::Floor(0.2));
        floor.paint([0.2, -0.2], [0.3, 0.2], Surface::Unknown);
        floor
    }

    #[test]
    fn a_raised_level_ends_where_nothing_was_seen_but_pixels_that_were_missed_are_ground() {
        let mut floor = platform();
        assert!(
            !floor.after("platform_edges").any_edge,
            "nothing lies lower"
        );
        floor.goal_m = Some(0.0);
        let terrain = floor.after("platform_edges");
        let at = |x_m: f64| cell(&terrain, x_m, 0.025);
        assert!(terrain.edge[at(0.525)] && terrain.open[at(0.525)]);
        assert!(!terrain.edge[at(0.475)] && !terrain.edge[at(0.225)]);
        assert_eq!(terrain.level_m(at(0.225)), Some(f64::from(0.2_f32)));
    }

    #[test]
    fn around_the_robot_unseen_ground_is_its_own() {
        let mut floor = platform();
        floor.goal_m = Some(0.0);
        floor.paint([-0.15, -0.15], [0.15, 0.15], Surface::Unknown);
        let terrain = floor.after("platform_edges");
        let at = cell(&terrain, 0.075, 0.025);
        assert_eq!(terrain.level_m(at), Some(f64::from(0.2_f32)));
        assert!(!terrain.edge[at]);
    }

    /// The robot on a ramp of 0.2 m, up from the floor to a platform, with nothing seen beside it.
    fn ramp() -> Floor {
        let mut floor = Floor::new();
        floor.paint([-2.0, -2.0], [2.0, 2.0], Surface::Unknown);
        floor.paint([-2.0, -2.0], [-1.5, 2.0], Surface::Floor(0.0));
        floor.ramp([-1.5, -0.5], [0.5, 0.5], [0.0, 0.2]);
        floor.paint([0.5, -0.5], [1.5, 0.5], Surface::Floor(0.2));
        floor.stand.height_m = 0.15;
        floor.stand.gradient = [0.1, 0.0];
        floor
    }

    #[test]
    fn the_side_of_a_slope_is_an_edge_where_the_robot_was_near_and_so_is_that_of_what_it_leads_up_to()
     {
        let terrain = ramp().after("platform_edges");
        let is_edge = |x_m: f64, y_m: f64| terrain.edge[cell(&terrain, x_m, y_m)];
        assert!(is_edge(0.225, 0.525) && is_edge(-0.225, -0.525));
        assert!(!is_edge(-1.025, 0.525), "what lies there may come in sight");
        assert!(
            is_edge(1.025, 0.525) && is_edge(1.525, 0.025),
            "a level's end"
        );
        assert!(!is_edge(0.225, 0.025) && !is_edge(1.025, 0.025));
        assert!(!is_edge(-1.775, 0.025), "the floor is not raised");
    }

    #[test]
    fn ground_of_which_the_height_is_unsure_is_part_of_the_level() {
        let mut floor = platform();
        floor.goal_m = Some(0.0);
        floor.paint([0.3, -0.5], [0.5, 0.5], Surface::Floor(0.23));
        let is_edge = |floor: &Floor| {
            let terrain = floor.after("platform_edges");
            terrain.edge[cell(&terrain, 0.525, 0.025)]
        };
        assert!(!is_edge(&floor), "a level of its own");
        floor.doubt([0.3, -0.5], [0.5, 0.5], 0.02);
        assert!(is_edge(&floor));
    }
}
