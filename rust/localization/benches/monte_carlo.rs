//! Time of Monte Carlo localization in a furnished room of 6 by 5 m at 4 cm, on one thread: 500 guesses, 100 beams.

use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Camera, Grid, Lattice, Pose, Robot};
use known_map::{KnownMap, StandingRoom};
use localization::{Localizer, MonteCarloConfig, MonteCarloLocalizer, RangeModel, StaticMap};
use mapping::{FloorView, Surface};
use nalgebra::{
    Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector2, Vector3,
};
use proprioception::BodyState;
use robot::{LinkPoses, Side};
use segmentation::Planes;
use sensing::Intrinsics;
use volume::{LANES, Lanes, RangeField, SolidVoxels};

const SIDE_M: f64 = 0.04;
const CAMERA: Intrinsics = Intrinsics {
    width: 320,
    height: 240,
    focal_px: 288.7,
    baseline_m: 0.075,
};
const BOXES: [[[f64; 3]; 2]; 9] = [
    [[-0.2, -0.2, -0.2], [6.2, 5.2, 0.0]],
    [[-0.2, -0.2, 0.0], [0.0, 5.2, 2.0]],
    [[6.0, -0.2, 0.0], [6.2, 5.2, 2.0]],
    [[0.0, -0.2, 0.0], [6.0, 0.0, 2.0]],
    [[0.0, 5.0, 0.0], [6.0, 5.2, 2.0]],
    [[2.0, 1.0, 0.0], [2.6, 1.4, 0.5]],
    [[4.0, 3.0, 0.0], [4.3, 3.9, 0.8]],
    [[1.0, 3.5, 0.6], [2.0, 4.5, 0.68]],
    [[5.0, 1.0, 0.0], [5.2, 1.2, 0.3]],
];

/// Half a metre up, 30 degrees down, as on a NAO's head.
fn robot_from_camera() -> Isometry3<f64> {
    let axes = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
    let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.52);
    let turn = tilt * Rotation3::from_matrix_unchecked(axes);
    Isometry3::from_parts(
        Translation3::new(0.04, 0.0, 0.5),
        UnitQuaternion::from_rotation_matrix(&turn),
    )
}

fn place(x_m: f64) -> Isometry3<f64> {
    Isometry3::new(Vector3::new(x_m, 2.0, 0.0), Vector3::z() * 0.4)
}

/// What the camera sees of the map itself, in the robot's frame.
fn frame(field: &RangeField, robot: &Isometry3<f64>) -> Planes {
    let mut planes = Planes::new(CAMERA.width * CAMERA.height);
    let camera = robot_from_camera();
    let eye = (robot * camera).translation.vector;
    for (pixel, point) in planes.points_in_robot_m.iter_mut().enumerate() {
        let ray = Vector3::from(CAMERA.ray(pixel % CAMERA.width, pixel / CAMERA.width));
        let along = (camera.rotation * ray).normalize();
        let in_map = robot.rotation * along;
        if let Some(range_m) = field.cast(eye.into(), in_map.into(), 5.0) {
            let seen = camera.translation.vector + along * range_m;
            *point = [seen.x as f32, seen.y as f32, seen.z as f32];
        }
    }
    planes.robot_from_camera = Pose::<Robot, Camera>::wrap(camera);
    planes.camera = Some(CAMERA);
    planes.reliable = true;
    planes
}

fn body(number: u64, odometry_from_robot: Isometry3<f64>) -> BodyState {
    BodyState {
        time_ns: number * 160_000_000,
        odometry_from_torso_rotation: odometry_from_robot.rotation,
        angular_velocity_radps: Vector3::zeros(),
        links: LinkPoses::default(),
        foot_loads_n: [25.0; 2],
        support: Side::Left,
        stands_level: true,
        on_slope: false,
        odometry_from_robot: Pose::wrap(odometry_from_robot),
        robot_from_torso: Pose::wrap(Isometry3::translation(0.0, 0.0, 0.33)),
    }
}

fn no_view() -> FloorView {
    FloorView::new(
        Lattice {
            origin_m: [0.0; 2],
            cell_m: 1.0,
        },
        Grid::filled(1, 1, Surface::Unknown),
        0,
    )
}

