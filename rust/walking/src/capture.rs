//! Catching a push with the step that is under way: where it lands, and when.

use geometry::PlanarPose;
use nalgebra::Vector2;

use crate::footsteps::FootstepPlanner;
use crate::gait::{Gait, Phase};
use crate::support::Soles;
use crate::GaitConfig;

/// Share of the swing after which the landing stays where it is.
const COMMITTED: f64 = 0.85;
/// Fastest that a landing is moved, m/s.
const SPEED_MPS: f64 = 1.0;

/// Moves landings.
#[derive(Debug, Clone)]
pub struct Capture {
    config: GaitConfig,
    planner: FootstepPlanner,
}

impl Capture {
    /// For this gait.
    pub fn new(config: &GaitConfig, planner: FootstepPlanner) -> Self {
        Self {
            config: config.clone(),
            planner,
        }
    }

    /// Moves the landing of the step under way by what the ankles cannot take back of the DCM's `error` before it; returns how
    /// fast the step's clock is to run.
    pub fn adjust(
        &self,
        gait: &mut Gait,
        soles: &Soles,
        error: &Vector2<f64>,
        omega: f64,
        passed_s: f64,
    ) -> f64 {
        let stance_point = gait.zmp();
        let feet = gait.feet;
        let Phase::Single {
            elapsed_s,
            duration_s,
            swing,
        } = &mut gait.phase
        else {
            return 1.0;
        };
        let left_s = (*duration_s - *elapsed_s).max(0.0);
        let growth = (omega * left_s).exp();
        if growth < 1.01 {
            return 1.0;
        }
        let stance = swing.side.other();
        let stance_foot = &feet[stance.index()];
        let wanted = stance_point + error * (growth / (growth - 1.0));
        let given = soles.nearest(stance_foot, stance, &wanted);
        let rest = error * growth - (given - stance_point) * (growth - 1.0);
        let heading = PlanarPose::new(0.0, 0.0, -stance_foot.planar.yaw_rad);
        let (x, y) = heading.apply(rest.x, rest.y);
        let beyond = |value: f64| {
            let dead = self.config.capture_deadband;
            (value - value.clamp(-dead, dead))
                .clamp(-self.config.capture_limit, self.config.capture_limit)
        };
        let (x, y) = (beyond(x), beyond(y));
        if *elapsed_s < COMMITTED * *duration_s {
            let mut local = stance_foot.planar.relative(&swing.planned.planar);
            local.x_m += x;
            local.y_m += y;
            let goal = self.planner.keep_apart(
                &stance_foot.planar,
                &stance_foot.planar.compose(&local),
                swing.side,
            );
            let most = SPEED_MPS * passed_s;
            let to = &mut swing.to.planar;
            to.x_m += (goal.x_m - to.x_m).clamp(-most, most);
            to.y_m += (goal.y_m - to.y_m).clamp(-most, most);
        }
        let outward = y * swing.side.sign();
        1.0 + (outward / self.config.capture_limit).clamp(0.0, 1.0) * (self.config.capture_hurry - 1.0)
    }
}
