//! One motor for the yaw of both hips, as a NAO has it.
//!
//! Both legs turn by one angle, to opposite sides. Two soles on the ground differ in heading as they do; that both legs want the
//! same angle is then a matter of how the torso is turned between them: on level ground by the mean of the soles' headings.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use robot::{Body, Side};

use crate::error::WalkError;
use crate::leg::{LegAngles, LegSolver};
use crate::tuning::SharedHipTuning;

/// Difference of the wanted angles that is one of rounding, rad: no encoder tells it.
const AGREED_RAD: f64 = 1e-9;
/// Least growth of the left leg's angle over the right one's by a turn of the torso that tells legs which turn to opposite sides, for
/// which it is 2 or more, from legs that turn to one side, for which it is 0.
const LEAST_APART: f64 = 1.0;

/// How both legs agree on one angle.
#[derive(Debug, Clone)]
pub(crate) struct SharedHip {
    /// By how much the left leg's angle grows over the right one's by a turn of the torso to the left.
    apart_per_turn: f64,
    tuning: SharedHipTuning,
}

/// Two legs that agree.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Agreement {
    /// How far the torso has to be turned to the left, rad.
    pub(crate) turn_rad: f64,
    /// The legs' angles; the first one of both legs is the same.
    pub(crate) legs: [LegAngles; 2],
}

impl SharedHip {
    /// `None` where every leg has a yaw motor of its own. Fails where one motor turns both legs to the same side: no torso could
    /// be turned so that they agree.
    pub(crate) fn read(
        body: &Body,
        legs: &[LegSolver; 2],
        tuning: &SharedHipTuning,
    ) -> Result<Option<Self>, WalkError> {
        let [left, right] = Side::BOTH.map(|side| body.leg_joints(side)[0]);
        let shared = |&(follower, leader): &(usize, usize)| {
            [[left, right], [right, left]].contains(&[follower, leader])
        };
        if !body.followers.iter().any(shared) {
            return Ok(None);
        }
        let apart_per_turn = legs[0].yaw_per_turn() - legs[1].yaw_per_turn();
        if apart_per_turn.abs() < LEAST_APART {
            return Err(WalkError::Leg {
                side: Side::Right,
                what: "a shared yaw joint must turn the legs to opposite sides".to_owned(),
            });
        }
        Ok(Some(Self {
            apart_per_turn,
            tuning: tuning.clone(),
        }))
    }

    /// The turn of the torso about the vertical through `about` after which both legs want the same angle, and the legs then.
    /// The secant method; what is left goes to both legs alike.
    pub(crate) fn agree(
        &self,
        legs: &[LegSolver; 2],
        torso_from_sole: &[Isometry3<f64>; 2],
        about: &Point3<f64>,
    ) -> Agreement {
        let most_rad = self.tuning.most_turn;
        let mut turn_rad: f64 = 0.0;
        let mut soles = *torso_from_sole;
        let mut wanted_rad = [0.0; 2];
        let mut before: Option<[f64; 2]> = None;
        for _ in 0..self.tuning.turns {
            wanted_rad = [0, 1].map(|index| legs[index].wanted_yaw_rad(&soles[index]));
            let apart_rad = wanted_rad[0] - wanted_rad[1];
            if apart_rad.abs() < AGREED_RAD {
                break;
            }
            let slope = before.map_or(self.apart_per_turn, |[turn_before, apart_before]| {
                let slope = (apart_rad - apart_before) / (turn_rad - turn_before);
                let steep = slope / self.apart_per_turn > self.tuning.least_slope;
                if steep { slope } else { self.apart_per_turn }
            });
            before = Some([turn_rad, apart_rad]);
            turn_rad = (turn_rad - apart_rad / slope).clamp(-most_rad, most_rad);
            let turned = turn_back(about, turn_rad);
            soles = torso_from_sole.map(|sole| turned * sole);
        }
        let yaw_rad = 0.5 * (wanted_rad[0] + wanted_rad[1]);
        Agreement {
            turn_rad,
            legs: [0, 1].map(|index| legs[index].solve_turned(&soles[index], yaw_rad)),
        }
    }
}

/// What stands still as seen from a torso that has turned to the left about the vertical through `about`.
fn turn_back(about: &Point3<f64>, turn_rad: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -turn_rad);
    Isometry3::from_parts(Translation3::from(about - turn * about), turn)
}

#[cfg(test)]
#[path = "shared_hip_tests.rs"]
mod tests;
