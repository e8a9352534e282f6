//! The force sensors under the soles: they push, they never pull.

use serde::Deserialize;

use crate::truth::{needs, row};
use crate::{Normals, SimulatedBodyError, TrueState};

/// A stiff sole on four force sensors, at the corners of a rectangle.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensedSole {
    /// Index in `sensordata` of its contact sensor: net force (N) and where it acts (m), in the world.
    pub forces: usize,
    /// Number of the link that carries it.
    pub link: usize,
    /// The rectangle's centre in the link's frame, m.
    pub centre_m: [f64; 3],
    /// Its length and width, m.
    pub size_m: [f64; 2],
}

/// Which soles there are, and the errors of their sensors.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FootForcesConfig {
    /// Left and right.
    pub soles: [SensedSole; 2],
    /// Standard deviation of each sample as a share of the force; both 0 for exact ones.
    pub noise: f64,
    /// Standard deviation of what is added to each sample besides, N.
    pub noise_absolute_n: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// The force sensors of both soles. They share a foot's force as a stiff plate does: by how near to each corner it acts.
#[derive(Debug, Clone)]
pub struct FootForces {
    config: FootForcesConfig,
    normals: Normals,
}

impl FootForces {
    /// Makes them.
    pub fn new(config: FootForcesConfig) -> Self {
        Self {
            normals: Normals::new(config.seed),
            config,
        }
    }

    /// Whether the state has all that is read of it.
    pub(crate) fn fits(&self, state: &TrueState<'_>) -> Result<(), SimulatedBodyError> {
        for sole in &self.config.soles {
            needs("sensordata", state.sensordata, sole.forces + 6)?;
            needs("xpos", state.xpos, 3 * (sole.link + 1))?;
            needs("xmat", state.xmat, 9 * (sole.link + 1))?;
        }
        Ok(())
    }

    /// Reads them: of the left and the right sole front left, front right, rear left and rear right, N.
    pub fn read(&mut self, state: &TrueState<'_>) -> [[f64; 4]; 2] {
        let mut forces_n = [0, 1].map(|side: usize| carried_n(&self.config.soles[side], state));
        let (share, added_n) = (self.config.noise, self.config.noise_absolute_n);
        if share != 0.0 || added_n != 0.0 {
            for force_n in forces_n.as_flattened_mut() {
                let error_n =
                    share * self.normals.draw() * *force_n + added_n * self.normals.draw();
                *force_n = (*force_n + error_n).max(0.0);
            }
        }
        forces_n
    }
}

/// What each sensor of a sole truly carries, N.
fn carried_n(sole: &SensedSole, state: &TrueState<'_>) -> [f64; 4] {
    let [fx, fy, fz] = first(state.sensordata, sole.forces);
    let [x, y, z] = first(state.sensordata, sole.forces + 3);
    let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = row::<9>(state.xmat, sole.link);
    let [link_x, link_y, link_z] = row::<3>(state.xpos, sole.link);
    let (x, y, z) = (x - link_x, y - link_y, z - link_z);
    // What pushes along the sole, as a riser at the toe does, no sensor under it feels.
    let pressing_n = (-(xz * fx + yz * fy + zz * fz)).max(0.0);
    let ahead = 0.5 + (xx * x + yx * y + zx * z - sole.centre_m[0]) / sole.size_m[0];
    let aside = 0.5 + (xy * x + yy * y + zy * z - sole.centre_m[1]) / sole.size_m[1];
    let (front, left) = (ahead.clamp(0.0, 1.0), aside.clamp(0.0, 1.0));
    let (rear, right) = (1.0 - front, 1.0 - left);
    [front * left, front * right, rear * left, rear * right].map(|share| pressing_n * share)
}

