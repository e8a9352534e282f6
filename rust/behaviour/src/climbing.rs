//! The behaviours `stair_climbing` and `continuous`: walk where one can walk, climb where stairs lead on (003, section V).
//!
//! On the plan's legs that are walked the behaviour `walking` decides. Before a leg that is climbed 003's states take over:
//! align, approach, climb, finish. Decides from the [`Situation`] alone; whatever it waits for, it waits in bounded time.

mod align;
mod approach;
mod blind;
mod clearance;
mod climb;
mod config;
mod continuous;
mod drop_off;
mod edges;
mod finish;
mod flight;
mod footsteps;
mod goal;
pub(crate) mod head;
mod inspection;
mod leg;
mod memory;
mod next_step;
mod placement;
mod search;
mod setback;
mod state;
pub(crate) mod stepper;
mod tuning;
mod walk;

#[cfg(test)]
mod laws;
#[cfg(test)]
pub(crate) mod simulation;
#[cfg(test)]
mod tests;

use settings::{ConfigError, MakeError, Part, Table, TableDescription, read};
use stairs::{ClimbingConfig, Feet};
use terrain::support::stood_on_m;

use crate::machine::{Interruption, Machine, State as _, Tick};
use crate::part::{BehaviourNeeds, BehaviourPart};
use crate::{
    Arms, Behaviour, BehaviourError, Command, Decision, Motion, Outcome, Situation,
    WalkingBehaviour, WalkingConfig,
};
pub use config::StairClimbingConfig;
use flight::{Flight, StepRules};
use head::ClimbingHead;
use leg::ApproachLeg;
use memory::Memory;
use placement::Before;
use state::Finish;
pub(crate) use state::State;
use stepper::Stepper;
use walk::ClimbAhead;

/// How `stair_climbing` is listed and made.
pub(crate) const STEP_BY_STEP: BehaviourPart = Part {
    name: "stair_climbing",
    about: "walks where it can, climbs where stairs lead on, both feet on each step",
    source: Some("003, section V"),
    tables: &[
        TableDescription::of::<StairClimbingConfig>(),
        TableDescription::of::<WalkingConfig>(),
    ],
    make: |needs| {
        Ok(Box::new(StairClimbing::of(
            needs,
            "stair_climbing",
            Pace::StepByStep,
        )?))
    },
};

/// The table of the behaviour `continuous`.
const CONTINUOUS_KEY: &str = "navigation.continuous";

/// How `continuous` is listed and made.
pub(crate) const CONTINUOUS: BehaviourPart = Part {
    name: "continuous",
    about: "climbs one foot a step without stopping where the treads allow it",
    source: Some("003, section VIII, left to the future there"),
    tables: &[
        TableDescription::at::<StairClimbingConfig>(CONTINUOUS_KEY),
        TableDescription::of::<WalkingConfig>(),
    ],
    make: |needs| {
        Ok(Box::new(StairClimbing::of(
            needs,
            "continuous",
            Pace::Continuous,
        )?))
    },
};

/// How stairs are climbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pace {
    /// Both feet on each step, then a look (003).
    StepByStep,
    /// One foot a step without stopping, where the treads allow it.
    Continuous,
}

impl Pace {
    /// The table in which the settings of the behaviour stand that climbs so.
    const fn key(self) -> &'static str {
        match self {
            Self::StepByStep => StairClimbingConfig::KEY,
            Self::Continuous => CONTINUOUS_KEY,
        }
    }
}

/// Walks to the goal, and over stairs.
#[derive(Debug, Clone)]
pub struct StairClimbing {
    config: StairClimbingConfig,
    climbing: ClimbingConfig,
    feet: Feet,
    pace: Pace,
    walking: WalkingBehaviour,
    machine: Machine<State>,
    head: ClimbingHead,
    flight: Flight,
    stepper: Stepper,
    memory: Memory,
    ahead: ClimbAhead,
    /// Whether the walker had stumbled at the last tick.
    had_stumbled: bool,
    /// Whether a foot of the walk has met something since stairs were looked for.
    touched: bool,
}

impl StairClimbing {
    /// The behaviour that the table `[navigation.<name>]`, and those of walking and climbing, describe.
    pub(crate) fn of(
        needs: &BehaviourNeeds<'_>,
        name: &str,
        pace: Pace,
    ) -> Result<Self, MakeError> {
        let walking = WalkingBehaviour::of(needs)?;
        let (config, climbing) = (read(needs.tables, name)?, read(needs.tables, "climbing")?);
        let eyes = &needs.body.description().head;
        Ok(Self::new(
            config, walking, climbing, needs.feet, eyes, pace,
        )?)
    }

