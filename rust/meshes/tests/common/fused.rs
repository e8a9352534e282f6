//! What cameras on a walk saw, fused.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use meshes::{
    FusedVolume, FusionConfig, JoiningConfig, PictureRanges, TriangleMesh, mesh_of_picture,
};
use nalgebra::{Isometry3, Vector3};

use super::{CAMERA, NOISE, Scene, SplitMix64, rule, standing};

pub fn volume(voxel_m: f64) -> FusedVolume {
    let config = FusionConfig {
        voxel: voxel_m,
        ..FusionConfig::default()
    };
    FusedVolume::new(config, &JoiningConfig::default(), NOISE).unwrap()
}

/// Takes in what a camera sees.
pub fn see(volume: &mut FusedVolume, scene: &Scene, view: &Isometry3<f64>, luck: &mut SplitMix64) {
    let (points, _) = scene.look(CAMERA, view, NOISE, luck);
    let seen = mesh_of_picture(
        &points,
        CAMERA.size_px[0],
        &Isometry3::identity(),
        &rule(NOISE),
    );
    volume.insert(&seen.mesh.moved(view), view.translation.vector.into());
    let ranges: Vec<f32> = points.iter().map(|at| Vector3::from(*at).norm()).collect();
    volume.see_through(&PictureRanges::new(CAMERA, view.inverse(), &ranges));
}

/// Walks up to a scene and looks to both sides.
pub fn views() -> Vec<Isometry3<f64>> {
    let steps = (0..5).map(|step| -0.3 + 0.1 * f64::from(step));
    let views = steps.flat_map(|x| [-0.35, 0.0, 0.35].map(|pan| standing([x, 0.0, 0.6], 0.6, pan)));
    views.collect()
}

pub fn fused(scene: &Scene, seed: u64) -> TriangleMesh {
    let (mut volume, mut luck) = (volume(0.02), SplitMix64::new(seed));
    for view in views() {
        see(&mut volume, scene, &view, &mut luck);
    }
    volume.mesh()
}
