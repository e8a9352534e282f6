//! The part of a scan that shows an edge: where it lies in the picture, and which of its pixels take part.

use geometry::Robot;
use nalgebra::{Point3, Vector2, Vector3};
use segmentation::Planes;
use sensing::{Intrinsics, Scan};

use super::product::Untrusted;
use super::sight::{CameraSight, StepFaces, StepModel};
use crate::{Edge, EdgeModelTuning, ExcerptTuning};

/// Columns and rows of a picture, from and up to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) cols: (usize, usize),
    pub(super) rows: (usize, usize),
}

impl Area {
    pub(super) const fn columns(&self) -> usize {
        self.cols.1 - self.cols.0
    }
}

/// A pixel that takes part.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgePixel {
    pub(super) col: f64,
    pub(super) row: f64,
    /// Its disparity, px.
    pub(super) observed_px: f32,
}

/// The pixels around an edge.
#[derive(Debug, Clone, Default)]
pub(super) struct Excerpt {
    /// Disparities in `area`, row by row, px; NaN where nothing was seen.
    observed_px: Vec<f32>,
    /// The pixels of the area that take part.
    pub(super) chosen: Vec<EdgePixel>,
    /// Every so many of those that could take part does.
    pub(super) thinned: u32,
}

/// The part of the guess that is in the picture: its middle and half its length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) middle_m: Vector2<f64>,
    pub(super) half_m: f64,
}

/// Finds the part of `guess` that is in the picture.
pub(super) fn stretch_in_view(
    camera: &Intrinsics,
    planes: &Planes,
    guess: &Edge<Robot>,
    height_m: f64,
    tuning: &ExcerptTuning,
) -> Result<Stretch, Untrusted> {
    let (left, right) = (guess.left.inner.coords.xy(), guess.right.inner.coords.xy());
    let (places, outside_px) = (tuning.places, tuning.outside);
    let mut ends: Option<(f64, f64)> = None;
    for i in 0..places {
        let part = i as f64 / (places - 1) as f64;
        let place = right.lerp(&left, part).push(height_m);
        if let Some((col, row)) = pixel_of(camera, planes, &place, tuning)
            && (-outside_px..camera.width as f64 + outside_px).contains(&col)
            && (-outside_px..camera.height as f64 + outside_px).contains(&row)
        {
            ends = Some((ends.map_or(part, |(first, _)| first), part));
        }
    }
    let (first, last) = ends.ok_or(Untrusted::OutOfView)?;
    let length_m = (last - first) * (left - right).norm();
    if length_m < tuning.shortest {
        return Err(Untrusted::OutOfView);
    }
    Ok(Stretch {
        middle_m: right.lerp(&left, 0.5 * (first + last)),
        half_m: 0.5 * length_m.min(tuning.longest) - tuning.end,
    })
}

/// Width of a pixel at a place, m.
pub(super) fn pixel_m(camera: &Intrinsics, planes: &Planes, place: &Vector3<f64>) -> f64 {
    let pose = planes.robot_from_camera.inner;
    pose.inverse_transform_point(&Point3::from(*place)).z / camera.focal_px
}

/// Column and row at which a place is seen; `None` when it is not in front of the camera.
fn pixel_of(
    camera: &Intrinsics,
    planes: &Planes,
    place: &Vector3<f64>,
    tuning: &ExcerptTuning,
) -> Option<(f64, f64)> {
    let seen = planes
        .robot_from_camera
        .inner
        .inverse_transform_point(&Point3::from(*place));
    if seen.z < tuning.nearest_depth {
        return None;
    }
    let (cx, cy) = camera.principal_point_px();
    let scale = camera.focal_px / seen.z;
    Some((cx + seen.x * scale, cy + seen.y * scale))
}

