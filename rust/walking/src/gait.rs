//! The sequence of steps: which foot stands, which moves, and what comes next.

use geometry::PlanarPose;
use nalgebra::Vector2;
use robot::Side;

use crate::config::GaitConfig;
use crate::descent::Descent;
use crate::footsteps::FootstepPlanner;
use crate::listed::Listed;
use crate::phase::{FootPose, GaitPhase, Manner, Swing};
use crate::relief::Relief;
use crate::task::Task;

/// Where feet and weight are in the sequence of steps.
#[derive(Debug, Clone)]
pub struct Gait {
    pub(crate) config: GaitConfig,
    pub(crate) planner: FootstepPlanner,
    /// Where each foot stands, or left.
    pub feet: [FootPose; 2],
    /// What they do.
    pub phase: GaitPhase,
    /// Steps landed so far.
    pub steps_taken: u64,
    pub(crate) listed: Listed,
    /// How the robot goes down.
    pub(crate) descent: Option<Descent>,
    last: (Side, Manner),
    /// The foot that carries while the first step of a walk is taken, where it is told.
    pub(crate) carries_first: Option<Side>,
}

impl Gait {
    /// Standing on these feet.
    pub fn new(config: &GaitConfig, planner: FootstepPlanner, feet: [FootPose; 2]) -> Self {
        Self {
            config: config.clone(),
            planner,
            feet,
            phase: GaitPhase::Standing,
            steps_taken: 0,
            listed: Listed::default(),
            descent: None,
            last: (Side::Right, Manner::Walk),
            carries_first: None,
        }
    }

    /// Whether both feet stand and no step is due.
    pub fn is_standing(&self) -> bool {
        self.phase == GaitPhase::Standing
    }

    /// Point under one of `feet` where it is to carry: the middle of what bears or, near it, `support_ahead`; towards the other foot by
    /// `support_inward`, and forward by `support_forward` where it stands higher than the other one: the knee that lifts the body bears
    /// less so.
    pub fn support_point(&self, feet: &[FootPose; 2], side: Side) -> Vector2<f64> {
        self.support_point_at(feet, side, self.config.support_inward, 0.0)
    }

    /// Point under one of `feet` where it carries that is so far towards the other foot, and as much further forward as what bears has
    /// room for.
    fn support_point_at(
        &self,
        feet: &[FootPose; 2],
        side: Side,
        inward_m: f64,
        ahead_m: f64,
    ) -> Vector2<f64> {
        let (foot, other) = (&feet[side.index()], &feet[side.other().index()]);
        let [rear, front] = foot
            .bearing
            .on_sole_m(0.5 * self.planner.sole_length_m, 0.0);
        let middle = 0.5 * (rear + front);
        let forward = self.config.support_forward * (foot.z_m - other.z_m).max(0.0);
        let inward = -side.sign() * inward_m;
        let reach = self.config.tuning.stance.support_room * (front - middle);
        let along = self
            .config
            .support_ahead
            .map_or(middle, |ahead| ahead.clamp(middle - reach, middle + reach));
        let room = reach - (along - middle);
        let (x, y) = foot
            .planar
            .apply(along + (forward + ahead_m).min(room), inward);
        Vector2::new(x, y)
    }

    /// Midway between the feet's supporting points.
    pub fn middle(&self) -> Vector2<f64> {
        let points = Side::BOTH.map(|side| self.stance_point(side));
        0.5 * (points[0] + points[1])
    }

    /// Height of the ground that carries, m.
    pub fn ground_m(&self) -> f64 {
        match &self.phase {
            GaitPhase::Single { swing, .. } => self.feet[swing.side.other().index()].z_m,
            GaitPhase::Standing | GaitPhase::Double { .. } => {
                self.feet[0].z_m.min(self.feet[1].z_m)
            }
        }
    }

    /// Whether the last step was one of a walk; so is a start.
    pub(crate) const fn walked_last(&self) -> bool {
        matches!(self.last.1, Manner::Walk)
    }

    /// Frame between two feet.
    pub fn center_of(feet: &[FootPose; 2]) -> PlanarPose {
        let [left, right] = [feet[0].planar, feet[1].planar];
        let turn = geometry::angle_between(right.yaw_rad, left.yaw_rad);
        PlanarPose::new(
            0.5 * (left.x_m + right.x_m),
            0.5 * (left.y_m + right.y_m),
            right.yaw_rad + 0.5 * turn,
        )
    }

    /// Puts the foot down at `at` and goes on to the next step.
    pub(crate) fn land(&mut self, swing: &Swing, at: FootPose, task: Task<'_>) {
        let zmp = self.zmp();
        self.feet[swing.side.index()] = at;
        self.steps_taken += 1;
        self.last = (swing.side, swing.manner);
        let next = self.next_swing(&self.feet, swing.side, task, 0);
        let duration_s = next.map_or(self.config.shift_time, |next| {
            next.manner.double_support_s(&self.config)
        }) + std::mem::take(&mut self.listed.early_s);
        self.phase = Self::shift(zmp, next, duration_s);
    }

