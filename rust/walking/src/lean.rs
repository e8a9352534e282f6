//! How far the torso leans forward on a high step: so far that the shank of the leg that goes up first clears the step behind it.
//!
//! While the feet stand on two levels the hips are only as high as the lower foot lets them, and the knee of the upper leg comes far
//! ahead of its foot. A torso that leans brings the hips back and up under the same centre of mass.

use nalgebra::Vector2;

use crate::config::GaitConfig;
use crate::gait::Gait;
use crate::leg::LegSolver;
use crate::phase::FootPose;
use crate::trunk::{Trunk, TrunkPlace};
use crate::tuning::LeanTuning;

/// A foot that stands higher than the other one and ahead of it.
#[derive(Debug, Clone, Copy)]
struct UpperFoot {
    index: usize,
    foot: FootPose,
    /// How much higher than the other one, m.
    rise_m: f64,
}

impl UpperFoot {
    fn of(gait: &Gait, forward: &Vector2<f64>) -> Option<Self> {
        let [left, right] = &gait.feet;
        let index = usize::from(right.z_m > left.z_m);
        let (foot, lower) = (gait.feet[index], &gait.feet[1 - index]);
        let way = Vector2::new(
            foot.planar.x_m - lower.planar.x_m,
            foot.planar.y_m - lower.planar.y_m,
        );
        (way.dot(forward) > 0.0).then_some(Self {
            index,
            foot,
            rise_m: foot.z_m - lower.z_m,
        })
    }
}

/// The lean of the torso.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lean {
    most_rad: f64,
    half_sole_m: f64,
    tuning: LeanTuning,
    goal_rad: f64,
    rate_radps: f64,
    /// How far it leans forward, rad.
    pub(crate) rad: f64,
}

impl Lean {
    pub(crate) fn new(config: &GaitConfig, half_sole_m: f64) -> Self {
        Self {
            most_rad: config.climb_lean,
            half_sole_m,
            tuning: config.tuning.lean.clone(),
            ..Self::default()
        }
    }

    /// The least lean at which the shank of a foot that stands on the higher of two levels clears the step ahead, taken to be as high again
    /// and right before the toes; none where the shank ends above such a step. `height_m`: of the torso's origin, where it is so.
    pub(crate) fn needed_rad(
        &self,
        gait: &Gait,
        legs: &[LegSolver; 2],
        trunk: &Trunk,
        com: &Vector2<f64>,
        height_m: impl Fn(&TrunkPlace) -> f64,
    ) -> f64 {
        let forward = trunk.place(0.0).forward;
        let Some(upper) = UpperFoot::of(gait, &forward) else {
            return 0.0;
        };
        if self.most_rad <= 0.0 || upper.rise_m <= legs[upper.index].ankle_height_m() {
            return 0.0;
        }
        let clears = |lean_rad: f64| {
            let place = trunk.place(lean_rad);
            let over = com + place.from_com;
            self.clearance_m(&upper, &legs[upper.index], &place, &over, height_m(&place))
                >= self.tuning.clearance
        };
        if clears(0.0) {
            return 0.0;
        }
        let (mut less, mut enough) = (0.0, self.most_rad);
        for _ in 0..self.tuning.halvings {
            let middle = 0.5 * (less + enough);
            if clears(middle) {
                enough = middle;
            } else {
                less = middle;
            }
        }
        enough
    }

    /// From the edge of the step ahead to the middle line of the shank, m.
    fn clearance_m(
        &self,
        upper: &UpperFoot,
        leg: &LegSolver,
        place: &TrunkPlace,
        over: &Vector2<f64>,
        height_m: f64,
    ) -> f64 {
        let planar = &upper.foot.planar;
        let (x, y) = planar.apply(self.half_sole_m + self.tuning.edge_ahead, 0.0);
        let ankle = leg.ankle_in_plan(planar);
        let edge_ahead_m = (Vector2::new(x, y) - ankle).dot(&place.forward);
        let edge_up_m = upper.rise_m - leg.ankle_height_m();
        let hip = &place.hips[upper.index];
        let across = over + hip.xy() - ankle;
        let ahead_m = across.dot(&place.forward);
        let up_m = height_m + hip.z - upper.foot.z_m - leg.ankle_height_m();
        let (thigh_m, shank_m) = leg.lengths_m();
        let away_m = geometry::hypot(across.norm(), up_m).max(f64::MIN_POSITIVE);
        let cos =
            (shank_m * shank_m + away_m * away_m - thigh_m * thigh_m) / (2.0 * shank_m * away_m);
        let shank_rad = libm::acos(cos.clamp(-1.0, 1.0)) + libm::atan2(ahead_m, up_m);
        let (sin, cos) = libm::sincos(shank_rad);
        edge_ahead_m * cos - edge_up_m * sin
    }

    /// The lean that can be reached in this time when it is to be `needed_rad` then, rad.
    pub(crate) fn after_rad(&self, needed_rad: f64, passed_s: f64) -> f64 {
        let most_rad = self.tuning.speed * passed_s;
        needed_rad.clamp((self.rad - most_rad).max(0.0), self.rad + most_rad)
    }

    /// How far it has to lean already where it is to lean so far in this time, rad.
    pub(crate) fn before_rad(&self, needed_rad: f64, left_s: f64) -> f64 {
        needed_rad - self.tuning.speed * left_s
    }

