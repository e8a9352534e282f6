//! A robot that falls over the outer edge of the foot that stands: no step helps, for the feet would have to cross.
//!
//! What is left is to turn the body the way it falls: the leg in the air goes out to the other side and the torso rolls, and the
//! ground pushes the centre of mass back. How far they turn counts, and how early, for the fall grows by the factor of e in each time
//! constant of the pendulum; so it begins long before the edge, where a walk never brings the divergent component of motion.

use nalgebra::Vector2;
use robot::Side;

use super::Catching;
use crate::gait::Gait;
use crate::landing_search::Falling;
use crate::phase::{GaitPhase, Swing};

impl Catching {
    /// How far the torso is to roll to its right, rad.
    pub(crate) const fn roll_rad(&self) -> f64 {
        self.roll_rad
    }

    /// Rolls the torso to the side to which the robot falls over the outer edge of its sole, and back after that.
    pub(super) fn roll(&mut self, falling: &Falling<'_>) {
        let tuning = &self.config.tuning.catching;
        let goal_rad = -self.outer.sign() * tuning.roll * self.weighs;
        let speed = if self.weighs > 0.0 {
            tuning.roll_speed
        } else {
            tuning.roll_back
        };
        let most_rad = speed * falling.omega * falling.passed_s;
        self.roll_rad += (goal_rad - self.roll_rad).clamp(-most_rad, most_rad);
    }

    /// The foot over whose outer edge the robot would fall, and how far this point has got there from the middle of that sole, in heights
    /// of the hips.
    pub(super) fn outwards(&self, gait: &Gait, point: &Vector2<f64>) -> (Side, f64) {
        let out = |side: Side| {
            let foot = gait.feet[side.index()].planar.inverse();
            let (_, left_m) = foot.apply(point.x, point.y);
            (side, left_m * side.sign() / self.search.planner.leg_m)
        };
        match &gait.phase {
            GaitPhase::Standing => (Side::Left, 0.0),
            GaitPhase::Single { swing, .. } => out(swing.side.other()),
            GaitPhase::Double { .. } => {
                let [left, right] = Side::BOTH.map(out);
                if left.1 > right.1 { left } else { right }
            }
        }
    }

    /// What share of all that a counterweight can do is due.
    pub(super) fn weighing(&self, gait: &Gait, falling: &Falling<'_>) -> (Side, f64) {
        let tuning = &self.config.tuning.catching;
        let (outer, out) = self.outwards(gait, &falling.dcm);
        let weighs = (out - tuning.tips) / (tuning.tipped - tuning.tips);
        (outer, weighs.clamp(0.0, 1.0))
    }

    /// The robot falls over the outer edge of the sole that stands, where no step helps: the foot in the air goes out to the other side
    /// and waits there. What it takes of the robot's momentum, the body is given back.
    pub(super) fn counterweigh(
        &mut self,
        gait: &mut Gait,
        falling: &Falling<'_>,
        swing: Swing,
        [elapsed_s, duration_s]: [f64; 2],
    ) -> f64 {
        let tuning = &self.config.tuning.catching;
        let goal_m = self.weighs * tuning.weigh * self.search.planner.leg_m;
        let most_m = self.search.speed_mps(falling, tuning.out_speed) * falling.passed_s;
        self.out_m += (goal_m - self.out_m).clamp(0.0, most_m);
        let here = swing.foot(elapsed_s, &self.config);
        let out = self.search.far_out(gait, &swing, &here, self.out_m);
        if let GaitPhase::Single { swing, .. } = &mut gait.phase {
            (swing.from, swing.to) = (here, here);
            self.move_landing(swing, &out, falling);
            swing.to.z_m = out.z_m;
            swing.from = swing.to;
        }
        if elapsed_s < tuning.out_share * duration_s {
            return tuning.out_rate;
        }
        self.held_s += falling.passed_s;
        0.0
    }
}
