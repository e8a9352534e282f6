//! Settings of the segmenter `histogram`.

use settings::{POSITIVE, SHARE, settings, within};

settings! {
    /// How the peaks of the histogram of heights are found: the segmenter `histogram`.
    pub struct HistogramConfig("navigation.histogram") {
        /// Height of a bin.
        bin: f64 = 0.004, "m", within(0.001, 0.1);
        /// Peaks closer to a higher one than this are part of it.
        apart: f64 = 0.012, "m", POSITIVE;
        /// A pixel belongs to a peak when it is closer to it than this, in disparity.
        accept: f64 = 0.3, "px", POSITIVE;
        /// Numbers behind these that few will want to turn.
        tuning: HistogramTuning;
    }
}

settings! {
    /// Numbers behind the peaks of heights that few will want to turn.
    pub struct HistogramTuning("navigation.histogram.tuning") {
        /// Heights are looked at down to this depth below the camera.
        deepest: f32 = 2.0, "m", within(0.1, 100.0);
        /// A peak is so many times as high as the valleys beside it, or more: a wall has heights everywhere.
        stands_out: f32 = 1.6, "1", POSITIVE;
        /// Share of each neighbour when the counts of the bins are smoothed; the bin itself has the rest.
        smoothing: f32 = 0.25, "1", SHARE;
        /// Valleys are looked for up to so many times `apart` to both sides of a peak.
        valley: usize = 2, "1", within(1.0, 100.0);
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_bad_values_refused_by_their_keys() {
        let base = HistogramConfig::default;
        assert_eq!(base().check(), Ok(()));
        for (config, message) in [
            (
                HistogramConfig { bin: 0.0, ..base() },
                "bin must be from 0.001 to 0.1, got 0",
            ),
            (
                HistogramConfig {
                    apart: f64::NAN,
                    ..base()
                },
                "apart must be > 0, got NaN",
            ),
        ] {
            let error = config.check().unwrap_err().to_string();
            assert_eq!(error, format!("navigation.histogram.{message}"));
        }
    }
}
