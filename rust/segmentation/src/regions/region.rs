//! One surface of a frame as it is known while the frame is looked at.

use crate::picture::Linear;

/// A region of one surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Region {
    /// Disparity over `g`, 1/m; 0 of a surface that is not horizontal.
    pub q: f32,
    /// Pixels.
    pub support: usize,
    /// Pixels that the erosion leaves.
    pub core: usize,
    /// The disparities of its plane, px, from finders that find planes in any direction.
    pub plane: Option<Linear>,
    /// Whether that plane is a slope to walk on.
    pub is_slope: bool,
}
