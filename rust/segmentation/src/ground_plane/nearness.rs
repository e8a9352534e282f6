//! How near to the robot's feet surfaces are seen.

use crate::camera_pose::Levelled;
use crate::regions::{Finder, FrameSurfaces};

/// How near to the feet each region of a frame is seen. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Nearness {
    squares: Vec<Vec<f32>>,
    /// Of each region, m; infinite where nothing of it is seen away from its border.
    pub(super) nearest_m: Vec<f32>,
}

impl Nearness {
    /// Measures the level regions of `surfaces`, of whose pixels every `stride`-th each way is looked at. A region is as near as `enough`
    /// of its pixels are, away from its border: fewer may be mismatched.
    pub(super) fn measure(
        &mut self,
        surfaces: &FrameSurfaces<impl Finder>,
        levelled: &Levelled,
        [stride, enough]: [usize; 2],
    ) {
        let count = surfaces.regions.len();
        self.squares
            .resize_with(self.squares.len().max(count), Vec::new);
        self.squares.iter_mut().for_each(Vec::clear);
        let camera_m = levelled.predicted.inner.translation.vector.cast::<f32>();
        let view = &levelled.view;
        for (row, col, label) in surfaces.inner_pixels(stride) {
            let region = usize::from(label) - 1;
            let per_g = 1.0 / (surfaces.regions[region].q * view.g.at(col, row));
            let x_m = camera_m.x + view.x.at(col, row) * per_g;
            let y_m = camera_m.y + view.y.at(col, row) * per_g;
            self.squares[region].push(x_m * x_m + y_m * y_m);
        }
        let rank = enough / (stride * stride);
        self.nearest_m.clear();
        let squares = &mut self.squares[..count];
        self.nearest_m.extend(squares.iter_mut().map(|squares| {
            let rank = rank.min(squares.len().saturating_sub(1));
            if squares.is_empty() {
                return f32::INFINITY;
            }
            let (_, square, _) = squares.select_nth_unstable_by(rank, f32::total_cmp);
            square.sqrt()
        }));
    }
}
