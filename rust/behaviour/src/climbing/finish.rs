//! The end of a climb: to the middle of where it led, arms up for a moment, and on (003, section V.D).

use super::{Here, Phase, StairClimbing, State};
use crate::{Motion, Velocity};

/// The farthest that the robot walks away from the last edge before it is glad, from the edge to its middle, m.
const FARTHEST_M: f64 = 0.16;
/// Walking there ends after this, s.
const LONGEST_WALK_S: f64 = 5.0;
/// Waiting for the robot to stand ends after this, s.
const LONGEST_STOP_S: f64 = 3.0;

impl StairClimbing {
    /// One tick.
    pub(super) fn finish(&mut self, here: &Here<'_>) -> Motion {
        self.head.turn_to([0.35, 0.0], here.passed_s);
        let remaining_m = self.on.map_or(0.0, |step| {
            let beyond_m = step.stair.front.beyond_m([here.pose.x_m, here.pose.y_m]);
            (0.5 * step.stair.depth_m()).min(FARTHEST_M) - beyond_m
        });
        match self.phase {
            Phase::Look if remaining_m > 0.02 && self.phase_s < LONGEST_WALK_S => {
                return Motion::Walk(Velocity {
                    x_mps: (1.5 * remaining_m).clamp(0.02, 0.08),
                    ..Velocity::default()
                });
            }
            Phase::Look => self.phase(Phase::Step),
            Phase::Step if here.situation.standing || self.phase_s > LONGEST_STOP_S => {
                self.phase(Phase::Wait);
            }
            Phase::Wait if self.phase_s > self.config.cheer => {
                self.on = None;
                self.came_from = None;
                self.pauses = false;
                self.flight.clear();
                self.tries = super::Tries::default();
                self.walking.resume(here.situation);
                self.enter(State::Walk);
            }
            Phase::Step | Phase::Wait => {}
        }
        Motion::Stand
    }
}
