//! Time to take one 88x72 frame into the map, by several kinds of update.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Block, camera, look};
use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Map, Pose, Robot};
use mapping::{Clearing, Fog, FogConfig, Update, WorldModel};

/// A sill, steps and boxes seen while walking 8 mm a frame and sweeping the head.
fn insert(criterion: &mut Criterion) {
    let blocks = [
        Block::new([0.6, -0.5, 0.0], [0.69, 0.5, 0.038], true),
        Block::new([1.2, -0.2, 0.0], [2.0, 0.2, 0.03], true),
        Block::new([1.32, -0.2, 0.0], [2.0, 0.2, 0.06], true),
        Block::new([0.9, 0.3, 0.0], [1.0, 0.5, 0.3], false),
        Block::new([-3.0, 1.4, 0.0], [4.0, 1.5, 0.6], false),
        Block::new([-3.0, -1.5, 0.0], [4.0, -1.4, 0.6], false),
    ];
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
        ("fog insert 88x72, 16 layers, per frame", FogConfig::paper()),
        (
            "fog insert 88x72, 16 layers, per point",
            FogConfig {
                update: Update::PerPoint,
                ..FogConfig::paper()
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

criterion_group!(benches, insert);
criterion_main!(benches);
