//! Laws of the step model, on exact rays and with the errors of block matching.

use geometry::{Camera, Map, Point, Pose, Robot};
use proptest::prelude::*;
use segmentation::Planes;
use sensing::Scan;
use testkit::synthetic::{Block, CAMERA, Noise, Scene, camera_pose};

use super::*;

/// An edge across the world's x axis, seen by a robot that is turned against it.
#[derive(Debug, Clone, Copy)]
struct View {
    front_m: f64,
    rise_m: f64,
    yaw_rad: f64,
    tilt_rad: f64,
}

impl View {
    /// The near surface at height 0 up to the edge, the far one behind it.
    fn scene(&self) -> Scene {
        let block = |from_m: f64, to_m: f64, top_m: f64| Block {
            low_m: [from_m, -0.9, -0.2],
            high_m: [to_m, 0.9, top_m],
        };
        Scene {
            ground: false,
            blocks: vec![
                block(-1.0, self.front_m, 0.0),
                block(self.front_m, 1.5, self.rise_m),
            ],
        }
    }

    fn world_from_robot(&self) -> Pose<Map, Robot> {
        Pose::from_yaw(0.0, 0.0, 0.0, self.yaw_rad)
    }

    fn world_from_camera(&self) -> Pose<Robot, Camera> {
        let robot = camera_pose(0.0, self.tilt_rad).inner;
        Pose::wrap(self.world_from_robot().inner * robot)
    }

    fn edge(&self) -> Edge<Robot> {
        let top_m = self.rise_m.max(0.0);
        Edge {
            left: Point::<Map>::new(self.front_m, 0.3, top_m),
            right: Point::<Map>::new(self.front_m, -0.3, top_m),
        }
        .transformed(&self.world_from_robot().inverse())
    }

    /// The true edge shifted and turned.
    fn guess(&self, shift_m: f64, turn_rad: f64) -> Edge<Robot> {
        let about: Pose<Robot, Robot> = Pose::from_yaw(shift_m, 0.0, 0.0, turn_rad);
        self.edge().transformed(&about)
    }

    fn planes(&self) -> Planes {
        let mut planes = Planes::new(CAMERA.width * CAMERA.height);
        planes.robot_from_camera = camera_pose(0.0, self.tilt_rad);
        planes
    }

    fn exact(&self) -> Scan {
        let mut scan = Scan::new(CAMERA);
        (scan.disparity_px, _) = self.scene().exact(&self.world_from_camera());
        scan.valid = scan.disparity_px.len();
        scan
    }

    /// Exact rays as a matcher with windows of 5x5 pixels and a correlation peak of 1 px sees them; no border.
    fn matched(&self) -> Scan {
        let mut scan = self.exact();
        let exact = scan.disparity_px.clone();
        let width = CAMERA.width;
        for (at, value) in scan.disparity_px.iter_mut().enumerate() {
            let (col, row) = (at % width, at / width);
            if col < 2 || row < 2 || col + 2 >= width || row + 2 >= CAMERA.height {
                *value = f32::NAN;
                continue;
            }
            let inside: Vec<f32> = (0..25)
                .map(|i| exact[(row + i / 5 - 2) * width + col + i % 5 - 2])
                .collect();
            *value = inside.iter().copied().fold(0.0, f32::max);
            for _ in 0..5 {
                let near: Vec<f32> = inside
                    .iter()
                    .copied()
                    .filter(|other| (other - *value).abs() < 1.0)
                    .collect();
                *value = near.iter().sum::<f32>() / near.len() as f32;
            }
        }
        scan
    }

    fn fit(&self, scan: &Scan, guess: &Edge<Robot>) -> Result<FittedEdge, Untrusted> {
        EdgeModel::new(CAMERA, EdgeModelTuning::default()).fit(
            scan,
            &self.planes(),
            guess,
            0.0,
            self.rise_m,
        )
    }

    /// Error of the place, m, at the true edge's point that is nearest to the robot, and of the heading, rad.
    fn errors(&self, fitted: &FittedEdge) -> (f64, f64) {
        let truth = self.edge();
        let (sin, cos) = libm::sincos(truth.heading_rad());
        let place_m = fitted
            .edge
            .beyond_m([self.front_m * cos, self.front_m * sin]);
        (place_m, fitted.edge.heading_rad() - truth.heading_rad())
    }
}

