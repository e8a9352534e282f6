//! `[gait]` of robot.toml: how this robot walks.

use settings::{SHARE, above_to, between, from_below, settings, within};

use crate::tuning::GaitTuning;

settings! {
    /// How this robot walks: `[gait]` of its robot.toml.
    pub struct GaitConfig("gait") {
        /// Time from one landing to the next.
        step_time: f64 = 0.5, "s", above_to(0.0, 60.0);
        /// Part of the step time in which both feet carry.
        double_support: f64 = 0.15, "s", above_to(0.0, 60.0);
        /// Time to shift the weight onto the first foot, and at the end back to the middle.
        shift_time: f64 = 0.6, "s", above_to(0.0, 60.0);
        /// Height of the swing foot's sole over the higher of its two ends.
        step_height: f64 = 0.02, "m", above_to(0.0, 10.0);
        /// Longest step forward: from beside the standing foot to where it lands.
        max_forward: f64 = 0.07, "m", above_to(0.0, 10.0);
        /// Longest step backward.
        max_backward: f64 = 0.05, "m", above_to(0.0, 10.0);
        /// Largest extra distance between the feet in a side step.
        max_sideways: f64 = 0.06, "m", above_to(0.0, 10.0);
        /// Largest turn of one step.
        max_turn: f64 = 0.3, "rad", between(0.0, 1.0);
        /// Distance between the centres of the soles when they are side by side; where it is not given, that of the upright stance.
        stance_width: f64 = 0.0, "m", above_to(0.0, 10.0);
        /// Least gap between the soles.
        foot_gap: f64 = 0.008, "m", within(0.0, 10.0);
        /// Height of the hips' centres over the soles; where it is not given, that of the upright stance.
        hip_height: f64 = 0.0, "m", above_to(0.0, 10.0);
        /// The leg never gets longer than this share of its straight length.
        max_extension: f64 = 0.985, "1", from_below(0.5, 1.0);
        /// The hips are lowered so that a thigh stretches back no further than this; without it, as far as a straight leg asks.
        hip_stretch: Option<f64> = None, "rad", between(0.0, 1.5);
        /// Where the foot carries: this far from the sole's middle towards the other foot.
        support_inward: f64 = 0.005, "m", within(-1.0, 1.0);
        /// Where the foot carries while a careful step is taken, so far towards the other foot; without it, as far as `support_inward`.
        climb_inward: Option<f64> = None, "m", within(-1.0, 1.0);
        /// Where along the sole it carries, forward of the sole's middle, as far as that lies in the middle half of what bears; without
        /// it, in the middle of what bears.
        support_ahead: Option<f64> = None, "m", within(-1.0, 1.0);
        /// A foot that stands higher than the other one carries further forward, by this share of the difference.
        support_forward: f64 = 0.2, "1", within(0.0, 100.0);
        /// The centre of pressure keeps this far from the sole's edges.
        sole_margin: f64 = 0.006, "m", within(0.0, 10.0);
        /// Gain from the error of the divergent component of motion to the centre of pressure; stable above 1.
        dcm_gain: f64 = 3.0, "1", between(1.0, 100.0);
        /// Share of the measured speed of the centre of mass that a tick takes over.
        velocity_blend: f64 = 0.5, "1", SHARE;
        /// How fast the reference follows the measured centre of mass.
        reference_pull: f64 = 0.0, "1/s", within(0.0, 100.0);
        /// Speed at which a foot yields to a wrong share of the load, for each newton of it.
        load_gain: f64 = 0.0006, "m/s/N", within(0.0, 1.0);
        /// How fast the difference of the feet's heights is forgotten.
        load_leak: f64 = 0.5, "1/s", within(0.0, 100.0);
        /// Largest difference of the feet's heights through load control.
        load_limit: f64 = 0.012, "m", within(0.0, 10.0);
        /// Load at which a foot counts as landed before its time.
        landing_load: f64 = 6.0, "N", above_to(0.0, 10_000.0);
        /// Speed at which a walking foot goes on down that is not on the ground at its time.
        late_speed: f64 = 0.15, "m/s", within(0.0, 10.0);
        /// How far a walking foot goes on down that is not on the ground at its time.
        late_depth: f64 = 0.015, "m", within(0.0, 10.0);
        /// Errors at landing up to this are left to the ankles; above, the step is moved.
        capture_deadband: f64 = 0.01, "m", within(0.0, 10.0);
        /// The farthest that a step is moved to catch a push.
        capture_limit: f64 = 0.08, "m", above_to(0.0, 10.0);
        /// Largest acceleration of a step's clock to catch a push.
        capture_hurry: f64 = 1.0, "1", within(1.0, 10.0);
        /// Error to the outer side, beyond the dead band, at which a step's clock stands still.
        capture_hold: f64 = 0.01, "m", above_to(0.0, 10.0);
        /// Longest time that the clock is held in a phase.
        capture_patience: f64 = 0.6, "s", within(0.0, 60.0);
        /// Speed at which an ankle yields, for each metre that the centre of pressure is beside where it is to be.
        ankle_gain: f64 = 30.0, "rad/s/m", within(0.0, 10_000.0);
        /// Distance of the centre of pressure from where it is to be beyond which an ankle yields.
        ankle_deadband: f64 = 0.012, "m", within(0.0, 10.0);
        /// Fastest that an ankle yields.
        ankle_speed: f64 = 1.0, "rad/s", within(0.0, 100.0);
        /// Farthest that an ankle yields.
        ankle_limit: f64 = 0.2, "rad", within(0.0, 3.2);
        /// How fast an ankle that has yielded gets level again.
        ankle_leak: f64 = 0.5, "1/s", within(0.0, 100.0);
        /// Share of the measured tilt that the swing foot makes up for.
        swing_tilt: f64 = 1.0, "1", within(0.0, 100.0);
        /// Speed over the ground that the foot of a long listed step keeps to on average.
        climb_speed: f64 = 0.195, "m/s", above_to(0.0, 10.0);
        /// Speed at which the foot of a high listed step rises and sinks on average.
        climb_lift_speed: f64 = 0.172, "m/s", above_to(0.0, 10.0);
        /// Time in which the foot of a listed step is in the air at least.
        climb_swing_time: f64 = 0.8, "s", above_to(0.0, 60.0);
        /// Time in which the foot of a listed step has to be found on the ground, while the other foot still carries everything.
        climb_landing_time: f64 = 0.2, "s", within(0.0, 60.0);
        /// Time on both feet between two listed steps.
        climb_double_support: f64 = 0.2, "s", above_to(0.0, 60.0);
        /// Height of a listed step's sole over the higher of its two ends.
        climb_clearance: f64 = 0.02, "m", above_to(0.0, 10.0);
        /// Longest listed step forward or backward.
        climb_forward: f64 = 0.135, "m", above_to(0.0, 10.0);
        /// A listed step that is walked goes forward and to the side at once so far, as the sum of its shares of the longest of each.
        listed_both: f64 = 1.5, "1", within(1.0, 2.0);
        /// Largest extra distance between the feet in a listed step.
        climb_sideways: f64 = 0.05, "m", above_to(0.0, 10.0);
        /// Largest extra distance between the feet in the highest careful step down, for which the legs are stretched already.
        climb_sideways_down: f64 = 0.015, "m", above_to(0.0, 10.0);
        /// Highest listed step up or down.
        climb_rise: f64 = 0.055, "m", above_to(0.0, 10.0);
        /// The farthest that the torso leans forward on high steps up, so that the shank clears the step behind.
        climb_lean: f64 = 0.6, "rad", within(0.0, 1.0);
        /// Speed at which a foot goes down that has not found the ground where it was told to be.
        probe_speed: f64 = 0.08, "m/s", above_to(0.0, 10.0);
        /// How much deeper than told a foot seeks the ground.
        probe_depth: f64 = 0.012, "m", within(0.0, 10.0);
        /// Speed at which a foot that was found on the ground goes on down while less than `landing_load` is on it.
        press_speed: f64 = 0.02, "m/s", within(0.0, 10.0);
        /// A listed step's foot that is this far beside its path has met something.
        obstructed_distance: f64 = 0.018, "m", above_to(0.0, 10.0);
        /// A listed step's foot that meets the next riser this near to its place comes down where it is: what lies behind its bearing part.
        brush_distance: f64 = 0.01, "m", above_to(0.0, 10.0);
        /// A listed step's foot that comes down on something this far above where it was told to land has met another level: 8 mm are
        /// climbed over, and heights are told within 3 mm.
        obstructed_height: f64 = 0.011, "m", above_to(0.0, 10.0);
        /// A foot whose sole is felt to be this far above the level that it left has met another level: a toe on the riser behind a
        /// short tread.
        known_height: f64 = 0.006, "m", above_to(0.0, 10.0);
        /// A listed step during which the divergent component of motion is this far beside its reference, towards the foot that has hardly
        /// left, is begun anew: 14 mm are the most in steps that go well.
        tip_error: f64 = 0.0175, "m", above_to(0.0, 10.0);
        /// A walking foot that comes upon something this far above the floor has met another level.
        stumble_height: f64 = 0.012, "m", above_to(0.0, 10.0);
        /// Time in which a walking foot goes back off what it met.
        retreat_time: f64 = 0.2, "s", above_to(0.0, 60.0);
        /// Time to raise the arms, or to lower them.
        arms_time: f64 = 1.5, "s", above_to(0.0, 60.0);
        /// Speed up to which the hips are raised and lowered.
        hip_speed: f64 = 0.12, "m/s", above_to(0.0, 10.0);
        /// Largest speed of the head's joints.
        gaze_speed: f64 = 2.0, "rad/s", above_to(0.0, 100.0);
        /// Numbers that few will want to turn.
        tuning: GaitTuning;
    }
    require (double_support) < (step_time);
}
