//! Ways through what is narrower than the robot's circle: straight, with the body turned so that it walks sideways.
//!
//! 002 checks collisions by a circle alone, which keeps the robot out of narrow passages (III.D), and wishes for better (V). A
//! humanoid is wide across its arms and flat from front to back.

use std::f64::consts::{FRAC_PI_2, TAU};

use geometry::{Cell, CellArea, wrap_angle};

use crate::AStarConfig;
use crate::keep::SLACK_M;
use crate::levels::Stand;
use crate::portals::{Fit, Portals, Scene, Way};
use crate::room::distance_m;
use crate::terrain::Terrain;

/// Directions in which the robot walks sideways.
const DIRECTIONS: u32 = 16;
/// From inside a slit it goes on by directions no further off than this from where its side points, rad.
const ASIDE_RAD: f64 = 0.3;
/// Slits are no longer than this, m.
const LONGEST_M: f64 = 2.0;
/// Two quarters of a turn, before and behind, rad.
pub(crate) const TURNS_RAD: f64 = 2.0 * FRAC_PI_2;

/// Half of the rectangle that has to stay clear while the robot walks sideways, m: from front to back, and across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) half_depth_m: f64,
    pub(crate) half_width_m: f64,
}

impl Terrain {
    /// What a metre sideways costs here for a robot with this heading; `None` where its rectangle, less `slack_m` all round, is not
    /// clear of obstacles or its feet are near an edge.
    pub(crate) fn sideways_weight(
        &self,
        at_m: [f64; 2],
        heading_rad: f64,
        slack_m: f64,
        config: &AStarConfig,
    ) -> Option<f64> {
        let rectangle = self.needs.turned?;
        let index = self.index_at(at_m)?;
        let at_edge = self.levels.edge[index] || self.edge_clearance_m(index) < self.needs.feet_m;
        if self.blocked[index] || at_edge {
            return None;
        }
        let half_width_m = rectangle.half_width_m - slack_m;
        let half_depth_m = rectangle.half_depth_m - slack_m;
        let soft_m = half_depth_m + config.soft_range;
        let (sin, cos) = heading_rad.sin_cos();
        let mut spare_m = config.soft_range;
        let reach_m = half_width_m.hypot(soft_m);
        for place_m in self.obstacles_near(at_m, reach_m) {
            let [dx, dy] = [place_m[0] - at_m[0], place_m[1] - at_m[1]];
            let ahead_m = (cos * dx + sin * dy).abs();
            let aside_m = (cos * dy - sin * dx).abs();
            if aside_m < half_width_m {
                if ahead_m < half_depth_m {
                    return None;
                }
                spare_m = spare_m.min(ahead_m - half_depth_m);
            }
        }
        let unseen = if self.unknown[index] {
            config.unknown_cost
        } else {
            0.0
        };
        Some(config.weight(spare_m, config.soft_range) + config.sideways_cost + unseen)
    }

    /// Centres of the blocked cells within a square around a place, m.
    pub(crate) fn obstacles_near(
        &self,
        [x, y]: [f64; 2],
        reach_m: f64,
    ) -> impl Iterator<Item = [f64; 2]> + '_ {
        // A range may be large; the window is not.
        let last = [self.cols, self.rows].map(|cells| cells as i32 - 1);
        let corner = |x_m: f64, y_m: f64| {
            let cell = self.lattice.cell_at(x_m, y_m);
            Cell::new(cell.col.min(last[0]).max(0), cell.row.min(last[1]).max(0))
        };
        let area = CellArea {
            min: corner(x - reach_m, y - reach_m),
            max: corner(x + reach_m, y + reach_m),
        };
        area.cells().filter_map(|cell| {
            let col = usize::try_from(cell.col).ok().filter(|&c| c < self.cols)?;
            let row = usize::try_from(cell.row).ok().filter(|&r| r < self.rows)?;
            self.blocked[row * self.cols + col].then(|| self.lattice.center_of(cell))
        })
    }

    /// Whether the robot stands where there is no room for the circle, but for itself as it is turned.
    pub(crate) fn is_in_slit(&self, stand: &Stand, config: &AStarConfig) -> bool {
        let closed = |start: &usize| !self.is_open(*start);
        let slack_m = SLACK_M.min(0.5 * self.lattice.cell_m);
        let start = self.index_at(stand.at_m).filter(closed);
        let weight = || self.sideways_weight(stand.at_m, stand.heading_rad, slack_m, config);
        start.and_then(|_| weight()).is_some()
    }

    fn is_open(&self, index: usize) -> bool {
        self.weights[index].is_finite() && self.clearance_m(index) >= self.needs.body_m
    }
}

