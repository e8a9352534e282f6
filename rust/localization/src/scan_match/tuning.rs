//! The finer settings of the localizer `scan_match`: what beams, surfaces and a match are.

use settings::{POSITIVE, SHARE, above, at_least, settings, within};

settings! {
    /// The finer settings of the localizer `scan_match`.
    pub struct MatchingLocalizerTuning("navigation.scan_match.tuning") {
        /// How beams are read from a frame.
        profile: ProfileTuning;
        /// How a keyframe keeps the surfaces that were seen.
        surfaces: SurfacesTuning;
        /// How a frame is laid on a keyframe's surfaces.
        alignment: AlignmentTuning;
    }
}

settings! {
    /// How beams, directions in which something stands out of the floor, are read from a frame.
    pub struct ProfileTuning("navigation.scan_match.tuning.profile") {
        /// Points lower than this above the robot's ground are left out: they are the ground's own edge.
        lowest: f64 = 0.02, "m", POSITIVE;
        /// What is nearer than this to the point below the camera is left out: it is the robot itself.
        nearest: f64 = 0.1, "m", POSITIVE;
        /// Points of one surface differ in distance by less than this near by.
        depth: f64 = 0.02, "m", POSITIVE;
        /// Far away, points of one surface differ in distance by less than so many standard deviations of it.
        depth_sigmas: f64 = 4.0, "1", POSITIVE;
        /// Pixels of a column that share one error: the height of the stereo matching window.
        window: f64 = 5.0, "px", POSITIVE;
        /// Standard deviation that is left of a beam's distance, however many points are averaged.
        least_noise: f64 = 0.004, "m", POSITIVE;
        /// Standard deviation of the place across a beam, as a share of the beam's width there.
        across: f64 = 0.3, "1", POSITIVE;
        /// Standard deviation that the place across a beam has at least.
        least_across: f64 = 0.003, "m", POSITIVE;
    }
}

settings! {
    /// How a keyframe keeps the surfaces that were seen: the normal distributions transform, read off between the cells.
    pub struct SurfacesTuning("navigation.scan_match.tuning.surfaces") {
        /// Cells along each side of a keyframe's window; what was seen outside is forgotten.
        cells: usize = 64, "1", within(4.0, 1000.0);
        /// Places further away than so many cells say nothing about a place.
        near: f64 = 2.2, "1", POSITIVE;
        /// Weight of the points around a place, that of one at the place itself being 1, below which no surface is known there.
        least_weight: f64 = 0.3, "1", POSITIVE;
        /// Cells around a place in which something must have been seen.
        least_cells: usize = 2, "1", at_least(1.0);
        /// A surface's variance along it is more than so many times that across it.
        slender: f64 = 4.0, "1", above(1.0);
        /// Standard deviation along a surface that it must have, as a share of a cell.
        least_length: f64 = 0.3, "1", POSITIVE;
    }
}

settings! {
    /// How a frame is laid on a keyframe's surfaces: Gauss-Newton for the heading and a small shift.
    pub struct AlignmentTuning("navigation.scan_match.tuning.alignment") {
        /// Steps after which the search ends.
        iterations: usize = 6, "1", within(1.0, 1000.0);
        /// A step that moves by less than this, m, and turns by less than this, rad, ends the search.
        small_step: f64 = 1e-5, "m, rad" of numerics, POSITIVE;
        /// Distances of so many standard deviations begin to count less.
        robust_sigmas: f64 = 3.0, "1", POSITIVE;
        /// Share of the beams that err independently: a stereo matching window sees three of them.
        independent: f64 = 1.0 / 3.0, "1", SHARE;
        /// Variance that any surface has at least: none is smoother.
        roughness: f64 = 4e-6, "m^2" of world, POSITIVE;
        /// A beam that counts less than this, by its distance from the surface, lies on none.
        least_trust: f64 = 0.3, "1", SHARE;
        /// A shift beyond so many of its standard deviations is none of odometry's: what was seen has moved.
        far_sigmas: f64 = 3.0, "1", POSITIVE;
        /// Standard deviation of the heading, before a frame is looked at, that is believed at least.
        least_guess: f64 = 0.005, "rad", POSITIVE;
    }
}
