//! Catching a push that ankles alone cannot hold: a step at once from a stand, and of a step that is under way both place and time.
//!
//! Nothing here acts on a robot that is not pushed and does not stumble: the divergent component of motion has to be farther off its
//! reference, and for longer, than a walk or a landing ever puts it, or farther over the outer edge of the foot that stands. Where and
//! when a foot lands, [`crate::landing_search`] says.

use robot::Side;

use crate::config::GaitConfig;
use crate::footsteps::FootstepPlanner;
use crate::gait::Gait;
use crate::landing_search::{Falling, LandingSearch};
use crate::phase::{FootPose, GaitPhase, Manner, Swing};
use crate::task::Task;

mod counterweight;

/// Steps that catch a push.
#[derive(Debug, Clone)]
pub(crate) struct Catching {
    config: GaitConfig,
    search: LandingSearch,
    state: Watch,
    held_s: f64,
    /// How far the torso is told to roll to its right, rad: what it gains of the robot's turning, the fall loses.
    roll_rad: f64,
    /// What share of all that a counterweight can do it does: of the foot in the air and the torso.
    weighs: f64,
    /// The foot over whose outer edge the robot falls.
    outer: Side,
    /// How far out the foot has gone as a counterweight, m.
    out_m: f64,
}

/// What is known of pushes, and for how long, s, the robot has been near its reference.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Watch {
    /// The robot has not stood or walked quietly yet.
    Settling(f64),
    /// It does; the time for which it has been off its reference all the same.
    Ready(f64),
    /// A push is being caught.
    Pushed(f64),
}

impl Catching {
    /// For this gait.
    pub(crate) fn new(config: &GaitConfig, planner: FootstepPlanner) -> Self {
        Self {
            config: config.clone(),
            search: LandingSearch::new(config, planner),
            state: Watch::Settling(0.0),
            held_s: 0.0,
            roll_rad: 0.0,
            weighs: 0.0,
            outer: Side::Left,
            out_m: 0.0,
        }
    }

    /// Whether a push is being caught.
    pub(crate) const fn is_active(&self) -> bool {
        matches!(self.state, Watch::Pushed(_))
    }

    /// Steps where the robot falls; returns how fast the clock of the steps is to run, or `None` where no push is to be caught.
    pub(crate) fn step(&mut self, gait: &mut Gait, falling: &Falling<'_>) -> Option<f64> {
        self.look(gait, falling);
        if !self.is_active() {
            (self.weighs, self.out_m) = (0.0, 0.0);
        }
        let rate = self.is_active().then(|| self.caught(gait, falling));
        self.roll(falling);
        rate
    }

    fn caught(&mut self, gait: &mut Gait, falling: &Falling<'_>) -> f64 {
        match gait.phase {
            GaitPhase::Standing | GaitPhase::Double { .. } => self.on_both(gait, falling),
            GaitPhase::Single {
                elapsed_s,
                duration_s,
                swing,
            } => self.on_one(gait, falling, swing, elapsed_s, duration_s),
        }
    }

    /// Tells whether the robot is pushed.
    fn look(&mut self, gait: &Gait, falling: &Falling<'_>) {
        let tuning = &self.config.tuning.catching;
        let error_m = (falling.dcm - falling.reference).norm();
        let leg_m = self.search.planner.leg_m;
        let calm_s = |before_s: f64| {
            if error_m > tuning.ends * leg_m {
                0.0
            } else {
                before_s + falling.passed_s
            }
        };
        self.state = match self.state {
            _ if !gait.may_catch() => Watch::Settling(0.0),
            Watch::Ready(_) if falling.carried < tuning.carried => Watch::Ready(0.0),
            Watch::Ready(_) if self.outwards(gait, &falling.dcm).1 > tuning.tips => {
                Watch::Pushed(0.0)
            }
            Watch::Ready(off_s) if error_m > tuning.begins * leg_m => {
                let off_s = off_s + falling.passed_s;
                if off_s > tuning.sure_time {
                    Watch::Pushed(0.0)
                } else {
                    Watch::Ready(off_s)
                }
            }
            Watch::Ready(_) => Watch::Ready(0.0),
            Watch::Settling(before_s) | Watch::Pushed(before_s)
                if calm_s(before_s) >= tuning.calm_time =>
            {
                Watch::Ready(0.0)
            }
            Watch::Settling(before_s) => Watch::Settling(calm_s(before_s)),
            Watch::Pushed(before_s) => Watch::Pushed(calm_s(before_s)),
        };
        if !self.is_active() {
            self.held_s = 0.0;
        }
    }

