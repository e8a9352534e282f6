//! One guess of the robot's way, with the landmarks that follow from it.

use geometry::{PlanarPose, SplitMix64, wrap_angle};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::{FastSlamConfig, OdometryStep};
use crate::landmark_map::{LandmarkMap, Matched, Pairing};
use crate::sighting::LandmarkReading;

/// Place, x and y (m), and the sensor's heading (rad); what the odometry's ways, turns to the left and turns to the right are to be multiplied
/// by; and by how much bearings are too large (rad): by that the robot's heading is larger than the sensor's, which began as the robot's was told.
type SlamState = SVector<f64, 7>;
type Covariance = SMatrix<f64, 7, 7>;

/// How much of the state is no pose.
const REST: usize = 4;
/// Where the sensor's turn stands in it.
const TURNED: usize = 6;

/// A particle. Its pose is drawn at each look (the improved proposal of Montemerlo, Thrun, Koller, Wegbreit 2003); between two looks it is a Gaussian. What
/// the odometry is to be multiplied by is never drawn: given the way it is a Gaussian, too.
#[derive(Debug, Clone)]
pub(super) struct SlamParticle {
    state: SlamState,
    covariance: Covariance,
    /// Logarithm of its weight.
    pub(super) log_weight: f64,
    pub(super) map: LandmarkMap,
}

impl SlamParticle {
    pub(super) fn new(start: &PlanarPose, map: LandmarkMap, config: &FastSlamConfig) -> Self {
        let mut covariance = Covariance::zeros();
        let [way, turn] = config.scale_noise;
        for (at, sd) in (3..).zip([way, turn, turn, config.bearing_bias]) {
            covariance[(at, at)] = sd * sd;
        }
        Self {
            state: SlamState::from([start.x_m, start.y_m, start.yaw_rad, 1.0, 1.0, 1.0, 0.0]),
            covariance,
            log_weight: 0.0,
            map,
        }
    }

    /// Where the robot is. The sensor's first look lay along what was told of the robot's heading, and was off that by how much bearings are too
    /// large: the way is turned back by it about where it began, m.
    pub(super) fn pose(&self, start_m: [f64; 2]) -> PlanarPose {
        let (sin, cos) = libm::sincos(-self.state[TURNED]);
        let [x, y] = [self.state[0] - start_m[0], self.state[1] - start_m[1]];
        let turned = [cos * x - sin * y, sin * x + cos * y];
        PlanarPose::new(
            start_m[0] + turned[0],
            start_m[1] + turned[1],
            self.state[2],
        )
    }

    /// Where the sensor looks from, and in which direction, where it looked along the robot's heading at the start.
    fn eye(&self) -> PlanarPose {
        PlanarPose::new(self.state[0], self.state[1], self.state[2])
    }

    /// By how much bearings are too large, rad: mean and standard deviation.
    pub(super) fn bearing_bias(&self) -> [f64; 2] {
        [
            self.state[TURNED],
            self.covariance[(TURNED, TURNED)].max(0.0).sqrt(),
        ]
    }

    /// Of x, y (m) and heading (rad), since the pose was drawn.
    pub(super) fn covariance_of_pose(&self) -> Matrix3<f64> {
        self.covariance.fixed_view::<3, 3>(0, 0).into_owned()
    }

    /// Means and standard deviations of what ways and turns are multiplied by.
    pub(super) fn scales(&self) -> [[f64; 2]; 3] {
        [3, 4, 5].map(|at| [self.state[at], self.covariance[(at, at)].max(0.0).sqrt()])
    }

    /// A copy that weighs as much as every other.
    pub(super) fn drawn_anew(&self) -> Self {
        Self {
            log_weight: 0.0,
            ..self.clone()
        }
    }

