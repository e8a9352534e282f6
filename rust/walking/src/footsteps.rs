//! Where the next foot lands: curved steps, side steps and turns within what the gait can do.

use behaviour::Velocity;
use geometry::{PlanarPose, wrap_angle};
use robot::{Body, Side};

use crate::GaitConfig;

/// Places a foot relative to the one that stands.
#[derive(Debug, Clone)]
pub struct FootstepPlanner {
    config: GaitConfig,
    sole_length_m: f64,
    sole_width_m: f64,
}

impl FootstepPlanner {
    /// A planner for this gait and these soles.
    pub fn new(config: &GaitConfig, body: &Body) -> Self {
        let legs = &body.description().legs;
        Self {
            config: config.clone(),
            sole_length_m: legs.left.sole.length.max(legs.right.sole.length),
            sole_width_m: legs.left.sole.width.max(legs.right.sole.width),
        }
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
        wanted.distance_m(other) < 0.01 && wrap_angle(wanted.yaw_rad - other.yaw_rad).abs() < 0.03
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
        let (sin, cos) = (0.5 * yaw).sin_cos();
        let advanced = middle.compose(&PlanarPose::new(cos * x - sin * y, sin * x + cos * y, yaw));
        let half = PlanarPose::new(0.0, swing.sign() * 0.5 * config.stance_width, 0.0);
        self.keep_apart(stance, &advanced.compose(&half), swing)
    }

    /// Moves a landing within reach: not onto the standing foot, not farther than the legs go.
    pub fn keep_apart(&self, stance: &PlanarPose, landing: &PlanarPose, swing: Side) -> PlanarPose {
        let config = &self.config;
        let mut local = stance.relative(landing);
        local.yaw_rad = local.yaw_rad.clamp(-config.max_turn, config.max_turn);
        let (nearest, farthest) = self.lateral_limits_m(local.yaw_rad);
        local.y_m = swing.sign() * (swing.sign() * local.y_m).clamp(nearest, farthest);
        stance.compose(&local)
    }

    /// Least and largest distance of the feet's centres across the standing foot when they differ by this heading.
    pub fn lateral_limits_m(&self, yaw_rad: f64) -> (f64, f64) {
        let (sin, cos) = yaw_rad.abs().sin_cos();
        let nearest = 0.5 * (self.sole_width_m * (1.0 + cos) + self.sole_length_m * sin)
            + self.config.foot_gap;
        let farthest = self.config.stance_width + self.config.max_sideways;
        (nearest, farthest.max(nearest))
    }
}
