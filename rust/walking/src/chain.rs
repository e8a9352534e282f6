//! Inverse kinematics of a leg whose joints may have any order, offsets, skew and tilt: from a solution that is near, and where that
//! leads nowhere from the upright stance.

use nalgebra::{Isometry3, Vector3};
use robot::{Body, MOST_LEG_JOINTS, Side};

use crate::chain_anatomy::{LegAnatomy, LegHinges};
use crate::error::WalkError;
use crate::leg_angles::{JointAngles, LegAngles};
use crate::leg_sizes::LegSizes;
use crate::newton::{Newton, SoleTask};
use crate::tuning::LegTuning;

/// A turn of the torso to see how a joint follows it, rad.
const SMALL_RAD: f64 = 1e-3;
/// How the axes of a sole are called about which it turns.
const TURNS: [&str; 3] = ["roll", "pitch", "yaw"];

/// A leg as a chain of hinges.
#[derive(Debug, Clone)]
pub(crate) struct LegChain {
    hinges: LegHinges,
    anatomy: LegAnatomy,
    rest_rad: JointAngles,
    longest_m: f64,
    shortest_m: f64,
    tuning: LegTuning,
}

impl LegChain {
    /// Reads it from the body, with its sizes; the leg gets no longer than `max_extension` of its straight length.
    pub(crate) fn read(
        body: &Body,
        side: Side,
        max_extension: f64,
        tuning: &LegTuning,
    ) -> Result<(Self, LegSizes), WalkError> {
        let mut hinges = LegHinges::read(body, side)?;
        let mut rest_rad = [0.0; MOST_LEG_JOINTS];
        for (rest, &joint) in rest_rad.iter_mut().zip(body.leg_joints(side)) {
            *rest = body.description().stand[joint];
        }
        let anatomy = LegAnatomy::read(&hinges, &rest_rad).ok_or_else(|| WalkError::Leg {
            side,
            what: "none of its joints bends it as a knee does".to_owned(),
        })?;
        let sizes = anatomy.sizes;
        let (a, b) = (sizes.thigh_m, sizes.shank_m);
        let shortest_m = (a - b).abs() + tuning.shortest * a;
        hinges.narrow(
            anatomy.knee,
            anatomy.bent_between(shortest_m, max_extension * (a + b)),
        );
        let chain = Self {
            longest_m: (max_extension * (a + b)).min(anatomy.longest_m),
            shortest_m,
            hinges,
            anatomy,
            rest_rad,
            tuning: tuning.clone(),
        };
        Ok((chain, sizes))
    }

    /// Longest distance from hip to ankle, m.
    pub(crate) const fn longest_m(&self) -> f64 {
        self.longest_m
    }

    /// Which joint is the knee.
    pub(crate) const fn knee_slot(&self) -> usize {
        self.anatomy.knee
    }

    /// What five joints leave open.
    pub(crate) fn left_open(&self) -> Option<&'static str> {
        self.anatomy.left_open.map(|axis| TURNS[axis])
    }

    /// The joint angles that put the sole there.
    pub(crate) fn solve(
        &self,
        torso_from_sole: &Isometry3<f64>,
        near_rad: &JointAngles,
    ) -> LegAngles {
        self.reach(
            SoleTask {
                torso_from_sole: *torso_from_sole,
                point: Vector3::zeros(),
                left_open: self.anatomy.left_open,
                held: None,
            },
            near_rad,
        )
    }

    /// The joint angles that put the ankle there and the sole as level as there, a joint being held.
    pub(crate) fn solve_turned(
        &self,
        torso_from_sole: &Isometry3<f64>,
        slot: usize,
        held_rad: f64,
        near_rad: &JointAngles,
    ) -> LegAngles {
        let mut near_rad = *near_rad;
        near_rad[slot] = held_rad;
        self.reach(
            SoleTask {
                torso_from_sole: *torso_from_sole,
                point: self.anatomy.sizes.ankle_in_sole,
                left_open: Some(2),
                held: Some(slot),
            },
            &near_rad,
        )
    }

    /// How much the angle of a joint grows by a turn of the torso to the left, in the upright stance.
    pub(crate) fn per_turn(&self, slot: usize) -> f64 {
        let (_, sole) = self.hinges.posed(&self.rest_rad);
        let turn = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -SMALL_RAD);
        let hip = self.anatomy.sizes.hip;
        let turned = Isometry3::from_parts((hip - turn * hip).into(), turn) * sole;
        let angle = |sole: &Isometry3<f64>| self.solve(sole, &self.rest_rad).angles_rad[slot];
        (angle(&turned) - angle(&sole)) / SMALL_RAD
    }

    fn reach(&self, task: SoleTask, near_rad: &JointAngles) -> LegAngles {
        let leg_m = self.anatomy.sizes.thigh_m + self.anatomy.sizes.shank_m;
        let mut newton = Newton {
            hinges: &self.hinges,
            rest_rad: &self.rest_rad,
            turn_m: leg_m,
            tuning: &self.tuning,
        };
        let mut found = newton.iterate(&task, near_rad);
        if found.done {
            return LegAngles {
                angles_rad: found.angles_rad,
                reached: true,
                short_m: 0.0,
            };
        }
        let (mut nearer, mut short_m) = self.shortened(task);
        let mut rest_rad = self.rest_rad;
        if let Some(slot) = task.held {
            rest_rad[slot] = near_rad[slot];
        }
        for start_rad in [near_rad, &rest_rad] {
            if !found.done {
                found = newton.iterate(&nearer, start_rad);
            }
        }
        let reached = found.done && nearer.torso_from_sole == task.torso_from_sole;
        if !found.done {
            // A joint is at its end: the ankle gets where it should, and the sole lies as it then can.
            nearer.point = self.anatomy.sizes.ankle_in_sole;
            newton.turn_m = self.tuning.lying * leg_m;
            found = newton.iterate(&nearer, near_rad);
            short_m = short_m.max(found.off_m);
        }
        LegAngles {
            angles_rad: found.angles_rad,
            reached,
            short_m,
        }
    }

    /// The task with the sole moved along the line from ankle to hip until the leg is long and short enough, and by how much it is too
    /// short, m.
    fn shortened(&self, mut task: SoleTask) -> (SoleTask, f64) {
        let LegSizes {
            hip, ankle_in_sole, ..
        } = &self.anatomy.sizes;
        let sole = &mut task.torso_from_sole;
        let ankle = sole.translation.vector + sole.rotation * ankle_in_sole;
        let apart = ankle - hip;
        let wanted_m = apart.norm();
        let length_m = wanted_m.clamp(self.shortest_m, self.longest_m);
        if length_m == wanted_m || wanted_m <= 0.0 {
            return (task, 0.0);
        }
        sole.translation.vector += apart * (length_m / wanted_m - 1.0);
        (task, (wanted_m - length_m).max(0.0))
    }
}

#[cfg(test)]
#[path = "chain_tests.rs"]
mod tests;
