//! Labelled points of one frame in the map frame: steps 1 and 2 of the update in 000, section III.A.

use geometry::{Lattice, Map, Pose, Robot};
use nalgebra::{Point3, Vector3};
use segmentation::Planes;

use crate::MapError;
use volume::{Locator, Picture, Ray};

/// Refuses poses that are no numbers, before anything is changed by them.
pub(crate) fn check_poses(
    planes: &Planes,
    map_from_robot: &Pose<Map, Robot>,
) -> Result<(), MapError> {
    let finite = |pose: &nalgebra::Isometry3<f64>| pose.to_matrix().iter().all(|v| v.is_finite());
    if !finite(&map_from_robot.inner) {
        return Err(MapError::PoseNotFinite);
    }
    if !finite(&planes.robot_from_camera.inner) {
        return Err(MapError::Failed("the camera's pose must be finite".into()));
    }
    Ok(())
}

/// A point with the height of the floor that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LabelledPoint {
    /// Its position in the map frame, m.
    pub position_m: [f64; 3],
    /// Height of its horizontal plane in the map frame, m; NaN is *invalid*.
    pub floor_height_m: f64,
    /// Whether something was seen here; false: only the way to it was seen to be free, as that of a ray cut at the longest range.
    pub hit: bool,
    /// Whether it lies on a surface that is too rough for a floor; none where that cannot be told.
    pub rough: Option<bool>,
    /// Number of its pixel, row by row.
    pub pixel: u32,
    /// Label of its surface.
    pub label: u16,
}

/// How a frame's points are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Points on a horizontal plane are moved along their ray to its height where that stretches the ray by less than this factor,
    /// and shortens it by less; none are where there is no factor.
    pub snap_stretch: Option<f64>,
    /// Points further away only tell that the way is free so far, m.
    pub max_range_m: f64,
    /// Points on no plane that are further away over the ground, m, and stand out by less than `delta_m` of what the robot stands on
    /// may as well be floor: they are no hits.
    pub sure_range_m: f64,
    /// How far an obstacle stands out at least, m.
    pub delta_m: f64,
    /// Level surfaces that are more times as rough as the ground are no floor.
    pub rough: f32,
}

/// One frame's points and where they were seen from. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct LabelledFrame {
    /// The camera in the map frame, m.
    pub eye_m: [f64; 3],
    /// What was seen.
    pub points: Vec<LabelledPoint>,
    /// The picture of which the pixels are, where they are one.
    pub picture: Option<Picture>,
    /// Whether the surface of a label is too rough for a floor.
    rough: Vec<Option<bool>>,
    /// Where the cell of each point is stored; none outside of the grid.
    cells: Vec<Option<u32>>,
    /// How much the surface of a label rises per metre along the map's axes.
    gradients: Vec<[f32; 2]>,
}

impl LabelledFrame {
    /// Carries the points to the map frame: turned by the heading, moved by the position, `h_G = h_R + z_R`.
    /// Those at the edge of a step tell of neither surface and are left out.
    pub fn read(&mut self, planes: &Planes, map_from_robot: &Pose<Map, Robot>, reading: Reading) {
        let eye = (*map_from_robot * planes.robot_from_camera.origin()).inner;
        self.eye_m = [eye.x, eye.y, eye.z];
        self.points.clear();
        self.picture = picture(planes, map_from_robot);
        let rotation = map_from_robot.inner.rotation.to_rotation_matrix();
        let translation = map_from_robot.inner.translation.vector;
        self.rough.clear();
        self.rough.push(None);
        let regions = planes.regions.iter();
        self.rough
            .extend(regions.map(|region| Some(region.roughness? > reading.rough)));
        self.gradients.clear();
        self.gradients.push([0.0; 2]);
        let regions = planes.regions.iter();
        self.gradients
            .extend(regions.map(|region| match region.floor_height_m {
                Some(_) => [0.0; 2],
                None => gradient(&(rotation * region.plane.normal)),
            }));
        let surfaces = planes.floor_height_m.iter().zip(&planes.labels);
        let pixels = planes.points_in_robot_m.iter().zip(surfaces);
        for (pixel, ((point, (&height, &label)), &at_step)) in
            (0..).zip(pixels.zip(&planes.at_step))
        {
            let [x, y, z] = point.map(f64::from);
            let rough = self.rough.get(usize::from(label)).copied().flatten();
            let height = if rough == Some(true) {
                f32::NAN
            } else {
                height
            };
            if at_step || !(x + y + z).is_finite() {
                continue;
            }
            let mut at = rotation * Point3::new(x, y, z) + translation;
            let floor_height_m = f64::from(height) + translation.z;
            if let Some(most) = reading.snap_stretch
                && let Some(factor) = snap_factor(eye.z, at.z, floor_height_m, most)
            {
                at = eye + (at - eye) * factor;
            }
            let range_m = (at - eye).norm();
            let seen = range_m <= reading.max_range_m;
            if !seen {
                at = eye + (at - eye) * (reading.max_range_m / range_m);
            }
            let far = (at - eye).xy().norm() > reading.sure_range_m;
            let stands_out = at.z > translation.z + reading.delta_m;
            self.points.push(LabelledPoint {
                position_m: [at.x, at.y, at.z],
                floor_height_m: if seen { floor_height_m } else { f64::NAN },
                rough: rough.filter(|_| !far),
                hit: seen && (stands_out || !far || !floor_height_m.is_nan()),
                pixel,
                label,
            });
        }
    }

