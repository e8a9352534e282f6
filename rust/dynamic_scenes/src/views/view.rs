//! One look of a range sensor: how far it saw in each direction.

use std::f64::consts::{PI, TAU};

use geometry::{Camera, Map, Point, Pose, distance_m, wrap_angle};
use plan_view::PlanarScan;

use super::ViewsConfig;

/// The pixels of a depth camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureShape {
    /// Columns and rows.
    pub size_px: [usize; 2],
    /// Focal length along columns and rows, pixels.
    pub focal_px: [f64; 2],
    /// Column and row of the optical axis, pixels.
    pub centre_px: [f64; 2],
}

/// How directions are numbered.
#[derive(Debug, Clone)]
enum ViewDirections {
    /// Pixels, row by row; ranges are depths along the optical axis.
    Picture(PictureShape, Pose<Camera, Map>),
    /// Bins of bearings all around, in the plane; ranges are distances over it.
    Sweep {
        eye_m: [f64; 2],
        yaw_rad: f64,
        step_rad: f64,
    },
}

/// How far a sensor saw from one place, in the map frame.
#[derive(Debug, Clone)]
pub struct RangeView {
    time_s: f64,
    directions: ViewDirections,
    /// The range of each direction, m; NaN where nothing was seen.
    ranges_m: Vec<f32>,
    /// The nearest of a direction and those beside it, m; NaN where the direction itself saw nothing.
    nearest_m: Vec<f32>,
    /// Columns of the picture; 0 of a sweep.
    cols: usize,
}

impl RangeView {
    /// A depth picture: depths along the optical axis, m, row by row, NaN where nothing was seen. Depths beyond the picture's size are left out.
    pub fn of_picture(
        time_s: f64,
        map_from_camera: &Pose<Map, Camera>,
        shape: PictureShape,
        depths_m: Vec<f32>,
    ) -> Self {
        let [cols, rows] = shape.size_px;
        let mut ranges_m = depths_m;
        ranges_m.resize(cols * rows, f32::NAN);
        Self {
            time_s,
            directions: ViewDirections::Picture(shape, map_from_camera.inverse()),
            nearest_m: Vec::new(),
            ranges_m,
            cols,
        }
    }

    /// A scan of the plane. Its beams go into bins of bearings; beams that saw nothing say nothing.
    pub fn of_scan(time_s: f64, scan: &PlanarScan, config: &ViewsConfig) -> Self {
        let step_rad = config.bearing_step;
        let count = (TAU / step_rad).ceil() as usize;
        let mut ranges_m = vec![f32::NAN; count];
        for beam in scan.beams.iter().filter(|beam| beam.is_usable()) {
            if let Some(range_m) = beam.range_m {
                let slot = &mut ranges_m[bin(beam.bearing_rad, step_rad, count)];
                *slot = slot.min(range_m as f32); // of NaN and a number the number
            }
        }
        let pose = scan.map_from_sensor;
        Self {
            time_s,
            directions: ViewDirections::Sweep {
                eye_m: [pose.x_m, pose.y_m],
                yaw_rad: pose.yaw_rad,
                step_rad,
            },
            nearest_m: Vec::new(),
            ranges_m,
            cols: 0,
        }
    }

    /// Finds what is nearest beside each direction, so that points can be looked for behind it; until then it sees through nothing.
    #[must_use]
    pub(crate) fn prepared(mut self, config: &ViewsConfig) -> Self {
        let (reach, count) = (config.beside, self.ranges_m.len());
        let mut near = Vec::new();
        let mut nearest = |at: usize| {
            near.clear();
            if self.ranges_m[at].is_nan() {
                return f32::NAN;
            }
            if let Some(row) = at.checked_div(self.cols) {
                let col = at % self.cols;
                for row in row.saturating_sub(reach)..(row + reach + 1).min(count / self.cols) {
                    let line = &self.ranges_m[row * self.cols..(row + 1) * self.cols];
                    let end = (col + reach + 1).min(self.cols);
                    near.extend_from_slice(&line[col.saturating_sub(reach)..end]);
                }
            } else {
                let beside = (0..=2 * reach).map(|by| (at + count * reach + by - reach) % count);
                near.extend(beside.map(|at| self.ranges_m[at]));
            }
            lowest(&mut near, config.stray)
        };
        self.nearest_m = (0..count).map(&mut nearest).collect();
        self
    }