fn near_view(rise_m: f64) -> View {
    View {
        front_m: 0.28,
        rise_m,
        yaw_rad: 0.12,
        tilt_rad: 0.95,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn exact_rays_give_the_edge_of_a_rise_to_a_millimetre(
        front_m in 0.24..0.38f64, rise_m in 0.015..0.05f64, yaw_rad in -0.35..0.35f64,
        shift_m in -0.03..0.03f64, turn_rad in -0.15..0.15f64,
    ) {
        let view = View { front_m, rise_m, yaw_rad, tilt_rad: 0.95 };
        let fitted = view.fit(&view.exact(), &view.guess(shift_m, turn_rad)).unwrap();
        let (place_m, turn_rad) = view.errors(&fitted);
        prop_assert!(place_m.abs() < 0.002 && turn_rad.abs() < 0.02, "{place_m} {turn_rad}");
    }

    #[test]
    fn matched_rays_give_the_edge_of_a_drop_to_half_a_pixel(
        front_m in 0.24..0.38f64, drop_m in 0.015..0.05f64, yaw_rad in -0.35..0.35f64,
        shift_m in -0.03..0.03f64, turn_rad in -0.15..0.15f64,
    ) {
        let view = View { front_m, rise_m: -drop_m, yaw_rad, tilt_rad: 0.95 };
        let fitted = view.fit(&view.matched(), &view.guess(shift_m, turn_rad)).unwrap();
        let (place_m, turn_rad) = view.errors(&fitted);
        prop_assert!(place_m.abs() < 0.0045 && turn_rad.abs() < 0.03, "{place_m} {turn_rad}");
    }
}

#[test]
fn windows_that_see_both_surfaces_do_not_shift_the_edge() {
    for rise_m in [0.05, 0.03, 0.015, -0.015, -0.03, -0.04, -0.05] {
        for yaw_rad in [0.05, -0.2] {
            let view = View {
                yaw_rad,
                ..near_view(rise_m)
            };
            let fitted = view.fit(&view.matched(), &view.guess(0.01, 0.05)).unwrap();
            let (place_m, turn_rad) = view.errors(&fitted);
            assert!(
                place_m.abs() < 0.002 && turn_rad.abs() < 0.02,
                "{rise_m}: {place_m} {turn_rad}"
            );
        }
    }
}

#[test]
fn heights_that_are_off_are_refined() {
    let view = near_view(0.03);
    let fitted = EdgeModel::new(CAMERA, EdgeModelTuning::default())
        .fit(
            &view.exact(),
            &view.planes(),
            &view.guess(0.01, 0.0),
            0.003,
            0.034,
        )
        .unwrap();
    assert!(fitted.near_height_m.abs() < 0.001);
    assert!((fitted.far_height_m - 0.03).abs() < 0.001);
}

#[test]
fn a_mirrored_scene_gives_the_mirrored_edge() {
    for rise_m in [0.03, -0.03] {
        let view = near_view(rise_m);
        let mirrored = View {
            yaw_rad: -view.yaw_rad,
            ..view
        };
        let scan = view.exact();
        let mut flipped = scan.clone();
        for line in flipped.disparity_px.chunks_exact_mut(CAMERA.width) {
            line.reverse();
        }
        let one = view.fit(&scan, &view.guess(0.01, 0.1)).unwrap().edge;
        let guess = view.guess(0.01, 0.1);
        let mirror =
            |point: Point<Robot>| Point::<Robot>::new(point.inner.x, -point.inner.y, point.inner.z);
        let other = Edge {
            left: mirror(guess.right),
            right: mirror(guess.left),
        };
        let other = mirrored.fit(&flipped, &other).unwrap().edge;
        assert!((mirror(other.right).inner - one.left.inner).norm() < 0.002);
        assert!((mirror(other.left).inner - one.right.inner).norm() < 0.002);
    }
}

#[test]
fn noise_leaves_near_edges_within_10_mm_and_3_degrees() {
    let (mut right, mut all) = (0, 0);
    for seed in 0..60 {
        let mut noise = Noise::new(seed);
        let sign = if seed % 2 == 0 { 1.0 } else { -1.0 };
        let view = View {
            front_m: 0.31 + noise.within(0.07),
            rise_m: sign * (0.035 + noise.within(0.015)),
            yaw_rad: noise.within(0.3),
            tilt_rad: 0.95,
        };
        let believed = camera_pose(0.0, view.tilt_rad);
        let scan = view
            .scene()
            .scan(&view.world_from_camera(), believed, 0.125, &mut noise);
        let guess = view.guess(noise.within(0.03), noise.within(0.15));
        all += 1;
        if let Ok(fitted) = view.fit(&scan, &guess) {
            let (place_m, turn_rad) = view.errors(&fitted);
            right += usize::from(place_m.abs() < 0.01 && turn_rad.abs() < 0.052);
        }
    }
    assert!(right * 100 >= all * 93, "{right} of {all}");
}

#[test]
fn an_edge_is_refused_when_the_surface_before_it_is_out_of_view() {
    // Seen from above at this gaze, the picture begins a few centimetres behind, at, or just before the edge.
    for front_m in [0.12, 0.16, 0.19] {
        for rise_m in [0.03, -0.03] {
            let view = View {
                front_m,
                rise_m,
                yaw_rad: 0.0,
                tilt_rad: 0.8,
            };
            for shift_m in [0.0, 0.03, 0.06] {
                let outcome = view.fit(&view.exact(), &view.guess(shift_m, 0.05));
                assert!(
                    outcome.is_err(),
                    "{front_m} {rise_m} {shift_m}: {outcome:?}"
                );
            }
        }
    }
}

#[test]
fn where_there_is_no_step_none_is_found() {
    let view = near_view(0.03);
    let flat = View {
        rise_m: 0.0,
        ..view
    };
    assert!(view.fit(&flat.exact(), &view.guess(0.0, 0.0)).is_err());
    let none = Untrusted::NoContrast(0.0);
    assert_eq!(flat.fit(&flat.exact(), &view.guess(0.0, 0.0)), Err(none));
}

#[test]
fn bad_numbers_are_refused() {
    let view = near_view(0.03);
    let mut guess = view.guess(0.0, 0.0);
    guess.left.inner.x = f64::NAN;
    assert_eq!(view.fit(&view.exact(), &guess), Err(Untrusted::BadGuess));
    let behind: Pose<Robot, Robot> = Pose::from_yaw(-0.6, 0.0, 0.0, 0.0);
    let guess = view.edge().transformed(&behind);
    assert!(view.fit(&view.exact(), &guess).is_err());
}

#[test]
fn a_blind_frame_shows_no_edge() {
    let view = near_view(0.03);
    let scan = Scan::new(CAMERA);
    assert!(view.fit(&scan, &view.guess(0.0, 0.0)).is_err());
}
