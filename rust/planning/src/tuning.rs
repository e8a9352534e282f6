//! Numbers of the planner that decide something, but that few will want to turn: one table for each part of it.

use settings::{NOT_NEGATIVE, POSITIVE, at_least, settings, within};

settings! {
    /// Numbers of the planner that decide something, but that few will want to turn.
    pub struct PlanningTuning("navigation.a_star.tuning") {
        /// What belongs together of stairs, and what lies before and behind their edges.
        directed_stairs: DirectedStairsTuning;
        /// Where there is room at edges.
        room_at_edges: RoomAtEdgesTuning;
        /// How a climb begins.
        entries: EntriesTuning;
        /// How a climb goes on and ends.
        climbs: ClimbsTuning;
        /// Which passages are walked sideways.
        sideways_passages: SidewaysPassagesTuning;
        /// Where a route may end.
        ends: EndsTuning;
        /// Which routes are looked for.
        path_search: PathSearchTuning;
        /// Where the robot looks from.
        viewpoints: ViewpointsTuning;
        /// How a route becomes a path.
        legs: LegsTuning;
        /// When a path is followed no more.
        followed_path: FollowedPathTuning;
        /// Which of two paths is taken.
        choice: ChoiceTuning;
        /// What is remembered of the ground outside of the window.
        outside_window: OutsideWindowTuning;
        /// Which word a refusal has.
        refusal: RefusalTuning;
    }
}

settings! {
    /// What belongs together of stairs, and what lies before and behind their edges.
    pub struct DirectedStairsTuning("navigation.a_star.tuning.directed_stairs") {
        /// Edges that belong together differ by no more than this in heading: a turn of a spiral staircase is a few degrees.
        askew: f64 = 0.6, "rad", within(0.0, 1.5);
        /// A stair begins this near to where the one before it ends.
        joint: f64 = 0.06, "m", within(0.0, 1.0);
        /// A stair begins this near to where the one before it ends, where that end is only where the view ended.
        loose_joint: f64 = 0.1, "m", within(0.0, 1.0);
        /// Least depth of ground between two edges that are told apart.
        least_depth: f64 = 0.03, "m", within(0.0, 1.0);
        /// How deep the floor at the foot of an edge is taken to be, where nothing follows.
        ground_depth: f64 = 0.3, "m", within(0.0, 10.0);
        /// Depths behind an edge that is askew are stretched as if its cosine were at least this.
        least_cosine: f64 = 0.5, "1", within(0.01, 1.0);
        /// How far before or behind an edge the level there is read.
        away: [f64; 4] = [0.04, 0.08, 0.12, 0.16], "m", within(0.0, 1.0);
        /// How far to the left the level beside an edge is read at each of those distances.
        aside: [f64; 3] = [-0.04, 0.0, 0.04], "m", within(-1.0, 1.0);
        /// Of the places where a level is read, so many must be known.
        enough: usize = 3, "1", within(1.0, 12.0);
        /// Something stands behind an edge where it does in so large a part of the places, one in so many.
        walls: usize = 2, "1", at_least(1.0);
    }
}

settings! {
    /// Where there is room at edges.
    pub struct RoomAtEdgesTuning("navigation.a_star.tuning.room_at_edges") {
        /// How far from an edge the robot lines up, or walks on as it came, at most.
        run: f64 = 0.35, "m", within(0.0, 10.0);
        /// An edge that is no wider than this, beyond what the feet need, is crossed near its middle.
        narrow: f64 = 0.3, "m", within(0.0, 10.0);
        /// The share of the room beside its middle in which such a narrow edge is crossed.
        narrow_share: f64 = 0.5, "1", within(0.0, 1.0);
        /// So many of the last pieces of a way up to an edge lie so near to it that they may have either height.
        at_edge: f64 = 2.0, "1", NOT_NEGATIVE;
        /// What stands on a stair reaches higher than what may still be a riser by this.
        riser: f64 = 0.1, "m", within(0.0, 10.0);
    }
}

settings! {
    /// How a climb begins.
    pub struct EntriesTuning("navigation.a_star.tuning.entries") {
        /// From a tread the robot steps on without moving up to an edge first when it is within this.
        reach: f64 = 0.16, "m", within(0.0, 1.0);
        /// It turns no more than this on a tread.
        turn: f64 = 0.5, "rad", within(0.0, 3.2);
        /// The robot stands where it should by this.
        in_place: f64 = 0.015, "m", within(0.0, 1.0);
        /// The robot stands on a stair when its middle is no further than this outside of the stair's outline.
        outside: f64 = 0.02, "m", within(0.0, 1.0);
    }
}

settings! {
    /// How a climb goes on and ends.
    pub struct ClimbsTuning("navigation.a_star.tuning.climbs") {
        /// Heels come to stand this far beyond an edge where no limit says better.
        heel: f64 = 0.015, "m", within(-1.0, 1.0);
        /// The stair was looked at from where a way to it begins when the robot looked from this near to that.
        looked: f64 = 0.25, "m", within(0.0, 10.0);
        /// Nobody climbs more steps in one go.
        most_steps: usize = 32, "1", within(1.0, 1000.0);
        /// What lies behind the last stair is paid for with this, and by the height that is missing.
        hope: f64 = 0.3, "m", NOT_NEGATIVE;
        /// What is missing of a height, or is too high for a step, is paid for as so many steps of this height.
        rise: f64 = 0.03, "m", POSITIVE;
    }
}

