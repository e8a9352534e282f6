//! One motor for the yaw of both hips, as a NAO has it.
//!
//! Both legs turn by one angle, to opposite sides. Two soles on the ground differ in heading as they do; that both legs want the
//! same angle is then a matter of how the torso is turned between them: on level ground by the mean of the soles' headings.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use robot::{Body, Follower, MOST_LEG_JOINTS, Side};

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
    /// The shared joint of each leg, by its place in the leg.
    slots: [usize; 2],
    /// How the left one's angle follows from the right one's.
    tie: Follower,
    /// By how much the left leg's angle grows over what the right one's makes of it by a turn of the torso to the left.
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
        let Some((slots, tie)) = shared(body) else {
            return Ok(None);
        };
        let [left, right] = [0, 1].map(|index: usize| legs[index].yaw_per_turn(slots[index]));
        let apart_per_turn = left - tie.ratio * right;
        if apart_per_turn.abs() < LEAST_APART {
            return Err(WalkError::Leg {
                side: Side::Right,
                what: "a shared yaw joint must turn the legs to opposite sides".to_owned(),
            });
        }
        Ok(Some(Self {
            slots,
            tie,
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
        near_rad: &[[f64; MOST_LEG_JOINTS]; 2],
    ) -> Agreement {
        let most_rad = self.tuning.most_turn;
        let mut turn_rad: f64 = 0.0;
        let mut soles = *torso_from_sole;
        let mut wanted_rad = [0.0; 2];
        let mut before: Option<[f64; 2]> = None;
        for _ in 0..self.tuning.turns {
            wanted_rad = [0, 1].map(|index| {
                legs[index].wanted_yaw_rad(&soles[index], self.slots[index], &near_rad[index])
            });
            let apart_rad = wanted_rad[0] - self.tie.angle_rad(wanted_rad[1]);
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
        let left_rad = 0.5 * (wanted_rad[0] + self.tie.angle_rad(wanted_rad[1]));
        let yaw_rad = [left_rad, self.tie.leader_rad(left_rad)];
        Agreement {
            turn_rad,
            legs: [0, 1].map(|index| {
                let (slot, near_rad) = (self.slots[index], &near_rad[index]);
                legs[index].solve_turned(&soles[index], slot, yaw_rad[index], near_rad)
            }),
        }
    }
}

/// The joints that one motor turns in both legs, by their places in them, and how the left one follows from the right one.
fn shared(body: &Body) -> Option<([usize; 2], Follower)> {
    let slot = |side: Side, joint: usize| {
        let mut joints = body.leg_joints(side).iter();
        joints.position(|&own| own == joint)
    };
    body.followers.iter().find_map(|tie| {
        let as_left = slot(Side::Left, tie.joint).zip(slot(Side::Right, tie.leader));
        if let Some((left, right)) = as_left {
            return Some(([left, right], *tie));
        }
        let (left, right) = slot(Side::Left, tie.leader).zip(slot(Side::Right, tie.joint))?;
        let turned = Follower {
            joint: tie.leader,
            leader: tie.joint,
            ratio: 1.0 / tie.ratio,
            offset_rad: -tie.offset_rad / tie.ratio,
        };
        Some(([left, right], turned))
    })
}

/// What stands still as seen from a torso that has turned to the left about the vertical through `about`.
fn turn_back(about: &Point3<f64>, turn_rad: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -turn_rad);
    Isometry3::from_parts(Translation3::from(about - turn * about), turn)
}

#[cfg(test)]
#[path = "shared_hip_tests.rs"]
mod tests;
