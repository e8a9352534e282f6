//! Catching a push with the step that is under way: where it lands, and when.

use geometry::PlanarPose;
use nalgebra::Vector2;
use robot::Side;

use crate::config::GaitConfig;
use crate::footsteps::FootstepPlanner;
use crate::gait::Gait;
use crate::phase::{GaitPhase, Manner, Swing};
use crate::support::Soles;

/// Moves landings and holds or hurries the steps' clock.
#[derive(Debug, Clone)]
pub struct Capture {
    config: GaitConfig,
    planner: FootstepPlanner,
    phase: Option<(Side, bool)>,
    held_s: f64,
}

impl Capture {
    /// For this gait.
    pub fn new(config: &GaitConfig, planner: FootstepPlanner) -> Self {
        Self {
            config: config.clone(),
            planner,
            phase: None,
            held_s: 0.0,
        }
    }

    /// Moves the landing of the step under way by what the ankles cannot take back of the DCM's `error` before it; returns how
    /// fast the step's clock is to run: faster when the robot falls towards the swing foot, slower while it leans outwards over
    /// the standing one, where a step would not help.
    pub fn adjust(
        &mut self,
        gait: &mut Gait,
        soles: &Soles,
        error: &Vector2<f64>,
        omega: f64,
        passed_s: f64,
    ) -> f64 {
        let tuning = &self.config.tuning.capture;
        let stance_point = gait.zmp();
        let feet = gait.feet;
        let (rate, phase) = match &mut gait.phase {
            GaitPhase::Standing | GaitPhase::Double { next: None, .. } => (1.0, None),
            GaitPhase::Double {
                next: Some(swing), ..
            } => {
                let stance = &feet[swing.side.other().index()].planar;
                let (_, across) = turned(stance, error);
                let lag = across * swing.side.sign();
                let late = (lag - self.config.capture_deadband).max(0.0);
                (
                    1.0 - (late / self.config.capture_hold).min(1.0),
                    Some((swing.side, false)),
                )
            }
            // A careful step is put where it was told: beside that there may be an edge.
            GaitPhase::Single { swing, .. } if !swing.manner.is_walked() => (1.0, None),
            GaitPhase::Single {
                elapsed_s,
                duration_s,
                swing,
            } => {
                let left_s = (*duration_s - *elapsed_s).max(0.0);
                let growth = libm::exp(omega * left_s);
                let stance = swing.side.other();
                let foot = &feet[stance.index()];
                let best = error * (growth / (growth - 1.0).max(tuning.least_growth));
                let given = soles.nearest(foot, stance, &(stance_point + best)) - stance_point;
                let rest = error * growth - given * (growth - 1.0);
                let (x, y) = turned(&foot.planar, &rest);
                let shift = Vector2::new(self.beyond(x), self.beyond(y));
                if *elapsed_s < tuning.committed * *duration_s {
                    self.move_landing(swing, &foot.planar, &shift, passed_s);
                }
                (
                    self.rate(shift.y * swing.side.sign()),
                    Some((swing.side, true)),
                )
            }
        };
        self.limit(rate, phase, passed_s)
    }

    fn beyond(&self, value: f64) -> f64 {
        let dead = self.config.capture_deadband;
        let limit = self.config.capture_limit;
        (value - value.clamp(-dead, dead)).clamp(-limit, limit)
    }

    fn rate(&self, towards_swing: f64) -> f64 {
        if towards_swing > 0.0 {
            let need = (towards_swing / self.config.capture_limit).min(1.0);
            1.0 + need * (self.config.capture_hurry - 1.0)
        } else {
            1.0 - (-towards_swing / self.config.capture_hold).min(1.0)
        }
    }

    fn move_landing(
        &self,
        swing: &mut Swing,
        stance: &PlanarPose,
        shift: &Vector2<f64>,
        passed_s: f64,
    ) {
        let limit = match swing.manner {
            Manner::Placed => self.config.tuning.listed.moved,
            _ => self.config.capture_limit,
        };
        let mut local = stance.relative(&swing.planned.planar);
        local.x_m += shift.x.clamp(-limit, limit);
        local.y_m += shift.y.clamp(-limit, limit);
        let goal = self
            .planner
            .keep_apart(stance, &stance.compose(&local), swing.side);
        let most = self.config.tuning.capture.speed * passed_s;
        let to = &mut swing.to.planar;
        to.x_m += (goal.x_m - to.x_m).clamp(-most, most);
        to.y_m += (goal.y_m - to.y_m).clamp(-most, most);
    }

