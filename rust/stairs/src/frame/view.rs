//! What the camera saw where a surface lies or ends.

use geometry::{Camera, Outline, Robot};
use nalgebra::{Isometry3, Point2, Point3, Vector2, Vector3};
use segmentation::{PlaneRegion, Planes};
use sensing::Intrinsics;

use crate::ViewTuning;

/// The planes of a frame, seen through its camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlanesView<'a> {
    planes: &'a Planes,
    camera: Intrinsics,
    camera_from_robot: Isometry3<f64>,
    tuning: &'a ViewTuning,
}

/// What a pixel shows against a level surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shows {
    /// The surface.
    Surface,
    /// Something above it.
    Higher,
    /// Something below it: the surface is not there.
    Lower,
}

impl<'a> PlanesView<'a> {
    pub(crate) fn new(planes: &'a Planes, camera: Intrinsics, tuning: &'a ViewTuning) -> Self {
        let robot_from_camera: geometry::Pose<Robot, Camera> = planes.robot_from_camera;
        Self {
            planes,
            camera,
            camera_from_robot: robot_from_camera.inner.inverse(),
            tuning,
        }
    }

    /// A region of the frame.
    pub(crate) fn region(&self, index: usize) -> &'a PlaneRegion {
        &self.planes.regions[index]
    }

    /// Height of the camera above the ground, m.
    fn height_m(&self) -> f64 {
        self.planes.robot_from_camera.inner.translation.z
    }

    /// Whether the camera is high enough above a surface at this height, m, to look at it.
    pub(crate) fn looks_down_on(&self, height_m: f64) -> bool {
        self.height_m() - height_m > self.tuning.least_below
    }

    /// How wide the fringes of a surface are, `away_m` away, m: what one row of pixels covers.
    pub(crate) fn fringe_m(&self, height_m: f64, away_m: f64) -> f64 {
        let below_m = (self.height_m() - height_m).max(self.tuning.least_below);
        let row_m = (below_m.powi(2) + away_m.powi(2)) / (self.camera.focal_px * below_m);
        row_m.max(self.tuning.fringe)
    }

    /// Where the ray through a place of the image (column, row) meets the level at this height; `None` where it does not.
    pub(crate) fn on_level(&self, [col, row]: [f64; 2], height_m: f64) -> Option<Point2<f64>> {
        let eye = &self.planes.robot_from_camera.inner;
        let (cx, cy) = self.camera.principal_point_px();
        let ray = Vector3::new(
            (col - cx) / self.camera.focal_px,
            (row - cy) / self.camera.focal_px,
            1.0,
        );
        let ray = eye.rotation * ray;
        let from = eye.translation.vector;
        let along = (height_m - from.z) / ray.z;
        (along > 0.0).then(|| (from + ray * along).xy().into())
    }

    /// Column and row at which a point would be seen, px; `None` behind the camera.
    fn pixel(&self, point: &Point3<f64>) -> Option<Vector2<f64>> {
        let seen = self.camera_from_robot * point;
        let (cx, cy) = self.camera.principal_point_px();
        (seen.z > self.tuning.nearest_depth).then(|| {
            Vector2::new(
                cx + self.camera.focal_px * seen.x / seen.z,
                cy + self.camera.focal_px * seen.y / seen.z,
            )
        })
    }

    /// Index of the pixel at a place of the image; `None` outside.
    fn index(&self, pixel: &Vector2<f64>) -> Option<usize> {
        let (col, row) = (pixel.x.round(), pixel.y.round());
        let inside = col >= 0.0
            && row >= 0.0
            && col < self.camera.width as f64
            && row < self.camera.height as f64;
        inside.then(|| row as usize * self.camera.width + col as usize)
    }

    /// Whether a place is in the picture, whatever shows there.
    pub(crate) fn contains(&self, place: &Point3<f64>) -> bool {
        let pixel = self.pixel(place);
        pixel.is_some_and(|pixel| self.index(&pixel).is_some())
    }

    /// What the pixel shows against a surface at this height; `None` where nothing was seen.
    fn shows(&self, pixel: &Vector2<f64>, height_m: f64) -> Option<Shows> {
        let at = self.index(pixel)?;
        let point = self.planes.points_in_robot_m[at].map(f64::from);
        if point[2].is_nan() {
            return None;
        }
        let level_m = f64::from(self.planes.floor_height_m[at]);
        let same_m = self.tuning.same_height;
        let (above_m, slack_m) = if level_m.is_nan() {
            let eye = self.planes.robot_from_camera.inner.translation.vector;
            let away = (Point3::from(point).coords - eye).norm_squared();
            (
                point[2] - height_m,
                same_m + self.tuning.height_noise * away,
            )
        } else {
            (level_m - height_m, same_m)
        };
        Some(if above_m > slack_m {
            Shows::Higher
        } else if above_m < -slack_m {
            Shows::Lower
        } else {
            Shows::Surface
        })
    }

    /// What is seen at a place of a surface at the place's height; `None` out of view or where nothing was seen.
    pub(crate) fn shows_at(&self, place: &Point3<f64>) -> Option<Shows> {
        self.shows(&self.pixel(place)?, place.z)
    }

    /// Whether a level surface that is higher than this place of another one is seen there, and lies over it.
    pub(crate) fn is_covered(&self, place: &Point3<f64>) -> bool {
        let at = self.pixel(place).and_then(|pixel| self.index(&pixel));
        let label = at.map_or(0, |at| usize::from(self.planes.labels[at]));
        let region = label
            .checked_sub(1)
            .and_then(|index| self.planes.regions.get(index));
        region.is_some_and(|region| {
            let higher = (region.floor_height_m)
                .is_some_and(|height_m| height_m - place.z > self.tuning.same_height);
            let over = |outline: &Outline| outline.contains(&place.xy());
            higher && region.boundary.as_ref().is_some_and(over)
        })
    }

    /// Shares of the places just beyond a side, from `a` to `b`, that show something lower and something higher than it.
    /// What is out of view shows nothing.
    pub(crate) fn beyond(&self, [a, b]: [&Point3<f64>; 2], outward: &Vector2<f64>) -> BeyondSide {
        let mut found = BeyondSide::default();
        let places = self.tuning.places;
        for i in 0..places {
            let share = (i as f64 + 1.0) / (places as f64 + 1.0);
            let on = a + (b - a) * share;
            let out = on + outward.push(0.0) * self.tuning.outward;
            let (Some(from), Some(to)) = (self.pixel(&on), self.pixel(&out)) else {
                continue;
            };
            let length = (to - from).norm();
            if length < 1e-6 {
                continue;
            }
            let outwards = (to - from) / length;
            let shows = self
                .tuning
                .beyond
                .map(|px| self.shows(&(from + outwards * px), on.z));
            let other = |shows: &Option<Shows>| !matches!(shows, None | Some(Shows::Surface));
            match shows.into_iter().find(other).flatten() {
                Some(Shows::Lower) => found.lower += 1.0 / places as f64,
                Some(Shows::Higher) => found.higher += 1.0 / places as f64,
                Some(Shows::Surface) | None => {}
            }
        }
        found
    }
}

/// Shares of the places just beyond a side of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct BeyondSide {
    /// Share of the places that show something lower.
    pub(crate) lower: f64,
    /// Share of the places that show something higher.
    pub(crate) higher: f64,
}

impl BeyondSide {
    /// Share of the places that show something of another height.
    pub(crate) fn any(&self) -> f64 {
        self.lower + self.higher
    }
}
