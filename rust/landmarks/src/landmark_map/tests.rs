//! Small filters against one for all, and what a map holds.

use super::*;
use geometry::SplitMix64;
use nalgebra::{DMatrix, DVector, Dyn, OMatrix, U2};
use proptest::prelude::*;

const PLACES_M: [[f64; 2]; 5] = [
    [4.0, 1.0],
    [3.0, -3.0],
    [-2.0, 3.0],
    [0.5, -4.0],
    [4.0, 4.0],
];

fn config() -> LandmarksConfig {
    LandmarksConfig {
        range_noise: 0.1,
        bearing_noise: 0.02,
        apart: [0.0, 0.0],
        ..LandmarksConfig::default()
    }
}

/// Where the robot is at a step: somewhere on a circle, looking somewhere.
fn pose(step: usize) -> PlanarPose {
    let angle = 0.37 * step as f64;
    let (sin, cos) = libm::sincos(angle);
    PlanarPose::new(1.0 + cos, 0.3 + sin, geometry::wrap_angle(2.3 * angle))
}

/// A reading of every landmark, with the sensor's noise.
fn readings(
    robot: &PlanarPose,
    random: &mut SplitMix64,
    config: &LandmarksConfig,
) -> Vec<LandmarkReading> {
    (0_u32..)
        .zip(PLACES_M)
        .map(|(name, at)| {
            let true_one = ExpectedReading::of(robot, &Vector2::from(at))
                .unwrap()
                .reading;
            let [range, bearing] = random.normals();
            let at = RangeBearing {
                range_m: true_one.range_m + config.range_noise * range,
                bearing_rad: true_one.bearing_rad + config.bearing_noise * bearing,
            };
            LandmarkReading {
                at,
                name: Some(name),
            }
        })
        .collect()
}

/// One filter for all: pose and K places in one state of 2 K + 3 numbers; the pose is told anew at each step, with no error.
struct FullFilter {
    state: DVector<f64>,
    covariance: DMatrix<f64>,
    known: [bool; PLACES_M.len()],
}

impl FullFilter {
    fn new() -> Self {
        let size = 3 + 2 * PLACES_M.len();
        Self {
            state: DVector::zeros(size),
            covariance: DMatrix::zeros(size, size),
            known: [false; PLACES_M.len()],
        }
    }

    fn see(&mut self, robot: &PlanarPose, sighting: &LandmarkReading, config: &LandmarksConfig) {
        for (at, value) in [robot.x_m, robot.y_m, robot.yaw_rad]
            .into_iter()
            .enumerate()
        {
            self.state[at] = value;
        }
        let which = sighting.name.unwrap() as usize;
        let at = 3 + 2 * which;
        if !std::mem::replace(&mut self.known[which], true) {
            let by = sighting.at.place_by_reading(robot);
            let spread = by * noise(config) * by.transpose();
            self.state
                .fixed_rows_mut::<2>(at)
                .copy_from(&sighting.at.place_m(robot));
            self.covariance
                .fixed_view_mut::<2, 2>(at, at)
                .copy_from(&spread);
            return;
        }
        let place = self.state.fixed_rows::<2>(at).into_owned();
        let expected = ExpectedReading::of(robot, &place).unwrap();
        let mut by = OMatrix::<f64, U2, Dyn>::zeros(self.state.len());
        by.fixed_view_mut::<2, 3>(0, 0).copy_from(&expected.by_pose);
        by.fixed_view_mut::<2, 2>(0, at)
            .copy_from(&expected.by_landmark);
        let spread = &by * &self.covariance * by.transpose() + noise(config);
        let gain = &self.covariance * by.transpose() * spread.try_inverse().unwrap();
        self.state += &gain * sighting.at.minus(&expected.reading);
        self.covariance = &self.covariance - &gain * by * &self.covariance;
    }
}

