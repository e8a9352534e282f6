//! The experiments of 000, Fig. 5, on both maps and the same frames: a box that is there, removed, moved. What simple
//! averaging gets wrong, the floor and obstacle grid must get right.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Block, HEIGHT, WIDTH, camera, interior, look};
use geometry::{Map, Pose, Robot};
use mapping::{Averaging, AveragingConfig, Fog, FogConfig, MapError, Surface, WorldModel};
use segmentation::Planes;

const TOP_M: f64 = 0.06;

/// Both maps, looking down from one place.
struct Both {
    averaging: Averaging,
    fog: Fog,
}

impl Both {
    fn new() -> Self {
        Self {
            averaging: Averaging::new(AveragingConfig::default()).unwrap(),
            fog: Fog::new(FogConfig::default()).unwrap(),
        }
    }

    fn insert(&mut self, planes: &Planes) {
        for map in [&mut self.averaging as &mut dyn WorldModel, &mut self.fog] {
            assert!(map.insert(planes, &here()).unwrap().used);
        }
    }

    fn see(&mut self, blocks: &[Block]) {
        self.insert(&seen(blocks));
    }

    /// Heights of averaging and of ours in the cells that lie wholly within a rectangle; none where unknown.
    fn heights(&self, min: [f64; 2], max: [f64; 2]) -> [Vec<Option<f64>>; 2] {
        let maps = [&self.averaging as &dyn WorldModel, &self.fog];
        maps.map(|map| {
            let cells = interior(map.view(), min, max).into_iter();
            cells.map(|cell| height(map.view().cell(cell))).collect()
        })
    }
}

fn here() -> Pose<Map, Robot> {
    Pose::from_yaw(0.0, 0.0, 0.0, 0.0)
}

fn seen(blocks: &[Block]) -> Planes {
    look(blocks, &here(), camera(0.5, 0.6, 0.0))
}

fn height(surface: Surface) -> Option<f64> {
    match surface {
        Surface::Floor(h) | Surface::Obstacle(h) => Some(f64::from(h)),
        Surface::Unknown => None,
    }
}

/// Repeatable numbers from 0 to 1.
fn random(at: &mut u64) -> f64 {
    *at = at.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    (*at >> 11) as f64 / (1_u64 << 53) as f64
}

/// Puts a share of a frame's points somewhere on their rays, as mismatches do; they belong to no plane.
fn mismatch(planes: &mut Planes, share: f64, luck: &mut u64) {
    let eye = planes.robot_from_camera.origin().inner;
    let eye = [eye.x as f32, eye.y as f32, eye.z as f32];
    for (point, height) in planes
        .points_in_robot_m
        .iter_mut()
        .zip(&mut planes.floor_height_m)
    {
        if random(luck) < share {
            let part = 0.3 + 0.6 * random(luck) as f32;
            for (value, from) in point.iter_mut().zip(eye) {
                *value = from + (*value - from) * part;
            }
            *height = f32::NAN;
        }
    }
}

fn root_mean_square(heights: &[Option<f64>], truth_m: f64) -> f64 {
    let squares = heights.iter().flatten().map(|h| (h - truth_m).powi(2));
    (squares.sum::<f64>() / heights.iter().flatten().count() as f64).sqrt()
}

#[test]
fn a_box_that_stays_looks_alike_in_both_maps() {
    // F3: 30 x 20 x 6 cm at half a metre.
    let box_ = [Block::new([0.5, -0.1, 0.0], [0.8, 0.1, TOP_M], true)];
    let mut both = Both::new();
    for _ in 0..10 {
        both.see(&box_);
    }
    let [averaged, ours] = both.heights([0.5, -0.1], [0.8, 0.1]);
    assert!(averaged.len() > 20);
    for (averaged, ours) in averaged.iter().zip(&ours) {
        let (averaged, ours) = (averaged.unwrap(), ours.unwrap());
        assert!((averaged - TOP_M).abs() < 0.005, "{averaged}");
        assert!((ours - TOP_M).abs() < 0.005, "{ours}");
    }
}

