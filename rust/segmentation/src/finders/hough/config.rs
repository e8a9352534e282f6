//! Settings of the segmenter `hough`.

use settings::{POSITIVE, above_to, at_least, settings, within};

use crate::finders::free_planes::tuning::{FreePlaneTuning, PeelingTuning};

settings! {
    /// How planes are found by votes: the segmenter `hough`.
    pub struct HoughConfig("navigation.hough") {
        /// Triples of pixels that vote for each plane.
        samples: usize = 3000, "1", within(1.0, 100_000.0);
        /// The pixels of a triple are at most this far from each other, in pixels along rows and columns.
        window: usize = 16, "1", within(1.0, 1000.0);
        /// Size of a cell of the accumulator in the normal's two angles. Smaller cells would need an accumulator of more than 40 MB.
        angle: f64 = 0.07, "rad", within(0.03, 0.5);
        /// Size of a cell of the accumulator in the distance from the camera.
        distance: f64 = 0.02, "m", within(0.01, 0.5);
        /// A pixel belongs to a plane when it is closer to it than this, in disparity.
        accept: f64 = 0.25, "px", POSITIVE;
        /// Fewest pixels of a plane.
        min_plane: usize = 150, "1", at_least(3.0);
        /// Numbers behind these that few will want to turn.
        tuning: HoughTuning;
    }
}

settings! {
    /// Numbers behind the votes for planes that few will want to turn.
    pub struct HoughTuning("navigation.hough.tuning") {
        /// Planes further away from the camera than this get no vote.
        farthest: f64 = 4.0, "m" of camera, above_to(0.0, 10.0);
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
        let base = HoughConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                HoughConfig {
                    samples: 0,
                    ..base()
                },
                "samples must be from 1 to 100000, got 0",
            ),
            (
                HoughConfig {
                    angle: f64::NAN,
                    ..base()
                },
                "angle must be from 0.03 to 0.5, got NaN",
            ),
            (
                HoughConfig {
                    distance: 0.0,
                    ..base()
                },
                "distance must be from 0.01 to 0.5, got 0",
            ),
            (
                HoughConfig {
                    min_plane: 2,
                    ..base()
                },
                "min_plane must be >= 3, got 2",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.hough.{message}"));
        }
    }
}
