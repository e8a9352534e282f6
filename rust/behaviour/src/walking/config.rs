//! Settings of the behaviour `walking`.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

/// The robot stands no longer than this at one place, however it is told to, s.
const LONGEST_STAND_S: f64 = 60.0;
/// No clock after which it gives up runs longer than this, s: with none it would go on for ever.
const LONGEST_PATIENCE_S: f64 = 600.0;

/// Settings of [`crate::WalkingBehaviour`]: `[navigation.walking]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WalkingConfig {
    /// Walking speed on open known ground, m/s.
    pub forward_speed: f64,
    /// Largest speed of side steps, m/s.
    pub side_speed: f64,
    /// Largest turning speed, rad/s.
    pub turn_speed: f64,
    /// Speed where ground lies ahead that stayed unknown after having been looked at, m/s.
    pub creep_speed: f64,
    /// How far ahead on the path the robot steers to, m.
    pub lookahead: f64,
    /// A heading further off than this is turned to on the spot, rad.
    pub turn_above: f64,
    /// A turn on the spot ends when the heading is no further off than this, rad.
    pub turn_until: f64,
    /// Nearer than this to its end the path is followed with side steps instead of turns, m.
    pub approach: f64,
    /// The robot walks slower where an obstacle is nearer to the path than this, m.
    pub slow_clearance: f64,
    /// Something new on the path within this distance stops the robot, m.
    pub stopping_distance: f64,
    /// Half the width of the path that must stay free, m.
    pub corridor: f64,
    /// The robot stands at least this long when something appeared, s.
    pub stop_time: f64,
    /// Unknown ground on the path is looked at when it is nearer than this, m.
    pub look_distance: f64,
    /// Ground nearer than this lies below the camera's view, m.
    pub unseen_radius: f64,
    /// Steepest look, to the ground before the feet, below the horizon, rad.
    pub gaze_steep: f64,
    /// Look at the ground near by, rad.
    pub gaze_near: f64,
    /// Look at the ground further away, rad.
    pub gaze_far: f64,
    /// Speed of the gaze, rad/s.
    pub gaze_speed: f64,
    /// How far to each side the robot looks around, rad.
    pub sweep: f64,
    /// Share of the goal's radius within which the robot has arrived.
    pub arrive_share: f64,
    /// A via point is passed this deep inside its disc, m.
    pub via_margin: f64,
    /// The robot declares that it has arrived after standing this long, s.
    pub arrive_time: f64,
    /// Without a frame for longer than this the robot stands and waits, s.
    pub blind_after: f64,
    /// Without a frame it gives up after waiting for this long, s.
    pub blind_limit: f64,
    /// A robot that does not know where it is gives up after this, s.
    pub locate_limit: f64,
    /// "No way" must be the planner's answer for this long, s, and in all directions looked at.
    pub refuse_time: f64,
    /// Without headway for this long the robot looks around, s.
    pub patience: f64,
    /// After more looks around without headway than this the robot gives up.
    pub tries: u32,
}

impl Default for WalkingConfig {
    fn default() -> Self {
        Self {
            forward_speed: 0.10,
            side_speed: 0.04,
            turn_speed: 0.4,
            creep_speed: 0.04,
            lookahead: 0.22,
            turn_above: 0.7,
            turn_until: 0.2,
            approach: 0.2,
            slow_clearance: 0.22,
            stopping_distance: 0.4,
            corridor: 0.1,
            stop_time: 1.0,
            look_distance: 0.4,
            unseen_radius: 0.2,
            gaze_steep: 1.0,
            gaze_near: 0.85,
            gaze_far: 0.5,
            gaze_speed: 0.9,
            sweep: 1.1,
            arrive_share: 0.35,
            via_margin: 0.03,
            arrive_time: 0.5,
            blind_after: 1.0,
            blind_limit: 10.0,
            locate_limit: 60.0,
            refuse_time: 3.0,
            patience: 15.0,
            tries: 3,
        }
    }
}

