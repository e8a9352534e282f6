//! All segmenters on the same frames (F-C4, S-M1): which surfaces each finds, and which it merges.

use std::collections::HashMap;

use geometry::{Camera, Pose, Robot};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use sensing::Scan;

use crate::arbitrary::blocks;
use crate::finders::{
    Histogram, HistogramConfig, Hough, HoughConfig, Ransac, RansacConfig, ScanLine, ScanLine1994,
    ScanLine1994Config, ScanLineAdaptive, ScanLineAdaptiveConfig, ScanLineConfig,
};
use crate::{GroundConfig, Planes, Segmenter};
use testkit::synthetic::{Block, CAMERA, GROUND, Noise, Scene, camera_pose};

/// The sensor's noise, px.
const SIGMA: f64 = 0.125;
/// Smallest surface that counts, pixels.
const LEAST: usize = 100;
/// Frames of stairs in a score.
const FRAMES: usize = 20;

/// Does something with each segmenter and its name.
macro_rules! each {
    (|$name:ident, $segmenter:ident| $body:expr) => {{
        each!(@ "scan_line", ScanLine, ScanLineConfig, $name, $segmenter, $body);
        each!(@ "scan_line_1994", ScanLine1994, ScanLine1994Config, $name, $segmenter, $body);
        each!(@ "scan_line_adaptive", ScanLineAdaptive, ScanLineAdaptiveConfig, $name, $segmenter, $body);
        each!(@ "hough", Hough, HoughConfig, $name, $segmenter, $body);
        each!(@ "ransac", Ransac, RansacConfig, $name, $segmenter, $body);
        each!(@ "histogram", Histogram, HistogramConfig, $name, $segmenter, $body);
    }};
    (@ $label:literal, $type:ty, $config:ty, $name:ident, $segmenter:ident, $body:expr) => {{
        let $name = $label;
        let $segmenter = <$type>::new(&<$config>::default(), GroundConfig::default(), CAMERA).unwrap();
        $body
    }};
}

fn look(
    segmenter: &mut impl Segmenter,
    scene: &Scene,
    truth: &Pose<Robot, Camera>,
    noise: &mut Noise,
) -> Planes {
    let mut planes = Planes::new(CAMERA.width * CAMERA.height);
    let scan = scene.scan(truth, *truth, SIGMA, noise);
    segmenter.segment(&scan, &mut planes).unwrap();
    planes
}

/// The segmenter after it has seen open floor and tracks the ground.
fn tracking<S: Segmenter>(mut segmenter: S) -> S {
    let (mut noise, pose) = (Noise::new(3), camera_pose(0.0, 0.75));
    for _ in 0..8 {
        let _ = look(&mut segmenter, &Scene::floor(), &pose, &mut noise);
    }
    segmenter
}

/// What became of the level surfaces of scenes, after Hoover et al. (1996) at 80 % overlap. Pixels of risers, four rows
/// that lie within one matching window of both treads, may go to either.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Score {
    surfaces: usize,
    correct: usize,
    over: usize,
    under: usize,
    /// Regions of that size with a fifth of their pixels or more on each of two surfaces.
    merged: usize,
    /// Regions on two treads or more that lie along the slope of the stairs.
    diagonal: usize,
}

impl Score {
    fn add(&mut self, planes: &Planes, labels: &[u16]) {
        let truths: Vec<u16> = (0..8).map(|i| GROUND + 2 * i).collect();
        // Pixels that each region has of each surface; the last column is of no region.
        let mut shared = vec![vec![0; planes.regions.len() + 1]; truths.len()];
        for (at, label) in labels.iter().enumerate() {
            let seen = !planes.points_in_robot_m[at][0].is_nan();
            if let Some(truth) = truths.iter().position(|truth| seen && truth == label) {
                let found = usize::from(planes.labels[at]).checked_sub(1);
                shared[truth][found.unwrap_or(planes.regions.len())] += 1;
            }
        }
        let size = |region: usize| shared.iter().map(|row| row[region]).sum::<usize>();
        for row in &shared {
            self.add_surface(row, size);
        }
        for (i, region) in planes.regions.iter().enumerate() {
            let parts = || shared.iter().map(|row| row[i]);
            let good = parts().filter(|&part| 5 * part >= size(i)).count();
            self.merged += usize::from(good > 1 && size(i) >= LEAST);
            let slope = (-region.plane.normal.x).atan2(region.plane.normal.z);
            let treads = parts().skip(1).filter(|&part| 2 * part >= LEAST).count();
            self.diagonal += usize::from((0.14..0.35).contains(&slope) && treads > 1);
        }
    }

