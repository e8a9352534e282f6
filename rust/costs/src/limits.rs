//! What a robot can do, from what its folder says of it.

use robot::{Body, BodyError, Side};
use settings::{ConfigError, POSITIVE, SHARE, Table, above_to, settings};

settings! {
    /// What a robot can do where its folder does not say it. What `[gait]` of robot.toml says goes first.
    pub struct LimitsConfig("costs.limits") {
        /// Steepest slope that is walked on: rise per metre.
        slope: f64 = 0.2, "1", above_to(0.0, 10.0);
        /// Highest step, `climb_rise` of `[gait]`.
        climb_rise: f64 = 0.055, "m", POSITIVE;
        /// How high the swing foot is lifted, `step_height` of `[gait]`.
        step_height: f64 = 0.02, "m", POSITIVE;
        /// A foot must clear so many standard deviations of rough ground.
        sigmas: f64 = 2.0, "1", POSITIVE;
        /// Longest step forward, `max_forward` of `[gait]`.
        max_forward: f64 = 0.07, "m", POSITIVE;
        /// Time from one landing to the next, `step_time` of `[gait]`.
        step_time: f64 = 0.6, "s", POSITIVE;
        /// How far inside of the soles' edges the weight stays, as a share of their sizes.
        sole_margin: f64 = 0.06, "1", SHARE;
    }
}

/// A robot whose limits cannot be told.
#[derive(Debug, thiserror::Error)]
pub enum LimitsError {
    /// Settings that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A body that does not fit its own stance.
    #[error(transparent)]
    Body(#[from] BodyError),
}

/// What a robot can do. At its limits it still goes on; beyond one it does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobotLimits {
    /// Steepest slope: rise per metre.
    pub slope: f64,
    /// Largest standard deviation of the ground about its plane, m.
    pub roughness_m: f64,
    /// Highest step up or down, m.
    pub step_m: f64,
    /// Least room to each side of its middle, m.
    pub radius_m: f64,
    /// Least room above the ground, m.
    pub height_m: f64,
    /// Fastest walk, m/s.
    pub speed_mps: f64,
    /// Height of the centre of mass above the soles, m.
    pub com_height_m: f64,
    /// From below the centre of mass to the nearest edge of what it stands on, m.
    pub half_support_m: f64,
    /// From the middle between the soles to the middle of each, m: so far the centre of mass is beside a foot when it takes the weight.
    pub half_stance_m: f64,
    /// Time from one landing to the next, s.
    pub step_time_s: f64,
    /// Length of a sole, m: shorter waves of the ground are bridged by it.
    pub sole_m: f64,
}

impl RobotLimits {
    /// Those of a robot: its size, soles and centre of mass as it stands, and its `[gait]`.
    pub fn of(body: &Body, config: &LimitsConfig) -> Result<Self, LimitsError> {
        config.check()?;
        let description = body.description();
        let gait = |key: &str, default: f64| {
            let said = description.gait.get(key);
            said.and_then(serde_json::Value::as_f64).unwrap_or(default)
        };
        let mut poses = robot::LinkPoses::default();
        body.pose_links(&description.stand, &mut poses)?;
        let [left, right] = Side::BOTH.map(|side| body.torso_from_sole(&poses, side).translation);
        let center = body.center_of_mass_in_torso(&poses);
        let sole = &description.legs.get(Side::Left).sole;
        let stance_m = (left.y - right.y).abs();
        let step_time_s = gait("step_time", config.step_time);
        let across_m = stance_m + sole.width;
        let narrower_m = across_m.min(sole.length);
        Ok(Self {
            slope: config.slope,
            roughness_m: gait("step_height", config.step_height) / config.sigmas,
            step_m: gait("climb_rise", config.climb_rise),
            radius_m: description.body.radius,
            height_m: description.body.height,
            speed_mps: gait("max_forward", config.max_forward) / step_time_s,
            com_height_m: center.z - 0.5 * (left.z + right.z),
            half_support_m: narrower_m * (0.5 - config.sole_margin),
            half_stance_m: 0.5 * stance_m,
            step_time_s,
            sole_m: sole.length,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::biped;

    #[test]
    fn a_robots_limits_follow_from_its_folder() {
        let body = biped();
        let limits = RobotLimits::of(&body, &LimitsConfig::default()).unwrap();
        let description = body.description();
        assert_eq!(limits.radius_m, description.body.radius);
        assert!(limits.com_height_m > 0.05 && limits.com_height_m < description.body.height);
        assert!(limits.half_support_m < 0.5 * description.legs.left.sole.length);
        assert_eq!(limits.roughness_m, 0.01);
    }

    #[test]
    fn what_the_gait_says_goes_before_the_settings() {
        let mut description = biped().description().clone();
        description.gait =
            serde_json::json!({"climb_rise": 0.04, "step_height": 0.03, "max_forward": 0.06});
        let body = Body::new(description).unwrap();
        let limits = RobotLimits::of(&body, &LimitsConfig::default()).unwrap();
        assert_eq!(limits.step_m, 0.04);
        assert_eq!(limits.roughness_m, 0.015);
        assert!((limits.speed_mps - 0.1).abs() < 1e-12);
    }
}