impl WalkingConfig {
    /// Refuses what cannot be used.
    pub fn check(&self) -> Result<(), ConfigError> {
        let positive = [
            ("forward_speed", self.forward_speed),
            ("side_speed", self.side_speed),
            ("turn_speed", self.turn_speed),
            ("creep_speed", self.creep_speed),
            ("lookahead", self.lookahead),
            ("turn_above", self.turn_above),
            ("turn_until", self.turn_until),
            ("slow_clearance", self.slow_clearance),
            ("corridor", self.corridor),
            ("gaze_speed", self.gaze_speed),
        ];
        for (name, value) in positive {
            let key = format!("navigation.walking.{name}");
            require(value.is_finite() && value > 0.0, &key, "> 0", value)?;
        }
        let not_negative = [
            ("approach", self.approach),
            ("stopping_distance", self.stopping_distance),
            ("look_distance", self.look_distance),
            ("unseen_radius", self.unseen_radius),
            ("sweep", self.sweep),
            ("via_margin", self.via_margin),
        ];
        for (name, value) in not_negative {
            let key = format!("navigation.walking.{name}");
            require(value.is_finite() && value >= 0.0, &key, ">= 0", value)?;
        }
        self.check_times()?;
        self.check_relations()
    }

    fn check_times(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("stop_time", self.stop_time),
            ("arrive_time", self.arrive_time),
            ("refuse_time", self.refuse_time),
        ] {
            let key = format!("navigation.walking.{name}");
            let allowed = format!("from 0 to {LONGEST_STAND_S}");
            let holds = (0.0..=LONGEST_STAND_S).contains(&value);
            require(holds, &key, &allowed, value)?;
        }
        for (name, value) in [
            ("blind_after", self.blind_after),
            ("blind_limit", self.blind_limit),
            ("locate_limit", self.locate_limit),
            ("patience", self.patience),
        ] {
            let key = format!("navigation.walking.{name}");
            let allowed = format!("> 0 and <= {LONGEST_PATIENCE_S}");
            let holds = value > 0.0 && value <= LONGEST_PATIENCE_S;
            require(holds, &key, &allowed, value)?;
        }
        Ok(())
    }

    fn check_relations(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("gaze_steep", self.gaze_steep),
            ("gaze_near", self.gaze_near),
            ("gaze_far", self.gaze_far),
        ] {
            let key = format!("navigation.walking.{name}");
            require((0.0..1.5).contains(&value), &key, "from 0 to 1.5", value)?;
        }
        let ordered = [
            (
                "turn_until",
                self.turn_until < self.turn_above,
                "below turn_above",
                self.turn_until,
            ),
            (
                "blind_limit",
                self.blind_limit > self.blind_after,
                "above blind_after",
                self.blind_limit,
            ),
            (
                "arrive_share",
                self.arrive_share > 0.0 && self.arrive_share <= 1.0,
                "in (0, 1]",
                self.arrive_share,
            ),
        ];
        for (name, holds, allowed, value) in ordered {
            require(holds, &format!("navigation.walking.{name}"), allowed, value)?;
        }
        let tries = self.tries;
        require(tries > 0, "navigation.walking.tries", "> 0", tries)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_settings_are_allowed() {
        assert_eq!(WalkingConfig::default().check(), Ok(()));
    }

    #[test]
    fn a_bad_setting_is_refused_by_name() {
        let config = WalkingConfig {
            forward_speed: -0.1,
            ..WalkingConfig::default()
        };
        let message = config.check().unwrap_err().to_string();
        assert_eq!(
            message,
            "navigation.walking.forward_speed must be > 0, got -0.1"
        );
        let config = WalkingConfig {
            blind_limit: 0.5,
            ..WalkingConfig::default()
        };
        assert!(config.check().is_err());
    }

    #[test]
    fn a_time_without_end_is_refused_by_name() {
        type Setting = fn(&mut WalkingConfig) -> &mut f64;
        let settings: [(&str, &str, Setting); 7] = [
            ("stop_time", "from 0 to 60", |config| &mut config.stop_time),
            ("arrive_time", "from 0 to 60", |config| {
                &mut config.arrive_time
            }),
            ("refuse_time", "from 0 to 60", |config| {
                &mut config.refuse_time
            }),
            ("blind_after", "> 0 and <= 600", |config| {
                &mut config.blind_after
            }),
            ("blind_limit", "> 0 and <= 600", |config| {
                &mut config.blind_limit
            }),
            ("locate_limit", "> 0 and <= 600", |config| {
                &mut config.locate_limit
            }),
            ("patience", "> 0 and <= 600", |config| &mut config.patience),
        ];
        for (name, allowed, setting) in settings {
            for value in [1e9, f64::INFINITY, f64::NAN, -1.0] {
                let mut config = WalkingConfig::default();
                *setting(&mut config) = value;
                let message = config.check().unwrap_err().to_string();
                let start = format!("navigation.walking.{name} must be {allowed}, got ");
                assert!(message.starts_with(&start), "{message}");
            }
        }
    }
}
