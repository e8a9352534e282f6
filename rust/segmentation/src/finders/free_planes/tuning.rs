//! Settings of what the finders of planes in any direction share. Each has them in a table of its own.

use settings::{POSITIVE, between, settings, within};

settings! {
    /// Which of the planes that were found in any direction may be a floor.
    pub struct FreePlaneTuning("navigation.hough.tuning.free_planes") {
        /// A plane that is tilted by this or more is none to stand on: half of the slope of a staircase. What is tilted by less the
        /// ground's own checks decide.
        level: f64 = 0.14, "rad", between(0.0, 1.6);
    }
}

settings! {
    /// How planes are taken out of a picture one after the other, each guessed by triples of pixels.
    pub struct PeelingTuning("navigation.hough.tuning.peeling") {
        /// Rounds of least squares by which a guessed plane is refined.
        refinements: usize = 3, "1", within(0.0, 100.0);
        /// Triples of pixels whose triangle in the picture has less than half this area make no plane: they nearly lie on a line.
        /// It is twice an area in pixels.
        least_triangle: f64 = 8.0, "1", POSITIVE;
    }
}
