//! Exact disparities of a ground plane and boxes, and the errors of block matching on top.

use geometry::{Camera, GOLDEN, Pose, Robot, SplitMix64};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use sensing::{Intrinsics, Scan};

/// The small humanoid's camera.
pub const CAMERA: Intrinsics = Intrinsics {
    width: 88,
    height: 72,
    focal_px: 101.2,
    baseline_m: 0.06,
};

/// Seeded random numbers of several kinds.
pub struct Noise(SplitMix64);

impl Noise {
    /// A stream of its own for each seed.
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::new(
            seed.wrapping_mul(GOLDEN) ^ 0x5851_F42D_4C95_7F2D,
        ))
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        self.0.uniform()
    }

    /// Uniform between -limit and limit.
    pub fn within(&mut self, limit: f64) -> f64 {
        limit * (2.0 * self.uniform() - 1.0)
    }

    /// Normal with sigma 1: twelve uniforms.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    /// Adds noise of this sigma that is the mean over 5x5 windows, as block matching has it.
    pub fn correlated(&mut self, width: usize, sigma_px: f64, image: &mut [f32]) {
        let height = image.len() / width;
        let (wide, high) = (width + 4, height + 4);
        let white: Vec<f64> = (0..wide * high).map(|_| self.normal()).collect();
        for row in 0..height {
            for col in 0..width {
                let sum: f64 = (0..25)
                    .map(|i| white[(row + i / 5) * wide + col + i % 5])
                    .sum();
                image[row * width + col] += (sum / 5.0 * sigma_px) as f32;
            }
        }
    }
}

/// An upright box: its lowest and its highest corner, m, world = robot frame.
#[derive(Debug, Clone, Copy)]
pub struct Block {
    /// Its lowest corner in the robot frame, m.
    pub low_m: [f64; 3],
    /// Its highest corner, m.
    pub high_m: [f64; 3],
}

/// The ground z = 0 where `ground`, and blocks.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// Whether there is ground at height 0.
    pub ground: bool,
    /// What stands on it.
    pub blocks: Vec<Block>,
}

/// Label of a pixel that saw nothing.
pub const NOTHING: u16 = 0;
/// Label of the ground; a block's top has twice its number from 1 on plus this, its sides one less than its top.
pub const GROUND: u16 = 1;

/// A camera 0.5 m above the ground that looks down by `tilt_rad` and left by `pan_rad`.
pub fn camera_pose(pan_rad: f64, tilt_rad: f64) -> Pose<Robot, Camera> {
    let optical =
        Rotation3::from_matrix_unchecked(Matrix3::new(0., 0., 1., -1., 0., 0., 0., -1., 0.));
    let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), pan_rad)
        * Rotation3::from_axis_angle(&Vector3::y_axis(), tilt_rad)
        * optical;
    Pose::wrap(Isometry3::from_parts(
        Translation3::new(0.04, 0.0, 0.5),
        UnitQuaternion::from_rotation_matrix(&rotation),
    ))
}

impl Scene {
    /// Open floor.
    pub fn floor() -> Self {
        Self {
            ground: true,
            blocks: Vec::new(),
        }
    }

    /// Open floor and blocks.
    pub fn with(blocks: &[Block]) -> Self {
        Self {
            ground: true,
            blocks: blocks.to_vec(),
        }
    }

    /// Steps across the way, the first edge at `front_m`.
    pub fn stairs(front_m: f64, rise_m: f64, tread_m: f64, steps: usize) -> Self {
        let block = |i: usize| {
            let end = if i + 1 == steps { 1.5 } else { tread_m };
            let front = front_m + i as f64 * tread_m;
            Block {
                low_m: [front, -0.6, 0.0],
                high_m: [front + end, 0.6, (i + 1) as f64 * rise_m],
            }
        };
        Self::with(&(0..steps).map(block).collect::<Vec<_>>())
    }

    /// Depth along the ray (direction with camera z = 1) and label of what it meets first.
    fn meet(&self, from: &Vector3<f64>, ray: &Vector3<f64>) -> Option<(f64, u16)> {
        let mut best: Option<(f64, u16)> = None;
        if self.ground && ray.z < 0.0 {
            best = Some((-from.z / ray.z, GROUND));
        }
        for (i, block) in self.blocks.iter().enumerate() {
            let (mut enter, mut leave, mut axis_in) = (0.0, f64::INFINITY, 3);
            for axis in 0..3 {
                let a = (block.low_m[axis] - from[axis]) / ray[axis];
                let b = (block.high_m[axis] - from[axis]) / ray[axis];
                if a.min(b) > enter {
                    enter = a.min(b);
                    axis_in = axis;
                }
                leave = f64::min(leave, a.max(b));
            }
            if axis_in < 3 && enter < leave && best.is_none_or(|(depth, _)| enter < depth) {
                best = Some((
                    enter,
                    GROUND + 2 * i as u16 + if axis_in == 2 { 2 } else { 1 },
                ));
            }
        }
        best
    }

    /// Exact disparities and labels from this camera pose; farther than 4 m counts as nothing.
    pub fn exact(&self, truth: &Pose<Robot, Camera>) -> (Vec<f32>, Vec<u16>) {
        let (mut disparity, mut labels) = (Vec::new(), Vec::new());
        for row in 0..CAMERA.height {
            for col in 0..CAMERA.width {
                let ray = truth.inner.rotation * Vector3::from(CAMERA.ray(col, row));
                match self.meet(&truth.inner.translation.vector, &ray) {
                    Some((depth, label)) if depth < 4.0 => {
                        disparity.push(CAMERA.disparity_px(depth) as f32);
                        labels.push(label);
                    }
                    _ => {
                        disparity.push(f32::NAN);
                        labels.push(NOTHING);
                    }
                }
            }
        }
        (disparity, labels)
    }

    /// A scan as the sensor would give it: correlated noise, 5 % drop-outs in clumps, 0.7 % mismatches, no border.
    pub fn scan(
        &self,
        truth: &Pose<Robot, Camera>,
        believed: Pose<Robot, Camera>,
        sigma_px: f64,
        noise: &mut Noise,
    ) -> Scan {
        let (mut disparity, _) = self.exact(truth);
        noise.correlated(CAMERA.width, sigma_px, &mut disparity);
        let mut luck = vec![0.0_f32; disparity.len()];
        noise.correlated(CAMERA.width, 1.0, &mut luck);
        for (at, value) in disparity.iter_mut().enumerate() {
            let (col, row) = (at % CAMERA.width, at / CAMERA.width);
            let border = col < 2 || row < 2 || col + 2 >= CAMERA.width || row + 2 >= CAMERA.height;
            if luck[at] > 1.645 || border {
                *value = f32::NAN;
            } else if noise.uniform() < 0.007 {
                *value = (1.5 + 22.5 * noise.uniform()) as f32;
            }
        }
        let mut scan = Scan::new(CAMERA);
        scan.robot_from_camera = believed;
        scan.valid = disparity.iter().filter(|d| !d.is_nan()).count();
        scan.disparity_px = disparity;
        scan
    }
}
