//! What is left of the readings when a part of them is wrong, for a robot that comes to stand and then does nothing more.

use geometry::GRAVITY_MPS2;
use nalgebra::{UnitQuaternion, Vector3};
use robot::{Body, Side};
use sensing::Observation;

use super::turn::turn_rad;
use crate::BodyState;

/// Which readings are made up, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Repair {
    /// None.
    Nothing,
    /// A force cell's: a stiff sole on three cells tells the fourth.
    Cell {
        /// The foot.
        side: Side,
        /// The cell, in the order of the observation.
        cell: usize,
    },
    /// A foot's: it carries what the other one does not.
    Foot(Side),
    /// The inertial unit's: the sole that carries lies level and rests.
    Inertial,
}

/// How the torso stands and turns by the leg that carries it.
#[derive(Debug, Clone, Default)]
pub(super) struct LegTurn {
    before: Option<(Side, UnitQuaternion<f64>)>,
    torso_from_imu: UnitQuaternion<f64>,
    up_in_torso: Vector3<f64>,
    rate_radps: Vector3<f64>,
}

impl LegTurn {
    /// Follows the legs.
    pub(super) fn follow(&mut self, state: &BodyState, body: &Body, passed_s: f64) {
        let side = state.support;
        let torso_from_sole = body.torso_from_sole(&state.links, side).rotation;
        let before = self.before.replace((side, torso_from_sole));
        self.torso_from_imu = body.torso_from_imu(&state.links).rotation;
        self.up_in_torso = torso_from_sole * Vector3::z();
        if let Some((_, before)) = before.filter(|&(before, _)| before == side && passed_s > 0.0) {
            self.rate_radps = turn_rad(&before, &torso_from_sole) / passed_s;
        }
    }
}

impl Repair {
    /// Takes what is wrong out of an observation.
    pub(super) fn apply(self, observation: &mut Observation, weight_n: f64, standing: &LegTurn) {
        match self {
            Self::Nothing => {}
            Self::Cell { side, cell } => {
                let cells = &mut observation.foot_forces_n[side.index()];
                // The corner across is 3 - cell; what the other two carry, less that.
                let sum: f64 = cells.iter().sum();
                let across = cells[3 - cell];
                cells[cell] = (sum - cells[cell] - 2.0 * across).max(0.0);
            }
            Self::Foot(side) => {
                let other: f64 = observation.foot_forces_n[side.other().index()].iter().sum();
                let left_n = (weight_n - other).max(0.0);
                let cells = &mut observation.foot_forces_n[side.index()];
                *cells = [left_n / cells.len() as f64; 4];
            }
            Self::Inertial => {
                let imu_from_torso = standing.torso_from_imu.inverse();
                let up = imu_from_torso * standing.up_in_torso * GRAVITY_MPS2;
                let rate = imu_from_torso * standing.rate_radps;
                observation.specific_force_mps2 = up.into();
                observation.angular_velocity_radps = rate.into();
            }
        }
    }
}
