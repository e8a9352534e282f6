//! A leg and its inverse kinematics: in closed form where its axes meet as that needs, else by Newton's method on its chain of joints.

use nalgebra::{Isometry3, Vector2, Vector3};
use robot::{Body, MOST_LEG_JOINTS, Side};

use crate::chain::LegChain;
use crate::closed_form::ClosedForm;
use crate::error::WalkError;
pub use crate::leg_angles::LegAngles;
use crate::leg_geometry::LegGeometry;
use crate::leg_sizes::LegSizes;
use crate::tuning::LegTuning;

/// A leg of five to seven joints in any order.
#[derive(Debug, Clone)]
pub struct LegSolver {
    joints: Vec<usize>,
    sizes: LegSizes,
    form: SolvedBy,
    rest_rad: [f64; MOST_LEG_JOINTS],
    /// Longest distance from hip to ankle, m.
    pub(crate) max_length_m: f64,
}

/// How angles are found.
#[derive(Debug, Clone)]
enum SolvedBy {
    ClosedForm(ClosedForm),
    Chain {
        chain: Box<LegChain>,
        /// Why the closed form does not hold.
        why: String,
    },
}

impl LegSolver {
    /// Reads a leg from the body. It gets no longer than `max_extension` of its straight length.
    ///
    /// # Errors
    ///
    /// Its joints are no chain that ends at the sole, or none of them is a knee.
    pub fn new(
        body: &Body,
        side: Side,
        max_extension: f64,
        tuning: &LegTuning,
    ) -> Result<Self, WalkError> {
        let joints = body.leg_joints(side).to_vec();
        let mut rest_rad = [0.0; MOST_LEG_JOINTS];
        for (rest, &joint) in rest_rad.iter_mut().zip(&joints) {
            *rest = body.description().stand[joint];
        }
        let (sizes, form, max_length_m) = match LegGeometry::read(body, side, tuning)? {
            Ok(geometry) => {
                let sizes = geometry.sizes();
                let (a, b) = (sizes.thigh_m, sizes.shank_m);
                let longest_m = max_extension * (a + b);
                let shortest_m = (a - b).abs() + tuning.shortest * a;
                let closed = ClosedForm::new(geometry, longest_m, shortest_m);
                (sizes, SolvedBy::ClosedForm(closed), longest_m)
            }
            Err(why) => {
                let (chain, sizes) = LegChain::read(body, side, max_extension, tuning)?;
                let longest_m = chain.longest_m();
                let chain = Box::new(chain);
                (sizes, SolvedBy::Chain { chain, why }, longest_m)
            }
        };
        Ok(Self {
            joints,
            sizes,
            form,
            rest_rad,
            max_length_m,
        })
    }

    /// Indices of its joints, from the hip down.
    pub fn joints(&self) -> &[usize] {
        &self.joints
    }

    /// Its angles in the upright stance, rad: where to begin when no solution is near.
    pub const fn rest_rad(&self) -> &[f64; MOST_LEG_JOINTS] {
        &self.rest_rad
    }

    /// Why its angles are found by Newton's method; `None` where the closed form holds.
    pub fn not_closed(&self) -> Option<&str> {
        match &self.form {
            SolvedBy::ClosedForm(_) => None,
            SolvedBy::Chain { why, .. } => Some(why),
        }
    }

