//! The finer settings of proprioception.

use settings::{NOT_NEGATIVE, POSITIVE, above_to, settings, within};

settings! {
    /// The finer settings of the body's own senses.
    pub struct ProprioceptionTuning("navigation.proprioception.tuning") {
        /// How stillness is told from motion.
        stillness: StillnessTuning;
        /// What the gears of the legs hide.
        play: PlayTuning;
        /// How the torso's motion is followed.
        motion: MotionTuning;
        /// When the start is over.
        start: StartTuning;
        /// How long body states are kept.
        history: HistoryTuning;
    }
}

settings! {
    /// How stillness is told from motion.
    pub struct StillnessTuning("navigation.proprioception.tuning.stillness") {
        /// A single angular velocity this many standard deviations off ends the rest.
        outlier: f64 = 4.0, "1", POSITIVE;
    }
}

settings! {
    /// What the gears of the legs hide: lost motion between a motor and its joint.
    pub struct PlayTuning("navigation.proprioception.tuning.play") {
        /// Share of a motor's peak torque that takes up the play.
        takes_up: f64 = 0.06, "1", above_to(0.0, 1.0);
        /// Share of a tick's new lead of the motor in the smoothed one.
        follow: f64 = 0.5, "1", above_to(0.0, 1.0);
    }
}

settings! {
    /// How the torso's motion is followed.
    pub struct MotionTuning("navigation.proprioception.tuning.motion") {
        /// Time over which the torso's speed by leg odometry is smoothed.
        speed_filter_time: f64 = 0.05, "s", NOT_NEGATIVE;
        /// Speeds of trunk joints below this are the encoders' noise.
        joint_speed_floor: f64 = 0.1, "rad/s" of sensor, NOT_NEGATIVE;
    }
}

settings! {
    /// When the start, at which the robot is where it was put, is over.
    pub struct StartTuning("navigation.proprioception.tuning.start") {
        /// The start is over after this time, whether the robot has settled or not.
        longest: f64 = 4.0, "s", within(0.0, 1000.0);
        /// A sole that the legs hold this much above the other one was lifted; play in their gears moves it by a millimetre.
        lifted: f64 = 0.004, "m", POSITIVE;
    }
}

settings! {
    /// How long body states are kept, so that a depth frame is posed by the joints at its exposure.
    pub struct HistoryTuning("navigation.proprioception.tuning.history") {
        /// Latency of the latest picture that finds the body state at its exposure: the most that a scenario allows as `sensors.latency`.
        longest_latency: f64 = 2.0, "s" of camera, within(0.0, 60.0);
    }
}
