//! Settings of the behaviours `stair_climbing` and `continuous`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

/// The robot waits no longer than this, s: without a step for so long it gives up, whatever for.
const LONGEST_WAIT_S: f64 = 60.0;
/// The arms stay up no longer than this, s: to be glad is no step either.
const LONGEST_CHEER_S: f64 = 30.0;
/// Smaller steps than this, m or rad, would be thousands in a list.
const LEAST_STEP: f64 = 0.005;
/// From further away than this an edge is not measured, m.
const FARTHEST_LOOK_M: f64 = 2.0;
/// More frames than this fit no edge while the robot stands.
const MOST_FRAMES: u32 = 1000;
/// After more tries than this nothing is learnt: between two searches the robot walks, so that no clock ends them.
const MOST_TRIES: u32 = 100;

/// Settings of [`crate::StairClimbing`]: `[navigation.stair_climbing]`. Those of 003's Table I are `[navigation.climbing]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StairClimbingConfig {
    /// The first edge is measured with the robot's middle at least this far before it: nearer, the camera sees too little
    /// of the ground in front of it, m.
    pub look_distance: f64,
    /// Steepest look, below the horizon, rad.
    pub gaze_steep: f64,
    /// Speed of the gaze, rad/s.
    pub gaze_speed: f64,
    /// An edge is stepped by when this many frames fitted it.
    pub edge_frames: u32,
    /// An edge is stepped by when its place is as sure as this, m.
    pub edge_sigma: f64,
    /// An edge is stepped by when its heading is as sure as this, rad.
    pub heading_sigma: f64,
    /// Edges behind the next one that are looked at before it is stepped by: more for a camera that sees nothing near its feet.
    pub edges_ahead: u32,
    /// How far from `approach_x` the toes may be when a step is taken, m.
    pub near_tolerance: f64,
    /// How far from square to the edge the robot may be when a step is taken, rad.
    pub aligned: f64,
    /// Highest step, up or down, that is climbed without a stop: a knee that lifts the body from far below the next step bears no
    /// more than this, m.
    pub run_rise: f64,
    /// Most that a careful step on the level moves a foot ahead of the other, m.
    pub step_forward: f64,
    /// Most that a careful step on the level moves a foot to the side, m.
    pub step_side: f64,
    /// Most that a careful step on the level turns a foot, rad.
    pub step_turn: f64,
    /// How long the robot waits for what stands on the next step, s.
    pub wait: f64,
    /// Looks, corrections and new tries of one kind before it gives up.
    pub tries: u32,
    /// How long the arms stay up at the end, s.
    pub cheer: f64,
}

impl Default for StairClimbingConfig {
    fn default() -> Self {
        Self {
            look_distance: 0.22,
            gaze_steep: 1.1,
            gaze_speed: 0.9,
            edge_frames: 4,
            edge_sigma: 0.006,
            heading_sigma: 0.045,
            edges_ahead: 1,
            near_tolerance: 0.012,
            aligned: 0.09,
            run_rise: 0.042,
            step_forward: 0.09,
            step_side: 0.03,
            step_turn: 0.2,
            wait: 10.0,
            tries: 3,
            cheer: 1.0,
        }
    }
}

impl StairClimbingConfig {
    /// Refuses what cannot be used.
    pub fn check(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("gaze_speed", self.gaze_speed),
            ("edge_sigma", self.edge_sigma),
            ("heading_sigma", self.heading_sigma),
            ("near_tolerance", self.near_tolerance),
            ("aligned", self.aligned),
            ("run_rise", self.run_rise),
        ] {
            let key = format!("navigation.stair_climbing.{name}");
            require(value.is_finite() && value > 0.0, &key, "> 0", value)?;
        }
        let steep = self.gaze_steep;
        require(
            (0.5..1.5).contains(&steep),
            "navigation.stair_climbing.gaze_steep",
            "from 0.5 to 1.5",
            steep,
        )?;
        let ahead = self.edges_ahead;
        require(
            ahead > 0,
            "navigation.stair_climbing.edges_ahead",
            "> 0",
            ahead,
        )?;
        self.check_lengths_and_times()?;
        self.check_counts()
    }

    fn check_lengths_and_times(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("step_forward", self.step_forward),
            ("step_side", self.step_side),
            ("step_turn", self.step_turn),
        ] {
            let key = format!("navigation.stair_climbing.{name}");
            let allowed = format!(">= {LEAST_STEP}");
            let holds = value.is_finite() && value >= LEAST_STEP;
            require(holds, &key, &allowed, value)?;
        }
        let look_m = self.look_distance;
        require(
            look_m > 0.0 && look_m <= FARTHEST_LOOK_M,
            "navigation.stair_climbing.look_distance",
            &format!("> 0 and <= {FARTHEST_LOOK_M}"),
            look_m,
        )?;
        for (name, value, most_s) in [
            ("wait", self.wait, LONGEST_WAIT_S),
            ("cheer", self.cheer, LONGEST_CHEER_S),
        ] {
            let key = format!("navigation.stair_climbing.{name}");
            let allowed = format!("from 0 to {most_s}");
            require((0.0..=most_s).contains(&value), &key, &allowed, value)?;
        }
        Ok(())
    }

    fn check_counts(&self) -> Result<(), ConfigError> {
        let frames = self.edge_frames;
        require(
            frames <= MOST_FRAMES,
            "navigation.stair_climbing.edge_frames",
            &format!("<= {MOST_FRAMES}"),
            frames,
        )?;
        let tries = self.tries;
        require(
            (1..=MOST_TRIES).contains(&tries),
            "navigation.stair_climbing.tries",
            &format!("from 1 to {MOST_TRIES}"),
            tries,
        )
    }
}

#[cfg(test)]
mod tests {
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
        let (edge_frames, tries) = (u32::MAX, u32::MAX);
        let looks_on = StairClimbingConfig {
            edge_frames,
            ..shipped
        };
        assert_refused(&looks_on, "edge_frames must be <= 1000");
        let tries_on = StairClimbingConfig { tries, ..shipped };
        assert_refused(&tries_on, "tries must be from 1 to 100");
    }

    fn assert_refused(config: &StairClimbingConfig, told: &str) {
        let message = config.check().unwrap_err().to_string();
        let start = format!("navigation.stair_climbing.{told}, got ");
        assert!(message.starts_with(&start), "{message}");
    }
}
