//! The points of one frame in the map frame, with their ranges.

use geometry::{Lattice, Map, Pose, Robot};
use segmentation::Planes;

use crate::surface::{MatchingTuning, Pair, height_shift};

/// A point and how far from the sensor it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SensedPoint {
    /// Position from the robot along the axes of the map frame, m.
    pub from_robot_m: [f32; 3],
    /// Distance from the sensor, m.
    pub range_m: f32,
    cell: u32,
}

impl SensedPoint {
    /// The cell of a point beside the window.
    const BESIDE: u32 = u32::MAX;

    /// Where its cell is stored in the window, row by row; none beside it.
    #[inline]
    pub(crate) fn cell(&self) -> Option<usize> {
        (self.cell != Self::BESIDE).then_some(self.cell as usize)
    }
}

/// The points of one frame and where they were seen from. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub(crate) struct SensedFrame {
    /// The robot in the map frame, m.
    robot_m: [f64; 3],
    /// The sensor from the robot along the axes of the map frame, m.
    eye_from_robot_m: [f32; 3],
    /// The sensor in the map frame, m.
    pub eye_m: [f64; 3],
    /// What was seen.
    pub points: Vec<SensedPoint>,
    pairs: Vec<Pair>,
}

/// Finds the cells of points in 32 bits.
#[derive(Debug, Clone, Copy)]
struct InWindow {
    /// Where the robot is, in cells from the corner of the window.
    robot: [f32; 2],
    per_metre: f32,
    /// Columns and rows.
    size: [f32; 2],
    cols: u32,
}

impl InWindow {
    fn new(robot_m: [f64; 3], (lattice, size): (Lattice, [usize; 2])) -> Self {
        let cells = |axis: usize| (robot_m[axis] - lattice.origin_m[axis]) / lattice.cell_m;
        Self {
            robot: [cells(0) as f32, cells(1) as f32],
            per_metre: (1.0 / lattice.cell_m) as f32,
            size: [size[0] as f32, size[1] as f32],
            cols: size[0] as u32,
        }
    }

    /// Where the cell of a point is stored, its position given from the robot.
    #[inline]
    fn index_at(&self, from_robot_m: [f32; 3]) -> u32 {
        let col = self.robot[0] + from_robot_m[0] * self.per_metre;
        let row = self.robot[1] + from_robot_m[1] * self.per_metre;
        if col >= 0.0 && row >= 0.0 && col < self.size[0] && row < self.size[1] {
            row as u32 * self.cols + col as u32
        } else {
            SensedPoint::BESIDE
        }
    }
}

impl SensedFrame {
    /// Carries the points up to `max_range_m` away to the map frame, and finds their cells in a window of so many columns and rows. Those at the
    /// edge of a step tell of neither surface and are left out.
    pub(crate) fn read(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
        max_range_m: f64,
        place: (Lattice, [usize; 2]),
    ) {
        let eye = planes.robot_from_camera.origin().inner.coords;
        let rotation = *map_from_robot.inner.rotation.to_rotation_matrix().matrix();
        let robot = map_from_robot.inner.translation.vector;
        self.eye_m = (rotation * eye + robot).into();
        self.robot_m = robot.into();
        self.eye_from_robot_m = (rotation * eye).map(|at_m| at_m as f32).into();
        let eye_m = eye.map(|at_m| at_m as f32);
        let rotation = rotation.map(|share| share as f32);
        let most = (max_range_m * max_range_m) as f32;
        let cell_of = InWindow::new(self.robot_m, place);
        self.points.clear();
        for (&[x, y, z], &at_step) in planes.points_in_robot_m.iter().zip(&planes.at_step) {
            let (right, up, on) = (x - eye_m.x, y - eye_m.y, z - eye_m.z);
            let squared = right * right + up * up + on * on;
            // What is no number is not near, either.
            let near = squared <= most;
            if at_step || !near {
                continue;
            }
            // Written out: nalgebra's product takes several times as long.
            let from_robot_m = [
                rotation.m11 * x + rotation.m12 * y + rotation.m13 * z,
                rotation.m21 * x + rotation.m22 * y + rotation.m23 * z,
                rotation.m31 * x + rotation.m32 * y + rotation.m33 * z,
            ];
            self.points.push(SensedPoint {
                from_robot_m,
                range_m: squared.sqrt(),
                cell: cell_of.index_at(from_robot_m),
            });
        }
    }

    /// Position of a point in the map frame, m.
    #[inline]
    pub(crate) fn at_m(&self, point: &SensedPoint) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.robot_m[axis] + f64::from(point.from_robot_m[axis]))
    }

    /// Position of a point from the sensor along the axes of the map frame, m.
    #[inline]
    pub(crate) fn eye_to_m(&self, point: &SensedPoint) -> [f32; 3] {
        let [x, y, z] = point.from_robot_m;
        let [eye_x, eye_y, eye_z] = self.eye_from_robot_m;
        [x - eye_x, y - eye_y, z - eye_z]
    }

    /// Height of a point in the map frame, m.
    #[inline]
    pub(crate) fn height_m(&self, point: &SensedPoint) -> f32 {
        self.robot_m[2] as f32 + point.from_robot_m[2]
    }

    /// The shift that brings the frame onto the heights that are known, m, where enough points agree on one; `known_m`: what is known nearest to
    /// a height in a cell, m.
    pub(crate) fn shift_m(
        &mut self,
        known_m: impl Fn(usize, f32) -> Option<f32>,
        gate: (f64, usize),
        tuning: &MatchingTuning,
    ) -> Option<f64> {
        let mut pairs = std::mem::take(&mut self.pairs);
        let pair = |point: &SensedPoint| {
            let height_m = self.height_m(point);
            Some(Pair {
                residual_m: f64::from(known_m(point.cell()?, height_m)? - height_m),
                weight: 1,
            })
        };
        let found = self.points.iter().filter_map(pair);
        let shift_m = height_shift(found, gate, tuning, &mut pairs);
        self.pairs = pairs;
        shift_m
    }

    /// Whether the frame is of use: its heights may be trusted, or a shift, m, brings it onto those that are known, by which it is moved. The
    /// ground that the robot stands on tells a frame's height best: where that is seen, no shift is asked for.
    pub(crate) fn settle(&mut self, planes: &Planes, shift_m: Option<f64>) -> bool {
        if let Some(shift_m) = shift_m {
            self.eye_m[2] += shift_m;
            self.robot_m[2] += shift_m;
        }
        planes.reliable || shift_m.is_some()
    }
}
