//! The particle filter: move, weigh, draw anew.

use nalgebra::Isometry3;
use rayon::prelude::*;
use volume::LANES;

use super::belief::Belief;
use super::config::MonteCarloConfig;
use super::motion::{BodyReading, TorsoMotion};
use super::observation::{LogLikelihood, SeenFrame};
use super::particle::{Particle, PoseBins, TorsoPose};
use super::random::{Purpose, Stream};
use super::resampling::{low_variance, resample};
use super::static_map::StaticMap;
use super::weights::{effective_number, weigh};

/// Groups of particles that a thread takes at least, the cost of a thousand rays: who moves a particle makes no difference to it.
const GROUPS_PER_THREAD: usize = 4;

/// Guesses, and the room to work on them.
#[derive(Debug, Clone)]
pub(super) struct Filter {
    config: MonteCarloConfig,
    pub(super) particles: Vec<Particle>,
    drawn: Vec<Particle>,
    likelihoods: Vec<LogLikelihood>,
    logs: Vec<f64>,
    bins: PoseBins,
}

impl Filter {
    pub(super) fn new(config: &MonteCarloConfig) -> Self {
        let most = config.most_particles;
        Self {
            config: config.clone(),
            particles: Vec::with_capacity(most),
            drawn: Vec::with_capacity(most),
            likelihoods: Vec::with_capacity(most),
            logs: Vec::with_capacity(most),
            bins: PoseBins::default(),
        }
    }

    /// Guesses about a torso's pose that is told.
    pub(super) fn start_at(&mut self, map_from_torso: &Isometry3<f64>) {
        let config = &self.config;
        let start = TorsoPose::of(map_from_torso);
        let [place_m, heading_rad] = config.start_noise;
        let count = config.particles;
        self.particles.clear();
        self.particles.extend((0..count).map(|index| {
            let normals = Stream::new(config.seed, 0, Purpose::Start, index).normals::<3>();
            let mut pose = start;
            pose.place_m[0] += place_m * normals[0];
            pose.place_m[1] += place_m * normals[1];
            pose.yaw_rad = geometry::wrap_angle(pose.yaw_rad + heading_rad * normals[2]);
            let weight = 1.0 / count as f64;
            Particle { pose, weight }
        }));
    }

    /// Guesses everywhere, other ones at another step.
    pub(super) fn start_anywhere(&mut self, map: &StaticMap, reading: &BodyReading, step: u64) {
        let count = self.config.most_particles;
        let seed = self.config.seed;
        self.particles.clear();
        self.particles.extend((0..count).filter_map(|index| {
            let mut stream = Stream::new(seed, step, Purpose::Start, index);
            let pose = anywhere(map, reading, &mut stream)?;
            let weight = 1.0 / count as f64;
            Some(Particle { pose, weight })
        }));
    }

    /// A filter of these guesses with other settings.
    pub(super) fn with(self, config: &MonteCarloConfig) -> Self {
        Self {
            config: config.clone(),
            ..self
        }
    }

    /// Drops what is not of a belief's cluster.
    pub(super) fn keep_near(&mut self, belief: &Belief) {
        self.particles
            .retain(|particle| belief.holds(&particle.pose, self.config.cluster));
        let sum: f64 = self.particles.iter().map(|particle| particle.weight).sum();
        if sum <= 0.0 {
            self.start_at(&belief.torso.isometry());
            return;
        }
        for particle in &mut self.particles {
            particle.weight /= sum;
        }
    }

    /// Moves every guess and weighs it by a frame, of which the share `news` tells something new.
    pub(super) fn update(
        &mut self,
        motion: Option<&TorsoMotion>,
        (observation, news): (&SeenFrame, f64),
        map: &StaticMap,
        step: u64,
    ) -> Option<Belief> {
        let seed = self.config.seed;
        self.likelihoods
            .resize(self.particles.len(), LogLikelihood::default());
        (self.particles.par_chunks_mut(LANES))
            .zip(self.likelihoods.par_chunks_mut(LANES))
            .enumerate()
            .with_min_len(GROUPS_PER_THREAD)
            .for_each(|(group, (particles, likelihoods))| {
                if let Some(motion) = motion {
                    for (lane, particle) in particles.iter_mut().enumerate() {
                        let index = group * LANES + lane;
                        let mut stream = Stream::new(seed, step, Purpose::Motion, index);
                        motion.sample(&mut particle.pose, &mut stream);
                    }
                }
                // The last group may be smaller.
                let poses =
                    std::array::from_fn(|lane| particles[lane.min(particles.len() - 1)].pose);
                let found = observation.log_likelihoods(&poses, map);
                likelihoods.copy_from_slice(&found[..likelihoods.len()]);
            });
        weigh(
            &mut self.particles,
            &self.likelihoods,
            [self.config.independence * news, self.config.least_effective],
            &self.config.tuning.weights,
            &mut self.logs,
        );
        Belief::of(&self.particles, &mut self.bins, &self.config)
    }

