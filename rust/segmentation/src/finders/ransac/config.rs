//! Settings of the segmenter `ransac`.

use settings::{POSITIVE, at_least, settings, within};

use crate::finders::free_planes::tuning::{FreePlaneTuning, PeelingTuning};

settings! {
    /// How planes are found by random samples: the segmenter `ransac`.
    pub struct RansacConfig("navigation.ransac") {
        /// Triples of pixels that are tried for each plane.
        samples: usize = 300, "1", within(1.0, 100_000.0);
        /// A pixel belongs to a plane when it is closer to it than this, in disparity.
        accept: f64 = 0.25, "px", POSITIVE;
        /// Fewest pixels of a plane: of what is left at the end some always lie on one by chance.
        min_plane: usize = 150, "1", at_least(3.0);
        /// Numbers behind these that few will want to turn.
        tuning: RansacTuning;
    }
}

settings! {
    /// Numbers behind the random samples that few will want to turn.
    pub struct RansacTuning("navigation.ransac.tuning") {
        /// Every so many pixels one is asked whether it lies on a plane that is tried.
        stride: usize = 4, "1", within(1.0, 1000.0);
        /// How planes are taken out of a picture one after the other.
        peeling: PeelingTuning;
        /// Which of the planes may be a floor.
        free_planes: FreePlaneTuning;
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_bad_values_refused_by_their_keys() {
        let base = RansacConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                RansacConfig {
                    samples: 0,
                    ..base()
                },
                "samples must be from 1 to 100000, got 0",
            ),
            (
                RansacConfig {
                    accept: f64::NAN,
                    ..base()
                },
                "accept must be > 0, got NaN",
            ),
            (
                RansacConfig {
                    min_plane: 2,
                    ..base()
                },
                "min_plane must be >= 3, got 2",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.ransac.{message}"));
        }
    }
}
