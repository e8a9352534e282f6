//! Where the next foot lands: curved steps, side steps and turns within what the gait can do.

use behaviour::Velocity;
use geometry::{PlanarPose, wrap_angle};
use nalgebra::Vector2;
use robot::{Body, Side};

use crate::config::GaitConfig;

/// Places a foot relative to the one that stands.
#[derive(Debug, Clone)]
pub struct FootstepPlanner {
    config: GaitConfig,
    /// Length of a sole, m.
    pub(crate) sole_length_m: f64,
    sole_width_m: f64,
    /// Height of the hips over the soles, m.
    pub(crate) leg_m: f64,
}

impl FootstepPlanner {
    /// A planner for this gait and these soles.
    pub fn new(config: &GaitConfig, body: &Body) -> Self {
        let legs = &body.description().legs;
        Self {
            config: config.clone(),
            sole_length_m: legs.left.sole.length.max(legs.right.sole.length),
            sole_width_m: legs.left.sole.width.max(legs.right.sole.width),
            leg_m: config.hip_height,
        }
    }

    /// Half of a sole's length and width, m.
    pub const fn half_sole_m(&self) -> Vector2<f64> {
        Vector2::new(0.5 * self.sole_length_m, 0.5 * self.sole_width_m)
    }

    /// The place beside the standing foot.
    pub fn beside(&self, stance: &PlanarPose, swing: Side) -> PlanarPose {
        stance.compose(&PlanarPose::new(
            0.0,
            swing.sign() * self.config.stance_width,
            0.0,
        ))
    }

    /// Whether the feet stand side by side.
    pub fn is_beside(&self, stance: &PlanarPose, other: &PlanarPose, side: Side) -> bool {
        let wanted = self.beside(stance, side);
        let tuning = &self.config.tuning.stance;
        wanted.distance_m(other) < tuning.beside
            && wrap_angle(wanted.yaw_rad - other.yaw_rad).abs() < tuning.beside_turn
    }

    /// The next landing of `swing` at this velocity. Sideways and turning, the foot on that side goes the whole way of a pair of
    /// steps and the other one closes up, so that the feet never come nearer to each other than side by side.
    pub fn next(&self, stance: &PlanarPose, swing: Side, velocity: &Velocity) -> PlanarPose {
        let config = &self.config;
        let number = |value: f64| if value.is_finite() { value } else { 0.0 };
        let leads = |rate: f64| if rate * swing.sign() > 0.0 { 2.0 } else { 0.0 };
        let (x_mps, y_mps, yaw_radps) = (
            number(velocity.x_mps),
            number(velocity.y_mps),
            number(velocity.yaw_radps),
        );
        let time = config.step_time;
        let x = (x_mps * time).clamp(-config.max_backward, config.max_forward);
        let y = (leads(y_mps) * y_mps * time).clamp(-config.max_sideways, config.max_sideways);
        let yaw = (leads(yaw_radps) * yaw_radps * time).clamp(-config.max_turn, config.max_turn);
        let middle = stance.compose(&PlanarPose::new(
            0.0,
            swing.sign() * 0.5 * config.stance_width,
            0.0,
        ));
        let (sin, cos) = libm::sincos(0.5 * yaw);
        let advanced = middle.compose(&PlanarPose::new(cos * x - sin * y, sin * x + cos * y, yaw));
        let half = PlanarPose::new(0.0, swing.sign() * 0.5 * config.stance_width, 0.0);
        self.keep_apart(stance, &advanced.compose(&half), swing)
    }

    /// Moves a landing within reach: not onto the standing foot, not farther than the legs go.
    pub fn keep_apart(&self, stance: &PlanarPose, landing: &PlanarPose, swing: Side) -> PlanarPose {
        let config = &self.config;
        if !(landing.x_m.is_finite() && landing.y_m.is_finite() && landing.yaw_rad.is_finite()) {
            return self.beside(stance, swing);
        }
        let extra = config.capture_limit;
        let along_m = [-config.max_backward - extra, config.max_forward + extra];
        self.within(stance, landing, swing, along_m)
    }

    /// Moves a landing of a walked step of a list within reach, as [`Self::keep_apart`]: no farther than a walk goes without a push.
    pub fn within_walk(
        &self,
        stance: &PlanarPose,
        landing: &PlanarPose,
        swing: Side,
    ) -> PlanarPose {
        let along_m = [-self.config.max_backward, self.config.max_forward];
        self.within(stance, landing, swing, along_m)
    }

    /// Moves a landing of a careful step within reach, as [`Self::keep_apart`].
    pub fn within_climb(
        &self,
        stance: &PlanarPose,
        landing: &PlanarPose,
        swing: Side,
    ) -> PlanarPose {
        let most = self.config.climb_forward;
        self.within(stance, landing, swing, [-most, most])
    }

    /// Moves a landing of a step that catches a push within reach, as [`Self::keep_apart`]: as far as legs go for once.
    pub fn within_catch(
        &self,
        stance: &PlanarPose,
        landing: &PlanarPose,
        swing: Side,
    ) -> PlanarPose {
        let tuning = &self.config.tuning.catching;
        let along_m = tuning.along * self.leg_m;
        let mut local = stance.relative(landing);
        local.x_m = local.x_m.clamp(-along_m, along_m);
        let (nearest, _) = self.lateral_limits_m(local.yaw_rad);
        let farthest = (self.config.stance_width + tuning.aside * self.leg_m).max(nearest);
        local.y_m = swing.sign() * (swing.sign() * local.y_m).clamp(nearest, farthest);
        stance.compose(&local)
    }

