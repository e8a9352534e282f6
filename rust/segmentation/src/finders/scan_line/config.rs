//! Settings of the scan-line segmenter: `[navigation.scan_line]`.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, settings, within};

settings! {
    /// How level surfaces are found by scan lines: the segmenter `scan_line`. Thresholds in disparity are multiples of the local
    /// noise.
    pub struct ScanLineConfig("navigation.scan_line") {
        /// Columns of pixels that are averaged before lines are fitted. To sort the pixels of a row takes the square of their number.
        strip: usize = 8, "1", within(1.0, 32.0);
        /// Price of one more line on a strip, in squared noise; higher joins more.
        segment_price: f64 = 25.0, "1", POSITIVE;
        /// Fewest rows of a line.
        min_segment: usize = 4, "1", POSITIVE;
        /// Neighbouring lines and regions are one surface when they are closer to each other than so many times the noise.
        join: f64 = 1.2, "1", POSITIVE;
        /// A pixel belongs to a surface when it is closer to it than so many times its noise.
        accept: f64 = 2.5, "1", POSITIVE;
        /// Numbers behind these that few will want to turn.
        tuning: ScanLineTuning;
    }
}

settings! {
    /// Numbers behind the scan lines that few will want to turn.
    pub struct ScanLineTuning("navigation.scan_line.tuning") {
        /// Rays whose fall is less than this share of focal length times baseline see nothing horizontal worth having.
        min_fall: f32 = 0.05, "1", SHARE;
        /// A pixel that is further from the middle one of its row than so many times its noise does not count.
        agree: f32 = 3.0, "1", POSITIVE;
        /// Share of a row's pixels that must agree with the middle one for the row to count.
        agreeing: f64 = 0.5, "1", SHARE;
        /// Most rows without a measurement that a line may bridge.
        max_gap: usize = 3, "1", within(0.0, 1000.0);
        /// Price of a steep line on a strip, in squared noise. A stack of level lines that one steep line explains at a lower price is
        /// a wall.
        steep_price: f64 = 40.0, "1", POSITIVE;
        /// A line is steep when its disparity changes from row to row by less than this share of what a horizontal surface's would:
        /// the share is 0.6 for a slope of 14 degrees as of stairs, and -1 for a wall.
        steep: f64 = 0.3, "1", within(-10.0, 1.0);
        /// Share of the shorter one of two lines that must lie beside the longer one for them to be joined.
        overlap: f64 = 0.5, "1", SHARE;
        /// Regions touch where pixels of theirs are so many columns or rows apart, or fewer.
        contact_reach: usize = 2, "1", within(1.0, 100.0);
        /// Fewest places where two regions must touch for them to be joined.
        min_contacts: u32 = 4, "1", POSITIVE;
        /// A region with fewer pixels than this is small: with some ten matching windows.
        small_region: usize = 250, "1", NOT_NEGATIVE;
        /// How many times as far as `join` says a small region may lie from the surface beside it: half of the noise is shared by a
        /// whole matching window.
        small_join: f64 = 1.35, "1", POSITIVE;
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn the_defaults_are_allowed() {
        assert_eq!(ScanLineConfig::default().check(), Ok(()));
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        let config = ScanLineConfig {
            join: 0.0,
            ..ScanLineConfig::default()
        };
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.scan_line.join must be > 0, got 0"
        );
        let config = ScanLineConfig {
            strip: 33,
            ..ScanLineConfig::default()
        };
        assert!(config.check().is_err());
    }
}
