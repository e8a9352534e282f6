//! Settings of the watch over the body's senses.

use settings::{POSITIVE, SHARE, above_to, settings};

settings! {
    /// When the senses of the body contradict each other.
    pub struct SenseWatchConfig("navigation.sense_watch") {
        /// A force cell, or an inertial unit, whose readings stay the same to the bit for this long while others change is stuck: noise
        /// never repeats itself.
        constant: f64 = 0.015, "s" of sensor, POSITIVE;
        /// Feet that carry less than this share of the robot's weight carry too little.
        least_load: f64 = 0.65, "1", above_to(0.0, 1.0);
        /// Time for which feet that carry too little are believed: a landing shakes them. A cell that has told nothing for so long
        /// while its foot carried half as much is the one that is dead.
        load_time: f64 = 0.2, "s", POSITIVE;
        /// Time over which forces are smoothed.
        smooth: f64 = 0.1, "s", POSITIVE;
        /// A smoothed specific force that differs by more from gravity's strength is wrong.
        gravity: f64 = 5.0, "m/s^2", POSITIVE;
        /// A joint whose encoder stays the same to the bit while its target moves by this has a stuck encoder.
        stuck: f64 = 0.08, "rad", POSITIVE;
        /// Time for which an encoder may stay the same whatever its target does: the joint follows late.
        stuck_time: f64 = 0.1, "s", POSITIVE;
        /// A gyroscope that tells this turn of a robot whose joints and feet rest is wrong: more than twenty standard
        /// deviations of the bias of those that come along.
        resting: f64 = 0.02, "rad/s" of sensor, POSITIVE;
        /// Time over which a resting gyroscope is averaged.
        resting_time: f64 = 0.9, "s" of sensor, POSITIVE;
        /// Joints rest while none of the legs' encoders moves by more than this in that time.
        joint_rest: f64 = 0.0035, "rad", POSITIVE;
        /// Time over which the turn by the gyroscope is held against the turn by the leg that carries, in roll and pitch.
        tilt_time: f64 = 0.3, "s", POSITIVE;
        /// A sole each of whose cells bears more than this share of the robot's weight does not rock: its leg tells roll and pitch.
        firm: f64 = 0.02, "1", above_to(0.0, 1.0);
        /// Roll or pitch by which the two may differ in that time: whole ones differ by less than 0.03.
        tilt: f64 = 0.045, "rad", POSITIVE;
        /// Roll or pitch by which they must differ over both feet: a sole on something a centimetre high rocks by less.
        tilt_of_both: f64 = 0.08, "rad", POSITIVE;
        /// How fast what differed over a foot fades: with the steps that follow.
        both_time: f64 = 1.0, "s", POSITIVE;
        /// Unless the turn of the legs about other axes explains the readings so much better: what is left of them then is less than
        /// this share.
        rewired: f64 = 0.2, "1", SHARE;
        /// Time over which both turns are smoothed for that.
        turn_smooth: f64 = 0.05, "s", POSITIVE;
        /// Time over which the heading by the gyroscope is held against that by the legs.
        heading_time: f64 = 2.0, "s", POSITIVE;
        /// A difference between the two that is faster counts as if it were so fast: a sole that slips turns fast and for a moment.
        slip: f64 = 0.06, "rad/s", POSITIVE;
        /// The heading of a foot that lies more aslant is left out: it slips.
        slope: f64 = 0.03, "rad", POSITIVE;
        /// Heading by which the two may differ in that time: twice what whole ones differ by on slippery slopes.
        heading: f64 = 0.03, "rad", POSITIVE;
    }
}
