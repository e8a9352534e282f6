//! The plan of the coming steps, and the reference of weight and motion that follows from it.

use nalgebra::Vector2;
use robot::Side;

use crate::dcm::{self, ZmpSegment};
use crate::gait::Gait;
use crate::phase::{GaitPhase, GaitReference, Manner, Swing};
use crate::task::Task;
use crate::tuning::MOST_STEPS;

/// Most segments of a plan: two a step, and the last shift to the middle.
const SEGMENTS: usize = 2 * MOST_STEPS + 1;

/// Segments of the ZMP from now on.
#[derive(Default)]
struct ZmpPlan {
    segments: [ZmpSegment; SEGMENTS],
    count: usize,
}

impl ZmpPlan {
    fn add(&mut self, from: Vector2<f64>, to: Vector2<f64>, duration_s: f64) {
        if let Some(slot) = self.segments.get_mut(self.count) {
            *slot = ZmpSegment {
                from,
                to,
                duration_s,
            };
            self.count += 1;
        }
    }
}

impl Gait {
    /// ZMP and DCM of the plan at the moment. The plan ends in a stand behind the last step that is looked ahead.
    pub fn reference(&self, omega: f64, task: Task<'_>) -> GaitReference {
        let zmp = self.zmp();
        let mut plan = ZmpPlan::default();
        if let Some(swing) = self.running(&mut plan) {
            self.coming(swing, task, &mut plan);
        }
        let dcm = dcm::start_dcm(&plan.segments[..plan.count], omega).unwrap_or(zmp);
        GaitReference { zmp, dcm }
    }

    /// Adds what is left of the running step; returns it, or `None` where the robot comes to stand.
    fn running(&self, plan: &mut ZmpPlan) -> Option<Swing> {
        match &self.phase {
            GaitPhase::Standing => None,
            GaitPhase::Double {
                elapsed_s,
                duration_s,
                next,
                ..
            } => {
                let goal = self.shift_goal(next.as_ref());
                plan.add(self.zmp(), goal, duration_s - elapsed_s);
                let swing = (*next)?;
                plan.add(goal, goal, swing.single_support_s(&self.config));
                Some(swing)
            }
            GaitPhase::Single {
                elapsed_s,
                duration_s,
                swing,
            } => {
                let point = self.carrying_point(&self.feet, swing);
                plan.add(point, point, duration_s - elapsed_s);
                Some(*swing)
            }
        }
    }

    /// Adds the steps behind `swing`, and the shift to the middle behind the last.
    fn coming(&self, mut swing: Swing, task: Task<'_>, plan: &mut ZmpPlan) {
        let mut feet = self.feet;
        let mut stands = self.carrying_point(&self.feet, &swing);
        for ahead in 1..self.config.tuning.preview.steps {
            feet[swing.side.index()] = swing.to;
            if swing.manner == Manner::Placed && matches!(task, Task::Stand(_)) {
                break;
            }
            let Some(next) = self.next_swing(&feet, swing.side, task, ahead) else {
                break;
            };
            let point = self.carrying_point(&feet, &next);
            plan.add(stands, point, next.manner.double_support_s(&self.config));
            plan.add(point, point, next.single_support_s(&self.config));
            stands = point;
            swing = next;
        }
        feet[swing.side.index()] = swing.to;
        let points = Side::BOTH.map(|side| self.support_point(&feet, side));
        plan.add(
            stands,
            0.5 * (points[0] + points[1]),
            self.config.shift_time,
        );
    }
}
