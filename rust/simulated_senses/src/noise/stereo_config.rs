//! What a stereo camera is like.

use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, SHARE, at_least, require, settings, within};

settings! {
    /// The errors of a stereo camera that matches windows.
    pub struct StereoConfig("camera.stereo") {
        /// Distance between the eyes; the left one is the reference.
        baseline: f64 = 0.06, "m", POSITIVE;
        /// Width and height of the matching window, odd.
        window: usize = 5, "px", within(1.0, 101.0);
        /// Deviation of the disparity error that is the same for the same scene and pose.
        disparity_noise_fixed: f64 = 0.10, "px", NOT_NEGATIVE;
        /// Deviation of the disparity error that is new in each frame.
        disparity_noise_temporal: f64 = 0.05, "px", NOT_NEGATIVE;
        /// Step of the sub-pixel interpolation; 0 for none.
        quantum: f64 = 0.125, "px", NOT_NEGATIVE;
        /// What has less disparity, being farther, is not seen.
        min_disparity: f64 = 1.5, "px", POSITIVE;
        /// What has more disparity, being nearer, is not seen.
        max_disparity: f64 = 24.0, "px", POSITIVE;
        /// Share of the pixels whose match is anywhere.
        mismatch_rate: f64 = 0.007, "1", SHARE;
        /// Surfaces closer than this in disparity blend inside a window.
        crease_bandwidth: f64 = 1.0, "px", POSITIVE;
        /// Probability of a match where the texture is 1.
        valid_textured: f64 = 0.95, "1", SHARE;
        /// Probability of a match where the texture is 0.
        valid_blank: f64 = 0.02, "1", SHARE;
        /// The finer settings.
        tuning: StereoTuning;
    }
    check StereoConfig::fits;
}

impl StereoConfig {
    fn fits(&self, key: &str) -> Result<(), ConfigError> {
        let odd = self.window % 2 == 1;
        require(odd, &format!("{key}.window"), "odd", self.window)?;
        let ordered = self.min_disparity < self.max_disparity;
        let wanted = "below max_disparity";
        require(
            ordered,
            &format!("{key}.min_disparity"),
            wanted,
            self.min_disparity,
        )?;
        let ordered = self.valid_blank <= self.valid_textured;
        let wanted = "at least valid_blank";
        require(
            ordered,
            &format!("{key}.valid_textured"),
            wanted,
            self.valid_textured,
        )
    }
}

settings! {
    /// The finer settings of a stereo camera's errors.
    pub struct StereoTuning("camera.stereo.tuning") {
        /// The error that stays while the picture stays.
        pattern: PatternTuning;
        /// Which pixels find a match.
        matches: MatchTuning;
        /// What is found where surfaces meet.
        creases: CreaseTuning;
    }
}

settings! {
    /// The error that stays while the picture stays. It is another one when the picture has moved by about one pixel: the lengths of
    /// its Gaussian correlation are 1 / 2.15 of what moves the picture by a pixel at 0.6 m.
    pub struct PatternTuning("camera.stereo.tuning.pattern") {
        /// Length over the camera's turn.
        turn: f64 = 0.0046, "rad", POSITIVE;
        /// Length over the camera's way.
        way: f64 = 0.0028, "m", POSITIVE;
        /// Length over the disparity.
        disparity: f64 = 0.23, "px", POSITIVE;
        /// Number of waves that all pixels share.
        waves: usize = 1024, "1", at_least(1.0);
    }
}

settings! {
    /// Which pixels find a match.
    pub struct MatchTuning("camera.stereo.tuning.matches") {
        /// Share of a blank surface's matches that is decided anew in each frame.
        temporal: f64 = 0.4, "1", SHARE;
        /// No match is surer, or less sure, than up to this.
        doubt: f64 = 1e-12, "1", within(1e-15, 0.5);
    }
}

settings! {
    /// What is found where surfaces meet.
    pub struct CreaseTuning("camera.stereo.tuning.creases") {
        /// Most steps of the mean shift.
        iterations: u32 = 4, "1", at_least(1.0);
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn what_no_camera_could_be_is_refused_by_its_key() {
        assert_eq!(StereoConfig::default().check(), Ok(()));
        let refused = |config: StereoConfig| config.check().unwrap_err().to_string();
        let window = StereoConfig {
            window: 4,
            ..StereoConfig::default()
        };
        assert!(refused(window).starts_with("camera.stereo.window must be odd"));
        let disparity = StereoConfig {
            max_disparity: 1.0,
            ..StereoConfig::default()
        };
        assert!(refused(disparity).starts_with("camera.stereo.min_disparity must be below"));
        let valid = StereoConfig {
            valid_textured: 0.01,
            ..StereoConfig::default()
        };
        assert!(refused(valid).starts_with("camera.stereo.valid_textured must be at least"));
    }
}
