//! Settings of the behaviours `stair_climbing` and `continuous` that few will want to turn.

mod feet;
mod steps;

use settings::{NOT_NEGATIVE, POSITIVE, settings, within};

use crate::walking::tuning::{ANGLE, WAIT};

pub(super) use feet::{
    AlignTuning, ApproachLegTuning, ClearanceTuning, DropOffTuning, FinishTuning, FootstepsTuning,
    SetbackTuning, StepperTuning,
};
pub(super) use steps::{
    FlightTuning, InspectionTuning, MeasuredEdgeTuning, NextStepTuning, PlacementTuning,
    StepLookupTuning,
};

settings! {
    /// Numbers behind the behaviours `stair_climbing` and `continuous`.
    pub struct StairClimbingTuning("navigation.stair_climbing.tuning") {
        /// The map is asked at so many places under the soles to each side of their middle, along and across.
        raster: i32 = 5, "1", within(1.0, 100.0);
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
}

settings! {
    /// Where the head looks while the robot stands before a step or on one.
    pub struct HeadTuning("navigation.stair_climbing.tuning.head") {
        /// A place nearer to the eyes than this, on the ground, is looked at as if it were this far away.
        nearest: f64 = 0.05, "m", POSITIVE;
        /// A look at a place swings so far to its left and to its right: the noise of the depth image is mostly a fixed pattern, so
        /// that only moving the image averages it.
        apart: f64 = 0.12, "rad", ANGLE;
        /// A look at a place ends with a look that is this much flatter.
        flatter: f64 = 0.25, "rad", ANGLE;
        /// A search swings the head so far to each side.
        swing: f64 = 0.5, "rad", ANGLE, "003, section V.A";
        /// An inspection of stairs swings the head so far to each side.
        inspect_aside: f64 = 0.15, "rad", ANGLE;
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
    }
}
