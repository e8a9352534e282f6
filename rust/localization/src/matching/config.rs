//! Settings of the localizer `matching`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require, require_positive};

/// A keyframe takes 230 kB.
const MOST_KEYFRAMES: usize = 1000;

/// Settings of [`super::MatchingLocalizer`]: `[navigation.matching]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MatchingConfig {
    /// Width of a beam: points seen in directions that differ by less are one, rad.
    pub beam: f64,
    /// What is further away than this is too blurred to match, m.
    pub reach: f64,
    /// A beam counts when what it hits rises at least so high above its lowest point, m,
    pub rise: f64,
    /// and has at least so many points.
    pub beam_points: usize,
    /// Standard deviation of a disparity, px.
    pub disparity_noise: f64,
    /// Side of the cells in which a keyframe keeps what was seen, m.
    pub cell: f64,
    /// Frames of which a keyframe is made.
    pub frames: usize,
    /// Keyframes that are kept at most; the furthest one goes first.
    pub keyframes: usize,
    /// A keyframe from further away than this is not compared with, m.
    pub distance: f64,
    /// Beams that must lie on a keyframe's surfaces.
    pub least_beams: usize,
    /// Standard deviation of how far odometry and the camera's place may be off between a keyframe and now, m.
    pub offset: f64,
    /// Standard deviation of a heading by one frame, rad: no match is believed to be better.
    pub heading_noise: f64,
    /// So many frames in a row are wrong in the same way: camera and surfaces err alike.
    pub alike: f64,
    /// Standard deviation of the heading that a keyframe keeps, rad.
    pub keyframe_noise: f64,
    /// A new keyframe is begun where those that are known tell the heading worse than this, rad.
    pub enough: f64,
    /// A match that is further off than so many standard deviations is not believed.
    pub gate: f64,
    /// A keyframe that was not believed so often in a row is forgotten: what it shows has moved.
    pub refusals: u32,
    /// Standard deviation of the gyroscope's bias about the vertical before the robot stood still, rad/s.
    pub bias: f64,
    /// The robot stands still while it turns by less than this about every axis, rad/s,
    pub rest_rate: f64,
    /// from this time on, s.
    pub rest_time: f64,
    /// Standard deviation of a bias that was learned in a second of that, rad/s; it falls with the root of the time,
    pub rest_noise: f64,
    /// but for this, rad/s: soles creep.
    pub bias_creep: f64,
    /// Its random walk, rad/s per square root of a second.
    pub bias_drift: f64,
    /// Random walk of the odometry's heading, rad per square root of a second.
    pub heading_drift: f64,
    /// Until this time nothing is matched, s: the robot is put down and settles.
    pub settling: f64,
}

impl Default for MatchingConfig {
    fn default() -> Self {
        Self {
            beam: 0.026,
            reach: 1.2,
            rise: 0.03,
            beam_points: 4,
            disparity_noise: 0.12,
            cell: 0.05,
            frames: 8,
            keyframes: 24,
            distance: 1.0,
            least_beams: 8,
            offset: 0.02,
            heading_noise: 0.0175,
            alike: 20.0,
            keyframe_noise: 0.009,
            enough: 0.05,
            gate: 3.5,
            refusals: 12,
            bias: 0.0015,
            rest_rate: 0.01,
            rest_time: 0.2,
            rest_noise: 5e-4,
            bias_creep: 2e-4,
            bias_drift: 1e-5,
            heading_drift: 1e-4,
            settling: 1.2,
        }
    }
}

impl MatchingConfig {
    /// Refuses what cannot be used.
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("beam", self.beam),
            ("reach", self.reach),
            ("rise", self.rise),
            ("beam_points", self.beam_points as f64),
            ("disparity_noise", self.disparity_noise),
            ("cell", self.cell),
            ("frames", self.frames as f64),
            ("keyframes", self.keyframes as f64),
            ("distance", self.distance),
            ("least_beams", self.least_beams as f64),
            ("offset", self.offset),
            ("heading_noise", self.heading_noise),
            ("alike", self.alike),
            ("keyframe_noise", self.keyframe_noise),
            ("enough", self.enough),
            ("gate", self.gate),
            ("refusals", f64::from(self.refusals)),
            ("bias", self.bias),
            ("rest_rate", self.rest_rate),
            ("rest_time", self.rest_time),
            ("rest_noise", self.rest_noise),
            ("bias_creep", self.bias_creep),
            ("bias_drift", self.bias_drift),
            ("heading_drift", self.heading_drift),
            ("settling", self.settling),
        ] {
            require_positive(&format!("navigation.matching.{name}"), value)?;
        }
        require(
            self.keyframes <= MOST_KEYFRAMES,
            "navigation.matching.keyframes",
            &format!("at most {MOST_KEYFRAMES}"),
            self.keyframes,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_keyframes_as_fill_the_memory_are_refused() {
        assert_eq!(MatchingConfig::default().check(), Ok(()));
        let config = MatchingConfig {
            keyframes: 1_000_000,
            ..MatchingConfig::default()
        };
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.matching.keyframes must be at most 1000, got 1000000"
        );
    }
}
