//! Slopes in the map: floor with its height in each cell, and with its tilt.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{camera, look};
use geometry::{Map, Plane, Point, Pose, Robot};
use mapping::{Fog, FogConfig, Surface, WorldModel};
use nalgebra::{Point3, Unit, Vector3};
use segmentation::{PlaneRegion, Planes};

const EYE_M: f64 = 0.45;
/// The slope begins so far ahead and rises so much per metre.
const BEGINS_M: f64 = 0.4;
const RISE: f64 = 0.12;

/// Level ground and, if it is told from that, the slope ahead.
fn frame(sloped: bool) -> Planes {
    let mut planes = look(&[], &Pose::identity(), camera(EYE_M, 0.7, 0.0));
    if !sloped {
        return planes;
    }
    planes.labels.fill(0);
    let pixels = planes.points_in_robot_m.iter_mut().zip(&mut planes.labels);
    for ((point, label), height_m) in pixels.zip(&mut planes.floor_height_m) {
        let [x, y, _] = point.map(f64::from);
        if x > BEGINS_M {
            // Where the line of sight meets the slope before the ground.
            let share = (EYE_M + RISE * BEGINS_M) / (EYE_M + RISE * x);
            let z = RISE * (x * share - BEGINS_M);
            *point = [x * share, y * share, z].map(|value| value as f32);
            (*label, *height_m) = (1, z as f32);
        }
    }
    let normal = Unit::new_normalize(Vector3::new(-RISE, 0.0, 1.0));
    planes.regions.push(PlaneRegion {
        support: 1000,
        mean: Point::<Robot>::wrap(Point3::new(0.7, 0.0, RISE * (0.7 - BEGINS_M))),
        plane: Plane {
            normal,
            distance_m: -normal.x.abs() * BEGINS_M,
        },
        boundary: None,
        floor_height_m: None,
        roughness: None,
    });
    planes
}

fn seen(sloped: bool, map_from_robot: &Pose<Map, Robot>) -> Fog {
    let mut fog = Fog::new(FogConfig::default()).unwrap();
    let planes = frame(sloped);
    for _ in 0..4 {
        let _ = fog.insert(&planes, map_from_robot).unwrap();
    }
    fog
}

#[test]
fn a_slope_is_floor_with_its_tilt_and_its_height_in_each_cell() {
    let fog = seen(true, &Pose::identity());
    let view = fog.view();
    for x in [0.5, 0.6, 0.7, 0.8] {
        let [along, across] = view.gradient_at(x, 0.0);
        assert!(
            (along - RISE).abs() < 1e-3 && across.abs() < 1e-3,
            "{x}: {along}"
        );
        let Surface::Floor(height_m) = view.at(x, 0.0) else {
            panic!("no floor at {x}");
        };
        let off_m = f64::from(height_m) - RISE * (x - BEGINS_M);
        assert!(
            off_m.abs() < 0.5 * RISE * view.lattice.cell_m + 1e-3,
            "{x}: {off_m}"
        );
    }
    assert_eq!(view.gradient_at(0.3, 0.0), [0.0; 2], "before it");
}

#[test]
fn the_tilt_is_that_in_the_map_whatever_way_the_robot_faces() {
    let left = Pose::from_yaw(0.0, 0.0, 0.0, std::f64::consts::FRAC_PI_2);
    let [x, y] = seen(true, &left).view().gradient_at(0.0, 0.6);
    assert!(x.abs() < 1e-3 && (y - RISE).abs() < 1e-3, "{x} {y}");
}

#[test]
fn level_ground_has_no_tilt() {
    let fog = seen(false, &Pose::identity());
    let mut gradients = fog.view().gradients.values().iter();
    assert!(gradients.all(|gradient| *gradient == [0.0; 2]));
}
