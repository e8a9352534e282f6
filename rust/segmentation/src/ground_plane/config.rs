//! Settings that all segmenters share: `[navigation.ground]`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

/// The noise of the disparities, the smallest region, and how the ground is found and followed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GroundConfig {
    /// Whether what is seen of the ground corrects the camera's pose; false, to compare: surfaces are shown where the joints have
    /// them.
    pub correct: bool,
    /// Smallest noise of a disparity that is believed, px. Matching windows overlap, so that neighbours differ less
    /// than they err: what is measured in the image can only raise this calibrated figure.
    pub noise_floor: f64,
    /// Largest noise that the thresholds follow, as a multiple of `noise_floor`.
    pub noise_ceiling: f64,
    /// Smallest region, pixels.
    pub min_region: usize,
    /// Smallest ground, pixels; a third of them must be left when its border is taken off.
    pub min_ground: usize,
    /// Smallest ground when it is searched without a track, as a share of the image.
    pub open_floor: f64,
    /// When the ground is searched without a track, it is what is seen up to this distance from the robot, m: it stands on
    /// the floor beside its feet, what is further away may be the slope of a staircase.
    pub search_reach: f64,
    /// What is seen up to this distance from the robot, m, is near its feet: there a ground that is searched must not slope.
    pub near_reach: f64,
    /// Smallest share of the image that must show what is near the feet for it to be judged.
    pub near_floor: f64,
    /// Widest error of roll and of pitch when the ground is searched, rad (the paper: 7 degrees; the attitude adds).
    pub search_tilt: f64,
    /// Widest error of roll and pitch together while the ground is tracked, rad.
    pub track_tilt: f64,
    /// Largest distance of the ground from where the joints have it, m.
    pub ground_height: f64,
    /// Largest distance of the ground from where it is tracked, m.
    pub track_height: f64,
    /// Largest distance of a level surface from where it is known to lie, m: less than half of the lowest step.
    pub known_height: f64,
    /// Frames without any level surface for which the correction is still trusted.
    pub hold_frames: u32,
    /// Frames for which it is trusted when level surfaces are seen, but neither the ground nor one of known height.
    pub hold_level_frames: u32,
    /// Frames without any level surface after which it is searched anew, as at the start.
    pub forget_frames: u32,
    /// A surface tilted by more than this against the ground is no floor, rad: steps of 15 mm laid together, treads of 20 cm apart,
    /// slope by 0.075.
    pub floor_tilt: f64,
    /// Whether surfaces that are tilted by 3 to 10 degrees and are no stairs are kept as one, with their height at each pixel; false:
    /// they fall into level strips. What looks like one and is not yet sure is left out of maps.
    pub slopes: bool,
}

impl Default for GroundConfig {
    fn default() -> Self {
        Self {
            correct: true,
            noise_floor: 0.125,
            noise_ceiling: 4.0,
            min_region: 80,
            min_ground: 150,
            open_floor: 0.12,
            search_reach: 0.45,
            near_reach: 0.36,
            near_floor: 0.17,
            search_tilt: 0.15,
            track_tilt: 0.044,
            ground_height: 0.02,
            track_height: 0.012,
            known_height: 0.007,
            hold_frames: 40,
            hold_level_frames: 400,
            forget_frames: 75,
            floor_tilt: 0.03,
            slopes: false,
        }
    }
}

impl GroundConfig {
    /// Refuses what cannot be used, naming the key.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.ground.{name}");
        for (name, value) in [
            ("noise_floor", self.noise_floor),
            ("search_reach", self.search_reach),
            ("near_reach", self.near_reach),
            ("ground_height", self.ground_height),
            ("track_height", self.track_height),
            ("known_height", self.known_height),
        ] {
            require_positive(&key(name), value)?;
        }
        for (name, value) in [
            ("search_tilt", self.search_tilt),
            ("track_tilt", self.track_tilt),
            ("floor_tilt", self.floor_tilt),
        ] {
            require(
                value > 0.0 && value < 0.5,
                &key(name),
                "> 0 and < 0.5 rad",
                value,
            )?;
        }
        for (name, value) in [
            ("min_region", self.min_region),
            ("min_ground", self.min_ground),
        ] {
            require(value > 0, &key(name), "> 0", value)?;
        }
        require(
            self.noise_ceiling.is_finite() && self.noise_ceiling >= 1.0,
            &key("noise_ceiling"),
            "finite and >= 1",
            self.noise_ceiling,
        )?;
        for (name, value) in [
            ("open_floor", self.open_floor),
            ("near_floor", self.near_floor),
        ] {
            require(
                (0.0..=1.0).contains(&value),
                &key(name),
                "within 0 and 1",
                value,
            )?;
        }
        require(
            self.forget_frames >= self.hold_frames,
            &key("forget_frames"),
            ">= navigation.ground.hold_frames",
            self.forget_frames,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed() {
        assert_eq!(GroundConfig::default().check(), Ok(()));
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        let config = GroundConfig {
            noise_floor: 0.0,
            ..GroundConfig::default()
        };
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.ground.noise_floor must be finite and > 0, got 0"
        );
        let config = GroundConfig {
            hold_frames: 100,
            ..GroundConfig::default()
        };
        assert!(config.check().is_err());
    }
}
