//! What the segmenter must do as a whole, on synthetic scenes.

mod camera_place;
mod ground;
mod products;
mod slopes;
mod surfaces;
mod treads;

use geometry::{Camera, Pose, Robot};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use sensing::Scan;

use super::config::GroundConfig;
use crate::arbitrary::blocks;
use crate::finders::scan_line::{ScanLine, ScanLineConfig};
use crate::planes::{KnownFloor, Planes, SegmentError, Segmenter};
use testkit::synthetic::{Block, CAMERA, GROUND, NOTHING, Noise, Scene, camera_pose};

/// The sensor's noise, px.
const SIGMA: f64 = 0.125;

fn segmenter() -> ScanLine {
    ScanLine::new(&ScanLineConfig::default(), GroundConfig::default(), CAMERA).unwrap()
}

fn planes() -> Planes {
    Planes::new(CAMERA.width * CAMERA.height)
}

/// A segmenter that has seen open floor and tracks the ground.
fn tracking(noise: &mut Noise) -> ScanLine {
    let mut segmenter = segmenter();
    let mut planes = planes();
    let pose = camera_pose(0.0, 0.75);
    for _ in 0..8 {
        let scan = Scene::floor().scan(&pose, pose, SIGMA, noise);
        segmenter.segment(&scan, &mut planes).unwrap();
        assert!(planes.ground.is_some());
    }
    segmenter
}

fn look(
    segmenter: &mut ScanLine,
    scene: &Scene,
    truth: &Pose<Robot, Camera>,
    noise: &mut Noise,
) -> Planes {
    let mut planes = planes();
    let scan = scene.scan(truth, *truth, SIGMA, noise);
    segmenter.segment(&scan, &mut planes).unwrap();
    planes
}

/// A pose as it is believed with the camera turned and raised wrongly.
fn turned(truth: &Pose<Robot, Camera>, turn: &Vector3<f64>, raised_m: f64) -> Pose<Robot, Camera> {
    let mut believed = *truth;
    believed.inner.rotation *= UnitQuaternion::new(*turn);
    believed.inner.translation.vector.z += raised_m;
    believed
}

/// Angle between true and found vertical, rad, and error of the camera's height, m.
fn pose_error(planes: &Planes, truth: &Pose<Robot, Camera>) -> (f64, f64) {
    let found = planes.robot_from_camera.inner;
    let up = found.rotation * truth.inner.rotation.inverse() * Vector3::z();
    (
        up.xy().norm().asin(),
        found.translation.z - truth.inner.translation.z,
    )
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn wall(at_m: f64) -> Block {
    Block {
        low_m: [at_m, -2.0, 0.0],
        high_m: [at_m + 0.1, 2.0, 1.0],
    }
}

/// The true label that most pixels of region `index` have.
fn true_label(planes: &Planes, labels: &[u16], index: usize) -> u16 {
    let mut counts = [0; 64];
    for (&found, &label) in planes.labels.iter().zip(labels) {
        if usize::from(found) == index + 1 {
            counts[usize::from(label)] += 1;
        }
    }
    (0..64).max_by_key(|&label| counts[label]).unwrap() as u16
}
