//! Settings of the behaviours `stair_climbing` and `continuous` that few will want to turn.

mod feet;
mod steps;

use settings::{Bounds, NOT_NEGATIVE, POSITIVE, above_to, settings, within};

pub(super) use feet::{
    AlignTuning, ApproachLegTuning, ClearanceTuning, DropOffTuning, FinishTuning, FootstepsTuning,
    SetbackTuning, StepperTuning,
};
pub(super) use steps::{
    FlightTuning, InspectionTuning, MeasuredEdgeTuning, NextStepTuning, PlacementTuning,
    StepLookupTuning,
};

/// Times after which the robot goes on to something else: with a time without end it would wait for ever.
const WAIT: Bounds = above_to(0.0, 600.0);
/// Angles below the horizon, to the side, or between two headings.
const ANGLE: Bounds = within(0.0, 3.2);

settings! {
    /// Numbers behind the behaviours `stair_climbing` and `continuous`.
    pub struct StairClimbingTuning("navigation.stair_climbing.tuning") {
        /// The robot before or on stairs is blind when no frame has come for longer than this.
        blind_after: f64 = 2.0, "s", WAIT;
        /// The robot before or on stairs gives up when it has been blind for this long.
        blind_limit: f64 = 12.0, "s", WAIT;
        /// The robot before or on stairs gives up after this time without a step.
        idle_limit: f64 = 60.0, "s", WAIT;
        /// A goal is on the robot's level when its height differs by less than this from that of the ground under the robot.
        goal_level: f64 = 0.02, "m", POSITIVE;
        /// Where the head looks before and on stairs.
        head: HeadTuning;
        /// The walk to the next climb.
        walk: ClimbAheadTuning;
        /// Where the walk ends and the climb's own states begin.
        leg: ApproachLegTuning;
        /// Stairs that are looked at from near by.
        inspection: InspectionTuning;
        /// The way to the place before the first edge.
        align: AlignTuning;
        /// How well an edge must be known for what.
        edges: MeasuredEdgeTuning;
        /// The steps ahead that the robot remembers.
        flight: FlightTuning;
        /// How steps are found again among the stairs that are known.
        lookup: StepLookupTuning;
        /// The step that is taken next.
        next_step: NextStepTuning;
        /// Where the feet go on a step.
        placement: PlacementTuning;
        /// Careful footsteps on the level.
        footsteps: FootstepsTuning;
        /// Lists of footsteps that the walker is given.
        stepper: StepperTuning;
        /// What follows when a step fails.
        setback: SetbackTuning;
        /// Room for a move before a step and for the feet on it.
        clearance: ClearanceTuning;
        /// Where the map has the floor under the robot end.
        drop_off: DropOffTuning;
        /// The end of a climb.
        finish: FinishTuning;
    }
    require (blind_limit) > (blind_after);
}

settings! {
    /// Where the head looks while the robot stands before a step or on one.
    pub struct HeadTuning("navigation.stair_climbing.tuning.head") {
        /// The head is panned no further than this to each side.
        widest: f64 = 1.1, "rad", ANGLE;
        /// Flattest look below the horizon at a place of the ground.
        flattest: f64 = 0.5, "rad", ANGLE;
        /// A place nearer to the eyes than this, on the ground, is looked at as if it were this far away.
        nearest: f64 = 0.05, "m", POSITIVE;
        /// A look at a place swings so far to its left and to its right: the noise of the depth image is mostly a fixed pattern, so
        /// that only moving the image averages it.
        apart: f64 = 0.12, "rad", ANGLE;
        /// A look at a place ends with a look that is this much flatter.
        flatter: f64 = 0.25, "rad", ANGLE;
        /// A search swings the head so far to each side.
        swing: f64 = 0.5, "rad", ANGLE, "003, section V.A";
        /// Look below the horizon at the ground near by, during a search.
        search_near: f64 = 0.85, "rad", ANGLE;
        /// Look below the horizon at the ground further away, during a search.
        search_far: f64 = 0.55, "rad", ANGLE;
        /// Look below the horizon at the end of a search.
        search_end: f64 = 0.7, "rad", ANGLE;
        /// An inspection of stairs swings the head so far to each side.
        inspect_aside: f64 = 0.15, "rad", ANGLE;
        /// Look below the horizon at the steps behind the first edge, during an inspection.
        inspect_near: f64 = 0.8, "rad", ANGLE;
        /// Look below the horizon at the middle of the stairs, during an inspection.
        inspect_middle: f64 = 0.7, "rad", ANGLE;
        /// Look below the horizon at the far steps, during an inspection.
        inspect_far: f64 = 0.55, "rad", ANGLE;
        /// A look before or on stairs ends after this time, whatever the frames do.
        longest_look: f64 = 8.0, "s", WAIT;
        /// A look before or on stairs ends once so many frames were taken into the map after its last place was reached.
        last_frames: u64 = 2, "1", within(0.0, 100.0);
        /// Where enough is known already, a look ends after so many frames.
        glance_frames: u64 = 3, "1", within(0.0, 100.0);
        /// Before the robot has stairs in mind it looks at the ground this far ahead.
        look_ahead: f64 = 0.2, "m", POSITIVE;
        /// The place that a robot on stairs looks at is at least this far ahead.
        look_nearest: f64 = 0.15, "m", POSITIVE;
        /// While the feet move and no edge is left to measure, the robot looks at the ground this far ahead.
        step_ahead: f64 = 0.3, "m", POSITIVE;
        /// At the end of a climb the robot looks at the ground this far ahead.
        finish_ahead: f64 = 0.35, "m", POSITIVE;
    }
    require (swing) <= (widest);
}

settings! {
    /// The walk to the next climb.
    pub struct ClimbAheadTuning("navigation.stair_climbing.tuning.walk") {
        /// The first look around may end after this time when stairs lie on the way and are climbed step by step: by then all near
        /// ground was looked at.
        first_look: f64 = 3.8, "s", NOT_NEGATIVE;
        /// The first look around may end after this time when stairs lie on the way and are climbed without stops: by then the ground
        /// on the way was looked at.
        first_glance: f64 = 1.8, "s", NOT_NEGATIVE;
        /// A climb, or stairs that need a closer look, must be ahead for this long to be counted on.
        sure_after: f64 = 0.4, "s", NOT_NEGATIVE;
    }
}
