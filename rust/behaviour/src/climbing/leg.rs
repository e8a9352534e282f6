//! The legs of a plan: the way to the next climb, cut off where the climb's own states take over.

use geometry::{PlanarPose, distance_m};
use planning::{Plan, Step};
use stairs::{ClimbingConfig, Feet};

use crate::{climbing::StairClimbingConfig, climbing::tuning::ApproachLegTuning};

/// The plan's first climb as seen from the walk before it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ApproachLeg<'a> {
    /// Its steps.
    pub(crate) steps: &'a [Step],
    /// Its first step.
    pub(crate) first: &'a Step,
    /// Where the robot aligns.
    pub(crate) align: PlanarPose,
    from_point: usize,
}

impl<'a> ApproachLeg<'a> {
    /// The first climb of a plan, if it has one.
    pub(crate) fn next(
        plan: Option<&'a Plan>,
        config: &StairClimbingConfig,
        climbing: &ClimbingConfig,
        feet: &Feet,
    ) -> Option<Self> {
        let path = plan?.way.as_ref().ok()?;
        let climb = path.climbs.first()?;
        let first = climb.steps.first()?;
        Some(Self {
            steps: &climb.steps,
            first,
            align: align_pose(first, config, climbing, feet),
            from_point: climb.from_point,
        })
    }

    /// Whether a robot here may go on by the climb's own states.
    pub(crate) fn is_reached(&self, pose: &PlanarPose, tuning: &ApproachLegTuning) -> bool {
        let way = self.align.relative(pose);
        let aside_m = if libm::cos(way.yaw_rad) > tuning.heads_for_it {
            tuning.stops_aside
        } else {
            tuning.aside
        };
        // Whoever is beyond the edge has it behind, not ahead: a plan may lead round the stairs to their far side.
        let before = self.first.stair.front.beyond_m([pose.x_m, pose.y_m]) < 0.0;
        let on_the_way = before && way.x_m > -tuning.near && way.y_m.abs() < aside_m;
        self.align.distance_m(pose) < tuning.near || on_the_way
    }

    /// The part of the plan that is walked: its path ends where the robot aligns.
    pub(crate) fn walk(&self, plan: &Plan, tuning: &ApproachLegTuning) -> Option<Plan> {
        let path = plan.way.as_ref().ok()?;
        let end = self.from_point.min(path.points_m.len().checked_sub(1)?);
        let beyond = |place_m: &[f64; 2]| self.first.stair.front.beyond_m(*place_m);
        let align_m = [self.align.x_m, self.align.y_m];
        let limit_m = beyond(&align_m);
        let near = |place_m: &[f64; 2]| {
            beyond(place_m) > limit_m && distance_m(*place_m, align_m) < tuning.cut * tuning.near
        };
        let kept = path.points_m[..=end]
            .iter()
            .rposition(|place_m| !near(place_m))
            .map_or(1, |last| last + 1);
        let mut cut = path.first(kept);
        cut.points_m.push([self.align.x_m, self.align.y_m]);
        cut.unknown.push(false);
        let clearance_m = cut.clearance_m.last().copied().unwrap_or(f64::INFINITY);
        cut.clearance_m.push(clearance_m);
        Some(Plan {
            way: Ok(cut),
            replanned: plan.replanned,
        })
    }
}

/// The place square before a step from which it is measured: its toes `align_distance` before the edge, or as much further
/// back as the camera needs.
pub(crate) fn align_pose(
    first: &Step,
    config: &StairClimbingConfig,
    climbing: &ClimbingConfig,
    feet: &Feet,
) -> PlanarPose {
    let set = climbing.set_for(first.rise_m);
    let away_m = (set.align_distance + 0.5 * feet.length_m).max(config.look_distance);
    let heading_rad = first.stair.front.heading_rad();
    let (sin, cos) = libm::sincos(heading_rad);
    let on_edge_m = first.stair.front.beyond_m(first.crossing_m);
    let back_m = away_m + on_edge_m;
    PlanarPose::new(
        first.crossing_m[0] - cos * back_m,
        first.crossing_m[1] - sin * back_m,
        heading_rad,
    )
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use proptest::prelude::*;

    use super::*;
    use crate::climbing::simulation::{FEET, stair};

    fn leg(first: &Step) -> ApproachLeg<'_> {
        let (config, climbing) = (StairClimbingConfig::default(), ClimbingConfig::default());
        let align = align_pose(first, &config, &climbing, &FEET);
        ApproachLeg {
            steps: &[],
            first,
            align,
            from_point: 0,
        }
    }

    #[test]
    fn an_edge_on_the_far_side_of_the_stairs_is_not_reached_from_before_them() {
        let first = Step {
            stair: stair([1.4, 0.0, PI], [0.9, 0.0, PI], 0.033, 0.5),
            rise_m: 0.033,
            crossing_m: [1.4, 0.0],
        };
        let (leg, tuning) = (leg(&first), ApproachLegTuning::default());
        assert!(!leg.is_reached(&PlanarPose::new(0.5, 0.05, 0.0), &tuning));
        assert!(leg.is_reached(&PlanarPose::new(1.6, 0.05, PI), &tuning));
    }

    proptest! {
        /// A robot that walks at 10 cm/s comes to stand within 14 cm.
        #[test]
        fn who_heads_for_the_edge_is_stopped_in_time(
            aside_m in -0.25..0.25f64, yaw_rad in -0.7..0.7f64, x_m in 0.0..0.4f64, rise_m in -0.05..0.05f64,
        ) {
            let first = Step {
                stair: stair([0.6, 0.0, 0.0], [0.9, 0.0, 0.0], rise_m, 1.0),
                rise_m,
                crossing_m: [0.6, 0.0],
            };
            let (leg, tuning) = (leg(&first), ApproachLegTuning::default());
            let toes_m = 0.5 * FEET.length_m + 0.14 + 0.01;
            let reached = leg.is_reached(&PlanarPose::new(x_m, aside_m, yaw_rad), &tuning);
            prop_assert!(reached || x_m + toes_m < 0.6);
        }
    }
}
