//! The two maps of 002 while things come and go (M8, M11), and through a camera with errors (M7).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Block, DEPTH_CAMERA, WIDTH, camera, interior, is_obstacle, look, look_through};
use geometry::{Map, Pose, Robot};
use mapping::{FogConfig, Surface, TwoMaps, TwoMapsConfig, WorldModel};
use segmentation::Planes;

fn maps(config: TwoMapsConfig) -> TwoMaps {
    TwoMaps::new(config, &FogConfig::default(), None).unwrap()
}

fn with_voxels(resolution: f64) -> TwoMapsConfig {
    TwoMapsConfig {
        resolution,
        ..TwoMapsConfig::default()
    }
}

fn at(x_m: f64) -> Pose<Map, Robot> {
    Pose::from_yaw(x_m, 0.0, 0.0, 0.0)
}

/// Frames until nothing of a visitor is left in the view, at most 20.
fn frames_to_clear(maps: &mut TwoMaps, visitor: Block, rest: &[Block], pitch_rad: f64) -> u32 {
    let pose = at(0.0);
    let eye = camera(0.5, pitch_rad, 0.0);
    let with: Vec<_> = rest.iter().copied().chain([visitor]).collect();
    for _ in 0..60 {
        let _ = maps.insert(&look(&with, &pose, eye), &pose).unwrap();
    }
    let left = |maps: &TwoMaps| {
        let cells = interior(
            maps.view(),
            [visitor.min[0] - 0.04, visitor.min[1]],
            [visitor.max[0], visitor.max[1]],
        );
        cells
            .into_iter()
            .filter(|&cell| is_obstacle(maps.view().cell(cell)))
            .count()
    };
    assert!(left(maps) > 4, "it is seen before it goes");
    let planes = look(rest, &pose, eye);
    let frames = (1..20).find(|_| {
        let _ = maps.insert(&planes, &pose).unwrap();
        left(maps) == 0
    });
    frames.unwrap_or(20)
}

#[test]
fn who_goes_away_is_forgotten_within_a_second_at_six_frames_a_second() {
    let visitor = Block::new([1.0, -0.16, 0.0], [1.3, 0.16, 0.6], false);
    let wall = Block::new([2.0, -2.0, 0.0], [2.1, 2.0, 1.0], false);
    for resolution in [0.04, 0.02] {
        // Before a wall; before floor; and where nothing is behind what the camera can see.
        for (rest, pitch_rad) in [(vec![wall], 0.2), (vec![], 0.6), (vec![], -0.1)] {
            let frames = frames_to_clear(
                &mut maps(with_voxels(resolution)),
                visitor,
                &rest,
                pitch_rad,
            );
            assert!(frames <= 5, "{frames} frames at {resolution}, {pitch_rad}");
        }
    }
}

/// Frames after which something on ground that was seen to be free is an obstacle, at most 10.
fn frames_to_believe(thing: Block, place_m: [f64; 2]) -> usize {
    let mut maps = maps(TwoMapsConfig::default());
    let pose = at(0.0);
    let eye = camera(0.5, 0.4, 0.0);
    for _ in 0..60 {
        let _ = maps.insert(&look(&[], &pose, eye), &pose).unwrap();
    }
    let frames = (1..10).find(|_| {
        let _ = maps.insert(&look(&[thing], &pose, eye), &pose).unwrap();
        is_obstacle(maps.view().at(place_m[0], place_m[1]))
    });
    frames.unwrap_or(10)
}

#[test]
fn who_comes_is_an_obstacle_in_the_first_frame_what_is_small_in_the_second() {
    let visitor = Block::new([1.0, -0.16, 0.0], [1.3, 0.16, 0.6], false);
    assert_eq!(frames_to_believe(visitor, [1.02, 0.0]), 1);
    let ball = Block::new([0.97, -0.03, 0.0], [1.03, 0.03, 0.08], false);
    assert_eq!(frames_to_believe(ball, [0.98, 0.0]), 2);
}

#[test]
fn what_came_too_near_to_be_seen_is_remembered() {
    // A camera that is blind below half a metre.
    let blind = |mut planes: Planes| {
        let eye = planes.robot_from_camera.inner.translation.vector;
        for (point, height) in planes
            .points_in_robot_m
            .iter_mut()
            .zip(&mut planes.floor_height_m)
        {
            let off = nalgebra::Vector3::from(point.map(f64::from)) - eye;
            if off.norm() < 0.5 {
                (*point, *height) = ([f32::NAN; 3], f32::NAN);
            }
        }
        planes
    };
    let post = Block::new([0.6, -0.3, 0.0], [0.7, 0.3, 0.9], false);
    let mut maps = maps(TwoMapsConfig::default());
    for pitch in [-0.1, 0.0, 0.3] {
        for x_m in [
            0.0, 0.0, 0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25,
        ] {
            let pose = at(x_m);
            let planes = blind(look(&[post], &pose, camera(0.5, pitch, 0.0)));
            let _ = maps.insert(&planes, &pose).unwrap();
        }
        assert!(is_obstacle(maps.view().at(0.62, 0.02)), "{pitch}");
        let ahead = maps.local.is_occupied_at([0.62, 0.02, 0.5]);
        assert_eq!(ahead, Some(true), "{pitch}");
    }
}