    /// Some of the guesses, moved without error.
    pub(super) fn some_moved(&self, motion: Option<&TorsoMotion>) -> [TorsoPose; LANES] {
        std::array::from_fn(|lane| {
            let mut pose = self.particles[lane * self.particles.len() / LANES].pose;
            if let Some(motion) = motion {
                motion.apply(&mut pose, &[0.0; 6]);
            }
            pose
        })
    }

    /// Draws anew where few guesses weigh much: as many as their spread needs.
    pub(super) fn resample(&mut self, step: u64) {
        let config = &self.config;
        let enough = config.resample_below * self.particles.len() as f64;
        if effective_number(&self.particles) >= enough {
            return;
        }
        let mut stream = Stream::new(config.seed, step, Purpose::Resampling, 0);
        resample(
            &self.particles,
            (config.bins, config.kld),
            [config.particles, config.most_particles],
            &mut stream,
            (&mut self.bins, &mut self.drawn),
        );
        std::mem::swap(&mut self.particles, &mut self.drawn);
    }

    /// Draws anew where few guesses weigh much, all of the most there may be, and a share of them anywhere, some of these at
    /// the place that is believed, if any is: it is to be compared with the others.
    pub(super) fn resample_widely(
        &mut self,
        (map, reading): (&StaticMap, &BodyReading),
        believed: Option<&Belief>,
        step: u64,
    ) {
        let config = &self.config;
        let enough = config.resample_below * self.particles.len() as f64;
        if effective_number(&self.particles) >= enough {
            return;
        }
        let most = config.most_particles;
        let added = (config.search_anew * most as f64) as usize;
        let one_in = config.tuning.search.believed;
        let mut stream = Stream::new(config.seed, step, Purpose::Resampling, 0);
        low_variance(&self.particles, most - added, &mut stream, &mut self.drawn);
        std::mem::swap(&mut self.particles, &mut self.drawn);
        self.jitter(step);
        let here = believed.map_or(0, |_| added / one_in);
        if let Some(believed) = believed {
            let count = self.particles.len();
            self.particles.resize(
                count + here,
                Particle {
                    pose: believed.torso,
                    weight: 0.0,
                },
            );
        }
        self.add_anywhere(added - here, map, reading, step);
    }

    /// Guesses that were drawn several times part a little: there are too few of them for the room that is searched.
    fn jitter(&mut self, step: u64) {
        let [place_m, heading_rad] = self.config.search_jitter;
        for (index, particle) in self.particles.iter_mut().enumerate() {
            let mut stream = Stream::new(self.config.seed, step, Purpose::Jitter, index);
            let normals = stream.normals::<3>();
            particle.pose.place_m[0] += place_m * normals[0];
            particle.pose.place_m[1] += place_m * normals[1];
            let yaw_rad = particle.pose.yaw_rad + heading_rad * normals[2];
            particle.pose.yaw_rad = geometry::wrap_angle(yaw_rad);
        }
    }

    /// Adds guesses anywhere; all weigh the same then.
    fn add_anywhere(&mut self, count: usize, map: &StaticMap, reading: &BodyReading, step: u64) {
        let seed = self.config.seed;
        self.particles.extend((0..count).filter_map(|index| {
            let mut stream = Stream::new(seed, step, Purpose::Injection, index);
            let pose = anywhere(map, reading, &mut stream)?;
            Some(Particle { pose, weight: 0.0 })
        }));
        let weight = 1.0 / self.particles.len() as f64;
        for particle in &mut self.particles {
            particle.weight = weight;
        }
    }
}

/// A torso above a place to stand, in any heading, as high and tilted as the body says.
fn anywhere(map: &StaticMap, reading: &BodyReading, stream: &mut Stream) -> Option<TorsoPose> {
    if map.places.is_empty() {
        return None;
    }
    let top_m = map.places[stream.below(map.places.len())].top_m;
    let side_m = map.resolution_m();
    let mut within = || (stream.uniform() - 0.5) * side_m;
    let place_m = [
        top_m[0] + within(),
        top_m[1] + within(),
        top_m[2] + reading.torso_height_m,
    ];
    Some(TorsoPose {
        place_m,
        roll_rad: reading.odometry_from_torso.roll_rad,
        pitch_rad: reading.odometry_from_torso.pitch_rad,
        yaw_rad: std::f64::consts::TAU * (stream.uniform() - 0.5),
    })
}
