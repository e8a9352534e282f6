//! A map for each particle: each guess of the robot's way makes an octree of its own, and those live on whose maps agree with what is seen
//! again (004, section 36.3.2, reference 36.19: Fairfield, Kantor and Wettergreen 2007). The maps share what they have in common.

use geometry::{SplitMix64, low_variance};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use volume::octree::{Octree, OctreeError, probability};
use volume::{Ray, Update};

/// How the particles move, weigh and are drawn anew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleMapsRule {
    /// How many there are.
    pub particles: usize,
    /// Standard deviation of a moved distance along each horizontal axis, for each metre moved.
    pub sigma_per_metre: f64,
    /// Standard deviation of a turn about the vertical, rad for each metre moved.
    pub sigma_rad_per_metre: f64,
    /// Exponent of the likelihood of each ray: neighbouring rays are wrong alike.
    pub independence: f64,
    /// They are drawn anew where their effective number falls below this share of them.
    pub resample_below: f64,
}

/// A guess of where the robot is, and the map that follows from its way.
#[derive(Debug, Clone)]
pub struct ParticleMap {
    /// The robot in the map frame, m.
    pub map_from_robot: Isometry3<f64>,
    /// Share of the belief; those of all sum to one.
    pub weight: f64,
    /// What was seen from its way.
    pub map: Octree,
}

/// Localizes in maps that are made on the way.
#[derive(Debug, Clone)]
pub struct ParticleMaps {
    rule: ParticleMapsRule,
    particles: Vec<ParticleMap>,
    random: SplitMix64,
    rays: Vec<Ray>,
}

impl ParticleMaps {
    /// All particles at a place, each with this map.
    pub fn new(
        map_from_robot: Isometry3<f64>,
        map: &Octree,
        rule: ParticleMapsRule,
        seed: u64,
    ) -> Self {
        let one = ParticleMap {
            map_from_robot,
            weight: 1.0 / rule.particles as f64,
            map: map.clone(),
        };
        Self {
            particles: vec![one; rule.particles],
            rule,
            random: SplitMix64::new(seed),
            rays: Vec::new(),
        }
    }

    /// The particles.
    pub fn particles(&self) -> &[ParticleMap] {
        &self.particles
    }

    /// The likeliest particle.
    pub fn best(&self) -> Option<&ParticleMap> {
        let each = self.particles.iter();
        each.max_by(|a, b| a.weight.total_cmp(&b.weight))
    }

    /// Moves all particles as odometry says, each with an error of its own, after they are drawn anew where too few are left to speak of.
    /// `moved`: the robot now in the robot's frame before, m.
    pub fn advance(&mut self, moved: &Isometry3<f64>) {
        let squares: f64 = self.particles.iter().map(|one| one.weight.powi(2)).sum();
        if 1.0 / squares < self.rule.resample_below * self.rule.particles as f64 {
            self.resample();
        }
        let metres = moved.translation.vector.norm();
        for particle in &mut self.particles {
            let [x, y, yaw] = self.random.normals();
            let sigma_m = self.rule.sigma_per_metre * metres;
            let sigma_rad = self.rule.sigma_rad_per_metre * metres;
            let error = Isometry3::from_parts(
                Translation3::new(sigma_m * x, sigma_m * y, 0.0),
                UnitQuaternion::from_scaled_axis(Vector3::z() * (sigma_rad * yaw)),
            );
            particle.map_from_robot *= moved * error;
        }
    }

    /// Weighs all particles by how well their maps agree with a frame, and takes the frame into all of them. Eye and ends of the rays in the robot's frame, m.
    ///
    /// # Errors
    /// Where eye and ends lie beyond what a tree can hold.
    pub fn see(&mut self, eye_in_robot_m: [f64; 3], rays: &[Ray]) -> Result<(), OctreeError> {
        self.weigh(rays);
        for particle in &mut self.particles {
            let in_map = |at_m: [f64; 3]| {
                let at = particle.map_from_robot * Point3::from(at_m);
                [at.x, at.y, at.z]
            };
            self.rays.clear();
            self.rays.extend(rays.iter().map(|ray| Ray {
                end_m: in_map(ray.end_m),
                hit: ray.hit,
            }));
            let eye_m = in_map(eye_in_robot_m);
            let _beyond = particle.map.insert(eye_m, &self.rays, Update::PerFrame)?;
        }
        Ok(())
    }

    /// Multiplies the weights by the likelihoods of a frame: that something is where rays end. What is not known says nothing.
    fn weigh(&mut self, rays: &[Ray]) {
        let log_likelihood = |particle: &ParticleMap| {
            let ends = rays.iter().filter(|ray| ray.hit).filter_map(|ray| {
                let at = particle.map_from_robot * Point3::from(ray.end_m);
                particle.map.log_odds_at([at.x, at.y, at.z])
            });
            // Against one half, as probable as what is not known.
            ends.map(|log_odds| libm::log(2.0 * probability(log_odds)))
                .sum::<f64>()
        };
        let logs: Vec<f64> = self.particles.iter().map(log_likelihood).collect();
        let best = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut sum = 0.0;
        for (particle, log) in self.particles.iter_mut().zip(logs) {
            particle.weight *= libm::exp(self.rule.independence * (log - best));
            sum += particle.weight;
        }
        for particle in &mut self.particles {
            particle.weight /= sum;
        }
    }

    /// Draws as many particles anew. Copies share their maps.
    fn resample(&mut self) {
        let count = self.particles.len();
        let weight = 1.0 / count as f64;
        let mut drawn = Vec::with_capacity(count);
        let weights = self.particles.iter().map(|one| one.weight);
        low_variance(weights, count, self.random.uniform(), |index| {
            drawn.push(ParticleMap {
                weight,
                ..self.particles[index].clone()
            });
        });
        self.particles = drawn;
    }
}
