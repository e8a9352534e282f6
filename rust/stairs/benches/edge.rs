//! Time to fit one edge to an 88x72 frame with the sensor's noise: steps up and down, near and far.
#![expect(clippy::expect_used, reason = "a bench may stop at a bug")]

#[path = "../../segmentation/src/synthetic.rs"]
#[expect(dead_code, reason = "shared with the tests, which use more of it")]
mod synthetic;

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Point, Robot};
use segmentation::Planes;
use stairs::{Edge, EdgeModel, EdgeModelTuning};
use synthetic::{Block, CAMERA, Noise, Scene, camera_pose};

/// A drop at `front_m`, wide enough to fill the picture.
fn drop_at(front_m: f64, drop_m: f64) -> Scene {
    let block = |from_m: f64, to_m: f64, top_m: f64| Block {
        low_m: [from_m, -0.9, -0.2],
        high_m: [to_m, 0.9, top_m],
    };
    Scene {
        ground: false,
        blocks: vec![block(-1.0, front_m, 0.0), block(front_m, 1.5, -drop_m)],
    }
}

fn fit(criterion: &mut Criterion) {
    let cases: [(_, _, f64, f64); 4] = [
        (
            "step up at 0.28 m",
            Scene::stairs(0.28, 0.03, 0.14, 3),
            0.28,
            0.03,
        ),
        (
            "step up at 0.5 m",
            Scene::stairs(0.5, 0.03, 0.14, 3),
            0.5,
            0.03,
        ),
        ("step down of 30 mm", drop_at(0.28, 0.03), 0.28, -0.03),
        ("step down of 50 mm", drop_at(0.28, 0.05), 0.28, -0.05),
    ];
    for (name, scene, front_m, rise_m) in cases {
        let pose = camera_pose(0.05, 0.9);
        let mut noise = Noise::new(1);
        let scans: Vec<_> = (0..20)
            .map(|_| scene.scan(&pose, pose, 0.125, &mut noise))
            .collect();
        let mut planes = Planes::new(CAMERA.width * CAMERA.height);
        planes.robot_from_camera = pose;
        let guess = Edge {
            left: Point::<Robot>::new(front_m + 0.01, 0.2, rise_m.max(0.0)),
            right: Point::<Robot>::new(front_m + 0.02, -0.2, rise_m.max(0.0)),
        };
        let mut model = EdgeModel::new(CAMERA, EdgeModelTuning::default());
        let _ = model
            .fit(&scans[0], &planes, &guess, 0.0, rise_m)
            .expect("the edge is in view");
        let mut next = scans.iter().cycle();
        let _ = criterion.bench_function(name, |bencher| {
            bencher.iter(|| {
                next.next()
                    .map(|scan| model.fit(scan, &planes, &guess, 0.0, rise_m))
            });
        });
    }
}

criterion_group!(benches, fit);
criterion_main!(benches);
