//! Boxes on a floor, seen by a perfect depth camera: the worlds of the map's tests and of its bench.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its part")]

pub mod heights;
pub mod terrain;

use geometry::{Camera, Cell, Map, Pose, Robot};
use mapping::{FloorView, FogConfig, Surface};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use segmentation::Planes;
use sensing::Intrinsics;

pub const WIDTH: usize = 88;
pub const HEIGHT: usize = 72;
pub const CAMERA: Intrinsics = Intrinsics {
    width: WIDTH,
    height: HEIGHT,
    focal_px: 101.2,
    baseline_m: 0.06,
};
/// The depth camera of 002: 58 x 45 degrees.
pub const DEPTH_CAMERA: Intrinsics = Intrinsics {
    width: 320,
    height: 240,
    focal_px: 288.7,
    baseline_m: 0.075,
};

/// The size of 000: 16 layers that stay where they are.
pub fn paper() -> FogConfig {
    FogConfig {
        layers: 16,
        follow_height: false,
        floor_beside: 0.0,
        shadow: 0.0,
        rough: None,
        ..FogConfig::default()
    }
}

/// A block; its top is a floor to step on where `flat`.
#[derive(Debug, Clone, Copy)]
pub struct Block {
    pub min: [f64; 3],
    pub max: [f64; 3],
    pub flat: bool,
}

impl Block {
    pub fn new(min: [f64; 3], max: [f64; 3], flat: bool) -> Self {
        Self { min, max, flat }
    }

    /// Distance along the ray, and whether its top was met.
    fn meet(&self, from: Vector3<f64>, along: Vector3<f64>) -> Option<(f64, bool)> {
        let (mut enter, mut leave, mut top) = (0.0_f64, f64::INFINITY, false);
        for a in 0..3 {
            let (t0, t1) = (
                (self.min[a] - from[a]) / along[a],
                (self.max[a] - from[a]) / along[a],
            );
            if t0.min(t1) > enter {
                enter = t0.min(t1);
                top = a == 2 && along[2] < 0.0;
            }
            leave = leave.min(t0.max(t1));
        }
        (enter < leave && enter > 0.0).then_some((enter, top))
    }
}

/// The pose of a camera at a height, looking down by `pitch_rad` and to the left by `pan_rad`.
pub fn camera(height_m: f64, pitch_rad: f64, pan_rad: f64) -> Pose<Robot, Camera> {
    // Optical axes in a frame that looks along x.
    let optical = Rotation3::from_matrix_unchecked(Matrix3::new(
        0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0,
    ));
    let turned = Rotation3::from_euler_angles(0.0, pitch_rad, pan_rad) * optical;
    Pose::wrap(Isometry3::from_parts(
        Translation3::new(0.0, 0.0, height_m),
        UnitQuaternion::from_rotation_matrix(&turned),
    ))
}

/// What a perfect sensor and a perfect segmenter make of blocks on the ground z = 0.
pub fn look(
    blocks: &[Block],
    map_from_robot: &Pose<Map, Robot>,
    robot_from_camera: Pose<Robot, Camera>,
) -> Planes {
    look_through(CAMERA, blocks, map_from_robot, robot_from_camera)
}

/// Planes of a scene through another camera.
pub fn look_through(
    camera: Intrinsics,
    blocks: &[Block],
    map_from_robot: &Pose<Map, Robot>,
    robot_from_camera: Pose<Robot, Camera>,
) -> Planes {
    let mut planes = Planes::new(camera.width * camera.height);
    planes.robot_from_camera = robot_from_camera;
    planes.camera = Some(camera);
    planes.reliable = true;
    let map_from_camera = (*map_from_robot * robot_from_camera).inner;
    let robot_from_map = map_from_robot.inner.inverse();
    let eye = map_from_camera.translation.vector;
    let (centre_col, centre_row) = camera.principal_point_px();
    for row in 0..camera.height {
        for col in 0..camera.width {
            let (u, v) = (col as f64 - centre_col, row as f64 - centre_row);
            let [u, v] = [u, v].map(|px| px / camera.focal_px);
            let along = map_from_camera.rotation * Vector3::new(u, v, 1.0);
            let ground = (along.z < 0.0).then(|| (-eye.z / along.z, Some(0.0)));
            let nearest = blocks
                .iter()
                .filter_map(|block| {
                    let (t, top) = block.meet(eye, along)?;
                    Some((t, (top && block.flat).then_some(block.max[2])))
                })
                .chain(ground)
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((t, height)) = nearest.filter(|&(t, _)| t < 4.0) {
                let point = robot_from_map * nalgebra::Point3::from(eye + along * t);
                let index = row * camera.width + col;
                planes.points_in_robot_m[index] = [point.x as f32, point.y as f32, point.z as f32];
                let above_robot = height.map(|h| h - map_from_robot.inner.translation.z);
                planes.floor_height_m[index] = above_robot.map_or(f32::NAN, |h| h as f32);
            }
        }
    }
    planes
}

/// Cells of a view whose whole square lies within the rectangle.
pub fn interior(view: &FloorView, min: [f64; 2], max: [f64; 2]) -> Vec<Cell> {
    let half = 0.5 * view.lattice.cell_m;
    let inside = |cell: &Cell| {
        let at = view.lattice.center_of(*cell);
        (0..2).all(|a| at[a] - half > min[a] - 1e-9 && at[a] + half < max[a] + 1e-9)
    };
    let cells: Vec<_> = view.cells.area().cells().filter(inside).collect();
    assert!(!cells.is_empty());
    cells
}

pub fn is_obstacle(surface: Surface) -> bool {
    matches!(surface, Surface::Obstacle(_))
}
