//! One step: whether it is possible, how it is taken, and what it costs.

use super::limits::StepReach;
use super::plan::{PlannedFootstep, StepCost, StepManner};
use super::space::FootstepSpace;
use super::spots::StandingFoot;

impl FootstepSpace<'_> {
    /// The step of the foot that moves from where it is to a place; `None` where it is not possible.
    pub(super) fn step(
        &self,
        (standing, moving): (&StandingFoot, &StandingFoot),
        there: &StandingFoot,
        reach: StepReach,
    ) -> Option<PlannedFootstep> {
        let height_m = |foot: &StandingFoot| f64::from(foot.foothold.height_m);
        let [rise_m, lift_m] = [standing, moving].map(|foot| height_m(there) - height_m(foot));
        let Self { limits, config, .. } = self;
        if rise_m.abs() > limits.careful_rise_m - config.height_margin
            || lift_m.abs() > limits.careful_lift_m
        {
            return None;
        }
        let way_m = moving.pose.distance_m(&there.pose);
        let even = |foot: &StandingFoot| {
            let [ahead, left] = foot.foothold.slope.map(f64::from);
            f64::from(foot.foothold.bearing_share) >= config.walk_bearing
                && geometry::hypot(ahead, left) <= config.walk_slope
        };
        let level = rise_m.abs().max(lift_m.abs()) <= config.walk_height
            && limits.walks_so_far(way_m)
            && [standing, there].into_iter().all(even);
        let (manner, clearance_m) = match (level, reach) {
            (true, StepReach::Walking | StepReach::WalkingOnly) => {
                (StepManner::Walked, limits.clearance_m[0])
            }
            (false, StepReach::WalkingOnly) => return None,
            (false, _) | (true, StepReach::Careful) => (StepManner::Careful, limits.clearance_m[1]),
        };
        let ahead = || standing.pose.relative(&there.pose);
        if manner == StepManner::Careful && !limits.reaches_down(&ahead(), there.side, -rise_m) {
            return None;
        }
        let hangs_m = moving.hangs_m(limits.sole).max(there.hangs_m(limits.sole));
        let lifted_m =
            height_m(there).max(height_m(moving)) + clearance_m - config.way_margin - hangs_m;
        let seen = (self.map, self.blocks);
        let (from, to) = ((&moving.pose, moving.heading), (&there.pose, there.heading));
        if !self.footholds.is_way_free(seen, from, to, lifted_m as f32) {
            return None;
        }
        if !self.has_room((standing, there), manner) {
            return None;
        }
        let time_s = match manner {
            StepManner::Walked => limits.walked_s,
            StepManner::Careful => limits.careful_s(way_m, lift_m),
        };
        let turn_rad = geometry::angle_between(standing.pose.yaw_rad, there.pose.yaw_rad).abs();
        let missing = 1.0 - f64::from(there.foothold.bearing_share);
        let most = (1.0 - config.foothold.least_bearing).max(f64::EPSILON);
        Some(PlannedFootstep {
            side: there.side,
            pose: there.pose,
            foothold: there.foothold,
            manner,
            cost: StepCost {
                time_s,
                partial_s: config.partial_cost * missing / most
                    + config.uneven_cost * f64::from(there.foothold.unevenness),
                margin_s: config.margin_cost * f64::from(there.foothold.closed_share),
                turn_s: config.turn_cost * turn_rad,
            },
        })
    }

    /// Whether nothing is where the body comes: between the feet, and as the weight is shifted with care, over the one that stands.
    fn has_room(
        &self,
        (standing, there): (&StandingFoot, &StandingFoot),
        manner: StepManner,
    ) -> bool {
        let limits = &self.limits;
        let [from, to] = [standing, there].map(|foot| [foot.pose.x_m, foot.pose.y_m]);
        let middle_m = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        let lower_m = standing.foothold.height_m.min(there.foothold.height_m);
        let body_m = lower_m + limits.body_from_m as f32;
        let is_free = |place_m: [f64; 2]| {
            let radius_m = limits.body_radius_m;
            !(self.blocks).is_higher_within(self.map, place_m, radius_m, body_m)
        };
        is_free(middle_m) && (manner == StepManner::Walked || is_free(from))
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use crate::footsteps::tests::{goal, layer, map};
    use crate::footsteps::{FootstepPlan, StepManner};

    const START: PlanarPose = PlanarPose {
        x_m: 0.0,
        y_m: 0.0,
        yaw_rad: 0.0,
    };

    fn plan(height_m: impl Fn(f64, f64) -> f64) -> FootstepPlan {
        let map = map(height_m);
        let mut layer = layer();
        let feet = layer.feet_around(&START);
        layer.plan(&map, feet, &goal(1.2, 0.0)).unwrap()
    }

    #[test]
    fn a_floor_is_walked_and_on_a_tilted_slab_feet_go_carefully() {
        let careful = |slope: f64| {
            let steps = plan(|_, y_m| slope * y_m).steps;
            let careful = steps
                .iter()
                .filter(|step| step.manner == StepManner::Careful);
            (careful.count(), steps.len())
        };
        assert_eq!(careful(0.02).0, 0);
        let (slow, all) = careful(0.05);
        assert_eq!(slow, all);
    }

    #[test]
    fn the_body_has_room_over_a_foot_that_stands_while_the_other_goes_carefully() {
        // A step up beside a wall that leaves the body room between the feet, and hardly over the outer one.
        let wall_m = 0.22;
        let found = plan(|x_m, y_m| match (x_m, y_m) {
            (_, y_m) if y_m < -wall_m => 0.5,
            (0.4.., _) => 0.03,
            _ => 0.0,
        });
        let mut careful = 0;
        let mut feet = layer().feet_around(&START);
        for step in &found.steps {
            let standing = feet[step.side.other().index()];
            if step.manner == StepManner::Careful {
                careful += 1;
                assert!(standing.y_m + wall_m > 0.13, "{step:?}");
            }
            feet[step.side.index()] = step.pose;
        }
        assert!(careful >= 2);
    }
}