    /// Finds the points' cells in a grid with so many columns and rows; to be told again when points are others.
    pub fn locate(&mut self, lattice: &Lattice, size: [usize; 2]) {
        let locator = Locator::of_cells(lattice, size);
        self.cells.clear();
        self.cells.extend(self.points.iter().map(|point| {
            let [x_m, y_m, _] = point.position_m;
            locator.index_at([x_m, y_m]).map(|index| index as u32)
        }));
    }

    /// The points, each with where its cell is stored; none outside of the grid.
    pub(crate) fn located(&self) -> impl Iterator<Item = (&LabelledPoint, Option<usize>)> {
        assert_eq!(self.cells.len(), self.points.len(), "locate first");
        let cells = self.cells.iter();
        let cells = cells.map(|cell| cell.map(|index| index as usize));
        self.points.iter().zip(cells)
    }

    /// How much the surface of a label rises per metre along the map's axes.
    pub fn gradient(&self, label: u16) -> [f32; 2] {
        let gradient = self.gradients.get(usize::from(label));
        gradient.copied().unwrap_or_default()
    }

    /// Moves the whole frame up.
    pub fn raise(&mut self, height_m: f64) {
        self.eye_m[2] += height_m;
        for point in &mut self.points {
            point.position_m[2] += height_m;
            point.floor_height_m += height_m;
        }
    }

    /// Points of floors that cannot have been seen where they seem to lie, as `hidden` says of their position and cell: all that
    /// they tell is that the way there is free.
    pub(crate) fn disbelieve(&mut self, hidden: impl Fn([f64; 3], Option<usize>) -> bool) {
        for (point, cell) in self.points.iter_mut().zip(&self.cells) {
            let cell = cell.map(|index| index as usize);
            if !point.floor_height_m.is_nan() && hidden(point.position_m, cell) {
                (point.floor_height_m, point.hit) = (f64::NAN, false);
            }
        }
    }

    /// The lines of sight, each with the number of its pixel.
    pub fn rays(&self) -> impl Iterator<Item = (usize, Ray)> {
        self.points.iter().map(|point| {
            let ray = Ray {
                end_m: point.position_m,
                hit: point.hit,
            };
            (point.pixel as usize, ray)
        })
    }
}

/// Rise per metre of a plane with this normal.
fn gradient(normal: &Vector3<f64>) -> [f32; 2] {
    [normal.x, normal.y].map(|across| (-across / normal.z) as f32)
}

/// How the pixels' lines of sight lie side by side in the map frame.
fn picture(planes: &Planes, map_from_robot: &Pose<Map, Robot>) -> Option<Picture> {
    let camera = planes.camera?;
    let (col, row) = camera.principal_point_px();
    Some(Picture {
        size_px: [camera.width, camera.height],
        focal_px: [camera.focal_px; 2],
        centre_px: [col, row],
        axes: Picture::axes_of(&(*map_from_robot * planes.robot_from_camera)),
    })
}

/// By how much a ray is stretched to end at its plane's height; `None` where that is no small correction.
fn snap_factor(eye_z_m: f64, z_m: f64, floor_height_m: f64, most: f64) -> Option<f64> {
    let factor = (floor_height_m - eye_z_m) / (z_m - eye_z_m);
    (factor > 1.0 / most && factor < most).then_some(factor)
}

#[cfg(test)]
mod tests;
