//! Inverse kinematics of a leg whose joints may have any order, offsets, skew and tilt: Newton's method on its chain, damped by what is
//! left of the error (Sugihara, "Solvability-Unconcerned Inverse Kinematics by the Levenberg-Marquardt Method", IEEE Trans. Robotics 27,
//! 2011), from a solution that is near. Joints at the end of their range stand still while they are pushed beyond it.

use nalgebra::{Isometry3, SMatrix, SVector, Vector3};
use robot::{Body, MOST_LEG_JOINTS, Side};

use crate::chain_anatomy::{LegAnatomy, LegHinges};
use crate::error::WalkError;
use crate::leg_angles::LegAngles;
use crate::leg_sizes::LegSizes;
use crate::tuning::LegTuning;

type Angles = [f64; MOST_LEG_JOINTS];
type Moves = SMatrix<f64, 6, MOST_LEG_JOINTS>;

/// Damping that is left where nothing of the error is, as a share of the squared length of the leg.
const LEAST_DAMPING: f64 = 1e-12;
/// Weight of the pull to the upright stance where there are more joints than the sole needs, as a share of the same.
const PULL: f64 = 1e-7;
/// A turn of the torso to see how a joint follows it, rad.
const SMALL_RAD: f64 = 1e-3;
/// How the axes of a sole are called about which it turns.
const TURNS: [&str; 3] = ["roll", "pitch", "yaw"];

/// A leg as a chain of hinges.
#[derive(Debug, Clone)]
pub(crate) struct LegChain {
    hinges: LegHinges,
    anatomy: LegAnatomy,
    rest_rad: Angles,
    longest_m: f64,
    shortest_m: f64,
    tuning: LegTuning,
}

/// What the sole, or the ankle, is to do.
#[derive(Debug, Clone, Copy)]
struct SoleTask {
    torso_from_sole: Isometry3<f64>,
    /// The point that has to be where it is on the sole, in its frame, m.
    point: Vector3<f64>,
    /// The axis of the sole about which any turn is right.
    left_open: Option<usize>,
    /// A joint that stands still.
    held: Option<usize>,
}

/// Where an iteration came to.
#[derive(Debug, Clone, Copy)]
struct Solution {
    angles_rad: Angles,
    off_m: f64,
    done: bool,
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