    /// What its joints leave open of where the sole is, a turn about its own axis: `"roll"`, `"pitch"` or `"yaw"`, for five joints.
    pub fn left_open(&self) -> Option<&'static str> {
        match &self.form {
            SolvedBy::ClosedForm(_) => None,
            SolvedBy::Chain { chain, .. } => chain.left_open(),
        }
    }

    /// Centre of the hip in the torso, m.
    pub const fn hip(&self) -> &Vector3<f64> {
        &self.sizes.hip
    }

    /// From hip to knee, and from knee to ankle, m.
    pub const fn lengths_m(&self) -> (f64, f64) {
        (self.sizes.thigh_m, self.sizes.shank_m)
    }

    /// The greatest height of the hip over an ankle that is `back_m` behind and `aside_m` beside it at which the thigh stretches back by
    /// no more than `stretch_rad`: the knee bends until the shank makes up for the rest.
    pub fn stretched_m(&self, back_m: f64, aside_m: f64, stretch_rad: f64) -> f64 {
        let (thigh_m, shank_m) = (self.sizes.thigh_m, self.sizes.shank_m);
        let (sin, cos) = libm::sincos(stretch_rad);
        if back_m <= (thigh_m + shank_m) * sin {
            return f64::INFINITY;
        }
        let left_m = (back_m - thigh_m * sin).min(shank_m);
        let along_m = thigh_m * cos + (shank_m * shank_m - left_m * left_m).sqrt();
        (along_m * along_m - aside_m * aside_m).max(0.0).sqrt()
    }

    /// Where its ankle is in the frame of a sole, m.
    pub const fn ankle_in_sole(&self) -> &Vector3<f64> {
        &self.sizes.ankle_in_sole
    }

    /// Which of its joints is the knee.
    pub(crate) const fn knee_slot(&self) -> usize {
        match &self.form {
            SolvedBy::ClosedForm(_) => ClosedForm::KNEE,
            SolvedBy::Chain { chain, .. } => chain.knee_slot(),
        }
    }

    /// Height of the ankle over the sole, m.
    pub fn ankle_height_m(&self) -> f64 {
        self.sizes.ankle_in_sole.z
    }

    /// The ankle over the ground when the sole is level at `foot`, m.
    pub fn ankle_in_plan(&self, foot: &geometry::PlanarPose) -> Vector2<f64> {
        let ankle = &self.sizes.ankle_in_sole;
        let (x, y) = foot.apply(ankle.x, ankle.y);
        Vector2::new(x, y)
    }

    /// The joint angles that put the sole at `torso_from_sole`. `near_rad`: angles that are not far from them, those of a moment
    /// before; they only matter where there is no closed form.
    pub fn solve(
        &self,
        torso_from_sole: &Isometry3<f64>,
        near_rad: &[f64; MOST_LEG_JOINTS],
    ) -> LegAngles {
        match &self.form {
            SolvedBy::ClosedForm(form) => form.solve(torso_from_sole),
            SolvedBy::Chain { chain, .. } => chain.solve(torso_from_sole, near_rad),
        }
    }

    /// The angle of the joint in `slot`, which turns the whole leg about the hip, that [`Self::solve`] would like, rad; of a closed
    /// form without regard to its range.
    pub fn wanted_yaw_rad(
        &self,
        torso_from_sole: &Isometry3<f64>,
        slot: usize,
        near_rad: &[f64; MOST_LEG_JOINTS],
    ) -> f64 {
        match &self.form {
            SolvedBy::ClosedForm(form) if slot == 0 => form.wanted_yaw_rad(torso_from_sole),
            _ => self.solve(torso_from_sole, near_rad).angles_rad[slot],
        }
    }

    /// How much the angle of the joint in `slot` has to grow by a turn of the torso to the left.
    pub fn yaw_per_turn(&self, slot: usize) -> f64 {
        match &self.form {
            SolvedBy::ClosedForm(form) if slot == 0 => form.yaw_per_turn(),
            SolvedBy::ClosedForm(_) => 0.0,
            SolvedBy::Chain { chain, .. } => chain.per_turn(slot),
        }
    }

    /// The joint angles that put the ankle where it is at `torso_from_sole` and the sole as level as there, the joint in `slot` being
    /// held at `yaw_rad`: where the sole points to follows.
    pub fn solve_turned(
        &self,
        torso_from_sole: &Isometry3<f64>,
        slot: usize,
        yaw_rad: f64,
        near_rad: &[f64; MOST_LEG_JOINTS],
    ) -> LegAngles {
        match &self.form {
            SolvedBy::ClosedForm(form) => form.solve_turned(torso_from_sole, yaw_rad),
            SolvedBy::Chain { chain, .. } => {
                chain.solve_turned(torso_from_sole, slot, yaw_rad, near_rad)
            }
        }
    }
}

#[cfg(test)]
#[path = "leg_tests.rs"]
mod tests;
