//! The finer settings of the localizer `monte_carlo`.

use settings::{
    NOT_NEGATIVE, POSITIVE, SHARE, above, above_to, at_least, between, settings, within,
};

/// Most heaviest cells from which a mean may begin: room for them in an array.
pub(super) const MOST_SEEDS: usize = 16;
/// Most directions that may be told apart: room for them in an array.
pub(super) const MOST_DIRECTIONS: usize = 36;

settings! {
    /// The finer settings of the localizer `monte_carlo`.
    pub struct MonteCarloTuning("navigation.monte_carlo.tuning") {
        /// How the ground is found in a frame.
        ground: GroundPointsTuning;
        /// How likely a torso's height over the map's ground is.
        height: HeightTuning;
        /// How likelihoods are flattened.
        weights: WeightsTuning;
        /// How well a place explains a frame.
        fit: FrameFitTuning;
        /// Which beams end on what is not mapped.
        unmapped: UnmappedTuning;
        /// When frames stop to fit.
        doubt: DoubtTuning;
        /// What the particles say together.
        belief: BeliefTuning;
        /// How the robot is looked for elsewhere.
        search: SearchTuning;
        /// A camera without a robot.
        camera: CameraTuning;
    }
}

settings! {
    /// How the ground is found in a frame.
    pub struct GroundPointsTuning("navigation.monte_carlo.tuning.ground") {
        /// Columns of the grid on which the picture is read, at most: a hundred beams need no more.
        columns: usize = 80, "1", within(4.0, 10_000.0);
        /// Share of the picture's width, to each side of a pixel, over which its normal is taken.
        normal_share: f64 = 0.025, "1", within(0.0, 0.5);
        /// Pixels to each side over which a normal is taken at least.
        least_window: usize = 2, "px", within(1.0, 100.0);
        /// Neighbours that differ more in depth than this, per metre of depth, lie on two surfaces.
        jump: f64 = 0.2, "1", POSITIVE;
        /// Cosine of the largest angle from the vertical, 30 degrees, at which a normal counts for the ground.
        upright: f64 = 0.866, "1", between(0.0, 1.0);
        /// Points that may be ground below which a frame shows none.
        least_candidates: usize = 30, "1", at_least(3.0);
        /// Share of the points that may be ground which a plane of the ground holds at least.
        dominant: f64 = 0.2, "1", SHARE;
        /// Share of the tolerance within which a point lies on a plane though its neighbourhood is not level.
        near: f64 = 0.5, "1", NOT_NEGATIVE;
        /// Of so many points that may be ground one is asked whether it lies on a plane that is tried.
        stride: usize = 4, "1", at_least(1.0);
        /// Planes that are looked for: the ground before a stair, and its treads.
        planes: usize = 3, "1", within(1.0, 100.0);
    }
}

settings! {
    /// How likely a torso's height over the map's ground is.
    pub struct HeightTuning("navigation.monte_carlo.tuning.height") {
        /// Ground is looked for below a torso down to so many times its height.
        reach: f64 = 1.5, "1", above(1.0);
        /// Share of heights that have nothing to do with the map's ground: beside an edge, on what is not in it.
        any: f64 = 0.05, "1", between(0.0, 1.0);
        /// Density of such heights, as a share of that of the right height.
        any_density: f64 = 1e-2, "1", POSITIVE;
    }
}

settings! {
    /// How likelihoods are flattened until enough particles are left to speak of.
    pub struct WeightsTuning("navigation.monte_carlo.tuning.weights") {
        /// An exponent is halved so often at most until enough particles are left.
        halvings: usize = 40, "1", within(1.0, 1000.0);
        /// The exponent is then refined so often between the one that was found and twice of it.
        refinements: usize = 3, "1", within(0.0, 60.0);
    }
}

settings! {
    /// How well a place explains a frame.
    pub struct FrameFitTuning("navigation.monte_carlo.tuning.fit") {
        /// A range fits within so many standard deviations.
        sigmas: f64 = 3.0, "1", POSITIVE;
        /// What ends before the map's surface counts so much against a pose as what ends behind it.
        before_counts: f64 = 0.03, "1", POSITIVE;
        /// Fewer beams off the ground than this do not tell whether a frame fits.
        least_beams: f64 = 10.0, "1", POSITIVE;
    }
}

settings! {
    /// Which beams end on what is not mapped, and are left out of the likelihood.
    pub struct UnmappedTuning("navigation.monte_carlo.tuning.unmapped") {
        /// Beams that end nearer to each other than this end on one thing.
        thing: f64 = 0.15, "m", POSITIVE;
        /// A thing is not mapped where more than this share of the beams that end on it ends clearly before the map's surface.
        share: f64 = 0.25, "1", SHARE;
    }
}

settings! {
    /// When frames stop to fit.
    pub struct DoubtTuning("navigation.monte_carlo.tuning.doubt") {
        /// Share of its rate with which the slow mean goes on while frames do not fit: what is normal is not to be learned from what is not.
        while_lost: f64 = 0.1, "1", SHARE;
    }
}

settings! {
    /// What the particles say together.
    pub struct BeliefTuning("navigation.monte_carlo.tuning.belief") {
        /// Heaviest cells from which the mean begins: a cluster may lie across the borders of several.
        seeds: usize = 4, "1", within(1.0, MOST_SEEDS as f64);
        /// Side of those cells, as a share of the size of a cluster.
        seed_cell: f64 = 0.5, "1", POSITIVE;
        /// Steps of the mean's way to the middle of its cluster.
        shifts: usize = 4, "1", within(1.0, 1000.0);
    }
}

settings! {
    /// How the robot is looked for elsewhere.
    pub struct SearchTuning("navigation.monte_carlo.tuning.search") {
        /// Directions around the robot that are told apart: each counts the same, however long it was looked at.
        directions: usize = 12, "1", within(1.0, MOST_DIRECTIONS as f64);
        /// Directions in which another place has to be better before the robot stops to look.
        contest: usize = 4, "1", at_least(1.0);
        /// Share of a frame that is news to a search at least, since no two frames err quite alike.
        least_news: f64 = 0.1, "1", above_to(0.0, 1.0);
        /// Frames, half a minute of them, after which a search beside a place that fits ends.
        frames: u32 = 200, "frames", at_least(1.0);
        /// One in so many of the guesses that are drawn anywhere is drawn at the place that is believed.
        believed: usize = 10, "1", at_least(1.0);
    }
}

settings! {
    /// A depth camera that is carried, without a robot that feels its attitude and height.
    pub struct CameraTuning("navigation.monte_carlo.tuning.camera") {
        /// Time from picture to picture, by which errors of its odometry grow beside way and turn.
        period: f64 = 0.1, "s" of camera, POSITIVE;
        /// Room that there has to be above the floor where a camera is looked for.
        room: f64 = 0.5, "m", POSITIVE;
        /// Cosine of the largest angle, 60 degrees, between the camera's own upward axis and the vertical at which it finds the floor.
        upright: f64 = 0.5, "1", between(0.0, 1.0);
        /// Points of a picture, at most, in which the floor is looked for.
        points: usize = 2000, "1", at_least(3.0);
        /// Planes through three points that are tried.
        samples: usize = 400, "1", at_least(1.0);
        /// Share of the points that lie on the floor at least.
        on_floor: f64 = 0.1, "1", SHARE;
        /// Share of the points that lie below the floor at most.
        below_floor: f64 = 0.05, "1", SHARE;
    }
}
