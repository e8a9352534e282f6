//! Settings of the guide.

use settings::{NOT_NEGATIVE, POSITIVE, settings};

settings! {
    /// The guide of planners that see only what is near: the way through the map that the robot was told.
    pub struct GuideConfig("navigation.guide") {
        /// Numbers behind the guide.
        tuning: GuideTuning;
    }
}

settings! {
    /// Where on the guide's way the planner is sent, and what bars that way.
    pub struct GuideTuning("navigation.guide.tuning") {
        /// The planner is sent to a place this far ahead on the guide's way.
        ahead: f64 = 1.4, "m", POSITIVE, "002, section III.D";
        /// The planner is sent on to a place further ahead when the robot is no further away than this from where it was sent.
        send_on: f64 = 0.7, "m", POSITIVE;
        /// Radius of the places to which the planner is sent.
        radius: f64 = 0.2, "m", POSITIVE;
        /// Beyond stairs the planner is sent to where the way has been level for this long.
        landing: f64 = 0.3, "m", NOT_NEGATIVE;
        /// Obstacles bar no place that is nearer to the robot than this: it may stand beside obstacle cells of its own.
        own: f64 = 0.3, "m", NOT_NEGATIVE;
    }
}
