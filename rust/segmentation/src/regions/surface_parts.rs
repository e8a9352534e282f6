//! What the surfaces of a frame are found with, as the settings have it.

use settings::{NOT_NEGATIVE, between, settings, within};

use crate::picture::median::Median;
use crate::picture::noise::NoiseMap;
use crate::regions::cuts::Cuts;
use crate::regions::fit::FitTuning;
use crate::regions::roughness::Roughness;
use crate::regions::slivers::Slivers;
use crate::regions::slopes::SlopeSearch;

settings! {
    /// How the surfaces of one frame are fitted, and which of them are level.
    pub struct SurfaceTuning("navigation.ground.tuning.surfaces") {
        /// Columns and rows to each side of a pixel that must be of its region for the pixel to take part in a fit: those that a
        /// matching window of 5 reaches, and one more row.
        border: [usize; 2] = [2, 3], "1", within(0.0, 50.0);
        /// Columns and rows to each side of a pixel that must be of its region for the pixel to take part in the check whether the
        /// region is a slice of a wall: slices are thin, and `border` leaves too little of them.
        thin_border: [usize; 2] = [1, 1], "1", within(0.0, 50.0);
        /// A pixel without a region is a hole in the region that so many of its eight neighbours or more belong to, and spoils none
        /// of the pixels around it.
        hole: usize = 5, "1", within(1.0, 8.0);
        /// Pixels that must be left of a region when its border is taken off; of one with fewer all take part in the fit.
        min_fit: u32 = 24, "1", NOT_NEGATIVE;
        /// A region that is tilted by more than this is no level surface. Blending at the borders of a tread gives less than half
        /// of it.
        steep: f64 = 0.3, "rad", between(0.0, 1.6);
        /// A region counts as steep, or as sloping near the feet, only when the squared distance of its tilt from none, in its own
        /// errors, is above this.
        steep_sure: f64 = 3.5, "1", NOT_NEGATIVE;
    }
}

/// What surfaces are found with, beside the finder.
#[derive(Debug, Clone)]
pub(crate) struct SurfaceParts {
    pub(crate) tuning: SurfaceTuning,
    pub(crate) fit_tuning: FitTuning,
    /// A surface tilted by more than this is no floor, rad.
    pub(crate) floor_tilt_rad: f64,
    pub(crate) median: Median,
    pub(crate) noise: NoiseMap,
    pub(crate) roughness: Roughness,
    pub(crate) slivers: Slivers,
    pub(crate) cuts: Cuts,
    pub(crate) slopes: SlopeSearch,
}
