//! The behaviour `walking`: look around, follow the path, stop, find another way, arrive or refuse.
//!
//! Decides from the [`Situation`] alone; its only clock is `time_ns`. Whatever it waits for, it waits in bounded time.

mod ahead;
mod arrival;
mod config;
pub(crate) mod gaze;
mod legs;
mod locate;
mod progress;
mod sidle;
mod state;
mod states;
mod track;

#[cfg(test)]
mod simulation;
#[cfg(test)]
mod tests;

use geometry::{ConfigError, PlanarPose};
use planning::Goal;

use crate::machine::{Clock, Stopwatch, Tick};
use crate::{Behaviour, BehaviourError, Command, Decision, Motion, Situation};
use ahead::{Followed, Looked};
pub(crate) use ahead::{is_edge, is_roomy};
pub use config::WalkingConfig;
use gaze::{Gazer, Sweep};
use progress::Progress;
use state::State;
pub(crate) use track::Track;

/// Standing, looking and waiting without a step towards the goal ends after this, s.
const LONGEST_IDLE_S: f64 = 75.0;

/// Walks to the goal by what the robot sees.
#[derive(Debug, Clone)]
pub struct WalkingBehaviour {
    config: WalkingConfig,
    state: State,
    state_s: f64,
    clock: Clock,
    standing: Stopwatch,
    no_way: Stopwatch,
    way: Stopwatch,
    no_plan: Stopwatch,
    idle: Stopwatch,
    goal: Option<Goal>,
    gazer: Gazer,
    sweep: Sweep,
    looked: Looked,
    followed: Followed,
    progress: Progress,
    looks: u32,
    turn_to_rad: Option<f64>,
    watched_m: Option<[f64; 2]>,
    stumbles: u32,
    /// Time since the start at which the look around of the state `locate` was over, s.
    looked_round_s: Option<f64>,
    /// The odometry frame in the map when the robot lost its place.
    lost_at: Option<PlanarPose>,
    motion: Motion,
    refusal: String,
}

impl WalkingBehaviour {
    /// Refuses settings that cannot be used.
    pub fn new(config: WalkingConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            sweep: Sweep::around(&config),
            config,
            state: State::LookAround,
            state_s: 0.0,
            clock: Clock::default(),
            standing: Stopwatch::default(),
            no_way: Stopwatch::default(),
            way: Stopwatch::default(),
            no_plan: Stopwatch::default(),
            idle: Stopwatch::default(),
            goal: None,
            gazer: Gazer::default(),
            looked: Looked::default(),
            followed: Followed::default(),
            progress: Progress::default(),
            looks: 0,
            turn_to_rad: None,
            watched_m: None,
            stumbles: 0,
            looked_round_s: None,
            lost_at: None,
            motion: Motion::Stand,
            refusal: String::new(),
        })
    }

    fn tick<'a>(&self, situation: &'a Situation<'a>) -> Tick<'a> {
        let tick = self.clock.read(situation);
        let path = situation.plan.and_then(|plan| plan.way.as_ref().ok());
        let track = path.and_then(|path| {
            let track = Track::new(path, &tick.pose, self.config.lookahead)?;
            let straight = path.sidles.is_empty();
            let lengthened = |track| self.lengthened(track, &tick);
            Some((path, if straight { lengthened(track) } else { track }))
        });
        Tick { track, ..tick }
    }

    fn keep_time(&mut self, tick: &Tick<'_>) {
        let situation = tick.situation;
        if !self.clock.has_begun() {
            self.gazer.start(situation.gaze);
        }
        self.clock.count(tick);
        let passed_s = tick.passed_s;
        self.state_s += passed_s;
        self.standing.count(situation.standing, passed_s);
        self.no_way.count(tick.finds_no_way(), passed_s);
        self.way.count(tick.track.is_some(), passed_s);
        self.no_plan.count(situation.plan.is_none(), passed_s);
        // Who cannot tell where it is or what is around has limits of its own for that.
        if !matches!(self.state, State::Locate | State::Blind) {
            self.idle.count(self.state != State::Walk, passed_s);
        }
        if self.goal != Some(*situation.goal) {
            self.goal = Some(*situation.goal);
            self.progress = Progress::default();
            self.followed.forget();
        }
    }

    fn enter(&mut self, next: State) {
        if next == self.state || !self.state.may_become(next) {
            return;
        }
        if !next.moves() {
            self.followed.forget();
        }
        self.state = next;
        self.state_s = 0.0;
    }

    fn look(&mut self, sweep: Sweep) {
        self.sweep = sweep;
        self.enter(State::LookAround);
    }

    fn refuse(&mut self, reason: String) {
        if self.state != State::Refuse {
            self.refusal = reason;
            self.enter(State::Refuse);
        }
    }

    /// What may end any state: the robot does not know where it is, nothing is seen, the goal is reached, or nothing has happened for too long.
    fn interrupt(&mut self, tick: &Tick<'_>) {
        if matches!(self.state, State::Refuse | State::Arrive) {
            return;
        }
        if tick.situation.stepping.stumbled && self.state.moves() {
            self.stumble();
        } else if tick.situation.estimate.lost {
            self.begin_locating(tick);
        } else if self.state != State::Locate && self.has_arrived(tick) {
            self.enter(State::Arrive);
        } else if self.is_blind(tick) {
            self.enter(State::Blind);
        } else if self.idle.s() > LONGEST_IDLE_S {
            let reason = tick.no_way_reason().unwrap_or_else(|| {
                format!("lost: no step towards the goal could be taken for {LONGEST_IDLE_S:.0} s")
            });
            self.refuse(reason);
        }
    }

    fn is_blind(&self, tick: &Tick<'_>) -> bool {
        // Who stands and looks around may look where there is no ground for a while.
        let patience = if self.state == State::LookAround {
            4.0
        } else {
            1.0
        };
        let unseen_s = tick.unseen_s().unwrap_or(tick.elapsed_s);
        unseen_s > patience * self.config.blind_after
    }
}

impl Behaviour for WalkingBehaviour {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        let tick = self.tick(situation);
        self.keep_time(&tick);
        self.interrupt(&tick);
        self.motion = self.act(&tick);
        let moving = matches!(self.state, State::Walk | State::Turn | State::LookAround);
        Ok(Decision {
            command: Command {
                motion: self.motion.clone(),
                gaze: self.gazer.at(),
                ..Command::default()
            },
            state: self.state.name(),
            goal_passed: !situation.last_goal && moving && self.is_inside(&tick),
            outcome: self.outcome(&tick),
        })
    }
}