settings! {
    /// Which passages are walked sideways.
    pub struct SidewaysPassagesTuning("navigation.a_star.tuning.sideways_passages") {
        /// Number of directions, evenly around, in which the robot walks sideways.
        directions: u32 = 16, "1", within(4.0, 360.0);
        /// From inside a passage it goes on by directions no further off than this from where its side points.
        aside: f64 = 0.3, "rad", within(0.0, 3.2);
        /// Passages are no longer than this.
        longest: f64 = 2.0, "m", within(0.0, 10.0);
        /// A passage begins in a cell with room for the circle that lies no more than so many cells further from an obstacle than it has to.
        entrance: f64 = 1.5, "1", NOT_NEGATIVE;
        /// After so many strides of half a cell the robot has left the cell where a passage begins.
        first_strides: u32 = 3, "1", within(1.0, 100.0);
        /// Cells with room for the circle that are no further apart than so many cells need no passage between them.
        apart: f64 = 2.0, "1", NOT_NEGATIVE;
    }
}

settings! {
    /// Where a route may end.
    pub struct EndsTuning("navigation.a_star.tuning.ends") {
        /// How much worse a place off the goal's middle is than walking there: above 1.09, so that the octile distance to the middle stays
        /// below the cost.
        pull: f64 = 2.0, "1", at_least(1.09);
        /// What is paid for a goal on another level that nothing known leads to.
        blind: f64 = 1.0, "m", NOT_NEGATIVE;
        /// What is missing of the height of such a goal is paid for as so many steps of this height.
        rise: f64 = 0.03, "m", POSITIVE;
    }
}

settings! {
    /// Which routes are looked for.
    pub struct PathSearchTuning("navigation.a_star.tuning.path_search") {
        /// A way to a goal in the window that costs more than so many times the straight one, and `far_more` on top, may be shorter around
        /// the window.
        far: f64 = 2.0, "1", NOT_NEGATIVE;
        /// What the straight way to a goal in the window is lengthened by before it is compared.
        far_more: f64 = 0.5, "m", NOT_NEGATIVE;
        /// A route over more unseen ground than this is but a guess.
        guess: f64 = 1.0, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// Where the robot looks from.
    pub struct ViewpointsTuning("navigation.a_star.tuning.viewpoints") {
        /// Unseen ground is worth a look when it is unseen so many cells around as well.
        patch: usize = 1, "1", within(0.0, 20.0);
        /// An edge is looked at from a place that is no more than so many cells away.
        edge: usize = 5, "1", within(0.0, 100.0);
        /// A place that was looked from shows what lies this near to it.
        seen: f64 = 0.35, "m", within(0.0, 10.0);
        /// The robot is where it wanted to look from when it is this near.
        there: f64 = 0.12, "m", within(0.0, 10.0);
        /// Frames that it looks for from one place.
        frames: u32 = 25, "1", within(1.0, 1.0e6);
        /// What a metre from there to the goal counts: unseen ground may cost so much more than what is seen.
        detour: f64 = 2.0, "1", NOT_NEGATIVE;
    }
}

settings! {
    /// How a route becomes a path.
    pub struct LegsTuning("navigation.a_star.tuning.legs") {
        /// A step begins where the one before it ended when it is no further away than this.
        same_place: f64 = 0.01, "m", within(0.0, 1.0);
        /// The straight way is taken where it costs no more than so many times what the cells cost that it replaces.
        straighter: f64 = 1.002, "1", at_least(1.0);
    }
}

settings! {
    /// When a path is followed no more.
    pub struct FollowedPathTuning("navigation.a_star.tuning.followed_path") {
        /// How far ahead on the path the robot is looked for: a path may come back to where it passed.
        progress: f64 = 0.6, "m", within(0.0, 100.0);
        /// A path that ends at the window's border is planned anew when less than this is left of it.
        horizon: f64 = 1.0, "m", within(0.0, 100.0);
        /// An edge that moved by more than this is another one.
        moved: f64 = 0.03, "m", within(0.0, 1.0);
        /// An edge that turned by more than this is another one.
        turned: f64 = 0.25, "rad", within(0.0, 3.2);
        /// The lane over stairs is chosen anew when another one saves so much by what stands beside it.
        roomier: f64 = 0.25, "m", NOT_NEGATIVE;
        /// A step is taken once the robot has made this share of its way.
        taken: f64 = 0.5, "1", within(0.0, 1.0);
    }
}

settings! {
    /// Which of two paths is taken.
    pub struct ChoiceTuning("navigation.a_star.tuning.choice") {
        /// Where a path leads at first is seen this far from the robot.
        setting_off: f64 = 0.25, "m", within(0.0, 10.0);
    }
}

settings! {
    /// What is remembered of the ground outside of the window.
    pub struct OutsideWindowTuning("navigation.a_star.tuning.outside_window") {
        /// How much longer a way is taken to be that leaves the window where there is no room: what was seen may be gone.
        shut: f64 = 10.0, "m", NOT_NEGATIVE;
        /// The way outside of the window is looked for anew after so many plans at most.
        plans: u32 = 8, "1", within(1.0, 1.0e6);
        /// From so near it is believed that something has gone: from afar parts of a wall are floor for a while.
        near: f64 = 1.2, "m", within(0.0, 10.0);
    }
}

settings! {
    /// Which word a refusal has.
    pub struct RefusalTuning("navigation.a_star.tuning.refusal") {
        /// Gaps narrower than this are cracks between obstacles as the map has them, no ways.
        crack: f64 = 0.1, "m", within(0.0, 10.0);
        /// A way down of more than this is a drop, no step.
        drop: f64 = 0.1, "m", within(0.0, 10.0);
    }
}
