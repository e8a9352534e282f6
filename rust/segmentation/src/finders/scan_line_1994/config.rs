//! Settings of the segmenter `scan_line_1994`.

use settings::{POSITIVE, SHARE, at_least, settings, within};

use crate::finders::free_planes::tuning::FreePlaneTuning;

settings! {
    /// How planes are grown from straight scan lines: the segmenter `scan_line_1994`. The thresholds are fixed, whatever the local
    /// noise; the defaults are those that tell most treads of 30 mm apart at a noise of 1/8 px.
    pub struct ScanLine1994Config("navigation.scan_line_1994") {
        /// Columns of pixels that are averaged to one scan line.
        strip: usize = 8, "1", within(1.0, 32.0);
        /// A scan line is split where it lies further than this from the line between its ends, in disparity.
        split: f64 = 0.15, "px", POSITIVE;
        /// Fewest pixels of a line.
        min_segment: usize = 4, "1", at_least(2.0);
        /// A line belongs to a plane when its ends are closer to it than this, and so do pixels, in disparity.
        accept: f64 = 0.35, "px", POSITIVE;
        /// Numbers behind these that few will want to turn.
        tuning: ScanLine1994Tuning;
    }
}

settings! {
    /// Numbers behind the straight scan lines that few will want to turn.
    pub struct ScanLine1994Tuning("navigation.scan_line_1994.tuning") {
        /// Most rows without a measurement that a line may bridge.
        max_gap: usize = 3, "1", within(0.0, 1000.0);
        /// Share of a scan line's columns that must be seen in a row for the row to count.
        seen: f64 = 0.5, "1", SHARE;
        /// Share of the shorter one of two lines that must lie beside the longer one for them to be neighbours.
        overlap: f64 = 0.5, "1", SHARE;
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
        let base = ScanLine1994Config::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                ScanLine1994Config { strip: 0, ..base() },
                "strip must be from 1 to 32, got 0",
            ),
            (
                ScanLine1994Config {
                    split: f64::NAN,
                    ..base()
                },
                "split must be > 0, got NaN",
            ),
            (
                ScanLine1994Config {
                    min_segment: 1,
                    ..base()
                },
                "min_segment must be >= 2, got 1",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.scan_line_1994.{message}"));
        }
    }
}
