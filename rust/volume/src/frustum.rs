//! What of a grid shows in a picture: a space between planes.

use super::picture::{PictureLinear, PictureSight};
use super::placement::Size;

/// Planes around what shows in the picture and is not too deep.
const PLANES: usize = 6;
/// No place is looked up that is nearer to the camera than this, m: there a division by the depth would lose it, and no camera sees.
const NEAREST_M: f32 = 0.01;

/// Layers of a cell, first and last.
pub(super) type LayerSpan = [usize; 2];

/// A bound of the space: positive in it.
#[derive(Debug, Clone, Copy)]
struct FrustumPlane {
    inside: PictureLinear,
    /// From layer to layer it falls or rises by as much; one over that.
    per_layer: f32,
    /// How much it changes from the middle of a voxel to its furthest corner.
    corner: f32,
}

/// The voxels that show in the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frustum {
    planes: [FrustumPlane; PLANES],
    size: Size,
}

/// Values of a variable.
#[derive(Debug, Clone, Copy)]
struct Interval {
    low: f32,
    high: f32,
}

impl Interval {
    fn to(end: usize) -> Self {
        Self {
            low: 0.0,
            high: end as f32 - 1.0,
        }
    }

    /// Leaves those for which `origin + slope * value >= 0`, given one over the slope.
    #[inline]
    fn cut(&mut self, origin: f32, per_slope: f32) {
        let border = -origin * per_slope;
        if per_slope > 0.0 {
            self.low = if border > self.low { border } else { self.low };
        } else {
            self.high = if border < self.high {
                border
            } else {
                self.high
            };
        }
    }

    /// The first and the last whole number among them.
    #[inline]
    fn whole(self) -> Option<[usize; 2]> {
        if self.low > self.high {
            return None;
        }
        // Casts to 32 bits take a fraction of those to more, and of a call that rounds up.
        let below = self.low as i32;
        let low = below + i32::from((below as f32) < self.low);
        let high = self.high as i32;
        (low <= high).then_some([low as usize, high as usize])
    }
}

/// One over a slope; a slope of nothing is a very small one.
fn per(slope: f32) -> f32 {
    const LEAST: f32 = 1e-30;
    if slope.abs() < LEAST {
        1.0 / LEAST
    } else {
        1.0 / slope
    }
}

impl Frustum {
    /// What shows in a picture in which nothing is deeper than `farthest_m`.
    pub(super) fn new(sight: &PictureSight, farthest_m: f32, size: Size) -> Self {
        let [width, height] = sight.size_px.map(|n| n as f32);
        let (depth, across, down) = (&sight.depth, &sight.across, &sight.down);
        let plane = |inside: PictureLinear, by: f32| FrustumPlane {
            inside: PictureLinear {
                origin: inside.origin + by,
                ..inside
            },
            per_layer: per(inside.step[2]),
            corner: 0.5 * inside.step.iter().map(|step| step.abs()).sum::<f32>(),
        };
        Self {
            planes: [
                plane(*across, 0.0),
                plane(depth.combined(width, across, -1.0), 0.0),
                plane(*down, 0.0),
                plane(depth.combined(height, down, -1.0), 0.0),
                plane(*depth, -NEAREST_M),
                plane(depth.combined(-1.0, depth, 0.0), farthest_m),
            ],
            size,
        }
    }

    /// First and last column of a row in which any voxel may show.
    pub(super) fn columns(&self, row: usize) -> Option<[usize; 2]> {
        let mut cols = Interval::to(self.size.cols);
        let top = self.size.layers as f32 - 1.0;
        for plane in &self.planes {
            let [per_col, per_row, per_layer] = plane.inside.step;
            let highest = plane.inside.origin + per_row * row as f32 + (per_layer * top).max(0.0);
            cols.cut(highest + plane.corner, per(per_col));
        }
        cols.whole()
    }

    /// The layers of a cell of which a part shows, and those whose middle does.
    #[inline]
    pub(super) fn layers(&self, col: usize, row: usize) -> Option<(LayerSpan, Option<LayerSpan>)> {
        let mut part = Interval::to(self.size.layers);
        let mut middle = part;
        for plane in &self.planes {
            let lowest = plane.inside.at(col, row);
            part.cut(lowest + plane.corner, plane.per_layer);
            middle.cut(lowest, plane.per_layer);
        }
        part.whole().map(|part| (part, middle.whole()))
    }
}
