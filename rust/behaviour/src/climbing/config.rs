//! Settings of the behaviours `stair_climbing` and `continuous`.

use settings::{Bounds, POSITIVE, above_to, at_least, settings, within};

use super::tuning::StairClimbingTuning;

/// Smaller steps than this, m or rad, would be thousands in a list.
const STEP: Bounds = at_least(0.005);

settings! {
    /// The behaviours `stair_climbing` and `continuous`: walk where one can walk, climb where stairs lead on. The settings of 003's
    /// Table I are `[navigation.climbing]`.
    pub struct StairClimbingConfig("navigation.stair_climbing") {
        /// The first edge is measured with the robot's middle at least this far before it: nearer, the camera sees too little of the
        /// ground in front of it.
        look_distance: f64 = 0.22, "m", above_to(0.0, 2.0);
        /// An edge is stepped by when this many frames fitted it.
        edge_frames: u32 = 4, "1", within(0.0, 1000.0);
        /// An edge is stepped by when its place is as sure as this.
        edge_sigma: f64 = 0.006, "m", POSITIVE;
        /// An edge is stepped by when its heading is as sure as this.
        heading_sigma: f64 = 0.045, "rad", POSITIVE;
        /// So many edges behind the next one are looked at before it is stepped by: more for a camera that sees nothing near its feet.
        edges_ahead: u32 = 1, "1", POSITIVE;
        /// The toes may be this far from `approach_x` when a step is taken.
        near_tolerance: f64 = 0.012, "m", POSITIVE;
        /// The robot may be turned by this against square to the edge when a step is taken.
        aligned: f64 = 0.09, "rad", POSITIVE;
        /// Highest step, up or down, that is climbed without a stop: a knee that lifts the body from far below the next step bears no
        /// more than this.
        run_rise: f64 = 0.042, "m", POSITIVE;
        /// A careful step on the level moves a foot no further than this ahead of the other.
        step_forward: f64 = 0.09, "m", STEP;
        /// A careful step on the level moves a foot no further than this to the side.
        step_side: f64 = 0.03, "m", STEP;
        /// A careful step on the level turns a foot by no more than this.
        step_turn: f64 = 0.2, "rad", STEP;
        /// The robot waits for this long for what stands on the next step to go away; without a step for longer it would give up anyway.
        wait: f64 = 10.0, "s", within(0.0, 60.0);
        /// The arms stay up for this long at the end.
        cheer: f64 = 1.0, "s", within(0.0, 30.0);
        /// Numbers that few will want to turn.
        tuning: StairClimbingTuning;
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn the_shipped_settings_are_allowed_and_a_bad_one_is_refused_by_name() {
        assert_eq!(StairClimbingConfig::default().check(), Ok(()));
        let config = StairClimbingConfig {
            aligned: f64::NAN,
            ..StairClimbingConfig::default()
        };
        let message = config.check().unwrap_err().to_string();
        assert!(
            message.starts_with("navigation.stair_climbing.aligned must be > 0"),
            "{message}"
        );
    }

    #[test]
    fn what_would_take_for_ever_or_all_memory_is_refused_by_name() {
        type Setting = fn(&mut StairClimbingConfig) -> &mut f64;
        let settings: [(&str, Setting, f64); 8] = [
            ("wait must be from 0 to 60", |c| &mut c.wait, 61.0),
            ("wait must be from 0 to 60", |c| &mut c.wait, f64::NAN),
            ("cheer must be from 0 to 30", |c| &mut c.cheer, 1e9),
            (
                "look_distance must be > 0 and <= 2",
                |c| &mut c.look_distance,
                1e6,
            ),
            (
                "step_forward must be >= 0.005",
                |c| &mut c.step_forward,
                1e-9,
            ),
            ("step_side must be >= 0.005", |c| &mut c.step_side, 1e-9),
            ("step_turn must be >= 0.005", |c| &mut c.step_turn, 1e-9),
            (
                "step_turn must be >= 0.005",
                |c| &mut c.step_turn,
                f64::INFINITY,
            ),
        ];
        for (told, setting, value) in settings {
            let mut config = StairClimbingConfig::default();
            *setting(&mut config) = value;
            assert_refused(&config, told);
        }
        let shipped = StairClimbingConfig::default();
        let edge_frames = u32::MAX;
        let looks_on = StairClimbingConfig {
            edge_frames,
            ..shipped
        };
        assert_refused(&looks_on, "edge_frames must be from 0 to 1000");
    }

    fn assert_refused(config: &StairClimbingConfig, told: &str) {
        let message = config.check().unwrap_err().to_string();
        let start = format!("navigation.stair_climbing.{told}, got ");
        assert!(message.starts_with(&start), "{message}");
    }
}
