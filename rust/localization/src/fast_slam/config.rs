//! Settings of the localizer `fast_slam`.

use settings::{POSITIVE, at_least, settings, within};

settings! {
    /// The localizer `fast_slam`: leg odometry, and rocks and poles that are mapped on the way (004, section 36.2.4).
    pub struct FastSlamLocalizerConfig("navigation.fast_slam") {
        /// How many guesses of the robot's way there are, each with a map of its own.
        particles: usize = 30, "1", within(1.0, 1000.0), "36.8";
        /// Seed of all that is drawn.
        seed: u64 = 0, "1", within(0.0, 9_007_199_254_740_992.0);
        /// Standard deviation of where a landmark is seen, along the line of sight, from near by.
        range_noise: f64 = 0.05, "m", POSITIVE;
        /// Standard deviation of the direction in which it is seen.
        bearing_noise: f64 = 0.03, "rad", within(1e-6, 1.0);
        /// The camera may be turned about the upright by so much, standard deviation: found on the way.
        camera_yaw: f64 = 0.02, "rad", at_least(0.0);
        /// Nearest and furthest distance at which one is looked for.
        reach: [f64; 2] = [0.3, 2.0], "m", at_least(0.0);
        /// How far apart two looks at a landmark are of which each counts: the middle of what is not round errs alike from places near by.
        apart: [f64; 2] = [0.4, 0.4], "m, rad", at_least(0.0);
        /// Growth of the odometry's error along x and y: per square root of a metre, of a radian turned, and of a second.
        place_noise: [f64; 3] = [0.004, 0.002, 0.0002], "m/sqrt(m), m/sqrt(rad), m/sqrt(s)", at_least(0.0);
        /// Growth of the error of its heading, likewise.
        heading_noise: [f64; 3] = [0.003, 0.004, 0.0003], "rad/sqrt(m), rad/sqrt(rad), rad/sqrt(s)", at_least(0.0);
        /// Odometry's ways and turns are wrong by such shares, standard deviations: found on the way.
        scale_noise: [f64; 2] = [0.005, 0.005], "1, 1", at_least(0.0);
        /// Lowest thing that is a landmark, above the ground.
        lowest: f64 = 0.06, "m", POSITIVE;
        /// Narrowest and widest.
        width: [f64; 2] = [0.05, 0.5], "m", POSITIVE;
        /// How many pixels see it at least.
        points: usize = 20, "1", at_least(3.0);
    }
    require (reach[0]) < (reach[1]);
    require (width[0]) < (width[1]);
}
