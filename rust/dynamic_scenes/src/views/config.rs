//! Settings of views.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, above_to, at_least, from_below, settings};

settings! {
    /// When a point is seen through: an earlier or later look went on behind it.
    pub struct ViewsConfig("navigation.moving.views") {
        /// Looks are kept that are this far apart.
        spacing: f64 = 0.4, "s" of world, POSITIVE;
        /// Looks are kept so long; what has come and stayed is part of the world after that.
        memory: f64 = 12.0, "s" of world, POSITIVE;
        /// A look saw through a point if it went on for more than this behind it.
        margin: f64 = 0.1, "m", POSITIVE;
        /// A look saw through a point if its inverse range is less by more than this: what a stereo camera's error is.
        inverse_margin: f64 = 0.07, "1/m" of camera, NOT_NEGATIVE;
        /// A look saw something at a point if its range is as near to it as this share of the margins.
        same: f64 = 0.5, "1", above_to(0.0, 1.0);
        /// Directions up to this far beside may be taken for that of the point, for the errors of poses and at borders.
        beside: usize = 2, "pixels", at_least(0.0);
        /// A look saw through a point though this share of the directions beside may have seen something nearer: errors.
        stray: f64 = 0.1, "1", from_below(0.0, 1.0);
        /// Bearings of a sweep are told apart by this.
        bearing_step: f64 = 0.0175, "rad", POSITIVE;
        /// A point of which fewer directions beside its own saw something at its range is an error of the sensor: it is of nothing.
        company: usize = 2, "1", at_least(0.0);
        /// So many looks must have seen through a point.
        looks: u32 = 2, "1", at_least(1.0);
        /// They must be such a share of those that saw through it or saw it there.
        share: f64 = 0.5, "1", SHARE;
    }
}
