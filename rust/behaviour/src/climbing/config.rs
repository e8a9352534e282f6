//! Settings of the behaviours `stair_climbing` and `continuous`.

use geometry::{ConfigError, require};
use serde::{Deserialize, Serialize};

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
    /// An edge is stepped by when this many frames fitted it,
    pub edge_frames: u32,
    /// its place is as sure as this, m,
    pub edge_sigma: f64,
    /// and its heading as this, rad.
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
    /// Most that a careful step on the level moves a foot ahead of the other, m;
    pub step_forward: f64,
    /// to the side, m;
    pub step_side: f64,
    /// and turns it, rad.
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
            ("look_distance", self.look_distance),
            ("gaze_speed", self.gaze_speed),
            ("edge_sigma", self.edge_sigma),
            ("heading_sigma", self.heading_sigma),
            ("near_tolerance", self.near_tolerance),
            ("aligned", self.aligned),
            ("run_rise", self.run_rise),
            ("step_forward", self.step_forward),
            ("step_side", self.step_side),
            ("step_turn", self.step_turn),
        ] {
            let key = format!("navigation.stair_climbing.{name}");
            require(value.is_finite() && value > 0.0, &key, "> 0", value)?;
        }
        for (name, value) in [("wait", self.wait), ("cheer", self.cheer)] {
            let key = format!("navigation.stair_climbing.{name}");
            require(value.is_finite() && value >= 0.0, &key, ">= 0", value)?;
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
        let tries = self.tries;
        require(tries > 0, "navigation.stair_climbing.tries", "> 0", tries)
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
}