impl Portals {
    /// Finds the slits: from a cell with room for the circle to another, or from where the robot stands in one.
    pub(crate) fn slip_through(&mut self, scene: &Scene<'_>) {
        let terrain = scene.terrain;
        if terrain.needs.turned.is_none() {
            return;
        }
        let beside_m = terrain.needs.body_m + 1.5 * terrain.lattice.cell_m;
        for cell in 0..terrain.weights.len() {
            if terrain.is_open(cell) && terrain.clearance_m(cell) < beside_m {
                for direction in 0..DIRECTIONS {
                    let along_rad = TAU * f64::from(direction) / f64::from(DIRECTIONS);
                    self.slit(scene, (cell, terrain.center_m(cell)), along_rad);
                }
            }
        }
        if let Some(cell) = terrain.index_at(scene.stand.at_m)
            && !terrain.is_open(cell)
        {
            // Where it hardly left the room for its circle it may still turn.
            let turns = terrain.clearance_at_start_m >= terrain.needs.body_m - SLACK_M;
            for along_rad in sides(scene.stand.heading_rad, turns) {
                self.slit(scene, (cell, scene.stand.at_m), along_rad);
            }
        }
    }

    /// Adds the way that begins in a cell and leads straight on in a direction through a slit, if it is one.
    fn slit(&mut self, scene: &Scene<'_>, (from, enter_m): (usize, [f64; 2]), along_rad: f64) {
        let Scene {
            terrain, config, ..
        } = scene;
        let cell_m = terrain.lattice.cell_m;
        let heading_rad = turned(along_rad, scene.stand.heading_rad);
        let (sin, cos) = along_rad.sin_cos();
        let stride_m = 0.5 * cell_m;
        let mut cost_m = config.turn_cost * TURNS_RAD;
        let at = |stride: u32| {
            let away_m = f64::from(stride) * stride_m;
            [enter_m[0] + away_m * cos, enter_m[1] + away_m * sin]
        };
        let mut cells = (1..=3).filter_map(|stride| terrain.index_at(at(stride)));
        let beside = cells.find(|&cell| cell != from);
        if beside.is_none_or(|cell| terrain.blocked[cell] || terrain.is_open(cell)) {
            return;
        }
        for stride in 0..=(LONGEST_M / stride_m) as u32 {
            let at_m = at(stride);
            let Some(cell) = terrain.index_at(at_m) else {
                return;
            };
            // Who stands in a slit already may stand a little too near.
            let slack_m = if cell == from && !terrain.is_open(cell) {
                SLACK_M
            } else {
                0.0
            };
            let Some(weight) = terrain.sideways_weight(at_m, heading_rad, slack_m, config) else {
                return;
            };
            cost_m += stride_m * weight;
            if cell != from && terrain.is_open(cell) {
                // Cells with room for the circle beside each other need no slit between them.
                let centers_m = [from, cell].map(|cell| terrain.center_m(cell));
                if distance_m(centers_m[0], centers_m[1]) > 2.0 * cell_m {
                    self.add_slit(scene, [from, cell], cost_m, (enter_m, at_m, heading_rad));
                }
                return;
            }
        }
    }

    fn add_slit(
        &mut self,
        scene: &Scene<'_>,
        [from, to]: [usize; 2],
        cost_m: f64,
        (enter_m, leave_m, heading_rad): ([f64; 2], [f64; 2], f64),
    ) {
        let none = self.strides.len();
        let _ = (self.links).add(from, to, cost_m / scene.terrain.lattice.cell_m);
        self.ways.push(Way {
            first: none,
            end: none,
            enter_m,
            leave_m: Some(leave_m),
            fit: Fit::Holds,
            at_goal: false,
            turned_rad: Some(heading_rad),
        });
    }
}

/// Directions to either side of a heading, and near to them, or all for one who `turns`.
fn sides(heading_rad: f64, turns: bool) -> impl Iterator<Item = f64> {
    let own = [FRAC_PI_2, -FRAC_PI_2].map(|side_rad| heading_rad + side_rad);
    let near = move |along_rad: &f64| {
        let off = |side_rad: &f64| wrap_angle(along_rad - side_rad).abs();
        turns || own.iter().any(|side_rad| off(side_rad) < ASIDE_RAD)
    };
    let all = (0..DIRECTIONS).map(|i| TAU * f64::from(i) / f64::from(DIRECTIONS));
    own.into_iter().chain(all.filter(near))
}

/// The heading with which the robot walks sideways in a direction: of the two the one nearer to its own.
fn turned(along_rad: f64, own_rad: f64) -> f64 {
    let [left, right] = [FRAC_PI_2, -FRAC_PI_2].map(|side| wrap_angle(along_rad + side));
    let off_rad = |heading_rad: f64| wrap_angle(heading_rad - own_rad).abs();
    if off_rad(left) <= off_rad(right) {
        left
    } else {
        right
    }
}

#[cfg(test)]
mod tests;
