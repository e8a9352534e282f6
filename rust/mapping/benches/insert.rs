//! Time to take one frame into the map: of 88x72 pixels by several kinds of update, of 320x240 into the two maps.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Block, DEPTH_CAMERA, camera, look, look_through};
use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Map, Pose, Robot};
use mapping::{
    Clearing, Elevation, ElevationConfig, Fog, FogConfig, MultiLevel, MultiLevelConfig, TwoMaps,
    TwoMapsConfig, Update, WorldModel,
};

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
            let pan = 0.5 * libm::sin(0.3 * f64::from(i));
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
            let eye = camera(0.5, 0.52, 0.5 * libm::sin(0.3 * f64::from(i)));
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

/// Models of heights, 320x240 into 256 x 256 cells of 2 cm.
fn insert_heights(criterion: &mut Criterion) {
    let blocks = course();
    let frames: Vec<_> = (0..50)
        .map(|i| {
            let pose = Pose::<Map, Robot>::from_yaw(0.008 * f64::from(i), 0.0, 0.0, 0.0);
            let eye = camera(0.5, 0.52, 0.5 * libm::sin(0.3 * f64::from(i)));
            (look_through(DEPTH_CAMERA, &blocks, &pose, eye), pose)
        })
        .collect();
    let heights = ElevationConfig {
        cell: 0.02,
        window: 256,
        ..ElevationConfig::default()
    };
    let plain = ElevationConfig {
        clearing: false,
        fill: 0.0,
        ..heights.clone()
    };
    let levels = |config: &ElevationConfig| {
        MultiLevel::new(MultiLevelConfig::default(), config.clone(), Some(0.58))
    };
    let models: [(&str, Result<Box<dyn WorldModel>, _>); 4] = [
        (
            "elevation, plain",
            Elevation::new(plain.clone()).map(|made| Box::new(made) as _),
        ),
        (
            "elevation",
            Elevation::new(heights.clone()).map(|made| Box::new(made) as _),
        ),
        (
            "multi-level, plain",
            levels(&plain).map(|made| Box::new(made) as _),
        ),
        (
            "multi-level",
            levels(&heights).map(|made| Box::new(made) as _),
        ),
    ];
    for (name, model) in models {
        let Ok(mut model) = model else { return };
        let mut next = frames.iter().cycle();
        let _ = criterion.bench_function(&format!("{name} insert 320x240"), |bencher| {
            bencher.iter(|| next.next().map(|(planes, pose)| model.insert(planes, pose)));
        });
    }
}

criterion_group!(benches, insert, insert_into_two_maps, insert_heights);
criterion_main!(benches);
