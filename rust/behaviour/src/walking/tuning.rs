//! Settings of the behaviour `walking` that few will want to turn.

use settings::{Bounds, NOT_NEGATIVE, POSITIVE, above_to, at_least, settings, within};

/// Times after which the robot goes on to something else: with a time without end it would wait for ever.
pub(crate) const WAIT: Bounds = above_to(0.0, 600.0);
/// Angles below the horizon, to the side, or between two headings.
pub(crate) const ANGLE: Bounds = within(0.0, 3.2);

settings! {
    /// Numbers behind the behaviour `walking`.
    pub struct WalkingTuning("navigation.walking.tuning") {
        /// The robot gives up after standing, looking and waiting for this long without a step towards the goal.
        idle_limit: f64 = 75.0, "s", WAIT;
        /// The last command holds for this long without a plan: just after a via point was passed the next plan is not there yet.
        plan_hold: f64 = 0.3, "s" of camera, within(0.0, 10.0);
        /// Where the head looks.
        gaze: GazeTuning;
        /// How the path is followed.
        track: TrackTuning;
        /// The look around of a robot that stands.
        look_around: LookAroundTuning;
        /// The turn on the spot.
        turn: TurnTuning;
        /// How the robot finds out where it is.
        locate: LocateTuning;
        /// What is tried where nothing is seen.
        blind: BlindTuning;
        /// Unknown ground ahead on the path.
        unknown: UnknownGroundTuning;
        /// What a foot has met.
        touch: TouchTuning;
        /// Obstacles on the way.
        obstacles: WayObstaclesTuning;
        /// The watch over headway on the way to the goal.
        progress: ProgressTuning;
        /// The walk sideways.
        sidle: SidleTuning;
        /// When the robot has arrived.
        arrival: ArrivalTuning;
    }
}

settings! {
    /// Where the head looks while the robot stands and while it walks.
    pub struct GazeTuning("navigation.walking.tuning.gaze") {
        /// A look ends once so many frames were taken into the map after its last place was reached.
        last_frames: u64 = 2, "1", within(0.0, 100.0);
        /// A look up shows so much more above what the robot's head would meet, by which the body sways and the camera is off.
        above_head: f64 = 0.04, "rad", ANGLE;
        /// The look around looks up so far to each side.
        up_aside: f64 = 0.5, "rad", ANGLE;
        /// The look around looks up at the room for the head from this distance on.
        up_from: f64 = 0.5, "m", NOT_NEGATIVE;
        /// A look at a place on the path reaches this far to its left and to its right.
        aside: f64 = 0.3, "rad", ANGLE;
        /// While the robot walks it looks far ahead and near by in turns that repeat after this time.
        period: f64 = 3.0, "s", POSITIVE;
        /// Share of that time in which it looks far ahead.
        far_share: f64 = 0.6, "1", within(0.0, 1.0);
        /// While the robot walks the gaze sways so far to each side of the path.
        sway: f64 = 0.35, "rad", ANGLE;
        /// The gaze sways to and fro once in so many periods of far and near.
        sway_periods: f64 = 1.5, "1", POSITIVE;
    }
}

settings! {
    /// How the path is followed.
    pub struct TrackTuning("navigation.walking.tuning.track") {
        /// A robot that is nearer than this to the place that it steers to keeps its heading.
        on_target: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Share of the walking speed that is left where the path has no clearance at all.
        slowest_share: f64 = 0.4, "1", above_to(0.0, 1.0);
        /// A path whose bearing is smaller than this is met by side steps; any other one is met by a turn.
        straight: f64 = 0.35, "rad", ANGLE;
        /// Speed of the side steps for each metre between the robot and its path.
        side_gain: f64 = 0.5, "1/s", NOT_NEGATIVE;
        /// Near its end the path is walked at such a speed that what is left of it would take this long.
        end_time: f64 = 1.0, "s", POSITIVE;
        /// The robot walks no slower than this towards the end of its path, or of a climb.
        slowest: f64 = 0.02, "m/s", POSITIVE;
    }
}

settings! {
    /// The look around of a robot that stands, and what follows when it shows no way.
    pub struct LookAroundTuning("navigation.walking.tuning.look_around") {
        /// A way, or a climb, must have been there for this long to be counted on: to end a look around, or a turn to the next one,
        /// before its end.
        sure_after: f64 = 0.5, "s", NOT_NEGATIVE;
        /// After looks in so many directions all around was seen: one sweep covers about 3 rad with the camera's width, and the head
        /// looks on while the robot turns.
        directions: u32 = 2, "1", within(1.0, 100.0);
        /// The directions of two looks differ by this.
        apart: f64 = 3.1, "rad", ANGLE;
        /// A look, of whatever kind, ends after this time, whatever the frames do: all around takes some 9 s.
        longest: f64 = 12.0, "s", WAIT;
        /// A robot that looks around may see nothing for so many times as long as one that does not: it may look where there is no
        /// ground.
        patience: f64 = 2.0, "1", within(1.0, 100.0);
    }
}

settings! {
    /// The turn on the spot.
    pub struct TurnTuning("navigation.walking.tuning.turn") {
        /// A turn ends after this time, wherever the robot points.
        longest: f64 = 15.0, "s", WAIT;
        /// While there is more than this left to turn the robot looks far ahead, to see walls; then it looks at the ground near by, on
        /// which it steps next.
        look_near: f64 = 1.0, "rad", ANGLE;
        /// A turn of more than this, nearly half a circle, keeps the side to which it turns.
        keeps_side: f64 = 2.4, "rad", ANGLE;
        /// Turning speed, on the spot and on the way, for each radian that is left to turn.
        gain: f64 = 1.5, "1/s", POSITIVE;
        /// The robot turns no slower than this on the spot, so that no turn creeps to its end.
        slowest: f64 = 0.1, "rad/s", POSITIVE;
    }
}

