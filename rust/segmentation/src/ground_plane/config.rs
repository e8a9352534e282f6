//! Settings that all segmenters share: `[navigation.ground]`.

use settings::{ANY, NOT_NEGATIVE, POSITIVE, SHARE, at_least, between, settings};

use super::tuning::GroundTuning;

settings! {
    /// The noise of the disparities, the smallest region, and how the ground is found and followed.
    pub struct GroundConfig("navigation.ground") {
        /// Whether what is seen of the ground corrects the camera's pose; false, to compare: surfaces are shown where the joints have
        /// them.
        correct: bool = true, "-", ANY;
        /// Smallest noise of a disparity that is believed. Matching windows overlap, so that neighbours differ less
        /// than they err: what is measured in the image can only raise this calibrated figure.
        noise_floor: f64 = 0.125, "px", POSITIVE, "003, section III";
        /// Largest noise that the thresholds follow, as a multiple of `noise_floor`.
        noise_ceiling: f64 = 4.0, "1", at_least(1.0);
        /// Fewest pixels of a region.
        min_region: usize = 80, "1", POSITIVE;
        /// Fewest pixels of the ground. One of `tuning.reference.core_part` of them must be left when its border is taken off.
        min_ground: usize = 150, "1", POSITIVE;
        /// A ground that is searched is what is seen as near to the robot as this: it stands on the floor before its feet, whatever
        /// share of the picture that is.
        underfoot_reach: f64 = 0.29, "m", POSITIVE;
        /// A ground that is searched, not seen as near as `underfoot_reach` and not even, is most of what is seen up to this distance
        /// from the robot: what is further away may be the slope of a staircase.
        search_reach: f64 = 0.45, "m", POSITIVE;
        /// What is seen up to this distance from the robot is near its feet: there a ground that is searched must not slope.
        near_reach: f64 = 0.36, "m", POSITIVE;
        /// Smallest share of the image that must show what is near the feet for it to be judged.
        near_floor: f64 = 0.17, "1", SHARE;
        /// Widest error of roll and of pitch when the ground is searched; the attitude adds to the 7 degrees of the paper.
        search_tilt: f64 = 0.15, "rad", between(0.0, 0.5), "003, section III";
        /// Widest error of roll and pitch together while the ground is tracked.
        track_tilt: f64 = 0.044, "rad", between(0.0, 0.5);
        /// Largest distance of the ground from where the joints have it.
        ground_height: f64 = 0.02, "m", POSITIVE;
        /// Largest distance of the ground from where it is tracked.
        track_height: f64 = 0.012, "m", POSITIVE;
        /// Largest distance of a level surface from where it is known to lie: less than half of the lowest step.
        known_height: f64 = 0.007, "m", POSITIVE;
        /// Frames without any level surface for which the correction is still trusted.
        hold_frames: u32 = 40, "frames", NOT_NEGATIVE;
        /// Frames for which the correction is trusted when level surfaces are seen, but neither the ground nor one of known height.
        hold_level_frames: u32 = 400, "frames", NOT_NEGATIVE;
        /// Frames without any level surface after which the ground is searched anew, as at the start.
        forget_frames: u32 = 75, "frames", NOT_NEGATIVE;
        /// A surface tilted by more than this against the ground is no floor: steps of 15 mm laid together, treads of 20 cm apart,
        /// slope by 0.075.
        floor_tilt: f64 = 0.03, "rad", between(0.0, 0.5);
        /// Whether surfaces that are tilted and are no stairs are kept as one, with their height at each pixel; false, to compare: they
        /// fall into level strips. What looks like one and is not yet sure is left out of maps.
        slopes: bool = true, "-", ANY;
        /// Numbers behind these that few will want to turn.
        tuning: GroundTuning;
    }
    require (forget_frames) >= (hold_frames);
}

#[cfg(test)]
mod tests {
    use settings::Table;

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
            "navigation.ground.noise_floor must be > 0, got 0"
        );
        let config = GroundConfig {
            hold_frames: 100,
            ..GroundConfig::default()
        };
        assert!(config.check().is_err());
        let mut config = GroundConfig::default();
        config.tuning.slopes.memory.sure = -1.0;
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.ground.tuning.slopes.memory.sure must be >= 0, got -1"
        );
    }

    #[test]
    fn every_setting_has_a_key_of_its_own_a_unit_and_a_meaning() {
        let mut all = GroundConfig::parameters();
        assert!(
            all.iter()
                .all(|one| !one.unit.is_empty() && one.meaning.ends_with('.'))
        );
        let count = all.len();
        all.sort_by(|a, b| a.key.cmp(&b.key));
        all.dedup_by(|a, b| a.key == b.key);
        assert_eq!(all.len(), count);
    }
}
