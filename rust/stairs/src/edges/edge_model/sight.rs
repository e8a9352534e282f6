//! How a camera pose shows a step: disparities of level and of upright planes are linear in column and row.

use geometry::{Camera, Pose, Robot};
use nalgebra::{Vector2, Vector3};
use sensing::Intrinsics;

/// A function of the pixel that is linear in column and row.
#[derive(Debug, Clone, Copy)]
pub(super) struct PixelLinear {
    origin: f64,
    /// Change from column to column.
    pub(super) per_col: f64,
    /// Change from row to row.
    pub(super) per_row: f64,
}

impl PixelLinear {
    /// The value at a pixel, which may lie outside the picture.
    #[inline]
    pub(super) fn at(&self, col: f64, row: f64) -> f64 {
        self.origin + self.per_col * col + self.per_row * row
    }

    /// Length of the gradient, per pixel.
    pub(super) fn steepness(&self) -> f64 {
        self.per_col.hypot(self.per_row)
    }

    /// `a self + b other`.
    pub(super) fn mix(&self, a: f64, other: &Self, b: f64) -> Self {
        Self {
            origin: a * self.origin + b * other.origin,
            per_col: a * self.per_col + b * other.per_col,
            per_row: a * self.per_row + b * other.per_row,
        }
    }

    /// `a self`.
    pub(super) fn times(&self, a: f64) -> Self {
        self.mix(a, self, 0.0)
    }
}

/// Where the camera is, how far it must be from what it sees, m, and its rays times focal length and baseline, robot axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct CameraSight {
    pub(super) position_m: Vector3<f64>,
    pub(super) clear_m: f64,
    pub(super) x: PixelLinear,
    pub(super) y: PixelLinear,
    pub(super) fall: PixelLinear,
}

impl CameraSight {
    pub(super) fn new(
        camera: &Intrinsics,
        robot_from_camera: &Pose<Robot, Camera>,
        clear_m: f64,
    ) -> Self {
        let (cx, cy) = camera.principal_point_px();
        let turn = robot_from_camera.inner.rotation.to_rotation_matrix();
        let axis = |axis: usize, sign: f64| {
            let part = |i: usize| sign * camera.baseline_m * turn[(axis, i)];
            PixelLinear {
                origin: part(2) * camera.focal_px - part(0) * cx - part(1) * cy,
                per_col: part(0),
                per_row: part(1),
            }
        };
        Self {
            position_m: robot_from_camera.inner.translation.vector,
            clear_m,
            x: axis(0, 1.0),
            y: axis(1, 1.0),
            fall: axis(2, -1.0),
        }
    }

    /// Rays along a level direction.
    pub(super) fn along(&self, direction: &Vector2<f64>) -> PixelLinear {
        self.x.mix(direction.x, &self.y, direction.y)
    }
}

/// A step: level in front of the edge, level behind it, upright between.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepModel {
    /// A place that the edge passes close to, robot frame, m.
    pub(super) anchor_m: Vector2<f64>,
    /// How far the edge passes beyond it, m.
    pub(super) place_m: f64,
    /// Direction square to the edge, from near to far, rad.
    pub(super) heading_rad: f64,
    pub(super) near_height_m: f64,
    pub(super) far_height_m: f64,
}

/// The step's three planes in the picture: disparities, px, and what changes them.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepFaces {
    pub(super) near: PixelLinear,
    pub(super) far: PixelLinear,
    pub(super) riser: PixelLinear,
    /// Change of `riser` with the edge's place, px/m, and with its heading, px/rad.
    pub(super) riser_by_place: PixelLinear,
    pub(super) riser_by_heading: PixelLinear,
    /// Change of `near` and of `far` with the surfaces' heights, px/m.
    pub(super) near_by_height: PixelLinear,
    pub(super) far_by_height: PixelLinear,
    /// Whether the far surface is the higher one, so that the riser shows.
    pub(super) rising: bool,
}

impl StepModel {
    pub(super) fn normal(&self) -> Vector2<f64> {
        Vector2::new(self.heading_rad.cos(), self.heading_rad.sin())
    }

    /// From right to left along the edge.
    pub(super) fn along(&self) -> Vector2<f64> {
        let normal = self.normal();
        Vector2::new(-normal.y, normal.x)
    }

    /// How far beyond the edge a place is, m.
    pub(super) fn beyond_m(&self, place: &Vector2<f64>) -> f64 {
        self.normal().dot(&(place - self.anchor_m)) - self.place_m
    }

    /// The planes; `None` when the camera is not above both surfaces and in front of the edge.
    pub(super) fn faces(&self, sight: &CameraSight) -> Option<StepFaces> {
        let camera = sight.position_m;
        let (above_near_m, above_far_m) =
            (camera.z - self.near_height_m, camera.z - self.far_height_m);
        let ahead_m = -self.beyond_m(&camera.xy());
        if above_near_m.min(above_far_m).min(ahead_m) < sight.clear_m {
            return None;
        }
        let near = sight.fall.times(1.0 / above_near_m);
        let far = sight.fall.times(1.0 / above_far_m);
        let riser = sight.along(&self.normal()).times(1.0 / ahead_m);
        let aside_m = self.along().dot(&(camera.xy() - self.anchor_m));
        Some(StepFaces {
            near,
            far,
            riser,
            riser_by_place: riser.times(-1.0 / ahead_m),
            riser_by_heading: sight.along(&self.along()).mix(
                1.0 / ahead_m,
                &riser,
                aside_m / ahead_m,
            ),
            near_by_height: near.times(1.0 / above_near_m),
            far_by_height: far.times(1.0 / above_far_m),
            rising: self.far_height_m > self.near_height_m,
        })
    }
}

impl StepFaces {
    /// The disparity that the ray of a pixel meets first, px.
    #[inline]
    pub(super) fn seen(&self, col: f64, row: f64) -> f32 {
        first_met(
            self.rising,
            self.near.at(col, row) as f32,
            self.far.at(col, row) as f32,
            self.riser.at(col, row) as f32,
        )
    }
}

/// The first disparity that a ray meets. Going up, the riser hides the far surface's level below it and the near one hides
/// the riser's below; going down, the near surface hides what is behind its border.
#[inline]
pub(super) fn first_met(rising: bool, near: f32, far: f32, riser: f32) -> f32 {
    if rising {
        let behind = if far < riser { far } else { riser };
        if near > behind { near } else { behind }
    } else if near > riser {
        near
    } else {
        far
    }
}
