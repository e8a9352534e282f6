//! When the robot steps, and how far it plans.

use settings::{POSITIVE, above_to, settings, within};

settings! {
    /// What the behaviour `footsteps` does between its steps.
    pub struct SteppingConfig("navigation.stepping") {
        /// The robot stops walking so far before the edge of the first height change on its way: from there it sees the edge well.
        stop_before: f64 = 0.26, "m", above_to(0.0, 2.0);
        /// It is told to stop so much nearer.
        stop_slack: f64 = 0.05, "m", within(0.0, 1.0);
        /// It walks again where the way is level, and no height change comes nearer than this.
        walk_on: f64 = 0.6, "m", POSITIVE;
        /// So many steps of a plan are taken before the robot stands and looks, unless it has planned on by then.
        run: usize = 6, "1", within(1.0, 50.0);
        /// A plan ends so far before what was not seen: from there it can be looked at.
        look_from: f64 = 0.2, "m", within(0.0, 2.0);
        /// At its end the robot faces that at least so well.
        faces: f64 = 0.8, "rad", within(0.1, 3.2);
        /// Feet whose places and heights differ by no more from side by side and level walk on from there.
        side_by_side: f64 = 0.015, "m", POSITIVE;
        /// A sole is put down level where the ground under it rises less than this per metre: heights are known to so much.
        level_slope: f64 = 0.02, "1", within(0.0, 1.0);
        /// While it steps, the robot looks at the place of the step that comes so many steps later.
        look_ahead: usize = 3, "1", within(0.0, 20.0);
        /// The last places where feet stood, so many, count as ground while the robot steps.
        felt: usize = 12, "1", within(0.0, 1000.0);
        /// So many looks without a step between them are in vain, and so many times stepping is given up before the robot refuses.
        tries: u32 = 3, "1", within(1.0, 100.0);
        /// So many steps that led nowhere are taken back, to look for others from there.
        backs: u32 = 4, "1", within(0.0, 100.0);
        /// So many looks at one place that leave it unseen are enough.
        looks: u32 = 2, "1", within(1.0, 100.0);
        /// So often the way on may turn out longer than it had seemed and still count as getting on.
        longer: u32 = 8, "1", within(0.0, 1000.0);
        /// Stepping that was given up no farther away than this is not tried again until the robot has walked.
        elsewhere: f64 = 0.15, "m", POSITIVE;
        /// While the robot walks to a height change, footsteps are planned every so many frames.
        plan_every: u64 = 6, "frames", within(1.0, 1000.0);
        /// The first look around may end after this time where footsteps lead to the goal, or the planner to a height change.
        first_look: f64 = 3.8, "s", within(0.0, 60.0);
        /// The planner finds no way for so long before steps are tried.
        no_way_after: f64 = 1.0, "s", within(0.0, 60.0);
    }
}
