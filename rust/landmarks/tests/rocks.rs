//! A course of rocks in simulation: FastSLAM maps them and knows where the robot is.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot be set up has failed, and tells what it measured"
)]

mod common;

use core::f64::consts::FRAC_PI_2;

use geometry::{PlanarPose, SplitMix64, wrap_angle};
use landmarks::{
    ExpectedReading, FastSlam, FastSlamConfig, Landmark, LandmarkReading, LandmarksConfig,
    OdometryStep, RangeBearing,
};
use nalgebra::{Matrix3, Vector2, Vector3};

use common::{off_after_alignment, root_mean_square_and_worst};

const RANGE_NOISE_M: f64 = 0.1;
const ROCKS: usize = 20;
/// Three rounds of a circle.
const STEPS: usize = 600;
const RADIUS_M: f64 = 2.0;
const WAY_M: f64 = 0.06;
const PASSED_S: f64 = 0.2;
/// What the robot's odometry says of its turns, of what it makes.
const TURNS: f64 = 1.1;
/// A rock is found where something is mapped no further off, m.
const NEAR_M: f64 = 0.5;

#[derive(Debug)]
#[expect(
    dead_code,
    reason = "FastSLAM is known to be too sure of where the whole map lies: its NEES is told, not held to its bounds"
)]
struct Outcome {
    /// How many rocks were found, and how many things in all.
    rocks: [usize; 2],
    /// Root mean square error of the rocks after alignment, m: the map as a whole lies no better than the first looks say.
    rocks_m: f64,
    /// Mean of the rocks' squared error after alignment over their covariance; two degrees of freedom.
    rocks_nees: f64,
    /// Root mean square error of the robot's place over the way, m: by the filter, and by odometry alone.
    way_m: [f64; 2],
    /// Mean of the squared error of the pose over its covariance; three degrees of freedom.
    nees: f64,
}

/// A laser that sees half around, as in 004, Fig. 36.7.
fn settings(seed: u64, named: bool) -> (FastSlamConfig, LandmarksConfig) {
    let config = FastSlamConfig {
        seed,
        scale_noise: [0.05, 0.1],
        ..FastSlamConfig::default()
    };
    let landmarks = LandmarksConfig {
        range_noise: RANGE_NOISE_M,
        bearing_noise: 0.02,
        apart: [0.0; 2],
        reach: [0.5, 6.0],
        view: FRAC_PI_2,
        seen: 0.95,
        named,
        ..LandmarksConfig::default()
    };
    (config, landmarks)
}

/// A robot on its rounds among rocks.
struct Course {
    random: SplitMix64,
    rocks: Vec<Vector2<f64>>,
    robot: PlanarPose,
    config: FastSlamConfig,
    landmarks: LandmarksConfig,
}

impl Course {
    fn new(seed: u64, named: bool) -> Self {
        let mut random = SplitMix64::new(1000 + seed);
        let mut rocks: Vec<Vector2<f64>> = Vec::new();
        while rocks.len() < ROCKS {
            let at = Vector2::from([(); 2].map(|()| 8.0 * random.uniform() - 4.0));
            // Apart from each other, and off the robot's way.
            let apart = rocks.iter().all(|other| (other - at).norm() > 1.0);
            if apart && (at.norm() - RADIUS_M).abs() > 0.6 {
                rocks.push(at);
            }
        }
        let (config, landmarks) = settings(seed, named);
        Self {
            random,
            rocks,
            robot: PlanarPose::new(RADIUS_M, 0.0, FRAC_PI_2),
            config,
            landmarks,
        }
    }

    /// Goes on, with errors as the filter expects them; what odometry says of it.
    fn go(&mut self) -> OdometryStep {
        let turn_rad = WAY_M / RADIUS_M;
        let [along, across, yaw] = self.random.normals();
        let sd = |[way, turn, time]: [f64; 3]| {
            (way * way * WAY_M + turn * turn * turn_rad + time * time * PASSED_S).sqrt()
        };
        let place = sd(self.config.place_noise);
        self.robot = self.robot.compose(&PlanarPose::new(
            WAY_M + place * along,
            place * across,
            turn_rad + sd(self.config.heading_noise) * yaw,
        ));
        OdometryStep {
            forward_m: WAY_M,
            left_m: 0.0,
            turn_rad: TURNS * turn_rad,
            passed_s: PASSED_S,
        }
    }

