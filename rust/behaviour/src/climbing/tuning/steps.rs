//! Settings of what the robot knows and remembers of steps, and of where its feet go on them.

use settings::{NOT_NEGATIVE, POSITIVE, above_to, at_least, settings, within};

use super::ANGLE;

settings! {
    /// How well the edge of a step must be known for what.
    pub struct MeasuredEdgeTuning("navigation.stair_climbing.tuning.edges") {
        /// An edge will do, when no look tells more, with deviations up to so many times those that are asked for.
        usable: f64 = 1.2, "1", POSITIVE;
        /// An edge is known so well that another look would tell little after so many times the frames that are asked for.
        well_frames: u32 = 2, "1", within(1.0, 1000.0);
        /// An edge is known so well that another look would tell little with deviations up to so many times those that are asked for.
        well: f64 = 0.5, "1", POSITIVE;
    }
}

settings! {
    /// The steps ahead that the robot remembers.
    pub struct FlightTuning("navigation.stair_climbing.tuning.flight") {
        /// An edge nearer than this to the robot's middle is out of view: what was measured before is better than what is thought of it
        /// now.
        out_of_view: f64 = 0.17, "m", NOT_NEGATIVE;
        /// On a tread deeper than this the robot has room to turn and to walk.
        roomy: f64 = 0.22, "m", POSITIVE;
        /// A lane that lies further aside than this is another one.
        lane: f64 = 0.08, "m", NOT_NEGATIVE;
        /// A robot whose middle is further than this before an edge has no foot over it yet.
        not_yet_there: f64 = 0.06, "m", NOT_NEGATIVE;
        /// Steps that neither the plan nor the view has shown for this long are lost.
        lost_after: f64 = 1.5, "s", NOT_NEGATIVE;
        /// A step that the plan has not led over for this long is lost, too: a plan may think of another way for a while.
        unplanned_after: f64 = 4.0, "s", NOT_NEGATIVE;
        /// An edge stays where it was measured when it is now known worse by more than this factor.
        worse: f64 = 2.0, "1", POSITIVE;
        /// Of an edge that was shorter than this share of what is seen now, but a piece was known.
        piece: f64 = 0.5, "1", within(0.0, 1.0);
    }
}

settings! {
    /// How steps are found again among the stairs that are known.
    pub struct StepLookupTuning("navigation.stair_climbing.tuning.lookup") {
        /// Two sights of a front edge that was measured differ by less than this in its place.
        same_place: f64 = 0.05, "m", POSITIVE;
        /// Two sights of a front edge that was not measured differ by less than this in its place.
        vague_place: f64 = 0.09, "m", POSITIVE;
        /// Two sights of a front edge differ by less than this in its heading.
        same_heading: f64 = 0.4, "rad", ANGLE;
        /// Steps whose edges are nearer than this do not follow each other: a way turns back, or they are one.
        least_tread: f64 = 0.06, "m", NOT_NEGATIVE;
        /// A step follows another when its front edge is no further than this behind the other's back edge.
        joint: f64 = 0.06, "m", NOT_NEGATIVE;
        /// A remembered step that is higher than the limit by no more than this counts as being at the limit: heights vary as long as
        /// they are seen.
        doubt: f64 = 0.0015, "m", NOT_NEGATIVE;
        /// The feet come to stand this far behind the front edge of a step, as far as finding its stair goes.
        on_it: f64 = 0.05, "m", NOT_NEGATIVE;
        /// A stair covers a place that lies beyond its edges by no more than this.
        margin: f64 = 0.02, "m", NOT_NEGATIVE;
        /// A way meets an edge from this cosine of the angle between the way and square to the edge on.
        towards: f64 = 0.5, "1", above_to(0.0, 1.0);
    }
}

settings! {
    /// The step that is taken next.
    pub struct NextStepTuning("navigation.stair_climbing.tuning.next_step") {
        /// The edge of the next step lies no further than this ahead of the toes.
        reach: f64 = 0.06, "m", NOT_NEGATIVE;
        /// Steps that the plan leads over are taken over when the first edge is no further away than so many times what the robot
        /// reaches.
        planned: f64 = 2.0, "1", POSITIVE;
    }
}

settings! {
    /// Where the feet go on a step.
    pub struct PlacementTuning("navigation.stair_climbing.tuning.placement") {
        /// So much ground must be known behind where the toes will be, when no edge is.
        known_ahead: f64 = 0.02, "m", NOT_NEGATIVE;
        /// The heels stand at least this far behind the front edge when that ground is asked for.
        heels: f64 = 0.015, "m", NOT_NEGATIVE;
        /// The robot crosses an edge no further than this beside where the way crosses it.
        off_the_way: f64 = 0.04, "m", NOT_NEGATIVE;
        /// A robot that moves aside for room beside a step takes this much more.
        spare: f64 = 0.015, "m", NOT_NEGATIVE;
        /// Two edges that are turned against each other by less than this are parallel: their headings are no better known.
        unsure_turn: f64 = 0.05, "rad", ANGLE;
        /// From one edge to the next the turn counts up to this.
        largest_turn: f64 = 0.3, "rad", ANGLE;
    }
}

settings! {
    /// Stairs that a plan needs and does not use yet, and that are looked at from near by.
    pub struct InspectionTuning("navigation.stair_climbing.tuning.inspection") {
        /// Stairs further away than this are left alone.
        farthest: f64 = 1.5, "m", POSITIVE;
        /// A change of height above this is no step to look at, not even to tell that it is too high.
        highest: f64 = 0.075, "m", POSITIVE;
        /// Stairs nearer than this to some that were inspected have been looked at.
        inspected: f64 = 0.3, "m", NOT_NEGATIVE;
        /// The place from which stairs are looked at counts as reached within this distance.
        near: f64 = 0.1, "m", POSITIVE;
        /// Places on the way there are this far apart.
        spacing: f64 = 0.04, "m", at_least(0.005);
    }
}