    /// While both feet stand: waits as long as they hold the robot, and lifts one of them when they do not.
    fn on_both(&mut self, gait: &mut Gait, falling: &Falling<'_>) -> f64 {
        self.out_m = 0.0;
        (self.outer, self.weighs) = self.weighing(gait, falling);
        let tuning = &self.config.tuning.catching;
        let carry = Side::BOTH.map(|side| gait.stance_point(side));
        let lands = match gait.phase {
            GaitPhase::Double { elapsed_s, .. } => elapsed_s < tuning.settle,
            GaitPhase::Standing | GaitPhase::Single { .. } => false,
        };
        if lands {
            return 1.0;
        }
        let held = falling.soles.on_both(&gait.feet, &carry, &falling.dcm).zmp;
        let outside_m = tuning.outside * self.search.planner.half_sole_m().x;
        if self.weighs == 0.0 && (falling.dcm - held).norm() <= outside_m {
            if self.held_s > self.config.capture_patience || gait.is_standing() {
                return 1.0;
            }
            self.held_s += falling.passed_s;
            return 0.0;
        }
        let steps = Side::BOTH.map(|side| {
            let mut trial = gait.clone();
            let swing = trial.step_in_place(side, falling.task);
            let in_air_s = swing.in_air_s(&self.config);
            let catch = self.search.best(&trial, falling, &swing, in_air_s);
            (trial, swing, catch)
        });
        let [left, right] = steps;
        let lifts_left = if self.weighs > 0.0 {
            self.outer == Side::Right
        } else {
            left.2.cost_m <= right.2.cost_m
        };
        let (trial, mut swing, catch) = if lifts_left { left } else { right };
        *gait = trial;
        swing.to.planar = catch.to;
        let duration_s = swing.single_support_s(&self.config);
        gait.phase = GaitPhase::Single {
            elapsed_s: 0.0,
            duration_s,
            swing,
        };
        duration_s / catch.left_s
    }

    /// While a foot is on its way: moves where and when it lands.
    fn on_one(
        &mut self,
        gait: &mut Gait,
        falling: &Falling<'_>,
        swing: Swing,
        elapsed_s: f64,
        duration_s: f64,
    ) -> f64 {
        let tuning = &self.config.tuning.catching;
        let left_s = duration_s - elapsed_s;
        if left_s <= falling.passed_s {
            return 1.0;
        }
        let index = swing.side.index();
        if falling.loads_n[index] > self.config.landing_load
            && elapsed_s > tuning.lands * duration_s
        {
            if let GaitPhase::Single { swing, .. } = &mut gait.phase {
                let at = falling.soles_m[index];
                (swing.to.planar.x_m, swing.to.planar.y_m) = (at.x, at.y);
            }
            return left_s / falling.passed_s;
        }
        let catch = self.search.best(gait, falling, &swing, left_s);
        let (outer, due) = self.weighing(gait, falling);
        self.outer = outer;
        let goes_on = self.weighs > 0.0
            && self.outwards(gait, &falling.com).1 < self.outwards(gait, &falling.dcm).1;
        let weighs = if catch.outwards_m > 0.0 {
            1.0
        } else if goes_on {
            due.max(self.weighs)
        } else {
            due
        };
        if weighs > 0.0 && self.held_s <= self.config.capture_patience {
            self.weighs = self.weighs.max(weighs);
            return self.counterweigh(gait, falling, swing, [elapsed_s, duration_s]);
        }
        (self.weighs, self.out_m) = (0.0, 0.0);
        if let GaitPhase::Single { swing, .. } = &mut gait.phase
            && elapsed_s < tuning.committed * duration_s
        {
            let to = FootPose {
                planar: catch.to,
                ..swing.planned
            };
            self.move_landing(swing, &to, falling);
        }
        left_s / catch.left_s
    }

    fn move_landing(&self, swing: &mut Swing, goal: &FootPose, falling: &Falling<'_>) {
        let most = self
            .search
            .speed_mps(falling, self.config.tuning.catching.speed)
            * falling.passed_s;
        swing.to.z_m += (goal.z_m - swing.to.z_m).clamp(-most, most);
        let (to, goal) = (&mut swing.to.planar, &goal.planar);
        to.x_m += (goal.x_m - to.x_m).clamp(-most, most);
        to.y_m += (goal.y_m - to.y_m).clamp(-most, most);
    }
}

impl Gait {
    /// Whether a step may be taken that nobody asked for: not on steps of a list, beside which there may be an edge.
    fn may_catch(&self) -> bool {
        let level_m = (self.feet[0].z_m - self.feet[1].z_m).abs();
        match &self.phase {
            GaitPhase::Single { swing, .. }
            | GaitPhase::Double {
                next: Some(swing), ..
            } => swing.manner == Manner::Walk,
            GaitPhase::Standing | GaitPhase::Double { next: None, .. } => {
                self.walked_last() && level_m < self.config.tuning.listed.level
            }
        }
    }

    /// Begins a step of this foot that lands where the task wants it next, or beside the other one.
    fn step_in_place(&mut self, side: Side, task: Task<'_>) -> Swing {
        let from = self.feet[side.index()];
        let stance = self.feet[side.other().index()];
        let swing = match task {
            Task::Walk(..) => self.next_swing(&self.feet, side.other(), task, 0),
            Task::Stand(_) | Task::Steps(_) => None,
        };
        let swing = swing.unwrap_or_else(|| {
            let planar = self.planner.beside(&stance.planar, side);
            Swing::new(side, Manner::Walk, from, FootPose { planar, ..stance })
        });
        self.phase = GaitPhase::Single {
            elapsed_s: 0.0,
            duration_s: swing.single_support_s(&self.config),
            swing,
        };
        swing
    }
}

#[cfg(test)]
#[path = "catching_tests.rs"]
mod tests;