#[test]
fn what_lies_in_the_shadow_of_a_nearer_thing_is_remembered() {
    let post = Block::new([0.7, -0.1, 0.0], [0.8, 0.1, 1.0], false);
    let wall = Block::new([2.0, -2.0, 0.0], [2.2, 2.0, 1.5], false);
    let mut maps = maps(TwoMapsConfig::default());
    let (pose, eye) = (at(0.0), camera(0.5, -0.1, 0.0));
    for _ in 0..5 {
        let _ = maps.insert(&look(&[wall], &pose, eye), &pose).unwrap();
    }
    let mut planes = look(&[post, wall], &pose, eye);
    // Beside the post only one eye sees the wall, in 6 pixels: 6.1 / 0.7 less 6.1 / 2.
    let mut shadow = Vec::new();
    for row in planes.points_in_robot_m.chunks_exact_mut(WIDTH) {
        if let Some(edge) = row.iter().position(|point| point[0] < 1.0) {
            for point in &mut row[edge - 6..edge] {
                shadow.push([2.02, f64::from(point[1]), f64::from(point[2])]);
                *point = [f32::NAN; 3];
            }
        }
    }
    let remembered = |maps: &TwoMaps| {
        let seen = |at: &&[f64; 3]| maps.local.is_occupied_at(**at) == Some(true);
        shadow.iter().filter(seen).count()
    };
    let before = remembered(&maps);
    assert!(before > 300, "{before}");
    for _ in 0..10 {
        let _ = maps.insert(&planes, &pose).unwrap();
    }
    assert_eq!(remembered(&maps), before);
}

/// Numbers between -1 and 1 that look random.
struct Errors(u64);

impl Errors {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// About normal, of standard deviation 1.
    fn normal(&mut self) -> f64 {
        0.5 * (0..12).map(|_| self.next()).sum::<f64>()
    }

    /// What a depth camera with errors that grow with the square of the distance makes of a picture: one point of ten belongs to no
    /// plane, some are lost, some are anywhere.
    fn spoil(&mut self, planes: &mut Planes) {
        let eye = planes.robot_from_camera.inner.translation.vector;
        for (point, height) in planes
            .points_in_robot_m
            .iter_mut()
            .zip(&mut planes.floor_height_m)
        {
            let off = nalgebra::Vector3::from(point.map(f64::from)) - eye;
            let range_m = off.norm();
            let kind = self.next();
            let error_m = if kind > 0.99 {
                self.next()
            } else {
                0.0028 * range_m * range_m * self.normal()
            };
            if !(-0.95..0.985).contains(&kind) || (kind < -0.75 && !height.is_nan()) {
                *height = f32::NAN;
            }
            let there = eye + off * (1.0 + error_m / range_m);
            *point = if kind < -0.95 {
                [f32::NAN; 3]
            } else {
                there.map(|m| m as f32).into()
            };
        }
    }
}

#[test]
fn free_floor_is_no_obstacle_and_five_centimetres_are_one_to_a_camera_with_errors() {
    let low = [
        Block::new([0.8, -0.3, 0.0], [0.92, -0.18, 0.05], false),
        Block::new([1.2, 0.2, 0.0], [1.32, 0.32, 0.05], true),
    ];
    for resolution in [0.04, 0.02] {
        let mut maps = maps(with_voxels(resolution));
        let mut errors = Errors(7);
        let (mut free, mut called) = (0, 0);
        for frame in 0..40 {
            let pose = at(0.01 * f64::from(frame));
            let pan = 0.4 * (0.5 * f64::from(frame)).sin();
            let mut planes = look_through(DEPTH_CAMERA, &low, &pose, camera(0.5, 0.52, pan));
            errors.spoil(&mut planes);
            let _ = maps.insert(&planes, &pose).unwrap();
            let view = maps.view();
            for cell in view.cells.area().cells() {
                let [x, y] = view.lattice.center_of(cell);
                let beside = |block: &Block| {
                    let off = |a: usize, v: f64| (block.min[a] - v).max(v - block.max[a]).max(0.0);
                    off(0, x).hypot(off(1, y)) < 0.06
                };
                if !low.iter().any(beside) {
                    free += u32::from(view.cell(cell) != Surface::Unknown);
                    called += u32::from(is_obstacle(view.cell(cell)));
                }
            }
        }
        assert!(free > 50_000, "{free}");
        assert!(called <= free / 1000, "{called} of {free} at {resolution}");
        for block in low {
            let [min, max] = [block.min, block.max].map(|at| [at[0], at[1]]);
            for cell in interior(maps.view(), min, max) {
                let found = match maps.view().cell(cell) {
                    Surface::Obstacle(_) => true,
                    Surface::Floor(h) => h > 0.03,
                    Surface::Unknown => false,
                };
                assert!(
                    found,
                    "{cell:?} {:?} at {resolution}",
                    maps.view().cell(cell)
                );
            }
        }
    }
}
