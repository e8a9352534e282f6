//! The finer settings of what the walker does when it is pushed or tips.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, above_to, at_least, settings, within};

settings! {
    /// How steps are moved to catch a push.
    pub struct CaptureTuning("gait.tuning.capture") {
        /// Share of the swing after which the landing stays where it is.
        committed: f64 = 0.85, "1", SHARE;
        /// Fastest that a landing is moved.
        speed: f64 = 1.0, "m/s", above_to(0.0, 10.0);
        /// Growth of the error until the landing, less 1, that is reckoned with at least, at the end of a step.
        least_growth: f64 = 0.01, "1", POSITIVE;
    }
}

settings! {
    /// Steps that catch a push which ankles cannot hold: sooner than in a walk, and farther.
    pub struct CatchingTuning("gait.tuning.catching") {
        /// Error of the divergent component of motion from which on the robot counts as pushed, in heights of the hips.
        begins: f64 = 0.2, "1", POSITIVE;
        /// Time for which the error has to be so large: a start or a landing jolts for a moment.
        sure_time: f64 = 0.025, "s", within(0.0, 60.0);
        /// A robot whose feet carry less than this share of its weight is not taken to be pushed: a leg that it throws or stops has lifted it,
        /// and where its joints have it says nothing until it stands again. Where soles are narrower than the robot is large and this is
        /// not given, `[gait.tuning.sole_fit]` has it.
        carried: f64 = 0.0, "1", SHARE;
        /// Error below which a push is over, in heights of the hips.
        ends: f64 = 0.06, "1", POSITIVE;
        /// Time that the error has to be so small.
        calm_time: f64 = 0.3, "s", within(0.0, 60.0);
        /// How far outside of what both feet hold a foot is lifted at once, as a share of half a sole's length.
        outside: f64 = 0.12, "1", NOT_NEGATIVE;
        /// Share of the swing after which the landing stays where it is.
        committed: f64 = 0.85, "1", SHARE;
        /// Share of the swing after which a load on the foot is its landing.
        lands: f64 = 0.4, "1", SHARE;
        /// Time behind a landing before a foot is lifted again.
        settle: f64 = 0.03, "s", within(0.0, 60.0);
        /// How fast a landing is moved, in heights of the hips for each time constant of the pendulum.
        speed: f64 = 1.5, "1", POSITIVE;
        /// How fast a foot gets to another place on average, in heights of the hips for each time constant of the pendulum.
        stride: f64 = 0.7, "1", POSITIVE;
        /// How far over the outer edge a foot in the air is told to be a counterweight, in heights of the hips.
        out: f64 = 0.02, "1", NOT_NEGATIVE;
        /// How far towards the outer edge of the sole that stands, from its middle, the divergent component of motion is at once taken
        /// for a push, in heights of the hips: a quiet walk goes as far with any sole, however narrow.
        tips: f64 = 0.07, "1", NOT_NEGATIVE;
        /// How far out it is when foot and torso do all they can as a counterweight, in the same way.
        tipped: f64 = 0.12, "1", POSITIVE;
        /// How far out a foot that is a counterweight goes, in heights of the hips.
        weigh: f64 = 0.7, "1", SHARE;
        /// How fast it goes there, in heights of the hips for each time constant of the pendulum.
        out_speed: f64 = 1.5, "1", POSITIVE;
        /// How fast the clock of the step runs until then.
        out_rate: f64 = 2.0, "1", POSITIVE;
        /// How far the torso rolls to the side to which the robot falls over the outer edge.
        roll: f64 = 0.3, "rad", within(0.0, 1.0);
        /// How fast it does, for each time constant of the pendulum.
        roll_speed: f64 = 0.5, "rad", POSITIVE;
        /// How fast it comes back, for each time constant of the pendulum.
        roll_back: f64 = 0.1, "rad", POSITIVE;
        /// Share of the swing at which a foot that is a counterweight waits.
        out_share: f64 = 0.5, "1", SHARE;
        /// How many times faster than in a walk a foot goes at most.
        hurry: f64 = 2.0, "1", at_least(1.0);
        /// How much later than planned a foot lands at most, in time constants of the pendulum.
        wait: f64 = 1.5, "1", NOT_NEGATIVE;
        /// Among how many times that of the landing is chosen.
        times: usize = 12, "1", within(2.0, 1000.0);
        /// What moving a landing costs against missing what it had to catch.
        moving: f64 = 0.05, "1", NOT_NEGATIVE;
        /// What another time costs, half a sole's length for each time constant of the pendulum.
        shifting: f64 = 0.1, "1", NOT_NEGATIVE;
        /// Longest step ahead or back, in heights of the hips.
        along: f64 = 0.75, "1", POSITIVE;
        /// Largest extra distance between the feet, in heights of the hips.
        aside: f64 = 0.3, "1", POSITIVE;
    }
    require (tips) < (tipped);
}

settings! {
    /// When a leg buckles under a listed step.
    pub struct BucklingTuning("gait.tuning.buckling") {
        /// How far a joint of the leg that carries falls behind what it is told; in steps that go well 0.02, and 0.06 with a knee bent to the full.
        behind: f64 = 0.08, "rad", POSITIVE;
    }
}

settings! {
    /// When a listed step is begun anew because the robot tips.
    pub struct TippingTuning("gait.tuning.tipping") {
        /// How often in a list a foot is put down again; a robot that still tips is better off with the step behind it.
        times: usize = 3, "1", NOT_NEGATIVE;
        /// How far the robot may tip forward or back, as a share of how far it tips sideways: no foot beside the other one stops that.
        ahead_share: f64 = 0.5, "1", NOT_NEGATIVE;
        /// Share of its way over the ground up to which a foot is still where it left.
        gone_share: f64 = 0.05, "1", SHARE;
    }
}
