//! What the particles say together.

use geometry::wrap_angle;
use nalgebra::{Matrix4, Vector3, Vector4};

use super::config::MonteCarloConfig;
use super::motion::TorsoMotion;
use super::particle::{Particle, PoseBins, TorsoPose};

/// Where the torso is believed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Belief {
    /// Weighted mean of the best cluster.
    pub torso: TorsoPose,
    /// Share of the weight that this cluster holds.
    pub share: f64,
    /// Covariance of x, y, z (m) and heading (rad) about that mean: of all particles, so that another cluster shows in it.
    pub covariance: Matrix4<f64>,
}

impl Belief {
    /// What weighted particles say: from each of the heaviest cells the mean moves to the middle of what lies near; the one that ends
    /// with the most about it counts.
    pub(super) fn of(
        particles: &[Particle],
        bins: &mut PoseBins,
        config: &MonteCarloConfig,
    ) -> Option<Self> {
        let [near_m, near_rad] = config.cluster;
        let tuning = &config.tuning.belief;
        let side = tuning.seed_cell;
        let seeds = bins.heaviest(particles, side * near_m, side * near_rad, tuning.seeds);
        let mut best: Option<(TorsoPose, f64)> = None;
        for seed in seeds.into_iter().flatten() {
            let (torso, share) = middle(particles, seed, config.cluster, tuning.shifts);
            if best.is_none_or(|(_, most)| share > most) {
                best = Some((torso, share));
            }
        }
        let (torso, share) = best?;
        let mut covariance = Matrix4::zeros();
        for particle in particles {
            let [x, y, z] = std::array::from_fn(|a| particle.pose.place_m[a] - torso.place_m[a]);
            let off = Vector4::new(x, y, z, particle.pose.turned_rad(&torso));
            covariance += off * off.transpose() * particle.weight;
        }
        Some(Self {
            torso,
            share,
            covariance,
        })
    }

    /// Whether this is where an earlier belief has moved to since.
    pub(super) fn goes_on(
        &self,
        before: &Self,
        motion: Option<&TorsoMotion>,
        one_place: [f64; 2],
    ) -> bool {
        let mut expected = before.torso;
        if let Some(motion) = motion {
            motion.apply(&mut expected, &[0.0; 6]);
        }
        self.holds(&expected, one_place)
    }

    /// Whether a pose is within so many m and rad of this.
    pub(super) fn holds(&self, pose: &TorsoPose, [near_m, near_rad]: [f64; 2]) -> bool {
        let off: [f64; 3] = std::array::from_fn(|a| pose.place_m[a] - self.torso.place_m[a]);
        Vector3::from(off).norm() < near_m && pose.turned_rad(&self.torso).abs() < near_rad
    }

    /// Standard deviation of the place along its least certain level direction, m.
    pub fn spread_m(&self) -> f64 {
        let (xx, yy, xy) = (
            self.covariance.m11,
            self.covariance.m22,
            self.covariance.m12,
        );
        let radius = geometry::hypot(0.5 * (xx - yy), xy);
        (f64::midpoint(xx, yy) + radius).max(0.0).sqrt()
    }
}

/// Mean of the particles about a pose, after it moved there some times, and their weight.
fn middle(
    particles: &[Particle],
    mut torso: TorsoPose,
    [near_m, near_rad]: [f64; 2],
    shifts: usize,
) -> (TorsoPose, f64) {
    let mut share = 0.0;
    for _ in 0..shifts {
        let (mut sum, mut total) = ([0.0; 6], 0.0);
        for particle in particles {
            let pose = &particle.pose;
            let [x, y, z] = std::array::from_fn(|a| pose.place_m[a] - torso.place_m[a]);
            let yaw = pose.turned_rad(&torso);
            if x * x + y * y + z * z > near_m * near_m || yaw.abs() > near_rad {
                continue;
            }
            let tilt = [
                pose.roll_rad - torso.roll_rad,
                pose.pitch_rad - torso.pitch_rad,
            ];
            for (sum, off) in sum.iter_mut().zip([x, y, z, tilt[0], tilt[1], yaw]) {
                *sum += particle.weight * off;
            }
            total += particle.weight;
        }
        if total <= 0.0 {
            break;
        }
        let [x, y, z, roll, pitch, yaw] = sum.map(|value| value / total);
        for (place, off) in torso.place_m.iter_mut().zip([x, y, z]) {
            *place += off;
        }
        torso.roll_rad += roll;
        torso.pitch_rad += pitch;
        torso.yaw_rad = wrap_angle(torso.yaw_rad + yaw);
        share = total;
    }
    (torso, share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x_m: f64, yaw_rad: f64, weight: f64) -> Particle {
        Particle {
            pose: TorsoPose {
                place_m: [x_m, 0.0, 0.3],
                yaw_rad,
                ..TorsoPose::default()
            },
            weight,
        }
    }

    #[test]
    fn the_mean_is_that_of_the_best_cluster_and_the_spread_tells_of_the_other() {
        // Headings to both sides of pi, places to both sides of a cell's border.
        let particles = [
            at(0.28, 3.1, 0.3),
            at(0.32, -3.1, 0.3),
            at(2.0, 0.0, 0.2),
            at(2.02, 0.0, 0.2),
        ];
        let belief = Belief::of(
            &particles,
            &mut PoseBins::default(),
            &MonteCarloConfig::default(),
        )
        .unwrap();
        assert!((belief.torso.place_m[0] - 0.3).abs() < 1e-9);
        assert!(belief.torso.turned_rad(&particles[0].pose).abs() < 0.05);
        assert!((belief.share - 0.6).abs() < 1e-9);
        assert!(belief.spread_m() > 1.0);
        let alone = Belief::of(
            &[at(0.28, 3.1, 0.5), at(0.32, 3.1, 0.5)],
            &mut PoseBins::default(),
            &MonteCarloConfig::default(),
        );
        assert!((alone.unwrap().spread_m() - 0.02).abs() < 1e-9);
    }
}