    /// Moves by what odometry says, its errors in the covariance.
    pub(super) fn advance(&mut self, step: &OdometryStep, variance: [f64; 2]) {
        let [_, _, eye_rad, way, left, right, bias_rad] = self.state.into();
        let (turn, side) = if step.turn_rad > 0.0 {
            (left, 4)
        } else {
            (right, 5)
        };
        let turned_rad = turn * step.turn_rad;
        let (sin, cos) = libm::sincos(eye_rad + bias_rad + 0.5 * turned_rad);
        let along = cos * step.forward_m - sin * step.left_m;
        let across = sin * step.forward_m + cos * step.left_m;
        self.state[0] += way * along;
        self.state[1] += way * across;
        self.state[2] = wrap_angle(eye_rad + turned_rad);
        // Of the change with what was before, the rows of the pose: what ways and turns are multiplied by stays.
        let mut by = SMatrix::<f64, 3, 7>::identity();
        by[(0, 2)] = -way * across;
        by[(1, 2)] = way * along;
        by[(0, TURNED)] = by[(0, 2)];
        by[(1, TURNED)] = by[(1, 2)];
        by[(0, 3)] = along;
        by[(1, 3)] = across;
        by[(0, side)] = -0.5 * way * across * step.turn_rad;
        by[(1, side)] = 0.5 * way * along * step.turn_rad;
        by[(2, side)] = step.turn_rad;
        let moved = by * self.covariance;
        let crossed = moved.fixed_columns::<REST>(3).into_owned();
        let [place, heading] = variance;
        let added = Matrix3::from_diagonal(&Vector3::new(place, place, heading));
        let pose = moved * by.transpose() + added;
        self.covariance
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&pose);
        self.covariance
            .fixed_view_mut::<3, REST>(0, 3)
            .copy_from(&crossed);
        self.covariance
            .fixed_view_mut::<REST, 3>(3, 0)
            .copy_from(&crossed.transpose());
    }

    /// Takes in what is seen at one time: weighs, draws the pose, maps.
    pub(super) fn see(
        &mut self,
        sightings: &[LandmarkReading],
        gone: [f64; 2],
        (random, config): (&mut SplitMix64, &FastSlamConfig),
    ) {
        let mut taken = Vec::with_capacity(sightings.len());
        let mut paired = Vec::with_capacity(sightings.len());
        for sighting in sightings {
            let eye = (&self.eye(), &self.covariance_of_pose());
            let pairing = self.map.pair(eye, sighting, &taken, gone);
            let floor = self.map.log_likelihood_of_nobody();
            match &pairing {
                Pairing::Known(found) => {
                    taken.push(found.index);
                    if found.is_apart {
                        self.log_weight += found.log_likelihood.max(floor);
                        self.correct(found);
                    }
                }
                Pairing::New | Pairing::Nobody => self.log_weight += floor,
            }
            paired.push((*sighting, pairing));
        }
        self.draw(random, config.least_noise);
        self.map.take(&self.eye(), &paired, gone);
    }

    /// Moves the pose towards where a landmark is seen from.
    fn correct(&mut self, found: &Matched) {
        let by = found.expected.by_pose;
        let crossed = self.covariance.fixed_columns::<3>(0) * by.transpose();
        let gain = crossed * found.information;
        self.state += gain * found.innovation;
        self.state[2] = wrap_angle(self.state[2]);
        self.covariance -= gain * crossed.transpose();
    }

    /// Draws the pose; what it is to be multiplied by follows from the draw.
    fn draw(&mut self, random: &mut SplitMix64, least: f64) {
        let symmetric = 0.5 * (self.covariance + self.covariance.transpose());
        let pose = symmetric.fixed_view::<3, 3>(0, 0) + Matrix3::identity() * (least * least);
        let Some(root) = pose.cholesky() else {
            return;
        };
        let off = root.l() * Vector3::from(random.normals::<3>());
        let crossed = symmetric.fixed_view::<REST, 3>(3, 0).into_owned();
        let gain = crossed * root.inverse();
        let rest: SMatrix<f64, REST, REST> =
            symmetric.fixed_view::<REST, REST>(3, 3) - gain * crossed.transpose();
        for at in 0..3 {
            self.state[at] += off[at];
        }
        self.state[2] = wrap_angle(self.state[2]);
        let follows = gain * off;
        for at in 0..REST {
            self.state[3 + at] += follows[at];
        }
        self.covariance = Covariance::zeros();
        self.covariance
            .fixed_view_mut::<REST, REST>(3, 3)
            .copy_from(&rest);
    }
}
