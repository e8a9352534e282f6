//! Settings of the segmenter `scan_line_adaptive`.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, at_least, settings, within};

use crate::finders::free_planes::tuning::FreePlaneTuning;

settings! {
    /// How planes are grown from scan lines with a noise of their own: the segmenter `scan_line_adaptive`.
    pub struct ScanLineAdaptiveConfig("navigation.scan_line_adaptive") {
        /// Columns of pixels in a scan line. One column alone does not tell how a plane lies across.
        strip: usize = 8, "1", within(2.0, 32.0);
        /// What one more plane costs: by how much twice the logarithm of the likelihood must rise.
        price: f64 = 12.0, "1", POSITIVE;
        /// Fewest rows of a piece of a scan line.
        min_segment: usize = 3, "1", at_least(2.0);
        /// How far real surfaces are from planes: mean square, as a multiple of the noise's.
        uneven: f64 = 1.0, "1", NOT_NEGATIVE;
        /// Pixels that err alike: of a matching window all tell little more than one.
        alike: f64 = 4.0, "1", at_least(1.0);
        /// A pixel belongs to a plane when it is closer to it than so many times the plane's noise.
        accept: f64 = 4.0, "1", POSITIVE;
        /// Numbers behind these that few will want to turn.
        tuning: ScanLineAdaptiveTuning;
    }
}

settings! {
    /// Numbers behind the scan lines with a noise of their own that few will want to turn.
    pub struct ScanLineAdaptiveTuning("navigation.scan_line_adaptive.tuning") {
        /// Most rows of a piece of a scan line; what is longer is joined again.
        longest: usize = 128, "1", within(2.0, 10000.0);
        /// Share of a piece's pixels that must be seen for the piece to count.
        seen: f64 = 0.5, "1", SHARE;
        /// How often the borders between planes are looked over for pixels that a neighbour explains better.
        border_rounds: usize = 3, "1", within(0.0, 100.0);
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
        let base = ScanLineAdaptiveConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                ScanLineAdaptiveConfig { strip: 1, ..base() },
                "strip must be from 2 to 32, got 1",
            ),
            (
                ScanLineAdaptiveConfig {
                    price: f64::NAN,
                    ..base()
                },
                "price must be > 0, got NaN",
            ),
            (
                ScanLineAdaptiveConfig {
                    alike: 0.5,
                    ..base()
                },
                "alike must be >= 1, got 0.5",
            ),
            (
                ScanLineAdaptiveConfig {
                    uneven: -1.0,
                    ..base()
                },
                "uneven must be >= 0, got -1",
            ),
            (
                ScanLineAdaptiveConfig {
                    min_segment: 1,
                    ..base()
                },
                "min_segment must be >= 2, got 1",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.scan_line_adaptive.{message}"));
        }
    }
}
