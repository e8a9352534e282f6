//! Catching a push that ankles alone cannot hold: a step at once from a stand, and of a step that is under way both place and time.
//!
//! After Khadiv et al., "Walking control based on step timing adaptation" (IEEE T-RO 36, 2020): where the divergent component of
//! motion will be when the foot lands says where the foot has to land, and a step that comes sooner has less to catch. Place and
//! time are sought over a few times, not by a quadratic programme: there is one number to choose. Nothing here acts on a robot that
//! is not pushed.

use geometry::PlanarPose;
use nalgebra::{Vector2, Vector3};
use robot::Side;

use crate::config::GaitConfig;
use crate::footsteps::FootstepPlanner;
use crate::gait::Gait;
use crate::phase::{FootPose, GaitPhase, Manner, Swing};
use crate::support::Soles;
use crate::task::Task;

/// Steps that catch a push.
#[derive(Debug, Clone)]
pub(crate) struct Catching {
    config: GaitConfig,
    planner: FootstepPlanner,
    state: Watch,
    held_s: f64,
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

/// What a tick knows of the balance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Falling<'a> {
    /// The measured divergent component of motion, m.
    pub(crate) dcm: Vector2<f64>,
    /// Its reference, m.
    pub(crate) reference: Vector2<f64>,
    /// Natural frequency of the pendulum, 1/s.
    pub(crate) omega: f64,
    /// Where soles push.
    pub(crate) soles: &'a Soles,
    /// What the legs have to do.
    pub(crate) task: Task<'a>,
    /// Loads on the feet, N.
    pub(crate) loads_n: [f64; 2],
    /// Where the soles are, m.
    pub(crate) soles_m: [Vector3<f64>; 2],
    /// Time since the last tick, s.
    pub(crate) passed_s: f64,
}

/// A step as it may be taken.
#[derive(Debug, Clone, Copy)]
struct Catch {
    /// Where the foot lands.
    to: PlanarPose,
    /// Time until then, s.
    left_s: f64,
    /// How far the step misses what it had to catch, and what it takes, m.
    cost_m: f64,
    /// How far over the outer edge of the sole that stands the robot falls whenever it lands, m.
    outwards_m: f64,
}

impl Catching {
    /// For this gait.
    pub(crate) fn new(config: &GaitConfig, planner: FootstepPlanner) -> Self {
        Self {
            config: config.clone(),
            planner,
            state: Watch::Settling(0.0),
            held_s: 0.0,
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
            return None;
        }
        match gait.phase {
            GaitPhase::Standing | GaitPhase::Double { .. } => Some(self.on_both(gait, falling)),
            GaitPhase::Single {
                elapsed_s,
                duration_s,
                swing,
            } => {
                Some(self.on_one(gait, falling, swing, elapsed_s, duration_s))
            }
        }
    }

    /// Tells whether the robot is pushed.
    fn look(&mut self, gait: &Gait, falling: &Falling<'_>) {
        let tuning = &self.config.tuning.catching;
        let error_m = (falling.dcm - falling.reference).norm();
        let leg_m = self.planner.leg_m;
        let calm_s = |before_s: f64| {
            if error_m > tuning.ends * leg_m {
                0.0
            } else {
                before_s + falling.passed_s
            }
        };
        self.state = match self.state {
            _ if !gait.may_catch() => Watch::Settling(0.0),
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
        if (falling.dcm - held).norm() <= tuning.outside * self.planner.half_sole_m().x {
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
            let catch = self.best(&trial, falling, &swing, in_air_s);
            (trial, swing, catch)
        });
        let [left, right] = steps;
        let (trial, mut swing, catch) = if left.2.cost_m <= right.2.cost_m {
            left
        } else {
            right
        };
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
        let catch = self.best(gait, falling, &swing, left_s);
        if catch.outwards_m > 0.0 && self.held_s <= self.config.capture_patience {
            return self.counterweigh(gait, falling, swing, elapsed_s / duration_s);
        }
        if let GaitPhase::Single { swing, .. } = &mut gait.phase
            && elapsed_s < tuning.committed * duration_s
        {
            self.move_landing(swing, &catch.to, falling);
        }
        left_s / catch.left_s
    }