    /// Leans for this time towards `goal_rad`: critically damped, implicit in the rate.
    pub(crate) fn go(&mut self, goal_rad: f64, passed_s: f64) {
        let most_rad = self.tuning.speed * passed_s;
        self.goal_rad += (goal_rad.max(0.0) - self.goal_rad).clamp(-most_rad, most_rad);
        if self.goal_rad == 0.0 && self.rad < self.tuning.upright {
            (self.rad, self.rate_radps) = (0.0, 0.0);
            return;
        }
        let stiff = passed_s / self.tuning.smooth_time;
        let pull = (self.goal_rad - self.rad) / self.tuning.smooth_time;
        self.rate_radps = (self.rate_radps + stiff * pull) / ((1.0 + stiff) * (1.0 + stiff));
        self.rad = (self.rad + self.rate_radps * passed_s).max(0.0);
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;
    use nalgebra::{UnitQuaternion, Vector3};
    use proptest::prelude::*;
    use robot::Side;

    use super::*;
    use crate::footsteps::FootstepPlanner;
    use crate::test_biped::{biped, config, foot_at};

    const FRONT_M: f64 = 0.1;

    /// Legs, and a gait whose left foot stands ahead and this much higher.
    fn on_two_levels(rise_m: f64) -> ([LegSolver; 2], Gait) {
        let body = biped();
        let config = config();
        let legs = Side::BOTH.map(|side| {
            LegSolver::new(&body, side, config.max_extension, &config.tuning.leg).unwrap()
        });
        let (mut left, right) = (foot_at(FRONT_M, 0.0425), foot_at(0.0, -0.0425));
        left.z_m = rise_m;
        let planner = FootstepPlanner::new(&config, &body);
        (legs, Gait::new(&config, planner, [left, right]))
    }

    fn trunk() -> Trunk {
        Trunk {
            heading: UnitQuaternion::identity(),
            com: Vector3::new(0.0, 0.0, 0.1),
            hips: [
                Vector3::new(0.0, 0.0425, 0.0),
                Vector3::new(0.0, -0.0425, 0.0),
            ],
            roll_rad: 0.0,
        }
    }

    /// With this tuning, the feet on two levels.
    fn leaning(tuning: LeanTuning) -> Lean {
        Lean {
            tuning,
            ..Lean::new(&config(), 0.05)
        }
    }

    /// Hips over the upper foot at this height over it, m.
    fn needed_rad(lean: &Lean, rise_m: f64, hip_m: f64) -> f64 {
        let (legs, gait) = on_two_levels(rise_m);
        let com = Vector2::new(FRONT_M, 0.0);
        let height = |place: &TrunkPlace| rise_m + hip_m - place.hips[0].z;
        lean.needed_rad(&gait, &legs, &trunk(), &com, height)
    }

    /// From the edge ahead to the shank at this lean, m.
    fn clearance_m(lean: &Lean, rise_m: f64, hip_m: f64, lean_rad: f64) -> f64 {
        let (legs, gait) = on_two_levels(rise_m);
        let place = trunk().place(lean_rad);
        let upper = UpperFoot::of(&gait, &place.forward).unwrap();
        let over = Vector2::new(FRONT_M, 0.0) + place.from_com;
        let height_m = rise_m + hip_m - place.hips[0].z;
        lean.clearance_m(&upper, &legs[0], &place, &over, height_m)
    }

    #[test]
    fn a_step_no_higher_than_the_ankle_or_a_foot_that_is_behind_asks_for_no_lean() {
        let lean = leaning(LeanTuning {
            clearance: 0.06,
            ..LeanTuning::default()
        });
        assert_eq!(needed_rad(&lean, 0.04, 0.13), 0.0);
        assert!(needed_rad(&lean, 0.08, 0.13) > 0.1);
        let (legs, mut gait) = on_two_levels(0.08);
        gait.feet[0].planar = PlanarPose::new(-FRONT_M, 0.0425, 0.0);
        let height = |_: &TrunkPlace| 0.2;
        let needed = lean.needed_rad(&gait, &legs, &trunk(), &Vector2::zeros(), height);
        assert_eq!(needed, 0.0);
    }

    proptest! {
        #[test]
        fn the_torso_leans_no_further_than_the_shank_asks_for(
            hip_m in 0.14..0.2f64, rise_m in 0.05..0.1f64, clearance in 0.0..0.06f64,
        ) {
            let lean = leaning(LeanTuning { clearance, ..LeanTuning::default() });
            let needed = needed_rad(&lean, rise_m, hip_m);
            let most = config().climb_lean;
            prop_assert!((0.0..=most).contains(&needed));
            if needed < most {
                prop_assert!(clearance_m(&lean, rise_m, hip_m, needed) >= clearance);
            }
            let less = needed - 1.01 * most * libm::exp2(-(lean.tuning.halvings as f64));
            if less > 0.0 {
                prop_assert!(clearance_m(&lean, rise_m, hip_m, less) < clearance);
            }
        }

        #[test]
        fn the_torso_leans_no_faster_than_it_may_and_gets_upright_again(goal_rad in 0.0..0.6f64) {
            let mut lean = Lean::new(&config(), 0.05);
            let most_rad = lean.tuning.speed * 0.01;
            for tick in 0..400 {
                let before = lean.rad;
                lean.go(if tick < 200 { goal_rad } else { 0.0 }, 0.01);
                prop_assert!((lean.rad - before).abs() <= most_rad + 1e-12);
                prop_assert!(lean.rad <= goal_rad + 1e-9);
                if tick == 199 {
                    prop_assert!((lean.rad - goal_rad).abs() < 1e-3);
                }
            }
            prop_assert_eq!(lean.rad, 0.0);
        }
    }
}
