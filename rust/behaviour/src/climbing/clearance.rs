//! Whether there is room: for a move before a step, for the feet on it, to walk and to turn behind it.

use geometry::PlanarPose;
use planning::Step;
use terrain::support::{ObstacleCell, SolesOnGround, cells_under, is_riser, stairs_under};

use super::StairClimbing;
use crate::Situation;
use crate::climbing::flight::crosses_another;
use crate::climbing::footsteps::Stance;
use crate::machine::Tick;

impl StairClimbing {
    /// Whether a move to where `first` is taken from needs no large turn, crosses no other edge, and leaves the soles on the stair
    /// that the robot stands on.
    pub(super) fn stays_on(&self, tick: &Tick<'_>, stance: &Stance, first: &Step) -> bool {
        let tuning = &self.config.tuning.clearance;
        let (stairs, to) = (tick.situation.stairs, &stance.pose);
        if crosses_another(
            stairs,
            (&tick.pose, tick.ground_m),
            to,
            first,
            &self.rules(),
        ) {
            return false;
        }
        let Some(on) = self.memory.on else {
            return true;
        };
        if self.leaves_aside(&on, &tick.pose, &stance.pose) {
            return false;
        }
        let turn_rad = geometry::angle_between(tick.pose.yaw_rad, stance.pose.yaw_rad);
        let least_m = self.climbing.set_for(on.rise_m).front_x_limit - tuning.heels;
        let half_pair_m = 0.5 * self.feet.pair_width_m;
        turn_rad.abs() < tuning.largest_turn
            && [-half_pair_m, half_pair_m].into_iter().all(|aside_m| {
                let (x_m, y_m) = stance.pose.apply(-0.5 * self.feet.length_m, aside_m);
                on.stair.front.beyond_m([x_m, y_m]) >= least_m
            })
    }

    /// Whether a move would bring a sole beyond the side of the stair that the robot stands on, and further than it is.
    fn leaves_aside(&self, on: &Step, from: &PlanarPose, to: &PlanarPose) -> bool {
        let spare_m = self.config.tuning.clearance.aside;
        let edge = &on.stair.front;
        let half_pair_m = 0.5 * self.feet.pair_width_m;
        let sides = [1.0, -1.0].into_iter().zip(on.stair.room_beside_m());
        sides.into_iter().any(|(side, room_m)| {
            let outermost_m = |pose: &PlanarPose| {
                let (x_m, y_m) = pose.apply(0.0, side * half_pair_m);
                side * edge.aside_m([x_m, y_m])
            };
            let end_m = 0.5 * edge.length_m() + room_m;
            outermost_m(to) > end_m.max(outermost_m(from) + spare_m)
        })
    }

    /// Whether something stands where the feet shall go: not the riser behind the heels or before the toes.
    pub(super) fn is_occupied(&self, tick: &Tick<'_>, stance: &Stance) -> bool {
        let tuning = &self.config.tuning.clearance;
        let Situation { view, stairs, .. } = *tick.situation;
        let soles = SolesOnGround {
            half_m: [0.5 * self.feet.length_m, 0.5 * self.feet.pair_width_m],
            raster: self.config.tuning.raster,
        };
        let walking = &self.walking.config().tuning.obstacles;
        let top_m = stance.height_m as f32 + tuning.stands_on;
        let edges = walking.edges();
        let counts = |cell: &ObstacleCell| !is_riser(stairs, cell, edges);
        cells_under(view, soles, &stance.pose, top_m, counts) >= walking.cells
    }

    /// Whether what the robot stands on, as it is known by now, has room to turn and to walk.
    pub(super) fn has_room(&self, tick: &Tick<'_>) -> bool {
        let at = [tick.pose.x_m, tick.pose.y_m];
        let tuning = &self.config.tuning;
        let roomy = |stair: &stairs::Stair<geometry::Map>| stair.depth_m() >= tuning.flight.roomy;
        let level_m = (tick.ground_m, self.climbing.levels.same);
        let mut known_now = stairs_under(tick.situation.stairs, at, level_m);
        self.memory.on.is_none_or(|step| roomy(&step.stair)) || known_now.any(roomy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climbing::simulation::stair;
    use crate::climbing::tests::up;

    #[test]
    fn no_sole_is_moved_beyond_the_side_of_the_tread_that_the_robot_stands_on() {
        let behaviour = up(PlanarPose::default()).behaviour;
        let on = Step {
            stair: stair([0.0, 0.0, 0.0], [0.14, 0.0, 0.0], 0.018, 0.4),
            rise_m: 0.018,
            crossing_m: [0.0, 0.0],
        };
        let leaves = |from_m: f64, to_m: f64| {
            let pose = |y_m: f64| PlanarPose::new(0.08, y_m, 0.0);
            behaviour.leaves_aside(&on, &pose(from_m), &pose(to_m))
        };
        // The outer side of a sole is 8 cm from the middle.
        assert!(!leaves(0.0, 0.115) && !leaves(0.0, -0.115));
        assert!(leaves(0.0, 0.13) && leaves(0.0, -0.13));
        // Who already stands at the side of what was seen of it may stay, and come back.
        assert!(!leaves(0.15, 0.15) && !leaves(0.15, 0.13) && leaves(0.15, 0.17));
    }
}