    /// The robot falls over the outer edge of the sole that stands, where no step helps: the foot in the air goes out to the other side
    /// and waits there. What it takes of the robot's momentum, the body is given back.
    fn counterweigh(
        &mut self,
        gait: &mut Gait,
        falling: &Falling<'_>,
        mut swing: Swing,
        share: f64,
    ) -> f64 {
        let tuning = &self.config.tuning.catching;
        let stance = gait.feet[swing.side.other().index()].planar;
        let mut out = stance.relative(&swing.planned.planar);
        out.y_m = swing.side.sign() * (self.config.stance_width + self.planner.leg_m);
        let out = self.planner.within_catch(&stance, &stance.compose(&out), swing.side);
        self.move_landing(&mut swing, &out, falling);
        if let GaitPhase::Single { swing: moved, .. } = &mut gait.phase {
            *moved = swing;
        }
        if share < tuning.out_share {
            return 1.0;
        }
        self.held_s += falling.passed_s;
        0.0
    }

    fn move_landing(&self, swing: &mut Swing, goal: &PlanarPose, falling: &Falling<'_>) {
        let most = self.speed_mps(falling, self.config.tuning.catching.speed) * falling.passed_s;
        let to = &mut swing.to.planar;
        to.x_m += (goal.x_m - to.x_m).clamp(-most, most);
        to.y_m += (goal.y_m - to.y_m).clamp(-most, most);
    }

    /// A speed of so many heights of the hips for each time constant of the pendulum.
    fn speed_mps(&self, falling: &Falling<'_>, speed: f64) -> f64 {
        speed * falling.omega * self.planner.leg_m
    }

    /// The best place and time for a foot to land that has `left_s` to go by its clock.
    fn best(&self, gait: &Gait, falling: &Falling<'_>, swing: &Swing, left_s: f64) -> Catch {
        let tuning = &self.config.tuning.catching;
        let stance = swing.side.other();
        let foot = &gait.feet[stance.index()];
        let middle = gait.stance_point(stance);
        let reference = gait.reference(falling.omega, falling.task).dcm;
        let grown = libm::exp(falling.omega * left_s);
        let landed = middle + (reference - middle) * grown;
        let to = Vector2::new(swing.to.planar.x_m, swing.to.planar.y_m);
        let planned = Vector2::new(swing.planned.planar.x_m, swing.planned.planar.y_m);
        let ahead = landed - to;
        let (soonest_s, latest_s) = (left_s / tuning.hurry, left_s + tuning.wait / falling.omega);
        let times = tuning.times.max(2);
        let here = falling.soles_m[swing.side.index()].xy();
        let stride_mps = self.speed_mps(falling, tuning.stride);
        let (nearest_m, _) = self.planner.lateral_limits_m(0.0);
        let mut best: Option<Catch> = None;
        let mut outwards_m = f64::INFINITY;
        for index in 0..times {
            let share = index as f64 / (times - 1) as f64;
            let time_s = soonest_s + (latest_s - soonest_s) * share;
            let growth = libm::exp(falling.omega * time_s);
            let wanted = (falling.dcm * growth - planned - ahead) / (growth - 1.0).max(1e-3);
            let zmp = falling.soles.nearest(foot, stance, &wanted);
            let goal = zmp + (falling.dcm - zmp) * growth - ahead;
            let across_m = foot.planar.inverse().apply(goal.x, goal.y).1 * swing.side.sign();
            outwards_m = outwards_m.min(nearest_m - tuning.out * self.planner.leg_m - across_m);
            let place = PlanarPose::new(goal.x, goal.y, swing.planned.planar.yaw_rad);
            let mut place = self.planner.within_catch(&foot.planar, &place, swing.side);
            let way = Vector2::new(place.x_m, place.y_m) - here;
            let short = (stride_mps * time_s / way.norm().max(1e-9)).min(1.0);
            (place.x_m, place.y_m) = (here.x + way.x * short, here.y + way.y * short);
            let missed_m = (goal - Vector2::new(place.x_m, place.y_m)).norm();
            let moved_m = place.distance_m(&swing.planned.planar);
            let shifted_m = (time_s - left_s).abs() * falling.omega * self.planner.half_sole_m().x;
            let cost_m = missed_m + tuning.moving * moved_m + tuning.shifting * shifted_m;
            if best.is_none_or(|best| cost_m < best.cost_m) {
                best = Some(Catch {
                    to: place,
                    left_s: time_s,
                    cost_m,
                    outwards_m: 0.0,
                });
            }
        }
        let none = Catch {
            to: swing.to.planar,
            left_s,
            cost_m: f64::INFINITY,
            outwards_m,
        };
        best.map_or(none, |best| Catch { outwards_m, ..best })
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