    /// A clock that was held long enough in one phase runs again.
    fn limit(&mut self, rate: f64, phase: Option<(Side, bool)>, passed_s: f64) -> f64 {
        if phase != self.phase {
            self.phase = phase;
            self.held_s = 0.0;
        }
        if self.held_s > self.config.capture_patience {
            return rate.max(1.0);
        }
        self.held_s += (1.0 - rate).max(0.0) * passed_s;
        rate
    }
}

fn turned(stance: &PlanarPose, vector: &Vector2<f64>) -> (f64, f64) {
    PlanarPose::new(0.0, 0.0, -stance.yaw_rad).apply(vector.x, vector.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::{biped, config, foot_at, on_its_way};

    /// The left foot swings, for this share of its time already.
    fn swinging(share: f64) -> (Capture, Gait, Soles) {
        let (config, body) = (config(), biped());
        let left = foot_at(0.0, 0.0425);
        let swing = Swing::new(Side::Left, Manner::Walk, left, left);
        let gait = on_its_way(swing, foot_at(0.0, -0.0425), share);
        let planner = FootstepPlanner::new(&config, &body);
        let soles = Soles::new(&body, config.sole_margin);
        (Capture::new(&config, planner), gait, soles)
    }

    fn landing(gait: &Gait) -> PlanarPose {
        match &gait.phase {
            GaitPhase::Single { swing, .. } => swing.to.planar,
            _ => panic!("the foot swings"),
        }
    }

    #[test]
    fn small_errors_leave_the_step_alone() {
        let (mut capture, mut gait, soles) = swinging(0.3);
        let before = landing(&gait);
        let rate = capture.adjust(&mut gait, &soles, &Vector2::new(0.008, -0.008), 6.0, 0.01);
        assert_eq!((rate, landing(&gait)), (1.0, before));
    }

    #[test]
    fn a_push_to_the_swing_side_moves_the_landing_there() {
        let (mut capture, mut gait, soles) = swinging(0.3);
        for _ in 0..10 {
            let rate = capture.adjust(&mut gait, &soles, &Vector2::new(0.0, 0.05), 6.0, 0.01);
            assert!(rate >= 1.0);
        }
        assert!(landing(&gait).y_m > 0.06, "{:?}", landing(&gait));
    }

    #[test]
    fn a_walked_step_of_a_list_is_held_but_stays_where_it_was_told() {
        let (mut capture, mut gait, soles) = swinging(0.3);
        if let GaitPhase::Single { swing, .. } = &mut gait.phase {
            swing.manner = Manner::Placed;
        }
        let before = landing(&gait);
        let _ = capture.adjust(&mut gait, &soles, &Vector2::new(0.03, 0.05), 6.0, 0.01);
        assert!(landing(&gait).distance_m(&before) < 1e-12);
        let rate = capture.adjust(&mut gait, &soles, &Vector2::new(0.0, -0.05), 6.0, 0.01);
        assert!(rate < 1.0, "{rate}");
    }

    #[test]
    fn a_push_to_the_standing_side_holds_the_clock_but_not_for_ever() {
        let (mut capture, mut gait, soles) = swinging(0.9);
        let error = Vector2::new(0.0, -0.05);
        assert_eq!(capture.adjust(&mut gait, &soles, &error, 6.0, 0.01), 0.0);
        let patience = config().capture_patience;
        for _ in 0..(patience / 0.01) as usize + 2 {
            let _ = capture.adjust(&mut gait, &soles, &error, 6.0, 0.01);
        }
        assert_eq!(capture.adjust(&mut gait, &soles, &error, 6.0, 0.01), 1.0);
    }

    #[test]
    fn a_landing_is_never_moved_onto_the_standing_foot() {
        let (mut capture, mut gait, soles) = swinging(0.1);
        for _ in 0..50 {
            let _ = capture.adjust(&mut gait, &soles, &Vector2::new(0.03, -0.2), 6.0, 0.01);
        }
        assert!(landing(&gait).y_m >= 0.0425 - 0.003, "{:?}", landing(&gait));
    }
}
