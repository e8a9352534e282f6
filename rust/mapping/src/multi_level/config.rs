//! Parameters of the multi-level surface map, checked once.

use settings::{POSITIVE, at_least, settings, within};

settings! {
    /// What the multi-level surface map of Triebel, Pfaff and Burgard 2006 has beside `[navigation.elevation]`, which it reads, too; of that
    /// `cells`, `pyramid`, `fill` and `clearing` are not used.
    pub struct MultiLevelConfig("navigation.multi_level") {
        /// Room between two things above each other with which both are kept. Left out: the robot's own height.
        headroom: Option<f64> = None, "m", within(0.01, 100.0), "004, ref. 36.16";
        /// Numbers that few will want to turn.
        tuning: MultiLevelTuning;
    }
}

settings! {
    /// Numbers behind the multi-level surface map.
    pub struct MultiLevelTuning("navigation.multi_level.tuning") {
        /// Levels that lie this near above each other, in rises of `[navigation.elevation]`, are one way for the robot.
        joined: f64 = 1.0, "1", POSITIVE;
        /// Lines of sight that end further behind a surface than so many standard deviations of both took it back.
        behind: f64 = 4.0, "1", at_least(1.0);
    }
}
