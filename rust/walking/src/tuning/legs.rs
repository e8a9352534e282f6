//! The finer settings of the legs: their inverse kinematics, and what the soles change of the gait.

use settings::{POSITIVE, SHARE, above_to, between, settings, within};

settings! {
    /// The inverse kinematics of the legs: in closed form, or by Newton's method where that does not hold.
    pub struct LegTuning("gait.tuning.leg") {
        /// By how much axes may miss the point in which the closed form lets them meet: the sole then is that far from where it should be.
        miss: f64 = 1e-3, "m", above_to(0.0, 10.0);
        /// Steepest slant of a hip's yaw axis.
        steepest: f64 = 1.2, "rad", between(0.0, 1.57);
        /// Share of the thigh that is left between hip and ankle of the shortest leg, beyond the difference of thigh and shank.
        shortest: f64 = 0.05, "1", above_to(0.0, 1.0);
        /// Most steps of Newton's method from a solution that is near; as many again from the upright stance where those do not get there.
        steps: usize = 12, "1", within(1.0, 1000.0);
        /// Newton's method is done when the sole is so near to where it should be.
        near: f64 = 1e-6, "m" of numerics, above_to(0.0, 1e-3);
        /// Where a joint comes to its end: how much it counts how the sole lies, against where its ankle is.
        lying: f64 = 0.1, "1", above_to(0.0, 1.0);
        /// Largest turn of a joint in one step of it.
        longest_step: f64 = 0.5, "rad", above_to(0.0, 3.2);
    }
}

settings! {
    /// How two hips agree that share one yaw motor.
    pub struct SharedHipTuning("gait.tuning.shared_hip") {
        /// Turns of the torso after which both legs agree; the first is exact for legs side by side.
        turns: usize = 6, "1", within(1.0, 1000.0);
        /// The torso is never turned further from where it was to be than this.
        most_turn: f64 = 0.5, "rad", between(0.0, 1.57);
        /// Least slope of the secant method, as a share of that for legs side by side, which is taken where it is less.
        least_slope: f64 = 0.3, "1", POSITIVE;
    }
}

settings! {
    /// What soles change of the gait that are narrower than those of `qrio` made as large as the robot, where `[gait]` does not say it.
    pub struct SoleFitTuning("gait.tuning.sole_fit") {
        /// Width of the soles for which the gait's defaults are.
        width: f64 = 0.075, "m", above_to(0.0, 10.0);
        /// Shortest time of a step, as a share of what the robot's size alone makes it.
        quickest: f64 = 0.6, "1", above_to(0.0, 1.0);
        /// An ankle that turns the toes up by less than this beyond the upright stance comes to its end while the weight goes from one level
        /// to another: then that is quicker on narrow soles.
        short_ankle: f64 = 0.5, "rad", within(0.0, 3.2);
        /// Shortest time on both feet between two careful steps then, as a share of what the robot's size alone makes it.
        quickest_shift: f64 = 0.35, "1", above_to(0.0, 1.0);
        /// How far the weight goes inwards, as a share of what half a sole lacks.
        inward: f64 = 0.25, "1", SHARE;
        /// How far in the weight goes at most in careful steps, as a share of half a sole.
        careful: f64 = 0.33, "1", SHARE;
        /// The feet stand nearer to each other where they carry farther apart than so many times what half a sole leaves on either
        /// side of its middle.
        apart: f64 = 2.4, "1", POSITIVE;
        /// Share of the weight that the feet carry at least where the robot is taken to be pushed.
        carried: f64 = 0.7, "1", SHARE;
        /// Least distance of the feet, as a share of that in the upright stance: the legs clear each other, in turns too.
        narrowest: f64 = 0.9, "1", above_to(0.0, 1.0);
    }
}