    /// One surface, by the pixels that each region has of it.
    fn add_surface(&mut self, row: &[usize], size: impl Fn(usize) -> usize) {
        let pixels: usize = row.iter().sum();
        if pixels < LEAST {
            return;
        }
        let mut regions = 0..row.len() - 1;
        let whole = |i: &usize| 5 * row[*i] >= 4 * pixels;
        let pure = |i: &usize| 5 * row[*i] >= 4 * size(*i);
        let in_pure: usize = regions.clone().filter(pure).map(|i| row[i]).sum();
        self.surfaces += 1;
        if regions.clone().any(|i| whole(&i) && pure(&i)) {
            self.correct += 1;
        } else if regions.any(|i| whole(&i)) {
            self.under += 1;
        } else if 5 * in_pure >= 4 * pixels {
            self.over += 1;
        }
    }
}

/// The score over frames of stairs, seen from here and there.
fn on_stairs<S: Segmenter + Clone>(tracked: &S, rise_m: f64) -> Score {
    let (mut noise, mut score) = (Noise::new(4), Score::default());
    for i in 0..FRAMES {
        let front_m = 0.2 + 0.05 * (i % 5) as f64;
        let truth = camera_pose(0.0, 0.8);
        let scene = Scene::stairs(front_m, rise_m, 0.12, 4);
        let planes = look(&mut tracked.clone(), &scene, &truth, &mut noise);
        let (_, labels) = scene.exact(&truth);
        score.add(&planes, &labels);
    }
    score
}

fn scores(rise_m: f64) -> HashMap<&'static str, Score> {
    let mut scores = HashMap::new();
    each!(|name, segmenter| {
        let score = on_stairs(&tracking(segmenter), rise_m);
        let _ = scores.insert(name, score);
    });
    scores
}

/// F-C4, S-M1.
#[test]
fn of_all_that_look_for_planes_ours_merges_least_and_finds_most_treads() {
    for rise_m in [0.03, 0.045] {
        let scores = scores(rise_m);
        let ours = scores["scan_line"];
        assert!(ours.surfaces >= 4 * FRAMES);
        assert_eq!((ours.merged, ours.under), (0, 0), "{ours:?}");
        assert!(10 * ours.correct >= 9 * ours.surfaces, "{ours:?}");
        for name in ["scan_line_1994", "scan_line_adaptive", "hough", "ransac"] {
            let other = scores[name];
            assert_eq!(other.surfaces, ours.surfaces);
            assert!(other.merged > 0, "{name} at {rise_m} m: {other:?}");
            assert!(
                other.correct < ours.correct,
                "{name} at {rise_m} m: {other:?}"
            );
        }
    }
}

/// Steps of 30 mm are less than what free planes can tell from the slope of the stairs: what 003 says of Hough.
#[test]
fn free_planes_run_along_the_slope_of_the_stairs_ours_never() {
    let scores = scores(0.03);
    assert_eq!(scores["scan_line"].diagonal, 0);
    for name in ["hough", "ransac"] {
        let theirs = scores[name];
        assert!(theirs.diagonal >= FRAMES, "{name}: {theirs:?}");
        assert!(4 * theirs.correct < theirs.surfaces, "{name}: {theirs:?}");
    }
}

/// What a trial had found: heights alone tell parallel treads apart.
#[test]
fn the_histogram_tells_parallel_treads_apart_as_well_as_ours() {
    for rise_m in [0.03, 0.045] {
        let scores = scores(rise_m);
        let (theirs, ours) = (scores["histogram"], scores["scan_line"]);
        assert_eq!((theirs.merged, theirs.diagonal), (0, 0));
        assert!(theirs.correct + 2 >= ours.correct, "{theirs:?} {ours:?}");
    }
}

#[test]
fn two_tops_of_one_height_are_one_surface_to_the_histogram_and_two_to_ours() {
    let top = |low: f64, high: f64| Block {
        low_m: [0.4, low, 0.0],
        high_m: [0.65, high, 0.06],
    };
    let scene = Scene::with(&[top(-0.3, -0.08), top(0.08, 0.3)]);
    let truth = camera_pose(0.0, 0.75);
    let (_, labels) = scene.exact(&truth);
    each!(|name, segmenter| {
        let mut tracked = tracking(segmenter);
        let planes = look(&mut tracked, &scene, &truth, &mut Noise::new(5));
        let largest = |truth: u16| {
            let count = |i: usize| {
                let pixels = labels.iter().zip(&planes.labels);
                let both = pixels.filter(|&(&l, &found)| l == truth && usize::from(found) == i + 1);
                both.count()
            };
            (0..planes.regions.len()).max_by_key(|&i| count(i))
        };
        let one = largest(GROUND + 2) == largest(GROUND + 4);
        match name {
            "scan_line" => assert!(!one),
            "histogram" => assert!(one),
            _ => {}
        }
    });
}

