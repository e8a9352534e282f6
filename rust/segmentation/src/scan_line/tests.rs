//! What the segmenter must do as a whole, on synthetic scenes.

use approx::assert_relative_eq;
use nalgebra::{UnitQuaternion, Vector3};

use super::*;
use crate::synthetic::{CAMERA, Noise, Scene, camera_pose};

pub(super) fn segmenter() -> ScanLine {
    ScanLine::new(ScanLineConfig::default(), CAMERA).unwrap()
}

pub(super) fn planes() -> Planes {
    Planes::new(CAMERA.width * CAMERA.height)
}

#[test]
fn open_floor_without_errors_is_one_ground_at_height_zero() {
    let pose = camera_pose(0.0, 0.75);
    let scan = Scene::floor().scan(&pose, pose, 0.125, &mut Noise::new(1));
    let (mut segmenter, mut planes) = (segmenter(), planes());
    segmenter.segment(&scan, &mut planes).unwrap();
    assert_eq!(planes.ground, Some(0));
    assert!(planes.reliable);
    assert_relative_eq!(planes.regions[0].plane.distance_m, 0.0);
    let turn = planes.robot_from_camera.inner.rotation * pose.inner.rotation.inverse();
    assert!(turn.angle() < 0.01, "{}", turn.angle());
}

#[test]
fn a_camera_error_of_seven_degrees_is_put_right() {
    let mut noise = Noise::new(2);
    for seed in 0..20 {
        let truth = camera_pose(noise.within(0.3), 0.75);
        let (pitch, roll) = (noise.within(0.122), noise.within(0.122));
        let error = UnitQuaternion::from_scaled_axis(Vector3::new(pitch, 0.0, roll));
        let mut believed = truth;
        believed.inner.rotation *= error;
        believed.inner.translation.vector.z += noise.within(0.01);
        let scan = Scene::floor().scan(&truth, believed, 0.125, &mut noise);
        let (mut segmenter, mut planes) = (segmenter(), planes());
        segmenter.segment(&scan, &mut planes).unwrap();
        assert!(planes.ground.is_some(), "{seed} {pitch} {roll}");
        let up =
            planes.robot_from_camera.inner.rotation * truth.inner.rotation.inverse() * Vector3::z();
        println!(
            "{seed} {:.3} deg {:.2} mm",
            up.z.acos().to_degrees(),
            1e3 * (planes.robot_from_camera.inner.translation.z - 0.5)
        );
    }
}
