//! FastSLAM (reference 36.8): each particle is a guess of the robot's way, along which landmarks are mapped as if the robot's place were known.

mod config;
mod particle;

pub use config::FastSlamConfig;

use geometry::{PlanarPose, SplitMix64, low_variance, wrap_angle};
use nalgebra::{Matrix3, Vector3};
use settings::{ConfigError, Table};

use crate::{Landmark, LandmarkMap, LandmarkReading, LandmarksConfig};
use particle::SlamParticle;

/// How far the robot went by odometry, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OdometryStep {
    /// Straight ahead, m.
    pub forward_m: f64,
    /// To the left, m.
    pub left_m: f64,
    /// Counter-clockwise, rad.
    pub turn_rad: f64,
    /// Time that passed, s.
    pub passed_s: f64,
}

/// Localizes and maps landmarks at once.
#[derive(Debug, Clone)]
pub struct FastSlam {
    config: FastSlamConfig,
    particles: Vec<SlamParticle>,
    random: SplitMix64,
    gone: [f64; 2],
    start_m: [f64; 2],
}

impl FastSlam {
    /// At a place that is the map's by definition, without landmarks.
    pub fn new(
        start: &PlanarPose,
        config: FastSlamConfig,
        landmarks: LandmarksConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let map = LandmarkMap::new(landmarks)?;
        Ok(Self {
            particles: vec![SlamParticle::new(start, map, &config); config.particles],
            random: SplitMix64::new(config.seed),
            config,
            gone: [0.0; 2],
            start_m: [start.x_m, start.y_m],
        })
    }

    /// Moves all particles as odometry says.
    pub fn advance(&mut self, step: &OdometryStep) {
        let way_m = geometry::hypot(step.forward_m, step.left_m);
        let turned_rad = step.turn_rad.abs();
        let variance = [self.config.place_noise, self.config.heading_noise].map(
            |[per_way, per_turn, per_time]| {
                per_way * per_way * way_m
                    + per_turn * per_turn * turned_rad
                    + per_time * per_time * step.passed_s
            },
        );
        self.gone[0] += way_m;
        self.gone[1] += turned_rad;
        for particle in &mut self.particles {
            particle.advance(step, variance);
        }
    }

    /// Takes in what is seen at one time. What has no range or bearing is passed over.
    pub fn see(&mut self, sightings: &[LandmarkReading]) {
        let sound: Vec<LandmarkReading> = sightings
            .iter()
            .filter(|one| one.at.is_sound())
            .copied()
            .collect();
        if sound.is_empty() {
            return;
        }
        for particle in &mut self.particles {
            particle.see(&sound, self.gone, (&mut self.random, &self.config));
        }
        self.resample();
    }

    /// The map of the likeliest particle.
    pub fn map(&self) -> &LandmarkMap {
        &self.best().map
    }

    /// The landmarks of the likeliest particle, each the mean of what all particles say of it: its covariance is what is not known of the landmark, the way
    /// being unknown, too. Those of other particles are the same landmark where they have its name, or are the nearest and pass the gate.
    pub fn landmarks(&self) -> Vec<Landmark> {
        let weights = self.weights();
        let best = self.best();
        let mean = |landmark: &Landmark| {
            let each = self.particles.iter().zip(&weights);
            let same: Vec<_> = each
                .filter_map(|(one, weight)| Some((one.map.same_as(landmark)?, *weight)))
                .collect();
            landmark.mean_of(&same)
        };
        best.map.landmarks().map(mean).collect()
    }

    /// Where the likeliest particle is.
    pub fn pose(&self) -> PlanarPose {
        self.best().pose(self.start_m)
    }

    /// Where all particles together say that the robot is: mean, and covariance of x, y (m) and heading (rad).
    pub fn belief(&self) -> (PlanarPose, Matrix3<f64>) {
        let about = self.pose();
        let weights = self.weights();
        let each = || self.particles.iter().zip(&weights);
        let off = |pose: &PlanarPose, from: &PlanarPose| {
            let yaw_rad = wrap_angle(pose.yaw_rad - from.yaw_rad);
            Vector3::new(pose.x_m - from.x_m, pose.y_m - from.y_m, yaw_rad)
        };
        let shift: Vector3<f64> = each()
            .map(|(one, weight)| off(&one.pose(self.start_m), &about) * *weight)
            .sum();
        let mean = PlanarPose::new(
            about.x_m + shift.x,
            about.y_m + shift.y,
            wrap_angle(about.yaw_rad + shift.z),
        );
        let spread = |(one, weight): (&SlamParticle, &f64)| {
            let off = off(&one.pose(self.start_m), &mean);
            (one.covariance_of_pose() + off * off.transpose()) * *weight
        };
        (mean, each().map(spread).sum())
    }

    /// What the odometry's ways, turns to the left and turns to the right are multiplied by in the likeliest particle: of each, mean and standard deviation.
    pub fn scales(&self) -> [[f64; 2]; 3] {
        self.best().scales()
    }

    /// By how much bearings are too large in the likeliest particle, rad: mean and standard deviation.
    pub fn bearing_bias(&self) -> [f64; 2] {
        self.best().bearing_bias()
    }

    /// Place and weight of each particle; the weights sum to one.
    pub fn guesses(&self) -> impl Iterator<Item = (PlanarPose, f64)> {
        let poses = (self.particles.iter()).map(|one| one.pose(self.start_m));
        poses.zip(self.weights())
    }

    /// The particles' maps.
    pub fn maps(&self) -> impl ExactSizeIterator<Item = &LandmarkMap> {
        self.particles.iter().map(|particle| &particle.map)
    }

    fn best(&self) -> &SlamParticle {
        let mut best = &self.particles[0];
        for particle in &self.particles {
            if particle.log_weight > best.log_weight {
                best = particle;
            }
        }
        best
    }

    fn weights(&self) -> Vec<f64> {
        let most = self.best().log_weight;
        let each = self
            .particles
            .iter()
            .map(|one| libm::exp(one.log_weight - most));
        let weights: Vec<f64> = each.collect();
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|weight| weight / sum).collect()
    }

    /// Draws as many particles anew where too few are left to speak of. Copies share their landmarks.
    fn resample(&mut self) {
        let weights = self.weights();
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        let count = self.particles.len();
        if 1.0 / squares >= self.config.resample_below * count as f64 {
            return;
        }
        let mut drawn = Vec::with_capacity(count);
        low_variance(weights, count, self.random.uniform(), |index| {
            drawn.push(self.particles[index].drawn_anew());
        });
        self.particles = drawn;
    }
}