    /// Refuses settings that cannot be used.
    pub fn new(
        config: StairClimbingConfig,
        walking: WalkingBehaviour,
        climbing: ClimbingConfig,
        feet: Feet,
        eyes: &robot::Head,
        pace: Pace,
    ) -> Result<Self, ConfigError> {
        config.check_as(pace.key())?;
        climbing.check()?;
        let tuning = &config.tuning;
        let limits = (walking.config()).limits("no step could be taken", ", before or on stairs");
        Ok(Self {
            head: ClimbingHead::new(&config, walking.config(), eyes),
            machine: Machine::new(State::Walk, limits),
            flight: Flight::new(tuning, &climbing.levels),
            stepper: Stepper::new(tuning.stepper.clone()),
            config,
            climbing,
            feet,
            pace,
            walking,
            memory: Memory::default(),
            ahead: ClimbAhead::default(),
            had_stumbled: false,
            touched: false,
        })
    }

    fn keep_time(&mut self, tick: &Tick<'_>) {
        self.machine.keep_time(tick);
        self.flight.wait(tick.passed_s);
        if tick.new_frame && !self.is_walking() {
            let Situation { plan, stairs, .. } = *tick.situation;
            self.flight
                .refresh(plan, stairs, &tick.pose, &self.climbing);
        }
    }

    /// The tick of a robot that has climbed: its height is that of the stair that it stands on.
    fn on_known_stair<'a>(&self, tick: Tick<'a>) -> Tick<'a> {
        if self.memory.on.is_none() {
            return tick;
        }
        let (stairs, at_m) = (tick.situation.stairs, [tick.pose.x_m, tick.pose.y_m]);
        let told_m = self.climbing.levels.told;
        let ground_m = stood_on_m(stairs, at_m, tick.ground_m, told_m);
        Tick { ground_m, ..tick }
    }

    const fn is_walking(&self) -> bool {
        matches!(self.machine.state(), State::Walk)
    }

    fn enter(&mut self, next: State) {
        let _ = self.machine.enter(next);
    }

    fn refuse(&mut self, reason: String) {
        self.enter(State::refuse(reason));
    }

    /// Ends a state of the climb if something happened that must, while no foot is on its way.
    fn interrupt(&mut self, tick: &Tick<'_>) {
        if self.stepper.is_running() {
            return;
        }
        match self.machine.interruption(tick, || false) {
            None | Some(Interruption::Stumble | Interruption::Arrival) => {}
            Some(Interruption::Lost | Interruption::Blind) => {
                self.enter(State::Blind { looks: false });
            }
            Some(Interruption::Idle(reason)) => self.refuse(reason),
        }
    }

    /// One tick of a state of the climb.
    fn act(&mut self, tick: &Tick<'_>) -> Motion {
        match self.machine.state() {
            State::Walk | State::Refuse { .. } => Motion::Stand,
            State::Search => self.search(tick),
            State::Align => self.align(tick),
            State::Approach(approach) => self.approach(tick, *approach),
            State::Climb(_) => self.climb(tick),
            State::StepBack { .. } => self.step_back(tick),
            State::Finish { part, lasted_s } => self.finish(tick, *part, *lasted_s),
            State::Blind { looks } => self.wait_for_sight(tick, *looks),
        }
    }

    /// By what steps are found among the stairs.
    const fn rules(&self) -> StepRules<'_> {
        StepRules {
            climbing: &self.climbing,
            lookup: self.flight.lookup(),
        }
    }

    fn before<'a>(&'a self, tick: &Tick<'_>) -> Before<'a> {
        Before {
            config: &self.config,
            climbing: &self.climbing,
            feet: &self.feet,
            pose: tick.pose,
            ground_m: tick.ground_m,
        }
    }

    /// The decision of a state of the climb.
    fn decision(&self, tick: &Tick<'_>, motion: Motion) -> Decision {
        let state = self.machine.state();
        let cheers = matches!(
            state,
            State::Finish {
                part: Finish::Cheer,
                ..
            }
        );
        Decision {
            command: Command {
                motion,
                gaze: self.head.gazer.at,
                arms: if cheers { Arms::Raised } else { Arms::AtRest },
                ..Command::default()
            },
            state: state.name(),
            goal_passed: false,
            outcome: self.outcome(tick),
        }
    }

    fn outcome(&self, tick: &Tick<'_>) -> Option<Outcome> {
        if self.has_arrived(tick) {
            return Some(Outcome::GoalReached);
        }
        self.machine.refusal(tick.situation.standing)
    }
}

impl Behaviour for StairClimbing {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        let tick = self.on_known_stair(self.machine.read(situation));
        self.keep_time(&tick);
        let stumbles = situation.stepping.stumbled && !self.had_stumbled;
        self.had_stumbled = situation.stepping.stumbled;
        if stumbles {
            self.after_stumble(&tick);
        }
        if self.is_walking() {
            return if situation.estimate.lost {
                self.walk_lost(&tick)
            } else if self.has_stepped_off(situation) {
                self.after_stepping_off(&tick);
                Ok(self.decision(&tick, Motion::Stand))
            } else {
                self.walk(&tick)
            };
        }
        self.interrupt(&tick);
        let motion = self.act(&tick);
        Ok(self.decision(&tick, motion))
    }
}