/// The rectangle of pixels around a step: by the model's slack more than takes part.
pub(super) fn area_of(
    camera: &Intrinsics,
    planes: &Planes,
    step: &StepModel,
    half_m: f64,
    tuning: &EdgeModelTuning,
) -> Result<Area, Untrusted> {
    let (slack_m, tuning) = (tuning.slack, &tuning.excerpt);
    let (normal, along) = (step.normal(), step.along());
    let mut low = (f64::INFINITY, f64::INFINITY);
    let mut high = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for (beyond_m, height_m) in [
        (-tuning.before - slack_m, step.near_height_m),
        (tuning.behind + slack_m, step.far_height_m),
    ] {
        for aside_m in [-half_m, half_m] {
            let place = step.anchor_m + normal * (step.place_m + beyond_m) + along * aside_m;
            let (col, row) = pixel_of(camera, planes, &place.push(height_m), tuning)
                .unwrap_or((0.5 * camera.width as f64, camera.height as f64));
            low = (low.0.min(col), low.1.min(row));
            high = (high.0.max(col), high.1.max(row));
        }
    }
    let span = |low: f64, high: f64, limit: usize| {
        let from = low.floor().clamp(0.0, limit as f64) as usize;
        (from, (high.ceil() + 1.0).clamp(0.0, limit as f64) as usize)
    };
    let area = Area {
        cols: span(low.0, high.0, camera.width),
        rows: span(low.1, high.1, camera.height),
    };
    if area.cols.0 >= area.cols.1 || area.rows.0 >= area.rows.1 {
        return Err(Untrusted::OutOfView);
    }
    Ok(area)
}

impl Excerpt {
    /// Room for `pixels` pixels.
    pub(super) fn with_room(pixels: usize) -> Self {
        Self {
            observed_px: Vec::with_capacity(pixels),
            chosen: Vec::with_capacity(pixels),
            thinned: 1,
        }
    }

    /// Takes the area out of a scan.
    pub(super) fn cut(&mut self, scan: &Scan, area: &Area) {
        self.observed_px.clear();
        for row in area.rows.0..area.rows.1 {
            let from = row * scan.camera.width;
            let line = &scan.disparity_px[from + area.cols.0..from + area.cols.1];
            self.observed_px.extend_from_slice(line);
        }
    }

    /// Chooses the pixels that are close to the step's edge.
    pub(super) fn choose(
        &mut self,
        sight: &CameraSight,
        step: &StepModel,
        half_m: f64,
        area: &Area,
        tuning: &ExcerptTuning,
    ) {
        let Some(faces) = step.faces(sight) else {
            self.chosen.clear();
            return;
        };
        let zone = Zone::new(sight, step, half_m, tuning);
        let columns = area.columns();
        let thinned = self.observed_px.len().div_ceil(tuning.many).max(1);
        self.thinned = thinned as u32;
        self.chosen.clear();
        for (index, line) in self.observed_px.chunks_exact(columns).enumerate() {
            let row = (area.rows.0 + index) as f64;
            // From row to row by another column: no line of pixels is left out.
            let first = index * (thinned - 1) % thinned;
            for (i, &observed_px) in line.iter().enumerate().skip(first).step_by(thinned) {
                let col = (area.cols.0 + i) as f64;
                if observed_px > 0.0 && zone.holds(&faces, col, row) {
                    self.chosen.push(EdgePixel {
                        col,
                        row,
                        observed_px,
                    });
                }
            }
        }
    }

    /// Row by row: the row, and its disparities from the area's first column on.
    pub(super) fn lines(&self, area: &Area) -> impl Iterator<Item = (f64, &[f32])> {
        let top = area.rows.0;
        let lines = self.observed_px.chunks_exact(area.columns()).enumerate();
        lines.map(move |(index, line)| ((top + index) as f64, line))
    }
}

/// The places around an edge whose pixels take part.
struct Zone {
    ahead_m: f64,
    aside_m: f64,
    half_m: f64,
    before_m: f64,
    behind_m: f64,
    least_px: f32,
    along: super::sight::PixelLinear,
    across: super::sight::PixelLinear,
}

impl Zone {
    fn new(sight: &CameraSight, step: &StepModel, half_m: f64, tuning: &ExcerptTuning) -> Self {
        let camera = sight.position_m.xy();
        Self {
            ahead_m: -step.beyond_m(&camera),
            aside_m: step.along().dot(&(camera - step.anchor_m)),
            half_m,
            before_m: tuning.before,
            behind_m: tuning.behind,
            least_px: tuning.least_disparity,
            along: sight.along(&step.along()),
            across: sight.along(&step.normal()),
        }
    }

    fn holds(&self, faces: &StepFaces, col: f64, row: f64) -> bool {
        let (near, far) = (
            faces.near.at(col, row) as f32,
            faces.far.at(col, row) as f32,
        );
        if near.min(far) < self.least_px {
            return false;
        }
        let (across, along) = (self.across.at(col, row), self.along.at(col, row));
        let on_near_m = across / f64::from(near) - self.ahead_m;
        let on_far_m = across / f64::from(far) - self.ahead_m;
        let aside_m = self.aside_m + along / f64::from(faces.seen(col, row));
        on_near_m > -self.before_m && on_far_m < self.behind_m && aside_m.abs() < self.half_m
    }
}
