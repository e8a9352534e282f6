//! A sample of a surface: where it is, how it lies, and which cells of its block it covers.

use super::cells::{EDGE, cell_in_block, place_in_block};
use super::moments::{Moments, Shape};
use crate::columns::Span;

/// Of an even spread the square of half its width, in variances.
const EVENLY: f32 = 3.0;

/// A sample: a Gaussian over the points that were fused in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Of its points, from the block's lowest corner, m.
    pub moments: Moments,
    /// Cells of the block that it covers, one bit each.
    pub cells: u64,
    /// Frames that saw it, saturating.
    pub frames: u16,
    /// Across a surface of several cells; of a single cell's sample 0.
    pub normal: [f32; 3],
    /// How thick a surface of several cells is, as a standard deviation, m.
    pub thickness_m: f32,
    /// Whether it was seen from above or from below: the two sides of a thin plate are two surfaces.
    pub from_above: bool,
    /// Seen in this frame.
    fresh: bool,
    /// Frames in a row that saw through it.
    passed: u8,
}

impl Sample {
    /// Of one cell.
    pub(super) const fn of(moments: Moments, cells: u64, from_above: bool) -> Self {
        Self {
            moments,
            cells,
            frames: 0,
            normal: [0.0; 3],
            thickness_m: 0.0,
            from_above,
            fresh: true,
            passed: 0,
        }
    }

    /// Whether it stands for a surface of several cells.
    pub const fn is_surface(&self) -> bool {
        self.normal[2] != 0.0 || self.normal[0] != 0.0 || self.normal[1] != 0.0
    }

    /// How far a point of the block is from it, in standard deviations of both: across the surface, or in height.
    pub(super) fn deviations(&self, at_m: [f32; 3], variance_m2: f32) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| at_m[axis] - self.moments.mean_m[axis]);
        let own = 1.0 / self.moments.weight;
        if self.is_surface() {
            let [nx, ny, nz] = self.normal;
            let apart_m = nx * x + ny * y + nz * z;
            let thick = self.thickness_m * self.thickness_m;
            apart_m.abs() / (variance_m2.max(thick) + own).sqrt()
        } else {
            z.abs() / (variance_m2 + own).sqrt()
        }
    }

    /// Takes in a point.
    pub(super) fn fuse(&mut self, point: &Moments, cell: u64) {
        self.moments = self.moments.with(point);
        self.cells |= cell;
        self.fresh = true;
    }

    /// Takes in that a frame is over.
    pub(super) const fn end_frame(&mut self) {
        if self.fresh {
            self.frames = self.frames.saturating_add(1);
            self.fresh = false;
            self.passed = 0;
        }
    }

    /// Takes in that a frame saw through it; whether it is given up. What the frame saw stays.
    pub(super) const fn pass(&mut self, patience: u8) -> bool {
        self.passed += 1;
        self.passed >= patience
    }

    /// One sample of both.
    pub(super) fn joined(&self, other: &Self) -> Self {
        Self {
            moments: self.moments.with(&other.moments),
            cells: self.cells | other.cells,
            frames: self.frames.max(other.frames),
            fresh: self.fresh || other.fresh,
            ..*self
        }
    }

    /// Makes it a surface of this shape.
    pub(super) const fn laid(self, shape: Shape) -> Self {
        Self {
            normal: shape.normal,
            thickness_m: shape.sigmas_m[2],
            ..self
        }
    }

    /// Where its surface is over or beside the middle of a cell of the block, m; its mean where it is a single cell's.
    pub(super) fn at_cell(&self, cell: usize, cell_m: f32) -> [f32; 3] {
        let mean_m = self.moments.mean_m;
        if !self.is_surface() {
            return mean_m;
        }
        let centre = place_in_block(cell).map(|at| (at as f32 + 0.5) * cell_m);
        let [nx, ny, nz] = self.normal;
        let off = [0, 1, 2].map(|axis| centre[axis] - mean_m[axis]);
        let apart_m = nx * off[0] + ny * off[1] + nz * off[2];
        [0, 1, 2].map(|axis| centre[axis] - apart_m * self.normal[axis])
    }

    /// The samples of single cells that it stands for.
    pub(super) fn split(&self, cell_m: f32) -> impl Iterator<Item = Self> + use<> {
        let whole = *self;
        let share = self.cells.count_ones();
        let own = (0..u64::BITS as usize).filter(move |cell| whole.cells >> cell & 1 == 1);
        own.map(move |cell| {
            let moments = Moments {
                weight: whole.moments.weight / share as f32,
                count: (whole.moments.count / share).max(1),
                mean_m: whole.at_cell(cell, cell_m),
                covariance_m2: [0.0; 6],
            };
            let mut one = Self::of(moments, 1 << cell, whole.from_above);
            (one.frames, one.fresh) = (whole.frames, false);
            one
        })
    }

    /// What it is in a column of its block whose lowest corner lies so high, m; none in which it is not. `upright` as of the settings.
    pub(super) fn span(
        &self,
        [col, row]: [usize; 2],
        (bottom_m, cell_m): (f32, f32),
        upright: f32,
    ) -> Option<Span> {
        let shift = cell_in_block([col, row, 0]);
        let layers = self.cells >> shift & ((1 << EDGE) - 1);
        if layers == 0 {
            return None;
        }
        let mean_m = self.moments.mean_m[2];
        // Of things that are as high as they are spread, evenly: half of that is the root of three standard deviations.
        let spread = self.moments.covariance_m2[2] - self.moments.noise_m2();
        let half_m = (EVENLY * spread.max(0.0)).sqrt();
        let [nx, ny, nz] = self.normal;
        let (low_m, high_m) = if self.is_surface() && nz >= upright {
            let centre = [col, row].map(|at| (at as f32 + 0.5) * cell_m);
            let [x, y] = [0, 1].map(|axis| centre[axis] - self.moments.mean_m[axis]);
            let height_m = mean_m - (nx * x + ny * y) / nz;
            (height_m, height_m)
        } else if self.is_surface() {
            let low_m = layers.trailing_zeros() as f32 * cell_m;
            let high_m = (u64::BITS - layers.leading_zeros()) as f32 * cell_m;
            (
                low_m.max(mean_m - half_m).min(mean_m),
                high_m.min(mean_m + half_m).max(mean_m),
            )
        } else {
            (mean_m - half_m, mean_m + half_m)
        };
        // As sure as one point of each frame: what makes a frame's points wrong makes them wrong alike.
        let frames = self.frames.max(u16::from(self.fresh));
        Some(Span {
            low_m: bottom_m + low_m,
            high_m: bottom_m + high_m,
            frames,
            sigma_m: (self.moments.noise_m2() / f32::from(frames.max(1))).sqrt(),
        })
    }
}