    fn look(&mut self) -> Vec<LandmarkReading> {
        let Self {
            random,
            robot,
            landmarks,
            ..
        } = self;
        let [near_m, far_m] = landmarks.reach;
        (0_u32..)
            .zip(&self.rocks)
            .filter_map(|(name, at)| {
                let at = ExpectedReading::of(robot, at)?.reading;
                let [range, bearing] = random.normals();
                let is_seen = random.uniform() < landmarks.seen
                    && (near_m..far_m).contains(&at.range_m)
                    && at.bearing_rad.abs() < landmarks.view;
                let at = RangeBearing {
                    range_m: at.range_m + landmarks.range_noise * range,
                    bearing_rad: at.bearing_rad + landmarks.bearing_noise * bearing,
                };
                let name = landmarks.named.then_some(name);
                is_seen.then_some(LandmarkReading { at, name })
            })
            .collect()
    }

    fn off(&self, at: &PlanarPose) -> Vector3<f64> {
        let yaw_rad = wrap_angle(at.yaw_rad - self.robot.yaw_rad);
        Vector3::new(at.x_m - self.robot.x_m, at.y_m - self.robot.y_m, yaw_rad)
    }

    fn outcome(&self, slam: &FastSlam, way_m: [f64; 2], nees: f64) -> Outcome {
        let found = slam.landmarks();
        let pairs = self.rocks.iter().filter_map(|rock| {
            let off_m = |one: &Landmark| (one.at_m - rock).norm();
            let near = found.iter().min_by(|a, b| off_m(a).total_cmp(&off_m(b)))?;
            (off_m(near) < NEAR_M).then_some((near, *rock))
        });
        let (near, rocks): (Vec<&Landmark>, Vec<_>) = pairs.unzip();
        let places: Vec<_> = near.iter().map(|one| one.at_m).collect();
        let off = off_after_alignment(&places, &rocks);
        let square = |(off, one): (&Vector2<f64>, &&Landmark)| {
            (off.transpose() * one.covariance.try_inverse().unwrap() * off).x
        };
        Outcome {
            rocks: [near.len(), found.len()],
            rocks_m: root_mean_square_and_worst(&off)[0],
            rocks_nees: off.iter().zip(&near).map(square).sum::<f64>() / off.len() as f64,
            way_m,
            nees,
        }
    }
}

fn walk(seed: u64, named: bool) -> Outcome {
    let mut course = Course::new(seed, named);
    let mut odometry = course.robot;
    let (config, landmarks) = (course.config.clone(), course.landmarks.clone());
    let mut slam = FastSlam::new(&course.robot, config, landmarks).unwrap();
    let (mut squares, mut nees) = ([0.0; 2], 0.0);
    for _ in 0..STEPS {
        let step = course.go();
        odometry = odometry.compose(&PlanarPose::new(step.forward_m, 0.0, step.turn_rad));
        slam.advance(&step);
        slam.see(&course.look());
        let (mean, covariance) = slam.belief();
        for (square, at) in squares.iter_mut().zip([&mean, &odometry]) {
            *square += course.off(at).xy().norm_squared() / STEPS as f64;
        }
        let inverse = (covariance + Matrix3::identity() * 1e-12)
            .try_inverse()
            .unwrap();
        nees += (course.off(&mean).transpose() * inverse * course.off(&mean)).x / STEPS as f64;
    }
    let outcome = course.outcome(&slam, squares.map(f64::sqrt), nees);
    println!("names {named}, seed {seed}: {outcome:.4?}");
    outcome
}

fn holds(seed: u64, named: bool) {
    let outcome = walk(seed, named);
    assert_eq!(outcome.rocks, [ROCKS; 2]);
    assert!(outcome.rocks_m <= 0.3 * RANGE_NOISE_M);
    assert!(outcome.way_m[0] < outcome.way_m[1]);
}

#[test]
fn rocks_are_mapped_to_a_third_of_the_range_noise_and_the_way_is_better_than_odometrys() {
    holds(0, true);
    holds(0, false);
}

/// `cargo test --release -p landmarks --test rocks -- --ignored --nocapture`
#[test]
#[ignore = "twenty seeds of each"]
fn rocks_are_mapped_with_every_seed() {
    for seed in 0..20 {
        holds(seed, true);
        holds(seed, false);
    }
}
