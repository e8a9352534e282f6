//! What a slope or an upright face between two levels looks like in the picture.

use crate::edges::edge_model::lot::REACH;
use crate::edges::edge_model::sight::{CameraSight, PixelLinear, StepModel};

/// The two levels in the picture and the face between them, and how far apart they are at a pixel.
pub(super) struct Faces {
    pub(super) near: PixelLinear,
    pub(super) far: PixelLinear,
    face: PixelLinear,
    rises: bool,
    is_upright: bool,
}

impl Faces {
    /// `None` where the camera does not look down on all of them, from before the edge.
    pub(super) fn new(sight: &CameraSight, step: &StepModel, run_m: f64) -> Option<Self> {
        let camera = sight.position_m;
        let above_m = |height_m: f64| camera.z - height_m;
        let (near_m, far_m) = (step.near_height_m, step.far_height_m);
        let ahead_m = -step.beyond_m(&camera.xy());
        let across = sight.along(&step.normal());
        let is_upright = run_m <= 0.0;
        let (face, clear_m) = if is_upright {
            (across.times(1.0 / ahead_m), ahead_m)
        } else {
            let slope = (far_m - near_m) / run_m;
            let over_m = above_m(f64::midpoint(near_m, far_m)) + slope * ahead_m;
            (
                across.mix(slope / over_m, &sight.fall, 1.0 / over_m),
                over_m,
            )
        };
        let least_m = [above_m(near_m), above_m(far_m), ahead_m, clear_m];
        (least_m.iter().all(|clear_m| *clear_m > sight.clear_m)).then(|| Self {
            near: sight.fall.times(1.0 / above_m(near_m)),
            far: sight.fall.times(1.0 / above_m(far_m)),
            face,
            rises: far_m > near_m,
            is_upright,
        })
    }

    /// The disparity that the ray of a pixel meets first, px.
    fn met_px(&self, col: f64, row: f64) -> f64 {
        let [near, far, face] = [&self.near, &self.far, &self.face].map(|plane| plane.at(col, row));
        match (self.rises, self.is_upright) {
            (true, _) => near.max(far.min(face)),
            (false, true) if near > face => near,
            (false, true) => far,
            (false, false) => near.min(far.max(face)),
        }
    }

    /// What the matching window around a pixel makes of that, px.
    pub(super) fn seen_px(&self, col: f64, row: f64) -> f64 {
        // A value to each side and the middle's have the mean of a window's side where they lie so far apart.
        let off_px = (0.5 * REACH * (REACH + 1.0)).sqrt();
        let beside = [-off_px, 0.0, off_px];
        let line = |row: f64| -> f64 {
            let met = beside.iter().map(|off| self.met_px(col + off, row));
            met.sum()
        };
        let all: f64 = beside.iter().map(|off| line(row + off)).sum();
        all / beside.len().pow(2) as f64
    }
}
