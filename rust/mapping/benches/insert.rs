//! Time to take one frame into the map: of 88x72 pixels by several kinds of update, of 320x240 into the two maps.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Block, DEPTH_CAMERA, camera, look, look_through};
use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Map, Pose, Robot};
use mapping::{Clearing, Fog, FogConfig, TwoMaps, TwoMapsConfig, Update, WorldModel};

/// A sill, steps and boxes.
fn course() -> [Block; 6] {
    [
        Block::new([0.6, -0.5, 0.0], [0.69, 0.5, 0.038], true),
        Block::new([1.2, -0.2, 0.0], [2.0, 0.2, 0.03], true),
        Block::new([1.32, -0.2, 0.0], [2.0, 0.2, 0.06], true),
        Block::new([0.9, 0.3, 0.0], [1.0, 0.5, 0.3], false),
        Block::new([-3.0, 1.4, 0.0], [4.0, 1.5, 0.6], false),
        Block::new([-3.0, -1.5, 0.0], [4.0, -1.4, 0.6], false),
    ]
}

/// The course seen while walking 8 mm a frame and sweeping the head.
fn insert(criterion: &mut Criterion) {
    let blocks = course();
    let frames: Vec<_> = (0..50)
        .map(|i| {
            let pose = Pose::<Map, Robot>::from_yaw(0.008 * f64::from(i), 0.0, 0.0, 0.0);
            let pan = 0.5 * (0.3 * f64::from(i)).sin();
            (look(&blocks, &pose, camera(0.5, 0.6, pan)), pose)
        })
        .collect();
    let cases = [
        (
            "fog insert 88x72, 24 layers, per frame",
            FogConfig::default(),
        ),
        (
            "fog insert 88x72, 24 layers, every ray",
            FogConfig {
                clearing: Clearing::EveryRay,
                ..FogConfig::default()
            },
        ),
        (
            "fog insert 88x72, 24 layers, projected",
            FogConfig {
                clearing: Clearing::Projected,
                ..FogConfig::default()
            },
        ),
        ("fog insert 88x72, 16 layers, per frame", common::paper()),
        (
            "fog insert 88x72, 16 layers, per point",
            FogConfig {
                update: Update::PerPoint,
                ..common::paper()
            },
        ),
    ];
    for (name, config) in cases {
        let Ok(mut fog) = Fog::new(config) else {
            return;
        };
        let mut next = frames.iter().cycle();
        let _ = criterion.bench_function(name, |bencher| {
            bencher.iter(|| next.next().map(|(planes, pose)| fog.insert(planes, pose)));
        });
    }
}

/// The scene as the sensor of 002 sees it.
fn insert_into_two_maps(criterion: &mut Criterion) {
    let blocks = course();
    let frames: Vec<_> = (0..50)
        .map(|i| {
            let pose = Pose::<Map, Robot>::from_yaw(0.013 * f64::from(i), 0.0, 0.0, 0.0);
            let eye = camera(0.5, 0.52, 0.5 * (0.3 * f64::from(i)).sin());
            (look_through(DEPTH_CAMERA, &blocks, &pose, eye), pose)
        })
        .collect();
    for resolution in [0.04, 0.02] {
        let config = TwoMapsConfig {
            resolution,
            ..TwoMapsConfig::default()
        };
        let Ok(mut maps) = TwoMaps::new(config, &FogConfig::default(), None) else {
            return;
        };
        let name = format!("two maps insert 320x240, {resolution} m");
        let mut next = frames.iter().cycle();
        let _ = criterion.bench_function(&name, |bencher| {
            bencher.iter(|| next.next().map(|(planes, pose)| maps.insert(planes, pose)));
        });
    }
    let Ok(mut fog) = Fog::new(FogConfig::default()) else {
        return;
    };
    let mut next = frames.iter().cycle();
    let _ = criterion.bench_function("fog insert 320x240", |bencher| {
        bencher.iter(|| next.next().map(|(planes, pose)| fog.insert(planes, pose)));
    });
}

criterion_group!(benches, insert, insert_into_two_maps);
criterion_main!(benches);