    pub(crate) const fn shift(
        from: Vector2<f64>,
        next: Option<Swing>,
        duration_s: f64,
    ) -> GaitPhase {
        GaitPhase::Double {
            elapsed_s: 0.0,
            duration_s,
            from,
            next,
        }
    }

    /// The first step out of a stand.
    pub(crate) fn first_swing(&self, task: Task<'_>) -> Option<Swing> {
        let Task::Walk(velocity, _) = task else {
            return match task {
                Task::Steps(_) => self.next_swing(&self.feet, self.last.0, task, 0),
                _ => None,
            };
        };
        let turning = velocity.y_mps + self.config.tuning.stance.turn_counts * velocity.yaw_radps;
        let carries = self.carries_first.unwrap_or(if turning > 0.0 {
            Side::Right
        } else if turning < 0.0 {
            Side::Left
        } else {
            self.last.0
        });
        self.next_swing(&self.feet, carries, task, 0)
    }

    /// The step behind one with foot `last` after which the feet stand as in `feet`, `ahead` others of a list left out; `None`
    /// where the feet shall stay.
    pub(crate) fn next_swing(
        &self,
        feet: &[FootPose; 2],
        last: Side,
        task: Task<'_>,
        ahead: usize,
    ) -> Option<Swing> {
        let side = last.other();
        let (stance, from) = (feet[last.index()], feet[side.index()]);
        match task {
            Task::Walk(velocity, relief) => {
                let planar = self.planner.next(&stance.planar, side, &velocity);
                let to = self.on_ground(&stance, planar, relief);
                Some(Swing::new(side, Manner::Walk, from, to))
            }
            // Behind a step of a list, or one back off an edge, there may be no ground beside the other foot.
            Task::Stand(_) if self.last.1 != Manner::Walk => None,
            Task::Stand(_) if self.planner.is_beside(&stance.planar, &from.planar, side) => None,
            Task::Stand(relief) => {
                let planar = self.planner.beside(&stance.planar, side);
                let to = self.on_ground(&stance, planar, relief);
                Some(Swing::new(side, Manner::Walk, from, to))
            }
            Task::Steps(steps) => self.listed_swing(feet, steps, ahead),
        }
    }

    /// A foot at this place of the ground on which the other one stands.
    fn on_ground(&self, stance: &FootPose, planar: PlanarPose, relief: Relief<'_>) -> FootPose {
        FootPose {
            planar,
            z_m: stance.z_m + relief.rise_m(&stance.planar, &planar),
            gradient: relief.under(&planar, self.planner.sole_length_m),
            ..FootPose::default()
        }
    }

    /// The ZMP reference at the moment.
    pub fn zmp(&self) -> Vector2<f64> {
        match &self.phase {
            GaitPhase::Standing => self.middle(),
            GaitPhase::Single { swing, .. } => self.carrying_point(&self.feet, swing),
            GaitPhase::Double {
                elapsed_s,
                duration_s,
                from,
                next,
            } => {
                let share = (elapsed_s / duration_s).clamp(0.0, 1.0);
                from + (self.shift_goal(next.as_ref()) - from) * share
            }
        }
    }

    pub(crate) fn stance_point(&self, side: Side) -> Vector2<f64> {
        self.support_point(&self.feet, side)
    }

    pub(crate) fn shift_goal(&self, next: Option<&Swing>) -> Vector2<f64> {
        next.map_or_else(
            || self.middle(),
            |swing| self.carrying_point(&self.feet, swing),
        )
    }

    /// Point under the foot that stands where it carries while `swing` is under way.
    pub(crate) fn carrying_point(&self, feet: &[FootPose; 2], swing: &Swing) -> Vector2<f64> {
        let side = swing.side.other();
        if !swing.manner.is_careful() {
            return self.support_point(feet, side);
        }
        let inward_m = self
            .config
            .climb_inward
            .unwrap_or(self.config.support_inward);
        let point = self.support_point_at(feet, side, inward_m, 0.0);
        let stance = &feet[side.index()];
        let ahead_m = self
            .descent
            .map_or(0.0, |descent| descent.ahead_m(&point, stance, swing));
        if ahead_m > 0.0 {
            return self.support_point_at(feet, side, inward_m, ahead_m);
        }
        point
    }

    /// Where a foot is to be now, without what the stabiliser adds.
    pub fn foot(&self, side: Side) -> FootPose {
        match &self.phase {
            GaitPhase::Single {
                elapsed_s, swing, ..
            } if swing.side == side => swing.foot(*elapsed_s, &self.config),
            _ => self.feet[side.index()],
        }
    }
}
