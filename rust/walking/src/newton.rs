//! Newton's method on the chain of a leg's joints, damped by what is left of the error (Sugihara, "Solvability-Unconcerned Inverse
//! Kinematics by the Levenberg-Marquardt Method", IEEE Trans. Robotics 27, 2011). Joints at the end of their range stand still while
//! they are pushed beyond it.

use nalgebra::{Isometry3, SMatrix, SVector, Vector3};
use robot::MOST_LEG_JOINTS;

use crate::chain_anatomy::LegHinges;
use crate::leg_angles::JointAngles;
use crate::tuning::LegTuning;

type Moves = SMatrix<f64, 6, MOST_LEG_JOINTS>;

/// Damping that is left where nothing of the error is, as a share of the square of what makes turns lengths.
const LEAST_DAMPING: f64 = 1e-12;
/// Weight of the pull to the upright stance where there are more joints than the sole needs, as a share of the same.
const PULL: f64 = 1e-7;

/// What the sole, or the ankle, is to do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SoleTask {
    /// Where the sole is to be.
    pub(crate) torso_from_sole: Isometry3<f64>,
    /// The point that has to be where it is on the sole, in its frame, m.
    pub(crate) point: Vector3<f64>,
    /// The axis of the sole about which any turn is right.
    pub(crate) left_open: Option<usize>,
    /// A joint that stands still.
    pub(crate) held: Option<usize>,
}

/// Where an iteration came to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solution {
    /// Of the joints, within their ranges.
    pub(crate) angles_rad: JointAngles,
    /// By how far the point of the sole is off, m.
    pub(crate) off_m: f64,
    /// That, and by how much the sole is turned off, made a length, m.
    both_m: f64,
    /// Whether that is next to nothing.
    pub(crate) done: bool,
}

/// The method for one leg.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Newton<'a> {
    /// The joints, and the sole behind them.
    pub(crate) hinges: &'a LegHinges,
    /// Their angles in the upright stance.
    pub(crate) rest_rad: &'a JointAngles,
    /// What makes turns lengths, m: the length of the leg, or less where it matters more where the sole is than how it lies.
    pub(crate) turn_m: f64,
    /// When it is done.
    pub(crate) tuning: &'a LegTuning,
}

impl Newton<'_> {
    /// Goes from angles that are near to those that do what is asked for, or as near to it as it gets.
    pub(crate) fn iterate(&self, task: &SoleTask, near_rad: &JointAngles) -> Solution {
        let all = self.hinges.all();
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
            both_m: f64::INFINITY,
            done: false,
        };
        for step in 0..=self.tuning.steps {
            let (error, moves) = self.error(task, &angles_rad);
            let off_m = error.fixed_rows::<3>(0).norm();
            let turned_m = error.fixed_rows::<3>(3).norm();
            let done = off_m.max(turned_m) < self.tuning.near;
            if done || off_m + turned_m < solution.both_m {
                solution = Solution {
                    angles_rad,
                    off_m,
                    both_m: off_m + turned_m,
                    done,
                };
            }
            // With joints to spare there is always something to pull towards the stance.
            if done && !(spare && step == 0) {
                break;
            }
            let Some(change) = self.step(task, &angles_rad, &error, moves) else {
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
    fn error(&self, task: &SoleTask, angles_rad: &JointAngles) -> (SVector<f64, 6>, Moves) {
        let (posed, sole) = self.hinges.posed(angles_rad);
        let wanted = &task.torso_from_sole;
        let point = sole.translation.vector + sole.rotation * task.point;
        let off = wanted.translation.vector + wanted.rotation * task.point - point;
        let back = wanted.rotation.inverse();
        let turn = (wanted.rotation * sole.rotation.inverse()).into_inner();
        // Twice the sine of half the turn: nothing where there is none, and as the turn where it is small.
        let turned = back * (turn.imag() * (2.0 * turn.w.signum() * self.turn_m));
        let mut error = SVector::<f64, 6>::zeros();
        error.fixed_rows_mut::<3>(0).copy_from(&off);
        error.fixed_rows_mut::<3>(3).copy_from(&turned);
        let mut moves = Moves::zeros();
        for (slot, (axis, anchor)) in posed.iter().take(self.hinges.all().len()).enumerate() {
            let shift = axis.cross(&(point - anchor));
            moves.fixed_view_mut::<3, 1>(0, slot).copy_from(&shift);
            let turns = back * (axis * self.turn_m);
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
        angles_rad: &JointAngles,
        error: &SVector<f64, 6>,
        mut moves: Moves,
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
        let damping = error.norm_squared() + LEAST_DAMPING * self.turn_m * self.turn_m;
        let pull = if all.len() > 6 {
            PULL * self.turn_m * self.turn_m
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
