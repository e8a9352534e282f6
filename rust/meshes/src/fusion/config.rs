//! How what several frames saw becomes one surface, checked once.

use settings::{POSITIVE, at_least, settings, within};

settings! {
    /// The volume of signed distances to the surface, in which frames are fused (Curless and Levoy 1996).
    pub struct FusionConfig("navigation.mesh.fusion") {
        /// Side of a voxel.
        voxel: f64 = 0.02, "m", within(0.001, 10.0);
        /// Distances are kept up to so many voxels before and behind the surface.
        truncation: f64 = 4.0, "1", at_least(2.0), "Curless and Levoy 1996, section 3";
        /// Where so many standard deviations of the measured range are more than `truncation`, distances are kept up to these.
        deviations: f64 = 2.0, "1", POSITIVE;
        /// So many voxels behind a surface something is for sure; what lies deeper and is seen to be free from the other side is free. Things that
        /// are thinner vanish.
        solid: f64 = 1.5, "1", at_least(1.0);
        /// From voxel to voxel distances change by no more than so many voxels on a surface: elsewhere there is a gap.
        steepest: f64 = 1.7, "1", at_least(1.0);
        /// Rounds over the neighbours by which the directions of surfaces are smoothed.
        smoothing: usize = 3, "1", within(0.0, 100.0);
        /// A distance is never taken to be surer than so many measurements make it: what changes is followed.
        memory: f64 = 30.0, "1", at_least(1.0);
        /// Where a line of sight passes through the surface, what was known counts for so many measurements at most.
        patience: f64 = 2.0, "1", at_least(1.0);
    }
}