    /// What five joints leave open.
    pub(crate) fn left_open(&self) -> Option<&'static str> {
        self.anatomy.left_open.map(|axis| TURNS[axis])
    }

    /// The joint angles that put the sole there.
    pub(crate) fn solve(&self, torso_from_sole: &Isometry3<f64>, near_rad: &Angles) -> LegAngles {
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
        near_rad: &Angles,
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
    pub(crate) fn per_turn(&self, slot: usize, rest_rad: &Angles) -> f64 {
        let (_, sole) = self.hinges.posed(rest_rad);
        let turn = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -SMALL_RAD);
        let hip = self.anatomy.sizes.hip;
        let turned = Isometry3::from_parts((hip - turn * hip).into(), turn) * sole;
        let angle = |sole: &Isometry3<f64>| self.solve(sole, rest_rad).angles_rad[slot];
        (angle(&turned) - angle(&sole)) / SMALL_RAD
    }

    fn reach(&self, task: SoleTask, near_rad: &Angles) -> LegAngles {
        let mut found = self.iterate(&task, near_rad);
        let mut short_m = 0.0;
        if !found.done {
            let mut rest_rad = self.rest_rad;
            if let Some(slot) = task.held {
                rest_rad[slot] = near_rad[slot];
            }
            let (nearer, beyond_m) = self.shortened(task);
            found = self.iterate(&nearer, near_rad);
            if !found.done {
                let anew = self.iterate(&nearer, &rest_rad);
                if anew.done || anew.off_m < found.off_m {
                    found = anew;
                }
            }
            short_m = beyond_m.max(if found.done { 0.0 } else { found.off_m });
            found.done &= nearer.torso_from_sole == task.torso_from_sole;
        }
        LegAngles {
            angles_rad: found.angles_rad,
            reached: found.done,
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

    fn iterate(&self, task: &SoleTask, near_rad: &Angles) -> Solution {
        let all = self.hinges.all();
        let leg_m = self.anatomy.sizes.thigh_m + self.anatomy.sizes.shank_m;
        let mut angles_rad = [0.0; MOST_LEG_JOINTS];
        for (slot, hinge) in all.iter().enumerate() {
            let [low, high] = hinge.range_rad;
            let held = task.held == Some(slot);
            let near = near_rad[slot];
            angles_rad[slot] = if held { near } else { near.clamp(low, high) };
        }
        let spare = all.len() > 6;
        let mut solution = Solution {
            angles_rad,
            off_m: f64::INFINITY,
            done: false,
        };
        for step in 0..=self.tuning.steps {
            let (error, moves) = self.error(task, &angles_rad, leg_m);
            let off_m = error.fixed_rows::<3>(0).norm();
            let turned_m = error.fixed_rows::<3>(3).norm();
            let done = off_m.max(turned_m) < self.tuning.near;
            if done || off_m + turned_m < solution.off_m {
                solution = Solution {
                    angles_rad,
                    off_m: off_m + turned_m,
                    done,
                };
            }
            if done && !(spare && step == 0) {
                break;
            }
            let Some(change) = self.step(task, &angles_rad, &error, moves, leg_m) else {
                break;
            };
            for (angle, (hinge, change)) in angles_rad.iter_mut().zip(all.iter().zip(change.iter()))
            {
                let [low, high] = hinge.range_rad;
                *angle = (*angle + change).clamp(low.min(*angle), high.max(*angle));
            }
        }
        solution
    }

    /// By how much the sole is off (turns times the length of the leg, all in m), and how each joint moves it.
    fn error(&self, task: &SoleTask, angles_rad: &Angles, leg_m: f64) -> (SVector<f64, 6>, Moves) {
        let (posed, sole) = self.hinges.posed(angles_rad);
        let wanted = &task.torso_from_sole;
        let point = sole.translation.vector + sole.rotation * task.point;
        let off = wanted.translation.vector + wanted.rotation * task.point - point;
        let back = wanted.rotation.inverse();
        let turn = (wanted.rotation * sole.rotation.inverse()).into_inner();
        // Twice the sine of half the turn: nothing where there is none, and as the turn where it is small.
        let turned = back * (turn.imag() * (2.0 * turn.w.signum() * leg_m));
        let mut error = SVector::<f64, 6>::zeros();
        error.fixed_rows_mut::<3>(0).copy_from(&off);
        error.fixed_rows_mut::<3>(3).copy_from(&turned);
        let mut moves = Moves::zeros();
        for (slot, (axis, anchor)) in posed.iter().take(self.hinges.all().len()).enumerate() {
            let shift = axis.cross(&(point - anchor));
            moves.fixed_view_mut::<3, 1>(0, slot).copy_from(&shift);
            let turns = back * (axis * leg_m);
            moves.fixed_view_mut::<3, 1>(3, slot).copy_from(&turns);
        }
        if let Some(axis) = task.left_open {
            error[3 + axis] = 0.0;
            moves.row_mut(3 + axis).fill(0.0);
        }
        (error, moves)
    }

    /// The damped step from these angles, rad.
    fn step(
        &self,
        task: &SoleTask,
        angles_rad: &Angles,
        error: &SVector<f64, 6>,
        mut moves: Moves,
        leg_m: f64,
    ) -> Option<SVector<f64, MOST_LEG_JOINTS>> {
        let all = self.hinges.all();
        let uphill = moves.tr_mul(error);
        let mut still = [true; MOST_LEG_JOINTS];
        for (slot, hinge) in all.iter().enumerate() {
            let [low, high] = hinge.range_rad;
            let (angle, pushed) = (angles_rad[slot], uphill[slot]);
            still[slot] = task.held == Some(slot)
                || (angle <= low && pushed < 0.0)
                || (angle >= high && pushed > 0.0);
            if still[slot] {
                moves.column_mut(slot).fill(0.0);
            }
        }
        let mut normal = moves.tr_mul(&moves);
        let mut right = moves.tr_mul(error);
        let damping = error.norm_squared() + LEAST_DAMPING * leg_m * leg_m;
        let pull = if all.len() > 6 {
            PULL * leg_m * leg_m
        } else {
            0.0
        };
        for slot in 0..MOST_LEG_JOINTS {
            if still[slot] {
                normal[(slot, slot)] = 1.0;
                right[slot] = 0.0;
                continue;
            }
            normal[(slot, slot)] += damping + pull;
            right[slot] += pull * (self.rest_rad[slot] - angles_rad[slot]);
        }
        let step = normal.cholesky()?.solve(&right);
        let longest = step.amax();
        let most = self.tuning.longest_step;
        Some(if longest > most {
            step * (most / longest)
        } else {
            step
        })
    }
}

#[cfg(test)]
#[path = "chain_tests.rs"]
mod tests;
