//! Ways through what is narrower than the robot's circle: straight, with the body turned so that it walks sideways.
//!
//! 002 checks collisions by a circle alone, which keeps the robot out of narrow passages (III.D), and wishes for better (V). A
//! humanoid is wide across its arms and flat from front to back.

use std::f64::consts::{FRAC_PI_2, TAU};

use geometry::wrap_angle;

use crate::climb_links::room_at_edges::distance_m;
use crate::climb_links::{ClimbLinks, Fit, Scene, Way};
use crate::tuning::SidewaysPassagesTuning;

/// Two quarters of a turn, before and behind, rad: to walk sideways is to turn there and back.
pub(crate) const TURNS_RAD: f64 = 2.0 * FRAC_PI_2;

impl ClimbLinks {
    /// Finds the passages: from a cell with room for the circle to another, or from where the robot stands in one.
    pub(crate) fn add_passages(&mut self, scene: &Scene<'_>) {
        let terrain = scene.terrain;
        if terrain.needs.turned.is_none() {
            return;
        }
        let tuning = &scene.config.tuning.sideways_passages;
        let (directions, slack_m) = (tuning.directions, terrain.room.slack);
        let beside_m = terrain.needs.body_m + tuning.entrance * terrain.lattice.cell_m;
        for cell in 0..terrain.weights.len() {
            if terrain.is_roomy(cell) && terrain.clearance_m(cell) < beside_m {
                for direction in 0..directions {
                    let along_rad = TAU * f64::from(direction) / f64::from(directions);
                    self.passage(scene, (cell, terrain.center_m(cell)), along_rad);
                }
            }
        }
        if let Some(cell) = terrain.index_at(scene.stand.at_m)
            && !terrain.is_roomy(cell)
        {
            // Where it hardly left the room for its circle it may still turn.
            let turns = terrain.clearance_at_start_m >= terrain.needs.body_m - slack_m;
            for along_rad in sides(tuning, scene.stand.heading_rad, turns) {
                self.passage(scene, (cell, scene.stand.at_m), along_rad);
            }
        }
    }

    /// Adds the way that begins in a cell and leads straight on in a direction through a passage, if it is one.
    fn passage(&mut self, scene: &Scene<'_>, (from, enter_m): (usize, [f64; 2]), along_rad: f64) {
        let Scene {
            terrain, config, ..
        } = scene;
        let (cell_m, tuning) = (terrain.lattice.cell_m, &config.tuning.sideways_passages);
        let heading_rad = turned(along_rad, scene.stand.heading_rad);
        let (sin, cos) = libm::sincos(along_rad);
        let stride_m = terrain.room.stride * cell_m;
        let mut cost_m = config.turn_cost * TURNS_RAD;
        let at = |stride: u32| {
            let away_m = f64::from(stride) * stride_m;
            [enter_m[0] + away_m * cos, enter_m[1] + away_m * sin]
        };
        let mut cells =
            (1..=tuning.first_strides).filter_map(|stride| terrain.index_at(at(stride)));
        let beside = cells.find(|&cell| cell != from);
        if beside.is_none_or(|cell| terrain.blocked[cell] || terrain.is_roomy(cell)) {
            return;
        }
        for stride in 0..=(tuning.longest / stride_m) as u32 {
            let at_m = at(stride);
            let Some(cell) = terrain.index_at(at_m) else {
                return;
            };
            // Who stands in a passage already may stand a little too near.
            let slack_m = if cell == from && !terrain.is_roomy(cell) {
                terrain.room.slack
            } else {
                0.0
            };
            let Some(weight) = terrain.sideways_weight(at_m, heading_rad, slack_m) else {
                return;
            };
            cost_m += stride_m * weight;
            if cell != from && terrain.is_roomy(cell) {
                // Cells with room for the circle beside each other need no passage between them.
                let centers_m = [from, cell].map(|cell| terrain.center_m(cell));
                if distance_m(centers_m[0], centers_m[1]) > tuning.apart * cell_m {
                    self.add_passage(scene, [from, cell], cost_m, (enter_m, at_m, heading_rad));
                }
                return;
            }
        }
    }

    fn add_passage(
        &mut self,
        scene: &Scene<'_>,
        [from, to]: [usize; 2],
        cost_m: f64,
        (enter_m, leave_m, heading_rad): ([f64; 2], [f64; 2], f64),
    ) {
        let none = self.strides.len();
        let way = Way {
            first: none,
            end: none,
            enter_m,
            leave_m: Some(leave_m),
            fit: Fit::Holds,
            at_goal: false,
            turned_rad: Some(heading_rad),
        };
        self.add(scene.terrain, (from, Some(to)), cost_m, way);
    }
}

/// Directions to either side of a heading, and near to them, or all for one who `turns`.
fn sides(
    tuning: &SidewaysPassagesTuning,
    heading_rad: f64,
    turns: bool,
) -> impl Iterator<Item = f64> + use<> {
    let (directions, aside_rad) = (tuning.directions, tuning.aside);
    let own = [FRAC_PI_2, -FRAC_PI_2].map(|side_rad| heading_rad + side_rad);
    let near = move |along_rad: &f64| {
        let off = |side_rad: &f64| wrap_angle(along_rad - side_rad).abs();
        turns || own.iter().any(|side_rad| off(side_rad) < aside_rad)
    };
    let all = (0..directions).map(move |i| TAU * f64::from(i) / f64::from(directions));
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
