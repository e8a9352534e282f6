//! Settings of what one frame shows: lines, places, the view, and the stairs that are made of level surfaces.

use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, SHARE, at_least, require, settings, within};

settings! {
    /// How straight lines are laid through segments, through points of which some lie anywhere, and along the sides of a hull.
    pub struct LinesTuning("navigation.stairs.tuning.lines") {
        /// Cosine of the largest angle between a line and the mean of its segments, and between a long piece of a hull and its side;
        /// beyond, the segments lie beside each other and the line has their mean direction.
        agreement: f64 = 0.9, "1", SHARE;
        /// Least number of points through which a line is laid.
        fewest_points: usize = 6, "1", at_least(1.0);
        /// Rounds in which a line is fitted to the points near it.
        rounds: usize = 4, "1", at_least(1.0);
        /// Columns of the picture from a point to the next within which the two count as neighbours.
        missing_columns: usize = 4, "1", at_least(1.0);
        /// Share of a side's or an edge's length that the pieces between neighbouring points must span.
        spanned: f64 = 0.5, "1", SHARE;
        /// Pieces of a hull that are longer must point along the side to which they belong.
        long_piece: f64 = 0.025, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// The places of a stair at which picture and map are asked: a square pattern between its edges.
    pub struct PlacesTuning("navigation.stairs.tuning.places") {
        /// Places from front to back, and as many from right to left.
        each_way: usize = 5, "1", within(1.0, 100.0);
        /// Where the first place lies, as a share of the way from edge to edge.
        first: f64 = 0.1, "1", SHARE;
        /// How far each place lies from the one before, as a share of the way from edge to edge.
        apart: f64 = 0.2, "1", SHARE;
    }
    check PlacesTuning::are_inside;
}

impl PlacesTuning {
    fn are_inside(&self, key: &str) -> Result<(), ConfigError> {
        let last = self.first + self.apart * (self.each_way as f64 - 1.0);
        require(
            last <= 1.0,
            &format!("{key}.each_way"),
            "so few that the last place is within the stair",
            self.each_way,
        )
    }
}

settings! {
    /// How the picture is asked what it shows where a surface lies or ends.
    pub struct ViewTuning("navigation.stairs.tuning.view") {
        /// How far beyond a side the picture is asked whether the surface goes on: half a matching window and one pixel more, and
        /// farther where a riser lies between.
        beyond: [f64; 3] = [3.5, 6.0, 8.5], "px", POSITIVE;
        /// A point belongs to a surface when their heights differ by less than this.
        same_height: f64 = 0.008, "m", POSITIVE;
        /// Noise of a single point's height at a distance of 1 m, which grows with the squared distance; it is added to the
        /// allowed difference where a point lies on no level surface.
        height_noise: f64 = 0.025, "1/m" of camera, NOT_NEGATIVE;
        /// Least width of the fringes of a boundary.
        fringe: f64 = 0.008, "m", POSITIVE;
        /// Places along a side at which the picture is asked.
        places: usize = 7, "1", within(1.0, 1000.0);
        /// Least height of the camera above a surface that is looked at.
        least_below: f64 = 0.05, "m", POSITIVE;
        /// Places whose depth is no greater are not in the picture.
        nearest_depth: f64 = 0.05, "m", POSITIVE;
        /// How far from a side a place is taken that tells which way is outward in the picture.
        outward: f64 = 0.01, "m", POSITIVE;
    }
}

settings! {
    /// How the stairs of one frame are made of its level surfaces.
    pub struct FrameTuning("navigation.stairs.tuning.frame") {
        /// Cosine of the angle between front and back beyond which the back is doubted, and laid parallel to the front.
        opposite: f64 = 0.9, "1", SHARE;
        /// Cosine of the angle between a front and the way to the surface beyond which it is a side, and the surface no stair.
        faces: f64 = 0.5, "1", SHARE;
        /// Share of the longest edge to a neighbour from which on another one counts.
        long_enough: f64 = 0.5, "1", SHARE;
        /// How far a surface may seem to reach into one that it lies before.
        overlap: f64 = 0.05, "m", NOT_NEGATIVE;
        /// Surfaces whose middle lies nearer to the robot's origin have no front, as no way leads to them.
        nearest: f64 = 0.001, "m", POSITIVE;
        /// How many fringes a point may lie off the side of a hull and still belong to it.
        side_window: f64 = 3.0, "1", POSITIVE;
        /// Share of the places beyond a side that must show that the surface ends there.
        side_ends: f64 = 0.5, "1", SHARE;
        /// Share of `min_depth` that a surface must be deep to lie between the robot and its own level, and that a side must be deep;
        /// where the picture cuts a surface to a corner, that is no side.
        side_depth: f64 = 0.5, "1", NOT_NEGATIVE;
        /// Share of a stair's places that must show the surface, of those that show anything.
        solid: f64 = 0.6, "1", SHARE;
        /// An edge that was seen from one of its sides only counts as this part of the points: fringes move it by centimetres.
        one_sided: usize = 8, "1", at_least(1.0);
        /// How far the camera's tilt may be off in a frame that does not show the ground: from afar the ground itself then seems to lie
        /// higher or lower.
        tilt: f64 = 0.012, "rad", NOT_NEGATIVE;
        /// Edges between two surfaces, seen from both.
        shared_edges: SharedEdgesTuning;
    }
}

settings! {
    /// How edges between two surfaces are found, column by column of the labels.
    pub struct SharedEdgesTuning("navigation.stairs.tuning.frame.shared_edges") {
        /// Pixels that a surface must have in a column in one piece to count there.
        least_run: u16 = 3, "px", at_least(1.0);
        /// Pixels between two surfaces up to which one ends where the other begins: what a riser takes from near.
        largest_gap: u16 = 14, "px", NOT_NEGATIVE;
        /// Least length of an edge that the columns span.
        least_length: f64 = 0.05, "m", NOT_NEGATIVE;
    }
}
