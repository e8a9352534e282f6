//! Parameters of the map of samples, checked once.

use settings::{NOT_NEGATIVE, POSITIVE, at_least, settings, within};

settings! {
    /// What the map of samples in a sparse grid (004, section 36.3.2) has beside `[navigation.elevation]`, which it reads, too; of that `cells`,
    /// `pyramid` and `fill` are not used.
    pub struct PointsConfig("navigation.points") {
        /// Room between two things above each other with which both are kept. Left out: the robot's own height.
        headroom: Option<f64> = None, "m", within(0.01, 100.0);
        /// SurfaceSamples become one where each lies no further than this from the surface of all; 0: each cell keeps its own.
        flat: f64 = 0.004, "m", NOT_NEGATIVE, "004, section 36.3.2 (ref. 36.22): resolution that adapts";
        /// What is further away from the robot than this is forgotten.
        kept: f64 = 20.0, "m", within(0.1, 1e6);
        /// Numbers that few will want to turn.
        tuning: PointsTuning;
    }
}

settings! {
    /// Numbers behind the map of samples.
    pub struct PointsTuning("navigation.points.tuning") {
        /// SurfaceSamples of fewer points are not shown: single ones are mismatches.
        least_points: u32 = 3, "1", at_least(1.0);
        /// Surfaces that rise by more than this along their normal's lean, its height for a length of 1, are walls: less is ground.
        upright: f64 = 0.5, "1", within(0.05, 0.95);
        /// Levels that lie this near above each other, in rises of `[navigation.elevation]`, are one way for the robot.
        joined: f64 = 1.0, "1", POSITIVE;
        /// Lines of sight that end further behind a sample than so many standard deviations of both took it back.
        behind: f64 = 4.0, "1", at_least(1.0);
        /// Cells beside a column, on either side, whose samples count for how scattered things are there.
        around: usize = 1, "1", within(0.0, 10.0);
    }
}
