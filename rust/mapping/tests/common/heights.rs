//! Elevation maps of a test, and what they know.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use geometry::{Map, Pose, Robot};
use mapping::{Elevation, ElevationConfig, HeightEstimate, Surface, WorldModel};
use segmentation::Planes;

pub fn here() -> Pose<Map, Robot> {
    Pose::from_yaw(0.0, 0.0, 0.0, 0.0)
}

pub fn map(config: ElevationConfig) -> Elevation {
    Elevation::new(config).unwrap()
}

/// A map after so many looks at the same picture.
pub fn seen(config: ElevationConfig, planes: &Planes, frames: usize) -> Elevation {
    let mut map = map(config);
    for _ in 0..frames {
        assert!(map.insert(planes, &here()).unwrap().used);
    }
    map
}

pub fn estimates(map: &Elevation) -> Vec<([f64; 2], HeightEstimate)> {
    let view = map.view();
    let cells = view.cells.area().cells();
    let known = cells.filter_map(|cell| Some((view.lattice.center_of(cell), map.estimate(cell)?)));
    known.collect()
}

pub fn root_mean_square(errors: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = errors.fold((0.0, 0), |(sum, count), e| (sum + e * e, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

pub fn height(surface: Surface) -> Option<f64> {
    match surface {
        Surface::Floor(h) | Surface::Obstacle(h) => Some(f64::from(h)),
        Surface::Unknown => None,
    }
}
