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

#[test]
fn scratch_scenes() {
    use crate::synthetic::Block;
    let wall = Block {
        low_m: [0.9, -2.0, 0.0],
        high_m: [1.0, 2.0, 1.0],
    };
    let low_box = Block {
        low_m: [0.5, -0.1, 0.0],
        high_m: [0.7, 0.2, 0.06],
    };
    let high_box = Block {
        low_m: [0.6, -0.3, 0.0],
        high_m: [0.7, 0.0, 0.3],
    };
    let scenes = [
        ("floor", Scene::floor()),
        ("wall", Scene::with(&[wall])),
        (
            "wall .5",
            Scene::with(&[Block {
                low_m: [0.5, -2.0, 0.0],
                high_m: [0.6, 2.0, 1.0],
            }]),
        ),
        ("low box", Scene::with(&[low_box])),
        ("high box", Scene::with(&[high_box])),
        ("stairs .3", Scene::stairs(0.3, 0.03, 0.12, 4)),
        ("stairs .5", Scene::stairs(0.5, 0.03, 0.12, 4)),
        ("stairs .2", Scene::stairs(0.2, 0.03, 0.12, 4)),
    ];
    let mut noise = Noise::new(5);
    for (name, scene) in scenes {
        let (mut segmenter, mut planes) = (segmenter(), planes());
        let truth = camera_pose(0.0, 0.75);
        for frame in 0..5 {
            let where_ = if frame < 2 {
                Scene::floor()
            } else {
                scene.clone()
            };
            let scan = where_.scan(&truth, truth, 0.125, &mut noise);
            let t = std::time::Instant::now();
            segmenter.segment(&scan, &mut planes).unwrap();
            let dt = t.elapsed().as_secs_f64() * 1e3;
            let up = planes.robot_from_camera.inner.rotation
                * truth.inner.rotation.inverse()
                * Vector3::z();
            println!(
                "{name} {frame} {dt:.2} ms tilt {:.2} z {:.1} ground {:?}",
                up.z.min(1.0).acos().to_degrees(),
                1e3 * (planes.robot_from_camera.inner.translation.z - 0.5),
                planes.ground
            );
            let (_, labels) = where_.exact(&truth);
            for (i, r) in planes.regions.iter().enumerate() {
                let mut counts = [0; 12];
                for (l, t) in planes.labels.iter().zip(&labels) {
                    if *l as usize == i + 1 {
                        counts[(*t as usize).min(11)] += 1;
                    }
                }
                println!(
                    "   {} h {:?} n {:.2?} mean {:.2?} {:?}",
                    r.support,
                    r.floor_height_m.map(|h| (h * 1e4).round() / 10.0),
                    r.plane.normal.as_slice(),
                    r.mean.inner.coords.as_slice(),
                    counts
                );
            }
        }
    }
}
