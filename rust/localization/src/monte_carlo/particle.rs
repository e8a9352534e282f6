//! One guess of where the torso is.

use geometry::wrap_angle;
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use super::tuning::MOST_SEEDS;

/// The torso in the map: `x = (x, y, z, phi, theta, psi)` of 002, III.C. Angles turn about z, then y, then x.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TorsoPose {
    /// Position in the map, m.
    pub place_m: [f64; 3],
    /// Roll, rad.
    pub roll_rad: f64,
    /// Pitch, rad.
    pub pitch_rad: f64,
    /// Heading, rad.
    pub yaw_rad: f64,
}

impl TorsoPose {
    pub(super) fn of(pose: &Isometry3<f64>) -> Self {
        let (roll_rad, pitch_rad, yaw_rad) = pose.rotation.euler_angles();
        Self {
            place_m: pose.translation.vector.into(),
            roll_rad,
            pitch_rad,
            yaw_rad,
        }
    }

    pub(super) fn isometry(&self) -> Isometry3<f64> {
        Isometry3::from_parts(
            Translation3::from(self.place_m),
            UnitQuaternion::from_euler_angles(self.roll_rad, self.pitch_rad, self.yaw_rad),
        )
    }

    /// Heading against that of another pose, rad.
    pub(super) fn turned_rad(&self, from: &Self) -> f64 {
        wrap_angle(self.yaw_rad - from.yaw_rad)
    }
}

/// A guess, and how much it counts: the weights of all sum to one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Particle {
    pub(super) pose: TorsoPose,
    pub(super) weight: f64,
}

/// Which cells of a grid over position and heading are not empty, and what weighs on them. Keeps its buffer.
#[derive(Debug, Clone, Default)]
pub(super) struct PoseBins(Vec<(u64, u32)>);

impl PoseBins {
    /// Sorts particles into cells; those of one cell in the order of their indices.
    fn fill(&mut self, particles: &[Particle], side_m: f64, side_rad: f64) {
        self.0.clear();
        let part = |value: f64, side: f64| u64::from((value / side).floor() as i32 as u16);
        self.0
            .extend(particles.iter().enumerate().map(|(index, particle)| {
                let [x, y, z] = particle.pose.place_m.map(|value| part(value, side_m));
                let yaw = part(particle.pose.yaw_rad, side_rad);
                (x << 48 | y << 32 | z << 16 | yaw, index as u32)
            }));
        self.0.sort_unstable();
    }

    /// How many cells hold particles.
    pub(super) fn count(&mut self, particles: &[Particle], side_m: f64, side_rad: f64) -> usize {
        self.fill(particles, side_m, side_rad);
        self.0.chunk_by(|a, b| a.0 == b.0).count()
    }

    /// The particles that weigh most in the `count` cells that weigh most, the heaviest first; of equals the first.
    pub(super) fn heaviest(
        &mut self,
        particles: &[Particle],
        side_m: f64,
        side_rad: f64,
        count: usize,
    ) -> [Option<TorsoPose>; MOST_SEEDS] {
        self.fill(particles, side_m, side_rad);
        let weight = |&(_, index): &(u64, u32)| particles[index as usize].weight;
        let mut all = [(0.0, None); MOST_SEEDS];
        let best = &mut all[..count];
        for cell in self.0.chunk_by(|a, b| a.0 == b.0) {
            let sum: f64 = cell.iter().map(weight).sum();
            let Some(place) = best.iter().position(|(most, _)| sum > *most) else {
                continue;
            };
            best[place..].rotate_right(1);
            let heaviest = (cell.iter())
                .rev()
                .max_by(|a, b| weight(a).total_cmp(&weight(b)));
            best[place] = (
                sum,
                heaviest.map(|&(_, index)| particles[index as usize].pose),
            );
        }
        all.map(|(_, pose)| pose)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_pose_is_read_back(place_m in prop::array::uniform3(-5.0..5.0f64), roll_rad in -1.0..1.0f64, pitch_rad in -1.0..1.0f64, yaw_rad in -3.0..3.0f64) {
            let pose = TorsoPose { place_m, roll_rad, pitch_rad, yaw_rad };
            let back = TorsoPose::of(&pose.isometry());
            let off = (back.isometry().inverse() * pose.isometry()).rotation.angle();
            prop_assert!(off < 1e-6 && (back.yaw_rad - yaw_rad).abs() < 1e-9);
        }
    }

    fn particle(x_m: f64, weight: f64) -> Particle {
        let mut particle = Particle {
            weight,
            ..Particle::default()
        };
        particle.pose.place_m[0] = x_m;
        particle
    }

    #[test]
    fn cells_count_what_lies_in_them() {
        let particles = [
            particle(-0.05, 0.2),
            particle(0.05, 0.1),
            particle(0.06, 0.2),
            particle(0.31, 0.25),
            particle(-0.05, 0.25),
        ];
        let mut bins = PoseBins::default();
        assert_eq!(bins.count(&particles, 0.1, 0.1), 3);
        let heaviest = bins.heaviest(&particles, 0.1, 0.1, 3);
        let expected = [4, 2, 3].map(|index: usize| Some(particles[index].pose));
        assert_eq!(heaviest[..3], expected);
        assert_eq!(heaviest[3..], [None; MOST_SEEDS - 3]);
        assert_eq!(bins.heaviest(&[], 0.1, 0.1, 1), [None; MOST_SEEDS]);
    }
}