    /// When it was taken, s.
    pub const fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Where the sensor was over the ground, m in the map frame.
    pub fn eye_m(&self) -> [f64; 2] {
        match &self.directions {
            ViewDirections::Picture(_, camera_from_map) => {
                let eye = camera_from_map.inverse().origin().inner;
                [eye.x, eye.y]
            }
            ViewDirections::Sweep { eye_m, .. } => *eye_m,
        }
    }

    /// How far a point of the map frame, m, is from the sensor, and how far the sensor saw in that direction: the nearest of it and those beside it, and
    /// itself. None where the sensor saw nothing or did not look.
    pub(super) fn towards(&self, point_m: [f64; 3]) -> Option<[f64; 3]> {
        let (index, range_m) = self.direction(point_m)?;
        let nearest_m = f64::from(*self.nearest_m.get(index)?);
        (nearest_m > 0.0).then(|| [range_m, nearest_m, f64::from(self.ranges_m[index])])
    }

    /// How many of the directions right beside that of a point of the map frame, m, saw something at about its range, as `same` tells of two ranges, m: of 8
    /// in a picture, of 2 in a sweep. None where the point lies in no direction.
    pub(super) fn beside(
        &self,
        point_m: [f64; 3],
        same: impl Fn(f64, f64) -> bool,
    ) -> Option<usize> {
        let (index, range_m) = self.direction(point_m)?;
        let count = self.ranges_m.len();
        let alike = |at: usize| same(f64::from(self.ranges_m[at]), range_m);
        if self.cols == 0 {
            let both = [(index + 1) % count, (index + count - 1) % count];
            return Some(both.into_iter().filter(|at| alike(*at)).count());
        }
        let (row, col) = (index / self.cols, index % self.cols);
        let rows = row.saturating_sub(1)..(row + 2).min(count / self.cols);
        let around = rows.flat_map(|row| {
            let cols = col.saturating_sub(1)..(col + 2).min(self.cols);
            cols.map(move |col| row * self.cols + col)
        });
        Some(around.filter(|at| *at != index && alike(*at)).count())
    }

    /// Whether a point of the map frame, m, lies in the first or last columns of a picture, so many.
    pub(crate) fn is_at_side(&self, point_m: [f64; 3], columns: usize) -> bool {
        let col = self
            .direction(point_m)
            .map(|(index, _)| index % self.cols.max(1));
        self.cols > 0 && col.is_some_and(|col| col < columns || col + columns >= self.cols)
    }

    /// The direction in which a point of the map frame, m, lies, and its range, m.
    fn direction(&self, point_m: [f64; 3]) -> Option<(usize, f64)> {
        Some(match &self.directions {
            ViewDirections::Picture(shape, camera_from_map) => {
                let point = (*camera_from_map
                    * Point::<Map>::new(point_m[0], point_m[1], point_m[2]))
                .inner;
                let [col, row] = [(point.x, 0), (point.y, 1)].map(|(off, axis)| {
                    off / point.z * shape.focal_px[axis] + shape.centre_px[axis] + 0.5
                });
                let [cols, rows] = shape.size_px.map(|size| size as f64);
                let inside =
                    point.z > 0.0 && (0.0..cols).contains(&col) && (0.0..rows).contains(&row);
                inside.then(|| (row as usize * shape.size_px[0] + col as usize, point.z))?
            }
            ViewDirections::Sweep {
                eye_m,
                yaw_rad,
                step_rad,
            } => {
                let [right_m, up_m] = [point_m[0] - eye_m[0], point_m[1] - eye_m[1]];
                let bearing_rad = libm::atan2(up_m, right_m) - yaw_rad;
                let index = bin(bearing_rad, *step_rad, self.ranges_m.len());
                (index, distance_m([point_m[0], point_m[1]], *eye_m))
            }
        })
    }
}

/// The bin of a bearing, rad.
fn bin(bearing_rad: f64, step_rad: f64, count: usize) -> usize {
    (((wrap_angle(bearing_rad) + PI) / step_rad) as usize).min(count - 1)
}

/// The lowest of the numbers, but for this share of them, which may be errors; NaN without a number. Changes their order.
fn lowest(values: &mut Vec<f32>, stray: f64) -> f32 {
    values.retain(|value| !value.is_nan());
    let at = (stray * values.len() as f64) as usize;
    if at >= values.len() {
        return f32::NAN;
    }
    *values.select_nth_unstable_by(at, f32::total_cmp).1
}
