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

use geometry::PlanarPose;
use planning::{Goal, Path};
use settings::ConfigError;

use crate::{Behaviour, BehaviourError, Command, Decision, Motion, Situation};
use ahead::{Followed, Looked};
pub(crate) use ahead::{is_edge, is_roomy};
pub use config::WalkingConfig;
use gaze::{Gazer, Sweep};
use progress::Progress;
use state::State;
use track::Track;

/// Standing, looking and waiting without a step towards the goal ends after this, s.
const LONGEST_IDLE_S: f64 = 75.0;

/// Walks to the goal by what the robot sees.
#[derive(Debug, Clone)]
pub struct WalkingBehaviour {
    config: WalkingConfig,
    state: State,
    state_s: f64,
    time_ns: Option<u64>,
    elapsed_s: f64,
    standing_s: f64,
    no_way_s: f64,
    way_s: f64,
    no_plan_s: f64,
    idle_s: f64,
    frames_used: u64,
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

/// What the states read at a tick.
#[derive(Clone, Copy)]
struct Moment<'a> {
    situation: &'a Situation<'a>,
    pose: PlanarPose,
    track: Option<(&'a Path, Track)>,
    passed_s: f64,
    new_frame: bool,
}

impl Moment<'_> {
    fn no_way(&self) -> bool {
        self.situation.plan.is_some_and(|plan| plan.way.is_err())
    }

    /// Why there is no way, in the planner's words.
    fn no_way_reason(&self) -> Option<String> {
        let no_way = self.situation.plan?.way.as_ref().err()?;
        Some(format!("{}: {}", no_way.refusal.word(), no_way.sentence))
    }

    /// Direction of a place of the map, rad to the left of straight ahead.
    fn bearing_rad(&self, [x, y]: [f64; 2]) -> f64 {
        let (x, y) = self.pose.inverse().apply(x, y);
        y.atan2(x)
    }
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
            time_ns: None,
            elapsed_s: 0.0,
            standing_s: 0.0,
            no_way_s: 0.0,
            way_s: 0.0,
            no_plan_s: 0.0,
            idle_s: 0.0,
            frames_used: 0,
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

    fn moment<'a>(&self, situation: &'a Situation<'a>) -> Moment<'a> {
        let origin = situation.estimate.map_from_robot.origin().inner;
        let yaw_rad = situation.estimate.map_from_robot.yaw_rad();
        let pose = PlanarPose::new(origin.x, origin.y, yaw_rad);
        let path = situation.plan.and_then(|plan| plan.way.as_ref().ok());
        let track = path.and_then(|path| {
            let track = Track::new(path, &pose, self.config.lookahead)?;
            let straight = path.sidles.is_empty();
            let lengthened = |track| self.lengthened(track, &pose, situation);
            Some((path, if straight { lengthened(track) } else { track }))
        });
        let passed_ns = self
            .time_ns
            .map_or(0, |before_ns| situation.time_ns.saturating_sub(before_ns));
        Moment {
            situation,
            pose,
            track,
            passed_s: passed_ns as f64 * 1e-9,
            new_frame: situation.frames_used != self.frames_used,
        }
    }

    fn keep_time(&mut self, moment: &Moment<'_>) {
        let situation = moment.situation;
        if self.time_ns.is_none() {
            self.gazer.start(situation.gaze);
        }
        self.time_ns = Some(situation.time_ns);
        self.frames_used = situation.frames_used;
        let passed_s = moment.passed_s;
        let count =
            |timer_s: &mut f64, runs: bool| *timer_s = if runs { *timer_s + passed_s } else { 0.0 };
        count(&mut self.elapsed_s, true);
        count(&mut self.state_s, true);
        count(&mut self.standing_s, situation.standing);
        count(&mut self.no_way_s, moment.no_way());
        count(&mut self.way_s, moment.track.is_some());
        count(&mut self.no_plan_s, situation.plan.is_none());
        // Who cannot tell where it is or what is around has limits of its own for that.
        if !matches!(self.state, State::Locate | State::Blind) {
            count(&mut self.idle_s, self.state != State::Walk);
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
    fn interrupt(&mut self, moment: &Moment<'_>) {
        if matches!(self.state, State::Refuse | State::Arrive) {
            return;
        }
        if moment.situation.stepping.stumbled && self.state.moves() {
            self.stumble();
        } else if moment.situation.estimate.lost {
            self.begin_locating(moment);
        } else if self.state != State::Locate && self.has_arrived(moment) {
            self.enter(State::Arrive);
        } else if self.is_blind(moment) {
            self.enter(State::Blind);
        } else if self.idle_s > LONGEST_IDLE_S {
            let reason = moment.no_way_reason().unwrap_or_else(|| {
                format!("lost: no step towards the goal could be taken for {LONGEST_IDLE_S:.0} s")
            });
            self.refuse(reason);
        }
    }

    /// Seconds since a frame was last taken into the map.
    fn unseen_s(&self, situation: &Situation<'_>) -> f64 {
        situation.last_frame_ns.map_or(self.elapsed_s, |last_ns| {
            situation.time_ns.saturating_sub(last_ns) as f64 * 1e-9
        })
    }

    fn is_blind(&self, moment: &Moment<'_>) -> bool {
        // Who stands and looks around may look where there is no ground for a while.
        let patience = if self.state == State::LookAround {
            4.0
        } else {
            1.0
        };
        let unseen_s = self.unseen_s(moment.situation);
        unseen_s > patience * self.config.blind_after
    }
}

impl Behaviour for WalkingBehaviour {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        let moment = self.moment(situation);
        self.keep_time(&moment);
        self.interrupt(&moment);
        self.motion = self.act(&moment);
        let moving = matches!(self.state, State::Walk | State::Turn | State::LookAround);
        Ok(Decision {
            command: Command {
                motion: self.motion.clone(),
                gaze: self.gazer.at(),
                ..Command::default()
            },
            state: self.state.name(),
            goal_passed: !situation.last_goal && moving && self.is_inside(&moment),
            outcome: self.outcome(&moment),
        })
    }
}
