//! Settings of how the feet are moved before, on and behind stairs.

use settings::{NOT_NEGATIVE, POSITIVE, above_to, at_least, settings, within};

use super::{ANGLE, WAIT};

settings! {
    /// Where the walk to stairs ends and the climb's own states begin.
    pub struct ApproachLegTuning("navigation.stair_climbing.tuning.leg") {
        /// A walk ends this near to the place where the robot aligns.
        near: f64 = 0.14, "m", POSITIVE;
        /// A robot that is no further to the side than this walks straight on to the edge.
        aside: f64 = 0.12, "m", NOT_NEGATIVE;
        /// A robot that heads for the edge must stop before it when it is no further to the side than this.
        stops_aside: f64 = 0.25, "m", NOT_NEGATIVE;
        /// A robot heads for the edge from this cosine of its angle to square on.
        heads_for_it: f64 = 0.7, "1", within(-1.0, 1.0);
        /// The end of the way to the edge is cut off where it comes nearer to the place where the robot aligns than so many times the
        /// distance at which a walk ends.
        cut: f64 = 2.0, "1", NOT_NEGATIVE;
    }
}

settings! {
    /// The way to the place before the first edge from which it is measured, and the turn square to it.
    pub struct AlignTuning("navigation.stair_climbing.tuning.align") {
        /// Aligning ends after this time, however well the robot stands.
        longest: f64 = 10.0, "s", WAIT;
        /// The robot is aligned when it is no further than this from the place along the way.
        along: f64 = 0.05, "m", POSITIVE;
        /// The robot is aligned when it is no further than this from the place across the way.
        across: f64 = 0.03, "m", POSITIVE;
        /// The robot is aligned when it is turned by no more than this against square to the edge.
        turned: f64 = 0.08, "rad", ANGLE;
        /// Walking speed for each metre that is left.
        gain: f64 = 1.2, "1/s", POSITIVE;
        /// Largest speed backwards.
        backward_speed: f64 = 0.05, "m/s", POSITIVE;
    }
}

settings! {
    /// Careful footsteps on the level.
    pub struct FootstepsTuning("navigation.stair_climbing.tuning.footsteps") {
        /// A stance that is further away than this along or across is moved to, not only turned to.
        aside: f64 = 0.004, "m", NOT_NEGATIVE;
        /// A stance whose heading differs by more than this is turned to, before the way where both together would cross the feet.
        turn: f64 = 0.04, "rad", ANGLE;
        /// The foot on the side of the motion goes first, where a radian of turn counts as so much of a way to that side.
        turn_arm: f64 = 0.1, "m/rad", NOT_NEGATIVE;
    }
}

settings! {
    /// Lists of footsteps that the walker is given.
    pub struct StepperTuning("navigation.stair_climbing.tuning.stepper") {
        /// A list that has not ended after this time, and as much again for each of its steps, is given up.
        patience: f64 = 3.0, "s", above_to(0.0, 60.0);
    }
}

settings! {
    /// What follows when a step fails.
    pub struct SetbackTuning("navigation.stair_climbing.tuning.setback") {
        /// With one foot on the next step, the other foot tries again after so many missteps; after more of them the robot moves back
        /// and gives up.
        second_tries: u32 = 1, "1", within(0.0, 100.0);
    }
}

settings! {
    /// Room for a move before a step and for the feet on it.
    pub struct ClearanceTuning("navigation.stair_climbing.tuning.clearance") {
        /// What is higher above a step than this stands on it.
        stands_on: f32 = 0.04, "m", NOT_NEGATIVE;
        /// A robot on a stair turns by less than this to get in place for the next step.
        largest_turn: f64 = 0.3, "rad", ANGLE;
        /// The heels may lie this much further back on a stair than they are put, when the robot moves on it.
        heels: f64 = 0.01, "m", NOT_NEGATIVE;
        /// A sole that is already beyond the side of the stair may be moved this much further out.
        aside: f64 = 0.005, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// Where the map has the floor under the robot end.
    pub struct DropOffTuning("navigation.stair_climbing.tuning.drop_off") {
        /// A walk is looked at this far ahead in time: one step, and a little more.
        ahead: f64 = 0.6, "s", NOT_NEGATIVE;
        /// A walk keeps this much room around the soles.
        margin: f64 = 0.03, "m", NOT_NEGATIVE;
        /// Lower floor at fewer places than this is a corner of a cell that may be of either level.
        few: usize = 2, "1", at_least(1.0);
    }
}

settings! {
    /// The end of a climb: away from the last edge, a stop, and on.
    pub struct FinishTuning("navigation.stair_climbing.tuning.finish") {
        /// The robot walks away from the last edge until its middle is no further than this behind it.
        farthest: f64 = 0.16, "m", NOT_NEGATIVE, "003, section V.D";
        /// The robot is there when less than this is left to walk.
        there: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Walking speed for each metre that is left.
        gain: f64 = 1.5, "1/s", POSITIVE;
        /// Largest walking speed.
        fastest: f64 = 0.08, "m/s", POSITIVE;
        /// The walk away from the edge ends after this time.
        longest_walk: f64 = 5.0, "s", WAIT;
        /// The robot waits no longer than this to come to stand.
        longest_stop: f64 = 3.0, "s", WAIT;
    }
}
