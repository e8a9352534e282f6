//! The behaviour `walking`: look around, follow the path, stop, find another way, arrive or refuse.
//!
//! Decides from the [`Situation`] alone; its only clock is `time_ns`. Whatever it waits for, it waits in bounded time.

mod arrival;
mod blind;
mod config;
mod dead_ends;
pub(crate) mod gaze;
mod handover;
mod locate;
mod look_around;
mod obstacles;
pub(crate) mod overhead;
mod progress;
mod room_beside;
mod side_leg;
mod sidle;
mod state;
mod step_off;
mod stop;
mod tick;
mod track;
pub(crate) mod tuning;
mod turn;
mod unknown;
mod walk;

#[cfg(test)]
pub(crate) mod simulation;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod touch_tests;

use mapping::FeltPlace;
use planning::Goal;
use robot::Extent;
use settings::{ConfigError, MakeError, Part, Table, TableDescription, read};
use stairs::{ClimbingConfig, LevelsConfig};

use crate::machine::{Interruption, Machine, State as _, Stopwatch};
use crate::part::{BehaviourNeeds, BehaviourPart};
use crate::things_met::ThingsMet;
use crate::{Behaviour, BehaviourError, Command, Decision, Motion, Situation};
use blind::{CameBy, Tried};
pub use config::WalkingConfig;
use dead_ends::DeadEnds;
use gaze::{Gazer, Sweep};
use obstacles::Followed;
use overhead::Eyes;
use progress::Progress;
pub(crate) use state::State;
use tick::WayTick;
use track::Track;
use unknown::Looked;

/// How it is listed and made.
pub(crate) const PART: BehaviourPart = Part {
    name: "walking",
    about: "walks the path, looks around, stops for what appears, refuses where no way is",
    source: None,
    tables: &[TableDescription::of::<WalkingConfig>()],
    make: |needs| Ok(Box::new(WalkingBehaviour::of(needs)?)),
};

/// Walks to the goal by what the robot sees.
#[derive(Debug, Clone)]
pub struct WalkingBehaviour {
    config: WalkingConfig,
    /// Half the distance between the outer edges of the feet, as far as the ground matters to them, m.
    foot_side_m: f64,
    /// Radius of the upright cylinder that holds the robot, m.
    radius_m: f64,
    levels: LevelsConfig,
    machine: Machine<State>,
    /// How long the robot stands.
    standing: Stopwatch,
    /// How long the planner finds no way.
    no_way: Stopwatch,
    /// How long there is a way.
    way: Stopwatch,
    /// How long there is no plan.
    no_plan: Stopwatch,
    goal: Option<Goal>,
    gazer: Gazer,
    looked: Looked,
    /// Where the eyes are, and where they looked up; without eyes nothing is looked up at.
    eyes: Option<Eyes>,
    looked_up: Looked,
    followed: Followed,
    progress: Progress,
    dead_ends: DeadEnds,
    /// What was tried against seeing nothing since the robot last walked.
    tried: Tried,
    came_by: CameBy,
    /// How often the pictures went dark while it walked.
    darks: u32,
    /// Directions looked at in vain, one after the other.
    looks: u32,
    /// The place at which something stood on the way when the robot last stopped for that.
    watched_m: Option<[f64; 2]>,
    touches: ThingsMet,
    /// What a foot has met, until the robot has stopped for it.
    met: Option<FeltPlace>,
    /// Time since the start at which the look around of the state `locate` was over, s.
    looked_round_s: Option<f64>,
    motion: Motion,
}

impl WalkingBehaviour {
    /// The behaviour that `[navigation.walking]` describes.
    pub(crate) fn of(needs: &BehaviourNeeds<'_>) -> Result<Self, MakeError> {
        let size = &needs.body.description().body;
        let climbing: ClimbingConfig = read(needs.tables, "climbing")?;
        let walking = Self::new(read(needs.tables, "walking")?, climbing.levels, size)?;
        Ok(walking.with_eyes(Eyes::of(needs.body.description())))
    }

