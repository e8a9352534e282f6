//! The behaviours `stair_climbing` and `continuous`: walk where one can walk, climb where stairs lead on (003, section V).
//!
//! On the plan's legs that are walked the behaviour `walking` decides. Before a leg that is climbed 003's states take over:
//! align, approach, climb, finish. Decides from the [`Situation`] alone; whatever it waits for, it waits in bounded time.

mod ascent;
mod blind;
mod brink;
mod config;
mod finish;
mod flight;
mod footsteps;
mod head;
mod here;
mod inspection;
mod leg;
mod placement;
mod room;
mod run;
mod setback;
mod state;
mod states;
mod stepper;
mod walk;

#[cfg(test)]
pub(crate) mod simulation;
#[cfg(test)]
mod tests;

use geometry::PlanarPose;
use planning::{Plan, Step};
use settings::ConfigError;
use stairs::{ClimbingConfig, Feet};

use crate::{
    Arms, Behaviour, BehaviourError, Command, Decision, Motion, Outcome, Situation,
    WalkingBehaviour,
};
pub use config::StairClimbingConfig;
use flight::Flight;
use footsteps::Stance;
use head::Head;
use here::Here;
use inspection::Inspection;
use leg::Leg;
use placement::Before;
use state::State;
use stepper::Stepper;

/// How stairs are climbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// Both feet on each step, then a look (003).
    StepByStep,
    /// One foot a step without stopping, where the treads allow it.
    Continuous,
}

/// What a state is at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// Stands and looks.
    Look,
    /// Moves its feet.
    Step,
    /// Waits for something to go away.
    Wait,
}

/// How often something was tried without success.
#[derive(Debug, Clone, Copy, Default)]
struct Tries {
    /// Looks at the same step.
    looks: u32,
    /// Moves to the place from which a step is taken.
    moves: u32,
    /// Lanes that were left for another one before the first step.
    lanes: u32,
    /// Steps that were taken back.
    missteps: u32,
    /// Searches for stairs without a climb after them.
    searches: u32,
    /// Stairs that were looked at from near by.
    inspections: u32,
    /// Walks that came upon a level which was not seen.
    stumbles: u32,
}

/// Walks to the goal, and over stairs.
#[derive(Debug, Clone)]
pub struct StairClimbing {
    config: StairClimbingConfig,
    climbing: ClimbingConfig,
    feet: Feet,
    pace: Pace,
    walking: WalkingBehaviour,
    state: State,
    phase: Phase,
    state_s: f64,
    phase_s: f64,
    /// Time with sight since a step was taken or the last walk ended, s.
    idle_s: f64,
    time_ns: Option<u64>,
    frames_used: u64,
    head: Head,
    flight: Flight,
    stepper: Stepper,
    /// The stances of a climb without stops that is on its way.
    run: Vec<Stance>,
    /// Whether a climb without stops goes on step by step, after a step of it failed.
    pauses: bool,
    /// The stair that the robot stands on, once it has climbed one.
    on: Option<Step>,
    /// Where it stood before the last step.
    came_from: Option<Stance>,
    tries: Tries,
    /// Whether the walker had stumbled at the last tick.
    had_stumbled: bool,
    refusal: String,
    /// The plan for `walking`: cut off before the next climb.
    walk_plan: Option<Plan>,
    climb_ahead_s: f64,
    inspection: Option<Inspection>,
    /// Whether the look around at the start is over.
    looked_around: bool,
    /// Edges of stairs that were looked at from near by, m.
    inspected: Vec<[f64; 2]>,
}

impl StairClimbing {
    /// Refuses settings that cannot be used.
    pub fn new(
        config: StairClimbingConfig,
        walking: WalkingBehaviour,
        climbing: ClimbingConfig,
        feet: Feet,
        pace: Pace,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        settings::Table::check(&climbing)?;
        Ok(Self {
            head: Head::new(config.gaze_speed, config.gaze_steep),
            config,
            climbing,
            feet,
            pace,
            walking,
            state: State::Walk,
            phase: Phase::Look,
            state_s: 0.0,
            phase_s: 0.0,
            idle_s: 0.0,
            time_ns: None,
            frames_used: 0,
            flight: Flight::default(),
            stepper: Stepper::default(),
            run: Vec::new(),
            pauses: false,
            on: None,
            came_from: None,
            tries: Tries::default(),
            had_stumbled: false,
            refusal: String::new(),
            walk_plan: None,
            climb_ahead_s: 0.0,
            inspection: None,
            looked_around: false,
            inspected: Vec::new(),
        })
    }