/// Three numbers of an array from an index on.
fn first(array: &[f64], from: usize) -> [f64; 3] {
    row::<3>(array.get(from..).unwrap_or(&[]), 0)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{Rotation3, Vector3};
    use proptest::prelude::*;

    use super::*;
    use crate::truth::tests::{Arrays, arrays};

    fn sole() -> SensedSole {
        SensedSole {
            forces: 0,
            link: 1,
            centre_m: [0.0, 0.0, -0.1],
            size_m: [0.2, 0.2],
        }
    }

    fn feet(noise: f64, noise_absolute_n: f64) -> FootForces {
        FootForces::new(FootForcesConfig {
            soles: [sole(), sole()],
            noise,
            noise_absolute_n,
            seed: 3,
        })
    }

    /// A link at a place and heading under which a force acts at a point of the link's frame.
    fn pressed(yaw_rad: f64, force_n: Vector3<f64>, at_m: Vector3<f64>) -> Arrays {
        let (mut made, place) = (arrays(), Vector3::new(0.3, -0.2, 0.1));
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), yaw_rad);
        made.xmat[9..].copy_from_slice(turn.matrix().transpose().as_slice());
        made.xpos[3..].copy_from_slice(place.as_slice());
        made.sensordata[..3].copy_from_slice(force_n.as_slice());
        made.sensordata[3..].copy_from_slice((place + turn * at_m).as_slice());
        made
    }

    proptest! {
        #[test]
        fn a_sole_shares_a_force_as_a_stiff_plate_does(x in -0.1..0.1, y in -0.1..0.1, yaw in -3.1..3.1) {
            let made = pressed(yaw, Vector3::new(0.0, 0.0, -20.0), Vector3::new(x, y, -0.1));
            let [forces, other] = feet(0.0, 0.0).read(&made.state());
            prop_assert_eq!(forces, other);
            prop_assert!(forces.iter().all(|&force| force >= 0.0));
            prop_assert!((forces.iter().sum::<f64>() - 20.0).abs() < 1e-9);
            let [front_left, front_right, rear_left, rear_right] = forces;
            let ahead = 0.1 * (front_left + front_right - rear_left - rear_right) / 20.0;
            let aside = 0.1 * (front_left - front_right + rear_left - rear_right) / 20.0;
            prop_assert!((ahead - x).abs() < 1e-9 && (aside - y).abs() < 1e-9);
        }

        #[test]
        fn what_pushes_along_a_sole_or_pulls_at_it_is_not_felt(yaw in -3.1..3.1, way in 0_usize..3) {
            let mut force = Vector3::new(15.0, -15.0, 15.0);
            for axis in (0..3).filter(|&axis| axis != way) {
                force[axis] = 0.0;
            }
            let made = pressed(yaw, force, Vector3::new(0.05, 0.0, -0.1));
            let forces = feet(0.0, 0.0).read(&made.state());
            prop_assert!(forces.as_flattened().iter().all(|force| force.abs() < 1e-12));
        }
    }

    #[test]
    fn foot_forces_are_noisy_and_never_pull() {
        let made = pressed(
            0.3,
            Vector3::new(0.0, 0.0, -40.0),
            Vector3::new(0.03, 0.02, -0.1),
        );
        let [exact, _] = feet(0.0, 0.0).read(&made.state());
        let mut noisy = feet(0.02, 0.1);
        let found: Vec<[f64; 4]> = (0..4000).map(|_| noisy.read(&made.state())[1]).collect();
        for corner in 0..4 {
            let errors = found.iter().map(|forces| forces[corner] - exact[corner]);
            let sigma = (errors.map(|error| error * error).sum::<f64>() / 4000.0).sqrt();
            let expected = geometry::hypot(0.02 * exact[corner], 0.1);
            assert_relative_eq!(sigma, expected, max_relative = 0.05);
        }
        let lifted: Vec<_> = (0..200).map(|_| noisy.read(&arrays().state())).collect();
        let every = lifted.iter().flat_map(|forces| forces.as_flattened());
        assert!(every.clone().all(|&force| force >= 0.0));
        assert!(every.clone().any(|&force| force > 0.0));
        assert!(every.clone().any(|&force| force == 0.0));
    }
}
