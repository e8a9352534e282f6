//! Settings of landmarks: how well they are seen, and when a reading is one of them.

use core::f64::consts::PI;

use settings::{ANY, POSITIVE, SHARE, at_least, between, settings, within};

settings! {
    /// Landmarks that are seen by range and bearing.
    pub struct LandmarksConfig("landmarks.readings") {
        /// Standard deviation of a range.
        range_noise: f64 = 0.2, "m", POSITIVE;
        /// Standard deviation of a bearing.
        bearing_noise: f64 = 0.05, "rad", within(1e-6, PI);
        /// A reading is a landmark's where such a share of its readings lies no further off, or nearer.
        gate: f64 = 0.999, "1", between(0.0, 1.0);
        /// A reading begins a landmark where of every known one such a share of readings lies nearer: what is between the two is nobody's.
        new_beyond: f64 = 0.999_999, "1", between(0.0, 1.0);
        /// Whether readings say which landmark they are of. Else the likeliest is taken.
        named: bool = true, "-", ANY;
        /// Readings of a landmark are independent where the robot went so far, or turned by so much, between them; others are passed over.
        apart: [f64; 2] = [0.1, 0.1], "m, rad", at_least(0.0);
        /// Nearest and furthest range at which a landmark is seen.
        reach: [f64; 2] = [0.5, 6.0], "m", at_least(0.0);
        /// Half of the angle that is in view, to each side of straight ahead.
        view: f64 = 0.4, "rad", within(0.0, PI);
        /// Share of the looks at a landmark in view that see it.
        seen: f64 = 0.3, "1", between(0.0, 1.0);
        /// Share of the looks at a place without a landmark that see one there.
        imagined: f64 = 0.05, "1", between(0.0, 1.0);
        /// How sure a landmark becomes that it is there, and so how long one that is gone is remembered.
        sure: f64 = 0.99, "1", between(0.5, 1.0);
        /// A landmark that is there with no more than this probability is forgotten.
        forget: f64 = 0.2, "1", SHARE;
    }
    require (gate) < (new_beyond);
    require (reach[0]) < (reach[1]);
    require (imagined) < (seen);
}

impl LandmarksConfig {
    /// The squared Mahalanobis distance within which a share of two-dimensional errors lies (chi-squared with two degrees of freedom).
    pub fn squared_distance(share: f64) -> f64 {
        -2.0 * libm::log(1.0 - share)
    }
}
