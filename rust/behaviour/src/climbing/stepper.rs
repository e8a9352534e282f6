//! Gives a list of footsteps to the walker until it stands again.

use geometry::PlanarPose;
use robot::Side;

use crate::{Footstep, Misstep, Motion, Situation, climbing::tuning::StepperTuning};

/// How the list goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stepped {
    /// There is no list.
    Idle,
    /// On it.
    Running,
    /// All of it landed, and the robot stands.
    Done,
    /// The list was given up, and the robot stands: so many had landed.
    Missed(Misstep, usize),
    /// The walker did not end it in time.
    Stuck,
}

/// Why the robot gives up at once after such a misstep; `None` where another step may do.
pub(crate) fn given_up(misstep: Misstep) -> Option<String> {
    let Misstep::Buckled(side) = misstep else {
        return None;
    };
    let leg = match side {
        Side::Left => "left",
        Side::Right => "right",
    };
    Some(format!(
        "sensor: the {leg} leg does not bear the robot: it buckled at a step, its joints did not get where they were told"
    ))
}

/// One list at a time.
#[derive(Debug, Clone, Default)]
pub(crate) struct Stepper {
    tuning: StepperTuning,
    /// The places of the list.
    pub(crate) holds: Vec<Footstep>,
    footsteps: Vec<Footstep>,
    list_from_map: PlanarPose,
    ground_m: f64,
    announced: bool,
    set_off: bool,
    elapsed_s: f64,
}

impl Stepper {
    /// No list is on its way.
    pub(crate) fn new(tuning: StepperTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Whether a list is on its way.
    pub(crate) const fn is_running(&self) -> bool {
        !self.footsteps.is_empty()
    }

    /// Whether the walker has taken the list up.
    pub(crate) const fn has_begun(&self) -> bool {
        self.announced && self.set_off
    }

    /// Begins a list; the robot stands at `pose` on ground of this height.
    pub(crate) fn start(&mut self, holds: Vec<Footstep>, pose: &PlanarPose, ground_m: f64) {
        self.list_from_map = pose.inverse();
        self.ground_m = ground_m;
        self.announced = false;
        self.set_off = false;
        self.elapsed_s = 0.0;
        self.replace(holds);
    }

    /// Changes places of the list that no foot is on its way to.
    pub(crate) fn replace(&mut self, holds: Vec<Footstep>) {
        self.footsteps.clear();
        self.footsteps.extend(holds.iter().map(|hold| Footstep {
            pose: self.list_from_map.compose(&hold.pose),
            height_m: hold.height_m - self.ground_m,
            ..*hold
        }));
        self.holds = holds;
    }

    /// One tick. Anything but `Running` ends the list.
    pub(crate) fn advance(&mut self, situation: &Situation<'_>, passed_s: f64) -> Stepped {
        if !self.is_running() {
            return Stepped::Idle;
        }
        self.elapsed_s += passed_s;
        self.set_off |= !situation.standing;
        let ended = self.ended(situation);
        if ended != Stepped::Running {
            self.footsteps.clear();
        }
        ended
    }

    fn ended(&self, situation: &Situation<'_>) -> Stepped {
        let stepping = &situation.stepping;
        let limit_s = self.tuning.patience * (1.0 + self.footsteps.len() as f64);
        if self.set_off && situation.standing {
            return match stepping.misstep {
                Some(misstep) => Stepped::Missed(misstep, stepping.landed),
                None => Stepped::Done,
            };
        }
        if self.elapsed_s > limit_s {
            Stepped::Stuck
        } else {
            Stepped::Running
        }
    }

    /// What the walker is told: a list begins with a tick of standing, which ends the list before.
    pub(crate) fn motion(&mut self) -> Motion {
        if self.is_running() && std::mem::replace(&mut self.announced, true) {
            Motion::Footsteps(self.footsteps.clone())
        } else {
            Motion::Stand
        }
    }
}
