//! A map that does not change, as dense grids: which voxels are solid, how far a ray gets, how near the next surface is.

mod distance_field;
mod free_boxes;
mod range_field;
mod side_by_side;
mod surfaces;
mod voxels;

pub use distance_field::DistanceField;
pub use range_field::RangeField;
pub use side_by_side::{LANES, Lanes};
pub use surfaces::{InnerSurfaceRule, InnerSurfaces};
pub use voxels::{SolidError, SolidVoxels};
