//! Milliseconds per 88x72 frame: `cargo bench -p segmentation`. Synthetic scenes with the sensor's noise, one core.
#![expect(clippy::print_stdout, reason = "a bench says what it measured")]
#![expect(clippy::expect_used, reason = "a bench may stop at a bug")]

#[path = "../src/synthetic.rs"]
#[expect(dead_code, reason = "shared with the tests, which use more of it")]
mod synthetic;

use std::time::Instant;

use segmentation::finders::{ScanLine, ScanLineConfig};
use segmentation::{GroundConfig, Planes, Segmenter};
use synthetic::{Block, CAMERA, Noise, Scene, camera_pose};

const FRAMES: usize = 400;
/// Frames of open floor after which the ground is tracked.
const UNTIL_TRACKED: usize = 8;

fn main() {
    let boxes = [
        Block {
            low_m: [0.5, -0.3, 0.0],
            high_m: [0.7, -0.1, 0.3],
        },
        Block {
            low_m: [0.9, 0.0, 0.0],
            high_m: [1.0, 0.6, 1.0],
        },
    ];
    for (name, scene) in [
        ("open floor", Scene::floor()),
        ("boxes", Scene::with(&boxes)),
        ("stairs", Scene::stairs(0.35, 0.03, 0.12, 4)),
    ] {
        let mut noise = Noise::new(1);
        let mut segmenter =
            ScanLine::new(&ScanLineConfig::default(), GroundConfig::default(), CAMERA)
                .expect("the defaults are allowed");
        let mut planes = Planes::new(CAMERA.width * CAMERA.height);
        let pose = camera_pose(0.0, 0.75);
        let floor = Scene::floor().scan(&pose, pose, 0.125, &mut noise);
        let scans: Vec<_> = (0..20)
            .map(|_| scene.scan(&pose, pose, 0.125, &mut noise))
            .collect();
        let first = Instant::now();
        segmenter.segment(&floor, &mut planes).expect("it fits");
        let searched_ms = first.elapsed().as_secs_f64() * 1e3;
        for _ in 0..UNTIL_TRACKED {
            segmenter.segment(&floor, &mut planes).expect("it fits");
        }
        assert!(planes.reliable, "the ground must be tracked");
        let mut times_ms: Vec<f64> = (0..FRAMES)
            .map(|i| {
                let start = Instant::now();
                segmenter
                    .segment(&scans[i % scans.len()], &mut planes)
                    .expect("it fits");
                start.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        times_ms.sort_by(f64::total_cmp);
        println!(
            "{name}: search {searched_ms:.3} ms, median {:.3} ms, 90 % {:.3} ms",
            times_ms[FRAMES / 2],
            times_ms[FRAMES * 9 / 10]
        );
    }
}
