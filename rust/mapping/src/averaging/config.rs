//! Parameters of the averaged height map, checked once.

use settings::{NOT_NEGATIVE, POSITIVE, at_least, settings, within};

use crate::{FogConfig, surface::MatchingTuning};

settings! {
    /// The averaged height map, after Kagami et al. 2003. A key that `[navigation.fog]` has as well means the same there and has the
    /// same default, so that both are compared on equal terms.
    pub struct AveragingConfig("navigation.averaging") {
        /// Side of a cell.
        cell: f64 = 0.04, "m", within(0.001, 10.0);
        /// Cells along each side of the window.
        cells: usize = 100, "1", within(4.0, FogConfig::MOST_CELLS as f64);
        /// A cell that lies more than this above one beside it is an obstacle; what is lower can be climbed.
        rise: f64 = 0.05, "m", POSITIVE, "003, Table I: steps up to 50 mm";
        /// Points that are further away than this are left out.
        max_range: f64 = 4.0, "m" of camera, POSITIVE;
        /// Frames are shifted in height to fit the known heights by at most this.
        match_gate: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Points that must fit the known heights before a frame is shifted, or used without a ground plane.
        min_pairs: usize = 150, "1", at_least(1.0);
        /// Unseen cells up to this far from the robot's middle are shown as floor at its height, since it stands there.
        footprint: f64 = 0.12, "m", NOT_NEGATIVE;
        /// Numbers that few will want to turn.
        tuning: AveragingTuning;
    }
}

settings! {
    /// Numbers behind the averaged height map.
    pub struct AveragingTuning("navigation.averaging.tuning") {
        /// The robot may wander this many cells from the middle of the window before the window follows: a robot that sways over a
        /// border would move it to and fro.
        wander: f64 = 0.75, "1", within(0.5, 100.0);
        /// How a frame's height is fitted to the heights that are known.
        matching: MatchingTuning;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use settings::Table;

    #[test]
    fn the_defaults_are_allowed() {
        assert_eq!(AveragingConfig::default().check(), Ok(()));
    }

    #[test]
    fn a_bad_value_is_refused_by_its_key() {
        let base = AveragingConfig::default;
        let refused = |config: AveragingConfig| config.check().unwrap_err().to_string();
        assert_eq!(
            refused(AveragingConfig {
                rise: f64::NAN,
                ..base()
            }),
            "navigation.averaging.rise must be > 0, got NaN"
        );
        for (config, key) in [
            (
                AveragingConfig {
                    footprint: -0.1,
                    ..base()
                },
                "footprint",
            ),
            (AveragingConfig { cells: 3, ..base() }, "cells"),
            (
                AveragingConfig {
                    min_pairs: 0,
                    ..base()
                },
                "min_pairs",
            ),
        ] {
            assert!(refused(config).starts_with(&format!("navigation.averaging.{key} must be")));
        }
    }

    #[test]
    fn what_both_maps_have_is_the_same_by_default() {
        let ours = FogConfig::parameters();
        let theirs = AveragingConfig::parameters();
        let mut shared = 0;
        for one in &theirs {
            let key = one.key.replacen("averaging", "fog", 1);
            if let Some(other) = ours.iter().find(|other| other.key == key) {
                assert_eq!(
                    (&one.default, &one.bounds),
                    (&other.default, &other.bounds),
                    "{key}"
                );
                shared += 1;
            }
        }
        assert_eq!(shared, theirs.len() - 1);
    }
}
