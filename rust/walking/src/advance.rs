//! The sequence of steps goes on: from a stand to a step, from one foot to the other, and to a stand again.

use crate::{felt::KnownGround, gait::Gait, phase::GaitPhase, task::Task};

impl Gait {
    /// Advances the sequence by `passed_s` of its own clock. A command takes effect when the next step is chosen.
    pub fn advance(&mut self, passed_s: f64, task: Task<'_>, ground: &KnownGround) {
        match &mut self.phase {
            GaitPhase::Standing => {
                if let Some(next) = self.first_swing(task) {
                    self.phase = Self::shift(self.middle(), Some(next), self.config.shift_time);
                }
            }
            GaitPhase::Double {
                elapsed_s,
                duration_s,
                next,
                ..
            } => {
                *elapsed_s += passed_s;
                if *elapsed_s >= *duration_s {
                    let over_s = *elapsed_s - *duration_s;
                    self.phase = match *next {
                        None => GaitPhase::Standing,
                        Some(swing) => GaitPhase::Single {
                            elapsed_s: over_s,
                            duration_s: swing.single_support_s(&self.config),
                            swing,
                        },
                    };
                } else if next.is_none()
                    && let Some(swing) = self.first_swing(task)
                {
                    let zmp = self.zmp();
                    self.phase = Self::shift(zmp, Some(swing), self.config.shift_time);
                }
            }
            GaitPhase::Single {
                elapsed_s,
                duration_s,
                swing,
            } => {
                let before_s = *elapsed_s;
                *elapsed_s += passed_s;
                let over = *elapsed_s >= *duration_s;
                if swing.manner.is_careful() {
                    self.go_carefully(before_s, passed_s, task, ground);
                } else if over {
                    let swing = *swing;
                    self.land_in_time(&swing, task, ground);
                } else if let KnownGround::Felt(felt) = ground {
                    self.feel_the_way(before_s, felt);
                }
            }
        }
    }
}
