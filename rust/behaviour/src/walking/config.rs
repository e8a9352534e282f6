//! Settings of the behaviour `walking`.

use settings::{Bounds, NOT_NEGATIVE, POSITIVE, above_to, from_below, settings, within};

use super::tuning::{WAIT, WalkingTuning};
use crate::machine::Limits;

/// The robot stands no longer than this at one place, however it is told to.
const STAND: Bounds = within(0.0, 60.0);
/// Angles of the gaze below the horizon.
const DOWN: Bounds = from_below(0.0, 1.5);

settings! {
    /// The behaviour `walking`: looks around, follows the path, stops, finds another way, arrives or refuses.
    pub struct WalkingConfig("navigation.walking") {
        /// Walking speed on open known ground.
        forward_speed: f64 = 0.10, "m/s", POSITIVE;
        /// Largest speed of side steps.
        side_speed: f64 = 0.04, "m/s", POSITIVE;
        /// Largest turning speed.
        turn_speed: f64 = 0.4, "rad/s", POSITIVE;
        /// Speed where ground lies ahead that stayed unknown after it was looked at.
        creep_speed: f64 = 0.04, "m/s", POSITIVE;
        /// The robot steers to a place this far ahead on the path.
        lookahead: f64 = 0.22, "m", POSITIVE;
        /// The robot turns on the spot to a heading that is further off than this.
        turn_above: f64 = 0.7, "rad", POSITIVE;
        /// A turn on the spot ends when the heading is no further off than this.
        turn_until: f64 = 0.2, "rad", POSITIVE;
        /// Nearer than this to its end the path is followed with side steps instead of turns.
        approach: f64 = 0.2, "m", NOT_NEGATIVE;
        /// The robot walks slower where an obstacle is nearer to the path than this.
        slow_clearance: f64 = 0.22, "m", POSITIVE;
        /// Something new on the path within this distance stops the robot.
        stopping_distance: f64 = 0.4, "m", NOT_NEGATIVE;
        /// Half the width of the path that must stay free.
        corridor: f64 = 0.1, "m", POSITIVE;
        /// The robot stands at least this long when something appeared.
        stop_time: f64 = 1.0, "s", STAND;
        /// Unknown ground on the path is looked at when it is nearer than this.
        look_distance: f64 = 0.4, "m", NOT_NEGATIVE;
        /// Ground nearer than this lies below the camera's view.
        unseen_radius: f64 = 0.2, "m", NOT_NEGATIVE;
        /// Steepest look below the horizon, to the ground before the feet.
        gaze_steep: f64 = 1.1, "rad", DOWN;
        /// Look below the horizon of a robot that sees no ground: what it stands on may show nowhere but right before its feet.
        gaze_feet: f64 = 1.2, "rad", DOWN;
        /// Look below the horizon at the ground near by.
        gaze_near: f64 = 0.85, "rad", DOWN;
        /// Look below the horizon at the ground further away.
        gaze_far: f64 = 0.5, "rad", DOWN;
        /// Highest look, to the room for the head above the ground near by; above the horizon where negative.
        gaze_high: f64 = -0.1, "rad", within(-1.5, 1.5);
        /// Room for the head that was not seen is looked at while walking where it is nearer than this on the path.
        look_up: f64 = 1.2, "m", NOT_NEGATIVE;
        /// Room for the head that was not seen is looked at before the robot goes on where it is nearer than this on the path.
        look_up_distance: f64 = 0.5, "m", NOT_NEGATIVE;
        /// Speed of the gaze.
        gaze_speed: f64 = 0.9, "rad/s", POSITIVE;
        /// The robot looks around so far to each side.
        sweep: f64 = 1.1, "rad", NOT_NEGATIVE;
        /// Share of the goal's radius within which the robot has arrived.
        arrive_share: f64 = 0.35, "1", above_to(0.0, 1.0);
        /// A via point is passed this deep inside its disc.
        via_margin: f64 = 0.03, "m", NOT_NEGATIVE;
        /// The robot declares that it has arrived after standing this long.
        arrive_time: f64 = 0.5, "s", STAND;
        /// The robot stands and waits when no frame has come for longer than this.
        blind_after: f64 = 2.0, "s" of camera, WAIT;
        /// The robot gives up when it has waited for a frame for this long.
        blind_limit: f64 = 12.0, "s" of camera, WAIT;
        /// A robot that does not know where it is gives up after this time.
        locate_limit: f64 = 60.0, "s", WAIT;
        /// The planner must find no way for this long, and in all directions looked at, before the robot gives up.
        refuse_time: f64 = 3.0, "s", STAND;
        /// The robot looks around when it has made no headway for this long.
        patience: f64 = 15.0, "s", WAIT;
        /// Looks without headway or from one place that show no way, stumbles, corrections and new tries of one kind before the robot
        /// gives up. More would tell nothing new, and between two searches the robot walks, so that no clock ends them.
        tries: u32 = 3, "1", within(1.0, 100.0);
        /// Things that were not seen, and that its feet meet, before the robot gives up: each one teaches it another way.
        touches: u32 = 12, "1", within(1.0, 1000.0);
        /// Numbers that few will want to turn.
        tuning: WalkingTuning;
    }
    require (turn_until) < (turn_above);
    require (blind_limit) > (blind_after);
    require (gaze_steep) >= (gaze_far);
    require (gaze_far) >= (gaze_high);
    require (look_up) >= (look_up_distance);
}

impl WalkingConfig {
    /// The limits of a behaviour that walks: what could not be done when it is idle, and where it was blind, as the end of a sentence.
    pub(crate) const fn limits(
        &self,
        idle_words: &'static str,
        place_words: &'static str,
    ) -> Limits {
        Limits {
            blind_after_s: self.blind_after,
            patience: self.tuning.look_around.patience,
            blind_limit_s: self.blind_limit,
            dark: (self.tuning.blind.dark_share, self.tuning.blind.dark_after),
            idle_limit_s: self.tuning.idle_limit,
            idle_words,
            place_words,
        }
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

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