#[test]
fn outliers_pull_at_averages_and_not_at_ours() {
    let box_ = [Block::new([0.5, -0.1, 0.0], [0.8, 0.1, TOP_M], true)];
    let (mut both, mut luck) = (Both::new(), 1);
    for _ in 0..20 {
        let mut planes = seen(&box_);
        mismatch(&mut planes, 0.01, &mut luck);
        both.insert(&planes);
    }
    let [averaged, ours] = both.heights([0.5, -0.1], [0.8, 0.1]);
    let (averaged, ours) = (
        root_mean_square(&averaged, TOP_M),
        root_mean_square(&ours, TOP_M),
    );
    assert!(ours < 0.001, "{ours}");
    assert!(
        averaged > 3.0 * ours && averaged > 0.001,
        "{averaged} {ours}"
    );
}

#[test]
fn of_a_removed_box_averaging_keeps_for_ever_what_is_out_of_view_and_ours_nothing() {
    // F4: the box reaches below the picture's lower border, where its top is in view and the floor under it is not.
    let box_ = [Block::new([0.3, -0.1, 0.0], [0.6, 0.1, TOP_M], true)];
    let mut both = Both::new();
    for _ in 0..20 {
        both.see(&box_);
    }
    let raised = |both: &Both| {
        both.heights([0.3, -0.1], [0.6, 0.1])
            .map(|heights| heights.iter().flatten().filter(|&&h| h > 0.03).count())
    };
    let [averaged, ours] = raised(&both);
    assert!(averaged > 20 && ours > 20, "{averaged} {ours}");
    let mut forgotten_after = None;
    for frame in 1..=300 {
        both.see(&[]);
        if raised(&both)[1] == 0 {
            forgotten_after = forgotten_after.or(Some(frame));
        } else {
            assert_eq!(forgotten_after, None, "what was forgotten stays so");
        }
    }
    assert!(forgotten_after.is_some_and(|frames| frames <= 12));
    let [averaged, ours] = raised(&both);
    assert_eq!(ours, 0);
    assert!(averaged > 3, "{averaged}");
}

#[test]
fn a_moving_box_leaves_averages_of_heights_in_between_and_ours_none() {
    // F5: 5 cm/s across the view.
    let mut both = Both::new();
    for i in 0..120 {
        let y = -0.35 + 0.05 * 0.08 * f64::from(i);
        both.see(&[Block::new([0.5, y, 0.0], [0.7, y + 0.2, TOP_M], true)]);
    }
    let share = |heights: &[Option<f64>]| {
        let between = |h: &&f64| **h > 0.01 && **h < TOP_M - 0.01;
        let between = heights.iter().flatten().filter(between).count();
        between as f64 / heights.iter().flatten().count() as f64
    };
    let [averaged, ours] = both.heights([0.5, -0.35], [0.7, 0.35]);
    assert!(share(&averaged) > 0.05, "{}", share(&averaged));
    assert_eq!(share(&ours), 0.0);
}

#[test]
fn a_wall_is_an_obstacle_a_step_that_can_be_climbed_is_none() {
    let blocks = [
        Block::new([0.6, -1.0, 0.0], [2.0, 0.0, 0.04], true),
        Block::new([0.8, 0.1, 0.0], [0.9, 1.0, 0.5], false),
    ];
    let mut both = Both::new();
    for _ in 0..3 {
        both.see(&blocks);
    }
    let view = both.averaging.view();
    assert!(matches!(view.at(0.82, 0.3), Surface::Obstacle(h) if h > 0.1));
    let floor = |x, y, wanted: f32| {
        let found = view.at(x, y);
        let right = matches!(found, Surface::Floor(h) if (h - wanted).abs() < 1e-3);
        assert!(right, "{found:?} at {x}, {y}, not {wanted}");
    };
    floor(0.5, 0.0, 0.0);
    floor(0.7, -0.2, 0.04);
    assert!(matches!(view.at(0.62, -0.2), Surface::Floor(_)));
    assert_eq!(view.at(1.2, 0.3), Surface::Unknown);
}

