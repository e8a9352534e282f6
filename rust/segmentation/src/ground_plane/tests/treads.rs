//! On a tread the ground is out of view: its place is taken by treads of known height, or by what was tracked before.

use super::*;

/// The steps of a staircase seen by a robot that stands on one of them.
#[derive(Debug, Clone, Copy)]
struct Steps {
    rise_m: f64,
    tread_m: f64,
}

impl Steps {
    /// Height of the tread at a place: the robot's own reaches to 7 cm before it.
    fn height_m(&self, x_m: f64) -> f64 {
        ((x_m - 0.07) / self.tread_m).floor().clamp(-1.0, 5.0) * self.rise_m + self.rise_m
    }

    fn scene(&self) -> Scene {
        let block = |i: i32| {
            let back = 0.07 + f64::from(i) * self.tread_m;
            let far = if i == 6 { 1.5 } else { back };
            Block {
                low_m: [back - self.tread_m, -0.6, -0.5],
                high_m: [far, 0.6, f64::from(i) * self.rise_m],
            }
        };
        Scene {
            ground: false,
            blocks: (-2..=6).map(block).collect(),
        }
    }
}

/// What the map knows: the steps, raised by an error.
fn told(steps: Steps, off_m: f64) -> impl Fn(f64, f64) -> Option<f64> {
    move |x_m, _| Some(steps.height_m(x_m) + off_m)
}

fn see(
    segmenter: &mut ScanLine,
    steps: Steps,
    low_m: f64,
    known: &KnownFloor<'_>,
    noise: &mut Noise,
) -> (Planes, Pose<Robot, Camera>) {
    let truth = camera_pose(noise.within(0.3), 0.85 + noise.within(0.1));
    let mut believed = truth;
    believed.inner.translation.vector.z -= low_m;
    let scan = steps.scene().scan(&truth, believed, SIGMA, noise);
    let mut planes = planes();
    segmenter.segment_known(&scan, known, &mut planes).unwrap();
    (planes, truth)
}

const STAIRS: [Steps; 4] = [
    Steps {
        rise_m: 0.03,
        tread_m: 0.12,
    },
    Steps {
        rise_m: -0.03,
        tread_m: 0.12,
    },
    Steps {
        rise_m: 0.045,
        tread_m: 0.15,
    },
    Steps {
        rise_m: 0.024,
        tread_m: 0.2,
    },
];

#[test]
fn treads_of_known_height_put_the_camera_right() {
    for steps in STAIRS {
        let mut noise = Noise::new(21);
        let mut errors = vec![];
        for low_m in [-0.005, -0.002, 0.002, 0.005] {
            let mut segmenter = tracking(&mut noise);
            for _ in 0..6 {
                let told = told(steps, 0.0);
                let (planes, truth) = see(&mut segmenter, steps, low_m, &told, &mut noise);
                assert!(planes.reliable && planes.ground.is_none());
                let (tilt, height) = pose_error(&planes, &truth);
                assert!(tilt < 0.02, "{steps:?}: {tilt}");
                errors.push(height.abs());
            }
        }
        errors.sort_by(f64::total_cmp);
        assert!(errors[12] < 0.0015, "{steps:?}: {errors:?}");
        assert!(errors[23] < 0.005, "{steps:?}: {errors:?}");
    }
}

