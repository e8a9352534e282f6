//! Where the robot truly stands: the poses of its soles, and how far its torso leans.

use nalgebra::{Matrix3, Vector3};

use crate::truth::{needs, row};
use crate::{SimulatedBodyError, TrueState};

/// Which links carry soles and torso.
#[derive(Debug, Clone)]
pub struct TrueStance {
    /// Left and right: number of the link, and the sole's centre on the underside in the link's frame, m.
    pub soles: [(usize, [f64; 3]); 2],
    /// Number of the torso's link.
    pub torso: usize,
    /// The torso's own direction that points up where the robot stands upright.
    pub up: [f64; 3],
}

/// The true pose of a sole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueSole {
    /// Its centre on the underside, in the world, m.
    pub place_m: [f64; 3],
    /// The sole's x axis seen from above, in the world.
    pub forward: [f64; 2],
}

impl TrueStance {
    /// Whether the state has all that is read of it.
    pub fn fits(&self, state: &TrueState<'_>) -> Result<(), SimulatedBodyError> {
        for link in [self.soles[0].0, self.soles[1].0, self.torso] {
            needs("xpos", state.xpos, 3 * (link + 1))?;
            needs("xmat", state.xmat, 9 * (link + 1))?;
        }
        Ok(())
    }

    /// The left and the right sole.
    pub fn soles(&self, state: &TrueState<'_>) -> [TrueSole; 2] {
        self.soles.map(|(link, offset_m)| {
            let world_from_link = Matrix3::from_row_slice(&row::<9>(state.xmat, link));
            let place_m = Vector3::from(row::<3>(state.xpos, link))
                + world_from_link * Vector3::from(offset_m);
            TrueSole {
                place_m: place_m.into(),
                forward: [world_from_link[(0, 0)], world_from_link[(1, 0)]],
            }
        })
    }

    /// By how much the torso leans from upright, rad.
    pub fn tilt_rad(&self, state: &TrueState<'_>) -> f64 {
        let [_, _, _, _, _, _, x, y, z] = row::<9>(state.xmat, self.torso);
        libm::acos(
            Vector3::new(x, y, z)
                .dot(&Vector3::from(self.up))
                .clamp(-1.0, 1.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::Rotation3;

    use super::*;
    use crate::truth::tests::arrays;

    fn stance() -> TrueStance {
        TrueStance {
            soles: [(0, [0.0, 0.0, -0.1]), (1, [0.2, 0.0, -0.1])],
            torso: 1,
            up: [0.0, 0.0, 1.0],
        }
    }

    #[test]
    fn a_sole_turns_and_moves_with_its_link_and_the_torsos_lean_is_its_angle() {
        let mut made = arrays();
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2);
        made.xmat[9..].copy_from_slice(turn.matrix().transpose().as_slice());
        made.xpos[3..].copy_from_slice(&[1.0, 2.0, 0.5]);
        let [left, right] = stance().soles(&made.state());
        assert_relative_eq!(Vector3::from(left.place_m), Vector3::new(0.0, 0.0, -0.1));
        assert_relative_eq!(
            Vector3::from(right.place_m),
            Vector3::new(1.0, 2.2, 0.4),
            epsilon = 1e-12
        );
        assert_relative_eq!(right.forward[1], 1.0);
        assert_eq!(stance().tilt_rad(&made.state()), 0.0);
        let lean = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.3);
        made.xmat[9..].copy_from_slice(lean.matrix().transpose().as_slice());
        assert_relative_eq!(stance().tilt_rad(&made.state()), 0.3, epsilon = 1e-12);
    }

    #[test]
    fn a_state_without_these_links_is_refused() {
        let mut made = arrays();
        assert_eq!(stance().fits(&made.state()), Ok(()));
        made.xmat.truncate(9);
        assert!(stance().fits(&made.state()).is_err());
    }
}