#[test]
fn the_floor_underfoot_is_known_and_heights_follow_the_window() {
    let mut map = Averaging::new(AveragingConfig::default()).unwrap();
    for _ in 0..3 {
        let _ = map.insert(&seen(&[]), &here()).unwrap();
    }
    assert_eq!(map.view().at(0.02, 0.02), Surface::Floor(0.0));
    let (cell, before) = (
        map.view().lattice.cell_at(0.7, 0.0),
        map.view().at(0.7, 0.0),
    );
    assert!(matches!(before, Surface::Floor(_)));
    assert_eq!(map.view().sightings.get(cell), Some(&3));
    let away = Pose::from_yaw(0.4, -0.2, 0.0, 0.0);
    let unseen = Planes::new(WIDTH * HEIGHT);
    assert!(!map.insert(&unseen, &away).unwrap().used);
    assert_eq!(map.view().at(0.7, 0.0), before);
    let moved = map.view().lattice.cell_at(0.7, 0.0);
    assert_ne!(moved, cell);
    assert_eq!(map.view().sightings.get(moved), Some(&3));
    let _ = map
        .insert(&unseen, &Pose::from_yaw(9.0, 0.0, 0.0, 0.0))
        .unwrap();
    assert_eq!(map.view().at(0.7, 0.0), Surface::Unknown);
}

#[test]
fn a_frame_without_ground_is_withdrawn_unless_it_fits_and_then_it_is_shifted() {
    let mut map = Averaging::new(AveragingConfig::default()).unwrap();
    let mut planes = seen(&[]);
    planes.reliable = false;
    assert!(!map.insert(&planes, &here()).unwrap().used);
    planes.reliable = true;
    assert!(map.insert(&planes, &here()).unwrap().used);
    planes.reliable = false;
    let too_high = Pose::from_yaw(0.0, 0.0, 0.008, 0.0);
    let insertion = map.insert(&planes, &too_high).unwrap();
    assert!(insertion.used);
    assert!((insertion.height_shift_m.unwrap() + 0.008).abs() < 1e-6);
    assert!(matches!(map.view().at(0.7, 0.0), Surface::Floor(h) if h.abs() < 1e-6));
}

#[test]
fn a_pose_that_is_no_number_changes_nothing() {
    let mut map = Averaging::new(AveragingConfig::default()).unwrap();
    let _ = map.insert(&seen(&[]), &here()).unwrap();
    let before = map.view().clone();
    for bad in [f64::NAN, f64::INFINITY] {
        let pose = Pose::from_yaw(bad, 0.0, 0.0, 0.0);
        let error = map.insert(&seen(&[]), &pose).unwrap_err();
        assert_eq!(error, MapError::PoseNotFinite);
    }
    let mut planes = seen(&[]);
    planes.robot_from_camera.inner.translation.z = f64::NAN;
    assert!(map.insert(&planes, &here()).is_err());
    assert_eq!(*map.view(), before);
}

#[test]
fn wild_input_is_survived() {
    let mut map = Averaging::new(AveragingConfig::default()).unwrap();
    let mut planes = seen(&[]);
    for (i, point) in planes.points_in_robot_m.iter_mut().enumerate() {
        match i % 4 {
            0 => *point = [f32::MAX, -f32::MAX, f32::MAX],
            1 => *point = [f32::INFINITY, 0.0, f32::NAN],
            _ => {}
        }
    }
    for x in [0.0, 1e9, -1e18, 0.3] {
        let at = Pose::from_yaw(x, 0.0, 0.0, 0.0);
        let insertion = map.insert(&planes, &at).unwrap();
        let (changed, all) = (insertion.changed, map.view().cells.area());
        assert!(changed.is_empty() || all.contains(changed.min) && all.contains(changed.max));
    }
}