#[test]
fn a_low_staircase_is_not_taken_for_a_level_floor_under_a_tilted_camera() {
    for rise_m in [-0.016, 0.016] {
        let steps = Steps {
            rise_m,
            tread_m: 0.16,
        };
        let mut noise = Noise::new(5);
        let mut tilts = vec![];
        for _ in 0..6 {
            let mut segmenter = tracking(&mut noise);
            for _ in 0..4 {
                let (planes, truth) = see(&mut segmenter, steps, 0.0, &|_, _| None, &mut noise);
                tilts.push(pose_error(&planes, &truth).0);
            }
        }
        tilts.sort_by(f64::total_cmp);
        assert!(tilts[12] < 0.005 && tilts[23] < 0.02, "{rise_m}: {tilts:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn a_level_is_never_taken_for_another_one(
        which in 0..4usize, off_m in 0.014..0.03f64, up in any::<bool>(), seed in 0..1000u64,
    ) {
        let steps = STAIRS[which];
        let mut noise = Noise::new(seed);
        let mut segmenter = tracking(&mut noise);
        let held = segmenter.correction.predict(&camera_pose(0.0, 0.75));
        let told = told(steps, if up { off_m } else { -off_m });
        for _ in 0..3 {
            let (planes, _) = see(&mut segmenter, steps, 0.0, &told, &mut noise);
            prop_assert!(planes.reliable && planes.ground.is_none());
        }
        prop_assert_eq!(segmenter.correction.predict(&camera_pose(0.0, 0.75)), held);
    }

    /// One frame's tilt errs by half a degree, 4 mm at half a metre, so that a single frame now and then sees a known level
    /// beyond the gate; the frames together do not.
    #[test]
    fn a_level_close_to_where_it_is_known_is_taken(
        which in 0..4usize, off_m in -0.004..0.004f64, seed in 0..1000u64,
    ) {
        let steps = STAIRS[which];
        let mut noise = Noise::new(seed);
        let mut segmenter = tracking(&mut noise);
        let told = told(steps, off_m);
        let misses_m: Vec<_> = (0..9)
            .map(|_| {
                let (planes, _) = see(&mut segmenter, steps, 0.0, &told, &mut noise);
                let near = planes.points_in_robot_m.iter().zip(&planes.floor_height_m);
                median(
                    near.filter(|(point, height_m)| point[0] < 0.6 && !height_m.is_nan())
                        .map(|(point, &height_m)| f64::from(height_m) - steps.height_m(f64::from(point[0])) - off_m)
                        .collect(),
                )
            })
            .collect();
        prop_assert!(median(misses_m.clone()).abs() < 0.004, "{misses_m:?}");
    }
}

#[test]
fn on_unknown_treads_the_tracked_correction_is_held_and_the_ground_is_not_searched_anew() {
    for steps in &STAIRS[..2] {
        let mut noise = Noise::new(22);
        let mut segmenter = tracking(&mut noise);
        let held = segmenter.correction.predict(&camera_pose(0.0, 0.75));
        let config = GroundConfig::default();
        for frame in 0..config.forget_frames + 10 {
            let (planes, truth) = see(&mut segmenter, *steps, 0.0, &|_, _| None, &mut noise);
            let (tilt, _) = pose_error(&planes, &truth);
            assert!(
                planes.reliable && planes.ground.is_none(),
                "{steps:?} frame {frame}"
            );
            assert!(tilt < 0.03, "{steps:?} frame {frame}: {tilt}");
        }
        assert_eq!(segmenter.correction.predict(&camera_pose(0.0, 0.75)), held);
    }
}

/// S9: what the ground's correction is worth for the height of a step.
#[test]
fn steps_are_high_to_three_millimetres_with_the_ground_and_to_no_ten_without() {
    let mut noise = Noise::new(23);
    let (mut with, mut without) = (vec![], vec![]);
    for _ in 0..8 {
        let sign = if noise.uniform() < 0.5 { -1.0 } else { 1.0 };
        let turn = Vector3::new(sign * (0.035 + 0.05 * noise.uniform()), 0.0, 0.0);
        let wrong = |truth: Pose<Robot, Camera>| {
            let mut believed = truth;
            believed.inner.rotation *= UnitQuaternion::new(turn);
            believed.inner.translation.vector.z += 0.015 * sign;
            believed
        };
        let (mut segmenter, mut planes) = (segmenter(), planes());
        for (scene, frames) in [(Scene::floor(), 8), (Scene::stairs(0.35, 0.03, 0.12, 4), 1)] {
            let truth = camera_pose(0.0, 0.8);
            for _ in 0..frames {
                let scan = scene.scan(&truth, wrong(truth), SIGMA, &mut noise);
                segmenter.segment(&scan, &mut planes).unwrap();
            }
            if frames > 1 {
                continue;
            }
            let (_, labels) = scene.exact(&truth);
            let step = (0..planes.regions.len())
                .find(|&i| true_label(&planes, &labels, i) == GROUND + 2)
                .unwrap();
            with.push((planes.regions[step].floor_height_m.unwrap() - 0.03).abs());
            let back = wrong(truth).inner * planes.robot_from_camera.inner.inverse();
            let by_joints = back * planes.regions[step].mean.inner;
            without.push((by_joints.z - 0.03).abs());
        }
    }
    assert!(median(with.clone()) < 0.003, "{with:?}");
    assert!(with.iter().all(|&error| error < 0.006), "{with:?}");
    assert!(median(without.clone()) > 0.01, "{without:?}");
}

/// S-M2: the ground before stairs is found when enough of it is seen, and is the ground.
#[test]
fn a_ground_of_400_pixels_is_found_before_stairs() {
    let mut noise = Noise::new(24);
    let (mut enough, mut found) = (0, 0);
    for front_m in [0.25, 0.3, 0.4, 0.55] {
        let mut segmenter = tracking(&mut noise);
        let scene = Scene::stairs(front_m, 0.03, 0.12, 4);
        for _ in 0..15 {
            let truth = camera_pose(noise.within(0.3), 0.7 + 0.3 * noise.uniform());
            let planes = look(&mut segmenter, &scene, &truth, &mut noise);
            let (_, labels) = scene.exact(&truth);
            let seen = labels.iter().zip(&planes.points_in_robot_m);
            let ground_px = seen
                .filter(|(label, point)| **label == GROUND && !point[0].is_nan())
                .count();
            if ground_px < 400 {
                continue;
            }
            enough += 1;
            if let Some(ground) = planes.ground {
                found += 1;
                assert_eq!(true_label(&planes, &labels, ground), GROUND);
            }
        }
    }
    assert!(enough > 30, "{enough}");
    assert!(100 * found >= 97 * enough, "{found} of {enough}");
}
