//! Settings of the localizer `scan_match`.

use settings::{POSITIVE, settings, within};

use super::tuning::MatchingLocalizerTuning;

settings! {
    /// The localizer `scan_match`: leg odometry whose heading is kept by what stands out of the floor.
    pub struct MatchingConfig("navigation.scan_match") {
        /// Width of a beam: points seen in directions that differ by less are one.
        beam: f64 = 0.026, "rad", POSITIVE;
        /// What is further away than this is too blurred to match.
        reach: f64 = 1.2, "m", POSITIVE;
        /// A beam counts when what it hits rises at least so high above its lowest point.
        rise: f64 = 0.03, "m", POSITIVE;
        /// A beam counts when it has at least so many points.
        beam_points: usize = 4, "1", POSITIVE;
        /// Standard deviation of a disparity.
        disparity_noise: f64 = 0.12, "px", POSITIVE;
        /// Side of the cells in which a keyframe keeps what was seen.
        cell: f64 = 0.05, "m", POSITIVE;
        /// Frames of which a keyframe is made.
        frames: usize = 8, "1", POSITIVE;
        /// Keyframes that are kept at most; the furthest one goes first. Each takes 230 kB.
        keyframes: usize = 24, "1", within(1.0, 1000.0);
        /// A keyframe from further away than this is not compared with.
        distance: f64 = 1.0, "m", POSITIVE;
        /// Beams that must lie on a keyframe's surfaces.
        least_beams: usize = 8, "1", POSITIVE;
        /// Standard deviation of how far odometry and the camera's place may be off between a keyframe and now.
        offset: f64 = 0.02, "m", POSITIVE;
        /// Standard deviation of a heading by one frame: no match is believed to be better.
        heading_noise: f64 = 0.0175, "rad", POSITIVE;
        /// So many frames in a row are wrong in the same way: camera and surfaces err alike.
        alike: f64 = 20.0, "1", POSITIVE;
        /// Standard deviation of the heading that a keyframe keeps.
        keyframe_noise: f64 = 0.009, "rad", POSITIVE;
        /// A new keyframe is begun where those that are known tell the heading worse than this.
        enough: f64 = 0.05, "rad", POSITIVE;
        /// A match that is further off than so many standard deviations is not believed.
        gate: f64 = 3.5, "1", POSITIVE;
        /// A keyframe that was not believed so often in a row is forgotten: what it shows has moved.
        refusals: u32 = 12, "1", POSITIVE;
        /// Standard deviation of a bias that was learned in a second of standing still; it falls with the root of the time.
        rest_noise: f64 = 5e-4, "rad/s" of sensor, POSITIVE;
        /// Standard deviation that is left of a bias, however long it was learned: soles creep.
        bias_creep: f64 = 2e-4, "rad/s" of sensor, POSITIVE;
        /// Random walk of the odometry's heading, per square root of a second.
        heading_drift: f64 = 1e-4, "rad/sqrt(s)" of sensor, POSITIVE;
        /// Until this time nothing is matched: the robot is put down and settles.
        settling: f64 = 1.2, "s", POSITIVE;
        /// Numbers that few will want to turn.
        tuning: MatchingLocalizerTuning;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use settings::Table;

    #[test]
    fn as_many_keyframes_as_fill_the_memory_are_refused() {
        assert_eq!(MatchingConfig::default().check(), Ok(()));
        let config = MatchingConfig {
            keyframes: 1_000_000,
            ..MatchingConfig::default()
        };
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.scan_match.keyframes must be from 1 to 1000, got 1000000"
        );
    }
}
