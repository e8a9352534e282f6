//! What a slope or an upright face between two levels looks like in the picture.

use crate::edges::edge_model::lot::REACH;
use crate::edges::edge_model::sight::{CameraSight, PixelLinear, StepModel};

/// What may lie between two levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RiseForm {
    /// An upright face.
    Riser,
    /// A slope that takes so far from level to level, m.
    Slope(f64),
    /// A tread that is so deep, m, half way up between two upright faces.
    Tread(f64),
}

/// What lies between the levels, in the picture.
enum Face {
    Riser(PixelLinear),
    Slope(PixelLinear),
    Tread {
        risers: [PixelLinear; 2],
        tread: PixelLinear,
    },
}

/// The two levels in the picture and what is between them, and how far apart they are at a pixel.
pub(super) struct Faces {
    pub(super) near: PixelLinear,
    pub(super) far: PixelLinear,
    face: Face,
    rises: bool,
}

impl Faces {
    /// `None` where the camera does not look down on all of them, from before the edge.
    pub(super) fn new(sight: &CameraSight, step: &StepModel, form: RiseForm) -> Option<Self> {
        let camera = sight.position_m;
        let above_m = |height_m: f64| camera.z - height_m;
        let (near_m, far_m) = (step.near_height_m, step.far_height_m);
        let middle_m = f64::midpoint(near_m, far_m);
        let ahead_m = -step.beyond_m(&camera.xy());
        let across = sight.along(&step.normal());
        let (face, clear_m) = match form {
            RiseForm::Riser => (Face::Riser(across.times(1.0 / ahead_m)), ahead_m),
            RiseForm::Slope(run_m) => {
                let slope = (far_m - near_m) / run_m;
                let over_m = above_m(middle_m) + slope * ahead_m;
                let plane = across.mix(slope / over_m, &sight.fall, 1.0 / over_m);
                (Face::Slope(plane), over_m)
            }
            RiseForm::Tread(deep_m) => {
                let first_m = ahead_m - 0.5 * deep_m;
                let risers = [first_m, first_m + deep_m].map(|at_m| across.times(1.0 / at_m));
                let tread = sight.fall.times(1.0 / above_m(middle_m));
                (Face::Tread { risers, tread }, first_m)
            }
        };
        let least_m = [above_m(near_m), above_m(far_m), ahead_m, clear_m];
        (least_m.iter().all(|clear_m| *clear_m > sight.clear_m)).then(|| Self {
            near: sight.fall.times(1.0 / above_m(near_m)),
            far: sight.fall.times(1.0 / above_m(far_m)),
            face,
            rises: far_m > near_m,
        })
    }

    /// The disparity that the ray of a pixel meets first, px.
    fn met_px(&self, col: f64, row: f64) -> f64 {
        let [near, far] = [&self.near, &self.far].map(|plane| plane.at(col, row));
        match (&self.face, self.rises) {
            (Face::Riser(face) | Face::Slope(face), true) => near.max(far.min(face.at(col, row))),
            (Face::Riser(face), false) if near > face.at(col, row) => near,
            (Face::Riser(_), false) => far,
            (Face::Slope(face), false) => near.min(far.max(face.at(col, row))),
            (Face::Tread { risers, tread }, rises) => {
                let [first, second] = risers.each_ref().map(|face| face.at(col, row));
                let tread = tread.at(col, row);
                match rises {
                    true => near.max(tread.min(first)).max(far.min(second)),
                    false if near > first => near,
                    false if tread > second => tread,
                    false => far,
                }
            }
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
