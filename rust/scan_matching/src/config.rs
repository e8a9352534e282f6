//! Settings: how scans are matched, what a local map is, which loops are closed, and how the graph of poses is solved.

use settings::{POSITIVE, SHARE, at_least, between, settings, within};

settings! {
    /// How a scan is matched to a local map: a search over cells, then least squares on the smooth field.
    pub struct ScanMatchConfig("plan_view.scan_matcher") {
        /// Side of a cell of the likelihood field.
        cell: f64 = 0.05, "m", within(0.001, 10.0);
        /// Standard deviation by which the likelihood falls off what was seen.
        spread: f64 = 0.06, "m", POSITIVE;
        /// What is seen side by side is one surface where it is no further apart.
        join: f64 = 0.25, "m", at_least(0.0);
        /// Ends of beams that are nearer to the one before are left out.
        thin: f64 = 0.03, "m", at_least(0.0);
        /// Longer ranges are left out.
        max_range: f64 = 25.0, "m", POSITIVE;
        /// Standard deviation of points off the surface that they are of.
        sigma: f64 = 0.03, "m", POSITIVE;
        /// Points of a scan that tell as much as one alone: what is seen side by side errs together.
        together: f64 = 8.0, "1", at_least(1.0);
        /// Of a direction in which a scan tells a smaller share of what it tells of its best one, it tells nothing: noise makes a plain wall uneven.
        plain: f64 = 0.02, "1", SHARE;
        /// The search goes so many standard deviations of the pose that odometry gives to each side.
        window: f64 = 3.0, "1", at_least(0.0);
        /// Mean likelihood of a scan's points below which it is searched further: odometry may be worse than it is said to be.
        sure_score: f64 = 0.65, "1", SHARE;
        /// It is searched further as well where it fits best so near to the rim of what was searched, as a share of the way there.
        rim: f64 = 0.7, "1", SHARE;
        /// So many times as far.
        wider: f64 = 3.0, "1", at_least(1.0);
        /// What is found there must be so much likelier.
        better: f64 = 0.05, "1", SHARE;
        /// Mean likelihood of a scan's points below which odometry is believed instead.
        least_score: f64 = 0.3, "1", SHARE;
        /// Most steps of least squares.
        steps: usize = 20, "1", at_least(1.0);
        /// They end where a step is shorter.
        least_step: f64 = 1e-5, "m, rad", POSITIVE;
    }
}

settings! {
    /// Local maps, one after the other along the way, each of the scans of a stretch.
    pub struct LocalMapsConfig("plan_view.local_maps") {
        /// Scans of a local map; the next one begins at half of them.
        scans: usize = 30, "1", at_least(2.0);
        /// Standard deviation of a step of odometry along each axis: of itself, and for each metre of way.
        place_noise: [f64; 2] = [0.01, 0.1], "m, m/m", at_least(0.0);
        /// Standard deviation of its turn: of itself, and for each radian of turn.
        heading_noise: [f64; 2] = [0.035, 0.1], "rad, rad/rad", at_least(0.0);
        /// Most local maps: the equations between them grow with the square, their solution with the cube.
        most: usize = 1500, "1", at_least(2.0);
    }
}

settings! {
    /// Which loops are closed between a scan and an older local map.
    pub struct LoopsConfig("plan_view.loops") {
        /// Whether any are.
        close: bool = true, "-", settings::ANY;
        /// One is looked for where the robot went or turned so far since it last was.
        apart: [f64; 2] = [0.3, 0.5], "m, rad", at_least(0.0);
        /// Local maps that a scan is matched to, those that it fits best from where it is believed to be.
        candidates: usize = 3, "1", at_least(1.0);
        /// The search goes so many standard deviations of the way between the two to each side.
        within: f64 = 3.5, "1", at_least(0.0);
        /// It goes no less far, and no further: along each axis.
        reach: [f64; 2] = [0.15, 4.0], "m, m", POSITIVE;
        /// It turns no less far, and no further.
        turn: [f64; 2] = [0.04, 0.7], "rad, rad", POSITIVE;
        /// Mean likelihood of the scan's points in the local map from which on it is a loop.
        least_score: f64 = 0.6, "1", SHARE;
        /// Another scan must say the same of the local map, so near.
        agree: [f64; 2] = [0.1, 0.03], "m, rad", POSITIVE;
        /// It must have been taken no more scans before.
        agree_within: usize = 60, "1", at_least(1.0);
    }
    require (reach[0]) <= (reach[1]);
    require (turn[0]) <= (turn[1]);
}

settings! {
    /// The graph of local maps and scans, solved by least squares.
    pub struct PoseGraphConfig("plan_view.pose_graph") {
        /// Most iterations at a time.
        iterations: usize = 20, "1", at_least(1.0);
        /// They end where the sum of squares falls by a smaller share.
        least_gain: f64 = 1e-5, "1", between(0.0, 1.0);
        /// Standard deviations off at which a loop counts half, and further off ever less.
        far: f64 = 3.0, "1", POSITIVE;
    }
}