settings! {
    /// How the robot finds out where it is once it does not know.
    pub struct LocateTuning("navigation.walking.tuning.locate") {
        /// The head sways so far to each side of straight ahead: walls tell more than the floor before the feet.
        sway: f64 = 0.6, "rad", ANGLE;
        /// The head sways to and fro once in this time.
        sway_period: f64 = 4.0, "s", POSITIVE;
        /// A robot that loses its place again within this time does not begin with a look around.
        look_holds: f64 = 30.0, "s", NOT_NEGATIVE;
        /// After turning so far on the spot the robot goes in small circles, which then tell more.
        turned: f64 = 4.0, "rad", NOT_NEGATIVE;
        /// Share of the turning speed with which it goes in circles.
        circle_share: f64 = 0.6, "1", within(0.0, 1.0);
        /// The robot has found itself elsewhere when the odometry frame has moved further than this in the map.
        elsewhere: f64 = 0.2, "m", NOT_NEGATIVE;
        /// Floor is needed at these distances ahead to go in circles.
        ahead: [f64; 3] = [0.15, 0.25, 0.35], "m", NOT_NEGATIVE;
        /// Floor is needed so far to the left at each distance ahead.
        aside: [f64; 3] = [-0.12, 0.0, 0.12], "m", within(-10.0, 10.0);
    }
}

settings! {
    /// What is tried where nothing is seen: a step back, and a turn.
    pub struct BlindTuning("navigation.walking.tuning.blind") {
        /// The robot steps back by so much of the way that it came.
        back: f64 = 0.2, "m", POSITIVE;
        /// A picture of which no more than this share was measured is dark: it is filled by what is too near, or the light is out.
        dark_share: f64 = 0.02, "1", within(0.0, 1.0);
        /// A robot that walks stops when its pictures have been dark for longer than this.
        dark_after: f64 = 0.3, "s" of camera, WAIT;
        /// It has come back so near to the place.
        reached: f64 = 0.04, "m", POSITIVE;
        /// Where the map has no room for a turn about, the outermost of the robot moves by this: a hand's breadth.
        hand: f64 = 0.08, "m", POSITIVE;
    }
}

settings! {
    /// What the robot does once a foot has met something that was not seen.
    pub struct TouchTuning("navigation.walking.tuning.touch") {
        /// The robot steps back until its middle is so far from it: it can turn there without touching it again.
        away: f64 = 0.24, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// Unknown ground ahead on the path, which is looked at before it is walked on.
    pub struct UnknownGroundTuning("navigation.walking.tuning.unknown") {
        /// A place that is still unknown after it was looked at counts as looked at within this distance.
        looked_radius: f64 = 0.12, "m", NOT_NEGATIVE;
        /// So many places that were looked at are remembered.
        looked_places: usize = 32, "1", within(1.0, 10000.0);
        /// The ground at a place of the path is unknown when it is so at this many of three places across: under both feet and between
        /// them.
        across: usize = 2, "1", within(1.0, 3.0);
    }
}

settings! {
    /// Obstacles that appear on the way, and those that are only the edge of a stair.
    pub struct WayObstaclesTuning("navigation.walking.tuning.obstacles") {
        /// An obstacle may be the edge of a stair when it is no higher above it than this.
        riser: f64 = 0.06, "m", NOT_NEGATIVE;
        /// An obstacle is the edge of a stair when it is no further from it than this.
        beside: f64 = 0.06, "m", NOT_NEGATIVE;
        /// So many cells of obstacles at a place of the path, or where the feet shall go, stand in the way.
        cells: usize = 2, "1", at_least(1.0);
    }
}

impl WayObstaclesTuning {
    /// By how much at most an obstacle that is the edge of a stair is higher than the stair, and how far from its edge, m.
    pub(crate) const fn edges(&self) -> (f64, f64) {
        (self.riser, self.beside)
    }
}

settings! {
    /// The watch over headway on the way to the goal.
    pub struct ProgressTuning("navigation.walking.tuning.progress") {
        /// What is left of the way must become shorter by this to count as headway.
        headway: f64 = 0.05, "m", POSITIVE;
        /// A way that was planned anew is a detour, which is waited for anew, when it is longer than the best so far by so many times
        /// that headway.
        detour: f64 = 2.0, "1", NOT_NEGATIVE;
        /// After so many times the patience without headway the robot gives up, detours or not.
        longest_detour: f64 = 12.0, "1", above_to(0.0, 1000.0);
    }
}

settings! {
    /// The walk sideways through what is too narrow to be walked straight ahead.
    pub struct SidleTuning("navigation.walking.tuning.sidle") {
        /// A leg sideways is over when less than this is left of it.
        done: f64 = 0.02, "m", NOT_NEGATIVE;
        /// A leg sideways begins when the robot is this near to where it has to turn.
        there: f64 = 0.03, "m", NOT_NEGATIVE;
        /// A turn on the spot, before the side steps, ends when the heading is no further off than this.
        turned: f64 = 0.06, "rad", ANGLE;
        /// The robot turns on the spot again when its heading is further off than this.
        astray: f64 = 0.2, "rad", ANGLE;
        /// A robot that is further beside the leg than this goes on along it only once it is back.
        beside: f64 = 0.03, "m", POSITIVE;
    }
}

settings! {
    /// When the robot has arrived.
    pub struct ArrivalTuning("navigation.walking.tuning.arrival") {
        /// A path is done when less than this is left of it.
        path_end: f64 = 0.04, "m", NOT_NEGATIVE;
        /// A via point is passed no deeper inside its disc than this share of the disc's radius, however large the margin is.
        via_share: f64 = 0.5, "1", within(0.0, 1.0);
    }
}