    fn here<'a>(&self, situation: &'a Situation<'a>) -> Here<'a> {
        let origin = situation.estimate.map_from_robot.origin().inner;
        let yaw_rad = situation.estimate.map_from_robot.yaw_rad();
        let passed_ns = self
            .time_ns
            .map_or(0, |before_ns| situation.time_ns.saturating_sub(before_ns));
        Here {
            situation,
            pose: PlanarPose::new(origin.x, origin.y, yaw_rad),
            ground_m: origin.z,
            passed_s: passed_ns as f64 * 1e-9,
            new_frame: situation.frames_used != self.frames_used || self.time_ns.is_none(),
        }
    }

    fn keep_time(&mut self, here: &Here<'_>) {
        self.time_ns = Some(here.situation.time_ns);
        self.frames_used = here.situation.frames_used;
        self.state_s += here.passed_s;
        self.phase_s += here.passed_s;
        // Who sees nothing has a limit of its own for that.
        if self.state != State::Blind {
            self.idle_s += here.passed_s;
        }
        self.flight.wait(here.passed_s);
        if here.new_frame && self.state != State::Walk {
            let Situation { plan, stairs, .. } = *here.situation;
            self.flight
                .refresh(plan, stairs, &here.pose, &self.climbing);
        }
    }

    fn enter(&mut self, next: State) {
        debug_assert!(self.state == next || self.state.may_become(next));
        if self.state.may_become(next) {
            self.state = next;
            self.state_s = 0.0;
            self.phase(Phase::Look);
        }
    }

    const fn phase(&mut self, next: Phase) {
        self.phase = next;
        self.phase_s = 0.0;
    }

    fn refuse(&mut self, reason: String) {
        if self.state != State::Refuse {
            self.refusal = reason;
            self.enter(State::Refuse);
        }
    }

    fn before<'a>(&'a self, here: &Here<'_>) -> Before<'a> {
        Before {
            config: &self.config,
            climbing: &self.climbing,
            feet: &self.feet,
            pose: here.pose,
            ground_m: here.ground_m,
        }
    }

    /// The decision of a state of the climb.
    fn decision(&self, here: &Here<'_>, motion: Motion) -> Decision {
        let cheers = self.state == State::Finish && self.phase == Phase::Wait;
        Decision {
            command: Command {
                motion,
                gaze: self.head.gazer.at(),
                arms: if cheers { Arms::Raised } else { Arms::AtRest },
            },
            state: self.state_name(),
            goal_passed: false,
            outcome: self.outcome(here),
        }
    }

    fn outcome(&self, here: &Here<'_>) -> Option<Outcome> {
        if self.has_arrived(here) {
            return Some(Outcome::GoalReached);
        }
        let refused = self.state == State::Refuse && here.situation.standing;
        refused.then(|| Outcome::Refused(self.refusal.clone()))
    }

    const fn state_name(&self) -> &'static str {
        match (self.state, self.phase) {
            (State::Climb, Phase::Wait) => "stop",
            (state, _) => state.name(),
        }
    }
}

impl Behaviour for StairClimbing {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        let here = self.here(situation);
        self.keep_time(&here);
        let stumbles = situation.stepping.stumbled && !self.had_stumbled;
        self.had_stumbled = situation.stepping.stumbled;
        if stumbles {
            self.after_stumble(&here);
        }
        if self.state == State::Walk {
            return if situation.estimate.lost {
                self.walk_lost(&here)
            } else {
                self.walk(&here)
            };
        }
        self.interrupt(&here);
        let motion = self.act(&here);
        Ok(self.decision(&here, motion))
    }
}