proptest! {
    #[test]
    fn separate_filters_are_one_full_filter_where_the_pose_is_known(seed in 0..1000_u64, steps in 1..20_usize) {
        // All of Gauss's law, so that none is doubted.
        let config = LandmarksConfig { gate: 1.0 - 1e-13, new_beyond: 1.0 - 1e-14, ..config() };
        let mut random = SplitMix64::new(seed);
        let (mut map, mut full) = (LandmarkMap::new(config.clone()).unwrap(), FullFilter::new());
        for step in 0..steps {
            let robot = pose(step);
            let seen = readings(&robot, &mut random, &config);
            map.insert(&robot, &seen, [step as f64, 0.0]);
            for sighting in &seen { full.see(&robot, sighting, &config); }
        }
        for (index, one) in map.landmarks().enumerate() {
            let at = 3 + 2 * index;
            prop_assert!((one.at_m - full.state.fixed_rows::<2>(at)).norm() < 1e-9);
            prop_assert!((one.covariance - full.covariance.fixed_view::<2, 2>(at, at)).norm() < 1e-9);
        }
        // The pose is known, and no landmark tells of another.
        for row in 0..full.state.len() {
            for column in (0..full.state.len()).filter(|column| row < 3 || (row - 3) / 2 != (column.max(&3) - 3) / 2) {
                prop_assert!(full.covariance[(row, column)].abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_landmark_becomes_no_less_certain_by_a_reading(seed in 0..1000_u64) {
        let config = config();
        let mut random = SplitMix64::new(seed);
        let mut map = LandmarkMap::new(config.clone()).unwrap();
        let mut before = [f64::INFINITY; PLACES_M.len()];
        for step in 0..10 {
            let robot = pose(step);
            map.insert(&robot, &readings(&robot, &mut random, &config), [step as f64, 0.0]);
            for (one, before) in map.landmarks().zip(&mut before) {
                let now = one.covariance.determinant();
                prop_assert!(now > 0.0 && now <= *before * (1.0 + 1e-9));
                *before = now;
            }
        }
    }
}

#[test]
fn errors_are_as_large_as_the_filters_say() {
    let config = LandmarksConfig {
        gate: 1.0 - 1e-13,
        new_beyond: 1.0 - 1e-14,
        ..config()
    };
    let (runs, mut sum) = (200, 0.0);
    for seed in 0..runs {
        let mut random = SplitMix64::new(seed);
        let mut map = LandmarkMap::new(config.clone()).unwrap();
        for step in 0..30 {
            let robot = pose(step);
            map.insert(
                &robot,
                &readings(&robot, &mut random, &config),
                [step as f64, 0.0],
            );
        }
        for (one, at) in map.landmarks().zip(PLACES_M) {
            let off = one.at_m - Vector2::from(at);
            sum += (off.transpose() * one.covariance.try_inverse().unwrap() * off).x;
        }
    }
    // Chi-squared with two degrees of freedom for each landmark of each run, nearly normal: 95 % lie within 1.96 standard deviations.
    let freedom = 2.0 * (runs as usize * PLACES_M.len()) as f64;
    let bound = 1.96 * (2.0 * freedom).sqrt();
    assert!(
        (sum - freedom).abs() < bound,
        "{sum} of {freedom} give or take {bound}"
    );
}

#[test]
fn what_is_not_seen_where_it_should_be_is_forgotten_and_what_is_seen_stays() {
    let config = LandmarksConfig {
        named: false,
        seen: 0.8,
        ..config()
    };
    let robot = PlanarPose::default();
    let at = |range_m, bearing_rad| LandmarkReading {
        at: RangeBearing {
            range_m,
            bearing_rad,
        },
        name: None,
    };
    let mut map = LandmarkMap::new(config).unwrap();
    map.insert(&robot, &[at(2.0, 0.1), at(4.0, -0.2)], [0.0; 2]);
    assert_eq!(map.landmarks().len(), 2);
    for step in 1..10 {
        map.insert(&robot, &[at(2.0, 0.1)], [f64::from(step), 0.0]);
    }
    let left: Vec<_> = map.landmarks().collect();
    assert_eq!(left.len(), 1);
    assert!(left[0].probability() > 0.9 && left[0].at_m.x < 2.1);
}

#[test]
fn two_readings_of_one_time_are_of_two_landmarks() {
    let config = LandmarksConfig {
        named: false,
        ..config()
    };
    let robot = PlanarPose::default();
    let at = |range_m| LandmarkReading {
        at: RangeBearing {
            range_m,
            bearing_rad: 0.0,
        },
        name: None,
    };
    let mut map = LandmarkMap::new(config).unwrap();
    map.insert(&robot, &[at(2.0), at(3.5)], [0.0; 2]);
    // The second fits the first best, and the first is taken.
    map.insert(&robot, &[at(2.02), at(2.05)], [1.0, 0.0]);
    let readings: Vec<u32> = map.landmarks().map(|one| one.readings).collect();
    assert_eq!(readings[..2], [2, 1]);
}

#[test]
fn readings_that_are_no_numbers_are_passed_over() {
    let robot = PlanarPose::default();
    let mut map = LandmarkMap::new(config()).unwrap();
    for (range_m, bearing_rad) in [
        (f64::NAN, 0.0),
        (f64::INFINITY, 0.0),
        (0.0, 0.0),
        (-1.0, 0.0),
        (1.0, f64::NAN),
    ] {
        map.insert(
            &robot,
            &[LandmarkReading {
                at: RangeBearing {
                    range_m,
                    bearing_rad,
                },
                name: None,
            }],
            [0.0; 2],
        );
    }
    assert_eq!(map.landmarks().len(), 0);
}

#[test]
fn copies_share_the_landmarks_that_neither_changed() {
    let config = config();
    let mut random = SplitMix64::new(1);
    let robot = pose(0);
    let mut map = LandmarkMap::new(config.clone()).unwrap();
    map.insert(&robot, &readings(&robot, &mut random, &config), [0.0; 2]);
    let copy = map.clone();
    assert_eq!(map.shared_with(&copy), 5);
    map.insert(
        &robot,
        &readings(&robot, &mut random, &config)[..2],
        [1.0, 0.0],
    );
    assert_eq!(map.shared_with(&copy), 3);
}