#[test]
fn each_finds_the_floor_and_levels_a_camera_that_is_turned_and_low() {
    each!(|name, segmenter| {
        let (mut noise, mut tilts) = (Noise::new(2), vec![]);
        for _ in 0..15 {
            let truth = camera_pose(noise.within(0.3), 0.75);
            let turn = Vector3::new(noise.within(0.12), 0.0, noise.within(0.12));
            let mut believed = truth;
            believed.inner.rotation *= UnitQuaternion::new(turn);
            believed.inner.translation.vector.z += noise.within(0.01);
            let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
            let mut planes = Planes::new(CAMERA.width * CAMERA.height);
            segmenter.clone().segment(&scan, &mut planes).unwrap();
            let ground = planes.ground.unwrap_or_else(|| panic!("{name}: no ground"));
            let support = planes.regions[ground].support;
            assert!(10 * support > 8 * scan.valid, "{name}: {support}");
            let found = planes.robot_from_camera.inner;
            let up = found.rotation * truth.inner.rotation.inverse() * Vector3::z();
            tilts.push(up.xy().norm().asin().to_degrees());
            let low_m = found.translation.z - truth.inner.translation.z;
            assert!(low_m.abs() < 0.008, "{name}: {low_m}");
        }
        tilts.sort_by(f64::total_cmp);
        assert!(tilts[7] < 0.4 && tilts[14] < 1.2, "{name}: {tilts:?}");
    });
}

#[test]
fn each_describes_a_wall_by_its_normal_and_calls_none_of_it_floor() {
    let wall = Block {
        low_m: [0.5, -2.0, 0.0],
        high_m: [0.6, 2.0, 1.0],
    };
    let (scene, truth) = (Scene::with(&[wall]), camera_pose(0.0, 0.6));
    each!(|name, segmenter| {
        let mut tracked = tracking(segmenter);
        let planes = look(&mut tracked, &scene, &truth, &mut Noise::new(7));
        let regions = planes.regions.iter();
        let largest = regions
            .filter(|region| region.plane.normal.x < -0.97)
            .max_by_key(|region| region.support)
            .unwrap_or_else(|| panic!("{name}: no wall"));
        assert!(largest.support > 800, "{name}: {}", largest.support);
        let off_m = largest.plane.distance_m + 0.5;
        assert!(off_m.abs() < 0.02, "{name}: {off_m}");
        let all = (0..planes.labels.len()).filter(|&at| planes.points_in_robot_m[at][2] > 0.08);
        let floor = all
            .clone()
            .filter(|&at| !planes.floor_height_m[at].is_nan());
        let (floor, all) = (floor.count(), all.count());
        assert!(20 * floor < all, "{name}: {floor} of {all}");
    });
}

#[test]
fn each_gives_the_same_product_for_the_same_frames() {
    let scene = Scene::stairs(0.3, 0.03, 0.12, 4);
    each!(|name, segmenter| {
        let tracked = tracking(segmenter);
        let again = || {
            let (mut noise, truth) = (Noise::new(12), camera_pose(0.1, 0.75));
            look(&mut tracked.clone(), &scene, &truth, &mut noise)
        };
        let (first, second) = (again(), again());
        assert_eq!(first.labels, second.labels, "{name}");
        assert_eq!(first.regions, second.regions, "{name}");
    });
}

#[test]
fn nothing_seen_is_an_ordinary_product_of_each() {
    each!(|name, segmenter| {
        for value in [f32::NAN, 0.0, 3.0, 24.0, f32::INFINITY, -5.0] {
            let mut planes = Planes::new(CAMERA.width * CAMERA.height);
            let mut scan = Scan::new(CAMERA);
            scan.robot_from_camera = camera_pose(0.0, 0.75);
            scan.disparity_px.fill(value);
            segmenter.clone().segment(&scan, &mut planes).unwrap();
            let found = (planes.ground, planes.reliable);
            assert_eq!(found, (None, false), "{name} {value}");
        }
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn every_product_of_each_is_consistent(
        blocks in blocks(),
        pan in -0.6..0.6f64, tilt in 0.2..1.0f64, seed in 0..1000u64,
    ) {
        let truth = camera_pose(pan, tilt);
        each!(|name, segmenter| {
            let mut tracked = tracking(segmenter);
            let planes = look(&mut tracked, &Scene::with(&blocks), &truth, &mut Noise::new(seed));
            let mut supports = vec![0; planes.regions.len()];
            for (at, &label) in planes.labels.iter().enumerate() {
                let height_m = planes.floor_height_m[at];
                prop_assert!(label == 0 || !planes.points_in_robot_m[at][0].is_nan());
                let region = usize::from(label).checked_sub(1).map(|i| &planes.regions[i]);
                let floor_m = region.and_then(|region| region.floor_height_m);
                prop_assert_eq!(floor_m.map(|h| h as f32), (!height_m.is_nan()).then_some(height_m), "{}", name);
                if label > 0 {
                    supports[usize::from(label) - 1] += 1;
                }
            }
            for (region, support) in planes.regions.iter().zip(supports) {
                prop_assert_eq!(region.support, support, "{}", name);
                prop_assert!((region.plane.normal.norm() - 1.0).abs() < 1e-9);
                prop_assert!((region.plane.normal.dot(&region.mean.inner.coords) - region.plane.distance_m).abs() < 1e-3);
            }
            if let Some(ground) = planes.ground {
                prop_assert_eq!(planes.regions[ground].floor_height_m, Some(0.0));
            }
        });
    }
}
