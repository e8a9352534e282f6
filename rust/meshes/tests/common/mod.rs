//! Blocks on a floor, as a depth camera of known noise sees them.
#![allow(dead_code, unreachable_pub, reason = "each test file uses its part")]

pub mod fused;

use meshes::{JoiningConfig, JoiningRule};
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use sensing::{PinholeCamera, RangeNoise};

pub use geometry::SplitMix64;

/// The depth camera of 002: 58 x 45 degrees, at half of its pixels.
pub const CAMERA: PinholeCamera = PinholeCamera {
    size_px: [160, 120],
    focal_px: [144.3, 144.3],
    centre_px: [79.5, 59.5],
};

/// As the elevation grid has it by default.
pub const NOISE: RangeNoise = RangeNoise {
    sigma_m: 0.004,
    per_metre: 0.01,
};

pub fn rule(noise: RangeNoise) -> JoiningRule {
    JoiningRule::new(&JoiningConfig::default(), noise)
}

/// Nearly normal, of mean 0 and deviation 1.
pub fn normal(luck: &mut SplitMix64) -> f64 {
    (0..12).map(|_| luck.uniform()).sum::<f64>() - 6.0
}

/// Blocks, each from its lowest corner to its highest, m, above a floor at z = 0.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    pub blocks: Vec<[[f64; 3]; 2]>,
}

impl Scene {
    /// A table of this height without legs, 3 cm thick.
    pub fn table(height_m: f64) -> Self {
        Self {
            blocks: vec![[[0.6, -0.3, height_m - 0.03], [1.1, 0.35, height_m]]],
        }
    }

    /// Two boxes and a sill.
    pub fn boxes() -> Self {
        Self {
            blocks: vec![
                [[0.9, -0.5, 0.0], [1.2, -0.1, 0.25]],
                [[1.1, 0.2, 0.0], [1.3, 0.6, 0.12]],
                [[0.6, -0.1, 0.0], [0.75, 0.6, 0.05]],
            ],
        }
    }

    /// How far along a ray something is, in lengths of its direction, and what: 0 the floor, else a block's number plus one.
    pub fn meet(&self, eye: Vector3<f64>, along: Vector3<f64>) -> Option<(f64, usize)> {
        let floor = (along.z < 0.0).then(|| (-eye.z / along.z, 0));
        let blocks = self
            .blocks
            .iter()
            .enumerate()
            .filter_map(|(number, block)| {
                let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
                for axis in 0..3 {
                    let at = [0, 1].map(|end: usize| (block[end][axis] - eye[axis]) / along[axis]);
                    enter = enter.max(at[0].min(at[1]));
                    leave = leave.min(at[0].max(at[1]));
                }
                (enter < leave && enter > 0.0).then_some((enter, number + 1))
            });
        blocks.chain(floor).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// How far a place is from the nearest surface, m.
    pub fn distance_m(&self, at: Vector3<f64>) -> f64 {
        let blocks = self.blocks.iter().map(|[low, high]| {
            let off = [0, 1, 2].map(|axis| (low[axis] - at[axis]).max(at[axis] - high[axis]));
            let inside = off.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if inside <= 0.0 {
                -inside
            } else {
                Vector3::from(off.map(|part| part.max(0.0))).norm()
            }
        });
        blocks.fold(at.z.abs(), f64::min)
    }

    /// What a camera sees that stands like this: points of its frame, m, the error along each sight line drawn, and what each is of.
    pub fn look(
        &self,
        camera: PinholeCamera,
        map_from_camera: &Isometry3<f64>,
        noise: RangeNoise,
        luck: &mut SplitMix64,
    ) -> (Vec<[f32; 3]>, Vec<usize>) {
        let [width, height] = camera.size_px;
        let eye = map_from_camera.translation.vector;
        let pixels = (0..height).flat_map(|row| (0..width).map(move |col| [col, row]));
        let seen = pixels.map(|[col, row]| {
            let along = ray(camera, [col as f64, row as f64]);
            let met = self.meet(eye, map_from_camera.rotation * along);
            let Some((t, what)) = met.filter(|(t, _)| *t < 4.0) else {
                return ([f32::NAN; 3], usize::MAX);
            };
            let range_m = t * along.norm();
            let error_m = f64::from(noise.deviation_m(range_m as f32)) * normal(luck);
            let at = along * (t * (1.0 + error_m / range_m));
            (at.cast().into(), what)
        });
        seen.unzip()
    }
}

/// Along a pixel's sight line in the camera's frame, with z = 1.
pub fn ray(camera: PinholeCamera, px: [f64; 2]) -> Vector3<f64> {
    let [x, y] =
        [0, 1].map(|axis: usize| (px[axis] - camera.centre_px[axis]) / camera.focal_px[axis]);
    Vector3::new(x, y, 1.0)
}

/// A camera at a place, looking down by `pitch_rad`, turned to the left by `pan_rad`.
pub fn standing(at_m: [f64; 3], pitch_rad: f64, pan_rad: f64) -> Isometry3<f64> {
    let optical = Rotation3::from_matrix_unchecked(Matrix3::new(
        0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0,
    ));
    let turned = Rotation3::from_euler_angles(0.0, pitch_rad, pan_rad) * optical;
    Isometry3::from_parts(
        Translation3::from(at_m),
        UnitQuaternion::from_rotation_matrix(&turned),
    )
}

/// Of the map frame what a camera has seen.
pub fn placed(map_from_camera: &Isometry3<f64>, at_m: [f32; 3]) -> Vector3<f64> {
    (map_from_camera * Point3::from(at_m.map(f64::from))).coords
}
