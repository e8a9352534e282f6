//! Milliseconds per 88x72 frame: `cargo bench -p stairs`. Stairs with the sensor's noise, a head that swings, one core.
#![expect(clippy::print_stdout, reason = "a bench says what it measured")]
#![expect(clippy::expect_used, reason = "a bench may stop at a bug")]

use std::time::Instant;

use geometry::Pose;
use segmentation::finders::{ScanLine, ScanLineConfig};
use segmentation::{GroundConfig, Planes, Segmenter};
use stairs::{EdgeModel, EdgeModelTuning, Recognizer, StairsConfig};
use testkit::synthetic::{CAMERA, Noise, Scene, camera_pose};

const FRAMES: usize = 400;

fn main() {
    let mut noise = Noise::new(1);
    let mut segmenter = ScanLine::new(&ScanLineConfig::default(), GroundConfig::default(), CAMERA)
        .expect("allowed");
    let mut planes = Planes::new(CAMERA.width * CAMERA.height);
    let floor_pose = camera_pose(0.0, 0.75);
    for _ in 0..10 {
        let floor = Scene::floor().scan(&floor_pose, floor_pose, 0.125, &mut noise);
        segmenter.segment(&floor, &mut planes).expect("it fits");
    }
    let scene = Scene::stairs(0.35, 0.03, 0.12, 4);
    let mut recognizer = Recognizer::new(StairsConfig::default(), CAMERA).expect("allowed");
    let mut model = EdgeModel::new(CAMERA, EdgeModelTuning::default());
    let (mut whole_ms, mut fit_ms) = (Vec::new(), Vec::new());
    for i in 0..FRAMES {
        let pose = camera_pose(0.3 * libm::sin(i as f64 / 10.0), 0.75);
        let scan = scene.scan(&pose, pose, 0.125, &mut noise);
        segmenter.segment(&scan, &mut planes).expect("it fits");
        let start = Instant::now();
        let staircase = recognizer
            .update(&scan, &planes, &Pose::identity(), 0)
            .expect("it fits");
        whole_ms.push(start.elapsed().as_secs_f64() * 1e3);
        if let Some(first) = staircase.stairs.first() {
            let guess = first.front.transformed(&Pose::identity());
            let start = Instant::now();
            let _ = model.fit(&scan, &planes, &guess, 0.0, 0.03);
            fit_ms.push(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    for (name, times_ms) in [
        ("recognition with fits", &mut whole_ms),
        ("one fit", &mut fit_ms),
    ] {
        times_ms.sort_by(f64::total_cmp);
        let at = |share: usize| times_ms[times_ms.len() * share / 100];
        println!(
            "{name}: 10 % {:.4} ms, median {:.4} ms, 90 % {:.4} ms",
            at(10),
            at(50),
            at(90)
        );
    }
}