    /// A landing moved to between these places along the standing foot, beside it, and turned no further than the gait turns.
    fn within(
        &self,
        stance: &PlanarPose,
        landing: &PlanarPose,
        swing: Side,
        [rear_m, front_m]: [f64; 2],
    ) -> PlanarPose {
        let mut local = stance.relative(landing);
        local.x_m = local.x_m.clamp(rear_m, front_m);
        local.yaw_rad = local
            .yaw_rad
            .clamp(-self.config.max_turn, self.config.max_turn);
        let (nearest, _) = self.lateral_limits_m(local.yaw_rad);
        let farthest = (self.config.stance_width + self.config.climb_sideways).max(nearest);
        local.y_m = swing.sign() * (swing.sign() * local.y_m).clamp(nearest, farthest);
        stance.compose(&local)
    }

    /// Least and largest distance of the feet's centres across the standing foot when they differ by this heading.
    pub fn lateral_limits_m(&self, yaw_rad: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(yaw_rad.abs());
        let nearest = 0.5 * (self.sole_width_m * (1.0 + cos) + self.sole_length_m * sin)
            + self.config.foot_gap;
        let farthest = self.config.stance_width + self.config.max_sideways;
        (nearest, farthest.max(nearest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::{biped, config};
    use proptest::prelude::*;

    fn any_rate() -> impl Strategy<Value = f64> {
        prop_oneof![
            8 => -1.0..1.0f64,
            1 => Just(f64::NAN),
            1 => prop_oneof![Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e300)],
        ]
    }

    fn velocity() -> impl Strategy<Value = Velocity> {
        (any_rate(), any_rate(), any_rate()).prop_map(|(x_mps, y_mps, yaw_radps)| Velocity {
            x_mps,
            y_mps,
            yaw_radps,
        })
    }

    fn planner() -> FootstepPlanner {
        FootstepPlanner::new(&config(), &biped())
    }

    /// Whether two soles of the biped overlap, by the separating axes of rectangles.
    fn overlap(a: &PlanarPose, b: &PlanarPose) -> bool {
        let corners = |foot: &PlanarPose| {
            [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
                .map(|(x, y)| foot.apply(0.0525 * x, 0.0375 * y))
        };
        [a.yaw_rad, b.yaw_rad].iter().all(|&yaw| {
            [
                (libm::cos(yaw), libm::sin(yaw)),
                (-libm::sin(yaw), libm::cos(yaw)),
            ]
            .iter()
            .all(|(x, y)| {
                let span = |foot: &PlanarPose| {
                    let on = corners(foot).map(|corner| corner.0 * x + corner.1 * y);
                    (
                        on.iter().copied().fold(f64::MAX, f64::min),
                        on.iter().copied().fold(f64::MIN, f64::max),
                    )
                };
                let (a, b) = (span(a), span(b));
                a.0 <= b.1 && b.0 <= a.1
            })
        })
    }

    proptest! {
        #[test]
        fn soles_never_overlap_whatever_is_asked(
            rates in prop::collection::vec(velocity(), 1..12),
            first_left in any::<bool>(),
        ) {
            let planner = planner();
            let mut stance = PlanarPose::default();
            let mut swing = if first_left { Side::Left } else { Side::Right };
            for velocity in rates {
                let landing = planner.next(&stance, swing, &velocity);
                prop_assert!(landing.x_m.is_finite() && landing.y_m.is_finite() && landing.yaw_rad.is_finite());
                prop_assert!(!overlap(&stance, &landing), "{stance:?} {landing:?}");
                (stance, swing) = (landing, swing.other());
            }
        }

        #[test]
        fn no_step_goes_beyond_the_gait(velocity in velocity()) {
            let config = config();
            let landing = planner().next(&PlanarPose::default(), Side::Left, &velocity);
            let reach = config.max_forward + 2.0 * config.max_turn * config.stance_width;
            prop_assert!(landing.x_m.abs() <= reach);
            prop_assert!(landing.yaw_rad.abs() <= config.max_turn + 1e-12);
            prop_assert!(landing.y_m <= config.stance_width + config.max_sideways + 1e-12);
        }
    }

    #[test]
    fn a_pair_of_steps_goes_as_fast_as_it_was_told() {
        let (planner, config) = (planner(), config());
        let velocity = Velocity {
            x_mps: 0.05,
            y_mps: 0.02,
            yaw_radps: 0.0,
        };
        let right = planner.beside(&PlanarPose::default(), Side::Right);
        let first = planner.next(&right, Side::Left, &velocity);
        let second = planner.next(&first, Side::Right, &velocity);
        let time = 2.0 * config.step_time;
        assert!((second.x_m - right.x_m - 0.05 * time).abs() < 1e-12);
        assert!((second.y_m - right.y_m - 0.02 * time).abs() < 1e-12);
    }

    #[test]
    fn beside_is_side_by_side() {
        let stance = PlanarPose::new(1.0, 2.0, 0.7);
        for side in Side::BOTH {
            let other = planner().beside(&stance, side);
            assert!(planner().is_beside(&stance, &other, side));
            assert!(!planner().is_beside(&stance, &stance, side));
        }
    }
}