/// Whole steps: beams drawn from a frame of 320 x 240, guesses moved, weighed and drawn anew.
fn steps(criterion: &mut Criterion) {
    let (Ok(known), Ok(pool)) = (
        KnownMap::of_boxes(&BOXES, SIDE_M),
        rayon::ThreadPoolBuilder::new().num_threads(1).build(),
    ) else {
        return;
    };
    let Ok(field) = known.ranges() else {
        return;
    };
    // To and fro, so that every frame is due.
    let places = [place(3.0), place(3.03)];
    let frames = places.map(|robot| (robot, frame(field, &robot)));
    let room = StandingRoom {
        radius_m: 0.1,
        height_m: 0.55,
    };
    for (name, range_model) in [
        ("step, ray casting", RangeModel::RayCast),
        ("step, likelihood field", RangeModel::LikelihoodField),
    ] {
        let config = MonteCarloConfig {
            range_model,
            most_particles: 500,
            ..MonteCarloConfig::default()
        };
        let Ok(map) = StaticMap::new(&known, room, &config) else {
            return;
        };
        let start = Some(Pose::wrap(places[1]));
        let Ok(mut localizer) = MonteCarloLocalizer::new(Arc::new(map), start, config) else {
            return;
        };
        let (view, mut number) = (no_view(), 0);
        let mut next = frames.iter().cycle();
        let _ = criterion.bench_function(name, |bencher| {
            pool.install(|| {
                bencher.iter(|| {
                    number += 1;
                    next.next().map(|(robot, planes)| {
                        localizer.correct(&body(number, *robot), planes, &view)
                    })
                });
            });
        });
    }
}

/// 50,000 rays alone, as guesses that stand within decimetres of each other cast them.
fn rays(criterion: &mut Criterion) {
    let Ok(solid) = SolidVoxels::of_boxes(&BOXES, SIDE_M) else {
        return;
    };
    let field = RangeField::new(&std::sync::Arc::new(solid));
    // A low-discrepancy sequence (the plastic number's) is spread evenly over guesses and beams.
    let at =
        |index: u32, axis: i32| (f64::from(index) * 0.754_877_666_f64.powi(axis)).fract() - 0.5;
    let mut guesses = Vec::with_capacity(500);
    for guess in 1..=500 {
        let shift = Vector2::new(at(guess, 1), at(guess, 2)) * 0.2;
        let turn =
            UnitQuaternion::from_euler_angles(0.0, 0.02 * at(guess, 3), 0.4 + 0.2 * at(guess, 4));
        let robot =
            Isometry3::from_parts(Translation3::new(3.0 + shift.x, 2.0 + shift.y, 0.0), turn);
        guesses.push(robot * robot_from_camera());
    }
    let beams: Vec<_> = (1..=100)
        .map(|beam| {
            let (col, row) = (320.0 * at(beam, 1), 240.0 * at(beam, 2));
            Vector3::new(col, row, CAMERA.focal_px).normalize()
        })
        .collect();
    let _ = criterion.bench_function("500 x 100 rays, 4 cm, one by one", |bencher| {
        bencher.iter(|| {
            let rays =
                (guesses.iter()).flat_map(|camera| beams.iter().map(move |ray| (camera, ray)));
            let ranges = rays.filter_map(|(camera, ray)| {
                let eye = (camera * Point3::origin()).coords.into();
                field.cast(eye, (camera.rotation * ray).into(), 5.0)
            });
            ranges.sum::<f64>()
        });
    });
    let _ = criterion.bench_function("500 x 100 rays, 4 cm, side by side", |bencher| {
        bencher.iter(|| {
            let mut ends = Lanes::ZERO;
            for cameras in guesses.as_chunks::<LANES>().0 {
                let eyes = cameras.map(|camera| camera.translation.vector);
                let eyes = std::array::from_fn(|a| eyes.map(|eye| eye[a]));
                let eyes = field.in_voxels(&eyes);
                for ray in &beams {
                    let along = cameras.map(|camera| camera.rotation * ray);
                    let along = std::array::from_fn(|a| along.map(|v| v[a] as f32).into());
                    ends += field.cast_side_by_side(&eyes, &along, Lanes::splat(5.0));
                }
            }
            ends
        });
    });
}

criterion_group!(benches, rays, steps);
criterion_main!(benches);
