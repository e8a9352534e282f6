//! Settings of the edges between stairs: where two are one, which are fitted, and how the fits of many frames are joined.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, settings, within};

settings! {
    /// How the edges between stairs are joined and fitted.
    pub struct EdgesTuning("navigation.stairs.tuning.edges") {
        /// Where one stair ends and the next begins.
        joints: JointsTuning;
        /// Which edges are fitted, and which fits count.
        fits: FitsTuning;
        /// One edge from the fits of many frames.
        fusion: FusionTuning;
        /// Which changes of height are short slopes, and no steps.
        bevels: BevelMemoryTuning;
    }
}

settings! {
    /// How the frames together say that a change of height is a short slope, and no step.
    pub struct BevelMemoryTuning("navigation.stairs.tuning.edges.bevels") {
        /// It is a slope when the frames explain it so by more than this better than by a step, in squared noise.
        sure: f64 = 12.0, "1", NOT_NEGATIVE;
        /// What a frame that explains it better by a slope takes off that, in squared noise: a slope of any length is one more number
        /// that is free.
        price: f64 = 2.0, "1", NOT_NEGATIVE;
        /// Most that one frame says, in squared noise: frames from one place err alike.
        most_once: f64 = 3.0, "1", POSITIVE;
        /// What the frames said is kept up to this, in squared noise.
        most: f64 = 36.0, "1", POSITIVE;
        /// What its place and length weigh at most against those of one more frame, in squared noise: who walks on it needs them settled.
        settled: f64 = 500.0, "1", POSITIVE;
        /// Farthest that the middles of one slope in two frames lie apart.
        apart: f64 = 0.12, "m", POSITIVE;
        /// A sole that stands on it and rises a metre by so much less than it says that it is none.
        felt: f64 = 0.1, "1", POSITIVE;
        /// Changes of height that are kept.
        kept: usize = 8, "1", within(1.0, 1000.0);
    }
}

settings! {
    /// When the back of one stair and the front of another are one edge.
    pub struct JointsTuning("navigation.stairs.tuning.edges.joints") {
        /// Farthest that the back of a stair and the front of the next may lie apart to be one edge.
        apart: f64 = 0.04, "m", POSITIVE;
        /// Cosine of the largest angle between the back of a stair and the front of the next for them to be one edge.
        parallel: f64 = 0.966, "1", SHARE;
        /// Share of a stair's width that another must have to begin on it and end it.
        wide: f64 = 0.6, "1", NOT_NEGATIVE;
        /// How deep a stair must be before another may begin on it and end it.
        least_depth: f64 = 0.05, "m", NOT_NEGATIVE;
        /// Points by which back and front each count as seen besides those that saw it, so that one edge comes of two that nothing
        /// saw end.
        unseen: f64 = 1.0, "1", POSITIVE;
    }
}

settings! {
    /// Which edges are fitted to the disparities of a frame, and which fits take the place of what the labels say.
    pub struct FitsTuning("navigation.stairs.tuning.edges.fits") {
        /// Edges that are fitted in a frame: those in view that the robot, going straight on, would cross first.
        fitted: usize = 2, "1", NOT_NEGATIVE;
        /// Cosine at which an edge along the robot's way counts as one that it meets: the sides of a staircase lie near all the
        /// way up, and are not climbed.
        glancing: f64 = 0.1, "1", POSITIVE;
        /// Fitted edges that are kept.
        kept: usize = 16, "1", within(1.0, 1000.0);
        /// How far the levels of an edge may differ from those that it was fitted with: less than half of the lowest step, since
        /// an edge that was fitted from afar between levels that turn out to be others lies elsewhere.
        same_level: f64 = 0.007, "m", POSITIVE;
        /// Standard deviation of the place of an edge between two regions of labels; only fits that are surer count.
        sure_place: f64 = 0.006, "m", POSITIVE;
        /// An edge that was as sure as that is listed among the known ones while its place is known to this, as the robot steps on: a cell of 4 cm tells
        /// it no better.
        lasting_place: f64 = 0.0115, "m", POSITIVE;
        /// Standard deviation of the heading of an edge between two regions of labels; only fits that are surer count.
        sure_heading: f64 = 0.06, "rad", POSITIVE;
        /// How far to either side of where it is crossed an edge is fitted whose middle is out of view.
        ahead: f64 = 0.15, "m", POSITIVE;
        /// Largest change of height at an edge that is fitted.
        largest_rise: f64 = 0.1, "m", POSITIVE;
    }
}

settings! {
    /// How the fits of one edge in many frames are joined: frames from one place in one direction err alike, and only motion of
    /// the head averages that.
    pub struct FusionTuning("navigation.stairs.tuning.edges.fusion") {
        /// Looks from other places or in other directions that are kept of each edge.
        looks: usize = 12, "1", within(1.0, 1000.0);
        /// Share of a frame's variance that all frames of a look have in common.
        fixed: f64 = 0.8, "1", SHARE;
        /// Cosine of the turn of the camera from which on a look is another: two pixels.
        other_direction: f64 = 0.9998, "1", SHARE;
        /// Shift of the camera from which on a look is another.
        other_place: f64 = 0.01, "m", NOT_NEGATIVE;
        /// Standard deviation that a step of the robot adds to the place of what was seen before it.
        step_place: f64 = 0.0015, "m", NOT_NEGATIVE;
        /// Standard deviation that a step of the robot adds to the heading of what was seen before it.
        step_heading: f64 = 0.004, "rad", NOT_NEGATIVE;
        /// Standard deviation of the place that all looks have in common, and no motion of the head averages.
        common_place: f64 = 0.0015, "m", NOT_NEGATIVE;
        /// Standard deviation of the heading that all looks have in common, and no motion of the head averages.
        common_heading: f64 = 0.01, "rad", NOT_NEGATIVE;
        /// Residual of a look, in standard deviations, from which on it counts less.
        robust: f64 = 1.5, "1", POSITIVE;
        /// Rounds in which the looks are weighed by their residuals.
        rounds: usize = 4, "1", within(1.0, 100.0);
    }
}