    /// Refuses settings that cannot be used.
    pub fn new(
        config: WalkingConfig,
        levels: LevelsConfig,
        size: &Extent,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        levels.check()?;
        let limits = config.limits("no step towards the goal could be taken", "");
        Ok(Self {
            machine: Machine::new(State::LookAround(Sweep::around(&config, None)), limits),
            config,
            foot_side_m: size.foot_side,
            radius_m: size.radius,
            levels,
            standing: Stopwatch::default(),
            no_way: Stopwatch::default(),
            way: Stopwatch::default(),
            no_plan: Stopwatch::default(),
            goal: None,
            gazer: Gazer::default(),
            looked: Looked::default(),
            eyes: None,
            looked_up: Looked::default(),
            followed: Followed::default(),
            progress: Progress::default(),
            dead_ends: DeadEnds::default(),
            tried: Tried::default(),
            came_by: CameBy::default(),
            darks: 0,
            looks: 0,
            watched_m: None,
            touches: ThingsMet::default(),
            met: None,
            looked_round_s: None,
            motion: Motion::Stand,
        })
    }

    fn tick<'a>(&self, situation: &'a Situation<'a>) -> WayTick<'a> {
        let tick = self.machine.read(situation);
        let path = situation.plan.and_then(|plan| plan.way.as_ref().ok());
        let track = path.and_then(|path| {
            let track = Track::new(path, &tick.pose, &self.config)?;
            let straight = path.sidles.is_empty();
            let lengthened = |track| self.lengthened(track, &tick);
            Some((path, if straight { lengthened(track) } else { track }))
        });
        WayTick { tick, track }
    }

    fn keep_time(&mut self, tick: &WayTick<'_>) {
        let situation = tick.situation;
        if !self.machine.has_begun() {
            self.gazer.start(situation.gaze);
        }
        self.machine.keep_time(tick);
        let passed_s = tick.passed_s;
        self.standing.count(situation.standing, passed_s);
        self.no_way.count(tick.finds_no_way(), passed_s);
        self.way.count(tick.track.is_some(), passed_s);
        self.no_plan.count(situation.plan.is_none(), passed_s);
        if self.goal != Some(*situation.goal) {
            self.goal = Some(*situation.goal);
            self.progress = Progress::default();
            self.dead_ends.forget();
            self.followed.forget();
        }
    }

    fn enter(&mut self, next: State) {
        let moves = next.moves();
        if self.machine.enter(next) && !moves {
            self.followed.forget();
        }
    }

    fn refuse(&mut self, reason: String) {
        self.enter(State::refuse(reason));
    }

    /// Ends the present state if something happened that must.
    fn interrupt(&mut self, tick: &WayTick<'_>) {
        let locates = matches!(self.machine.state(), State::Locate(_));
        let has_arrived = || !locates && self.has_arrived(tick);
        match self.machine.interruption(tick, has_arrived) {
            None => {}
            Some(Interruption::Stumble) => self.stumble(tick),
            Some(Interruption::Lost) => self.begin_locating(tick),
            Some(Interruption::Arrival) => self.enter(State::Arrive),
            // A robot that has just found its place first looks around.
            Some(Interruption::Blind) if locates => {}
            Some(Interruption::Blind) => self.begin_blind(tick),
            Some(Interruption::Idle(reason)) => self.refuse(reason),
        }
    }

    /// One tick of the present state.
    fn act(&mut self, tick: &WayTick<'_>) -> Motion {
        match self.machine.state() {
            State::LookAround(_) => self.look_around(tick),
            State::Walk => self.walk(tick),
            State::Turn { to_rad } => self.turn(tick, *to_rad),
            State::Sidle => self.sidle(tick),
            State::Stop => self.stop(tick),
            State::StepOff { to_m } => self.step_off(tick, *to_m),
            State::Arrive => self.arrive(tick),
            State::Refuse { .. } => self.stand(tick),
            State::Blind(blind) => self.wait_for_sight(tick, *blind),
            State::Locate(_) => self.locate(tick),
        }
    }

    /// Stands and looks ahead.
    fn stand(&mut self, tick: &WayTick<'_>) -> Motion {
        self.gaze_at(tick, 0.0, self.config.gaze_far);
        Motion::Stand
    }
}

impl Behaviour for WalkingBehaviour {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        let tick = self.tick(situation);
        self.keep_time(&tick);
        self.interrupt(&tick);
        self.motion = self.act(&tick);
        let state = self.machine.state();
        let passes = matches!(
            state,
            State::Walk | State::Turn { .. } | State::LookAround(_)
        );
        Ok(Decision {
            command: Command {
                motion: self.motion.clone(),
                gaze: self.gazer.at,
                carries_first: self.carries_first(&tick),
                ..Command::default()
            },
            state: state.name(),
            goal_passed: !situation.last_goal && passes && self.is_inside(&tick),
            outcome: self.outcome(&tick),
        })
    }
}
