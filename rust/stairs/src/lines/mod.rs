//! Straight lines in the plane: through segments, through points of which some lie anywhere, along the sides of a hull.

pub(crate) mod boundary;
pub(crate) mod line;
pub(crate) mod robust_line;
