//! The behaviour `footsteps`: every foot is planned where height changes or the planner knows no way; on open floor it walks.
//!
//! On level ways the behaviour `walking` decides. Before a height change the robot stands, looks, and takes the steps that the layer of
//! footsteps plans over the ground as it is known, planning anew after each. What was not seen is priced: a plan ends before it, and the
//! robot looks.

mod back;
mod config;
mod failed;
mod listed;
mod look;
mod progress;
mod route;
mod state;
mod step;
mod walk;

use geometry::PlanarPose;
use planning::footsteps::{FootstepLayer, FootstepPlan, FootstepsConfig, NoFootsteps, StepLimits};
use settings::{MakeError, Part, Table, TableDescription, read};
use stairs::ClimbingConfig;
use terrain::ground_map::{GroundMap, SoleOnGround};

use crate::climbing::head::ClimbingHead;
use crate::climbing::stepper::Stepper;
use crate::machine::{Interruption, Machine, SightAgain, State as _, Tick};
use crate::part::{BehaviourNeeds, BehaviourPart};
use crate::{
    Behaviour, BehaviourError, Command, Decision, Motion, Outcome, PlannedFootsteps, Situation,
    StairClimbingConfig, WalkingBehaviour, WalkingConfig,
};
use back::Stances;
pub use config::SteppingConfig;
use failed::Failed;
use listed::PlannersList;
use progress::CostToGo;
use route::LastSteps;
pub(crate) use state::State;
use walk::Lead;

/// How it is listed and made.
pub(crate) const PART: BehaviourPart = Part {
    name: "footsteps",
    about: "plans every foot where height changes or no way is known, over anything that its legs allow",
    source: None,
    tables: &[
        TableDescription::of::<FootstepsConfig>(),
        TableDescription::of::<SteppingConfig>(),
        TableDescription::of::<StairClimbingConfig>(),
        TableDescription::of::<WalkingConfig>(),
    ],
    make: |needs| Ok(Box::new(Footsteps::of(needs)?)),
};

/// Walks to the goal where it is level, and steps where it is not.
#[derive(Debug, Clone)]
pub struct Footsteps {
    config: SteppingConfig,
    /// Told heights and the robot's own may be off by so much, m.
    told_m: f64,
    walking: WalkingBehaviour,
    machine: Machine<State>,
    head: ClimbingHead,
    stepper: Stepper,
    layer: FootstepLayer,
    ground: GroundMap,
    /// Where feet found no ground, or met something.
    failed: Failed,
    /// Where feet stood, as long as the robot steps.
    felt: Vec<SoleOnGround>,
    /// How they stood, one stance after the other.
    stances: Stances,
    /// The walk to the next height change.
    lead: Option<Lead>,
    /// How far it has come: from look to look, and from step to step.
    to_go: [CostToGo; 2],
    /// The place at which it looks, if it was told one, m.
    looked_at_m: Option<[f64; 2]>,
    /// Looks since the last step.
    looks: u32,
    /// Times that stepping was given up, and where that was last.
    given_up: (u32, Option<PlanarPose>),
    /// How many of the list's steps had landed when it was planned last.
    planned_at: usize,
    /// The steps that were planned last, while they are taken.
    last: LastSteps,
    /// What became of the planner's own lists.
    list: PlannersList,
    /// The last plan, and how many there were.
    planned: (Option<Result<FootstepPlan, NoFootsteps>>, u64),
}

impl Footsteps {
    fn of(needs: &BehaviourNeeds<'_>) -> Result<Self, MakeError> {
        let walking = WalkingBehaviour::of(needs)?;
        let climbing: ClimbingConfig = read(needs.tables, "climbing")?;
        let head: StairClimbingConfig = read(needs.tables, "stair_climbing")?;
        let layer: FootstepsConfig = read(needs.tables, "footsteps")?;
        let config: SteppingConfig = read(needs.tables, "stepping")?;
        config.check()?;
        let eyes = &needs.body.description().head;
        let stride_m = climbing
            .ascend
            .longest_stride
            .min(climbing.descend.longest_stride);
        // Foot over foot, a foot passes the level of the other one.
        let limits = StepLimits {
            careful_forward_m: needs.steps.careful_forward_m.min(stride_m),
            careful_lift_m: 2.0 * head.run_rise,
            ..needs.steps
        };
        let ground = GroundMap::new(layer.ground.clone(), needs.steps.careful_rise_m);
        let waits = (walking.config()).limits("no step could be taken", ", while it stepped");
        Ok(Self {
            told_m: climbing.levels.told,
            head: ClimbingHead::new(&head, walking.config(), eyes),
            machine: Machine::new(State::Walk, waits),
            stepper: Stepper::new(head.tuning.stepper.clone()),
            layer: FootstepLayer::new(layer, limits)?,
            ground,
            config,
            walking,
            failed: Failed::default(),
            felt: Vec::new(),
            stances: Stances::default(),
            lead: None,
            to_go: [CostToGo::default(); 2],
            looked_at_m: None,
            looks: 0,
            given_up: (0, None),
            planned_at: 0,
            last: LastSteps::default(),
            list: PlannersList::default(),
            planned: (None, 0),
        })
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

    /// Ends a state if something happened that must, while no foot is on its way.
    fn interrupt(&mut self, tick: &Tick<'_>) {
        if self.stepper.is_running() {
            return;
        }
        match self.machine.interruption(tick, || false) {
            None | Some(Interruption::Stumble | Interruption::Arrival) => {}
            Some(Interruption::Lost | Interruption::Blind) => {
                self.head.look_down();
                self.enter(State::Blind);
            }
            Some(Interruption::Idle(reason)) => self.refuse(reason),
        }
    }

    /// One tick of a state in which the robot does not walk.
    fn act(&mut self, tick: &Tick<'_>) -> Motion {
        match self.machine.state() {
            State::Walk | State::Refuse { .. } | State::Arrive => Motion::Stand,
            State::Look => self.look(tick),
            State::Search => self.search(tick),
            State::Step => self.step(tick),
            State::Blind => self.wait_for_sight(tick),
        }
    }

    /// One tick of standing and looking down and around until something is seen.
    fn wait_for_sight(&mut self, tick: &Tick<'_>) -> Motion {
        if self.head.advance(tick.situation.frames_used, tick.passed_s) {
            self.head.look_down();
        }
        match self.machine.sight(tick) {
            SightAgain::Back => self.begin_look(tick, None),
            SightAgain::Away => {}
            SightAgain::Hopeless(reason) => self.refuse(reason),
        }
        Motion::Stand
    }

    fn decision(&self, tick: &Tick<'_>, motion: Motion) -> Decision {
        let state = self.machine.state();
        let arrived = matches!(state, State::Arrive) && tick.situation.standing;
        Decision {
            command: Command {
                motion,
                gaze: self.head.gazer.at,
                ..Command::default()
            },
            state: state.name(),
            goal_passed: arrived && !tick.situation.last_goal,
            outcome: if arrived && tick.situation.last_goal {
                Some(Outcome::GoalReached)
            } else {
                self.machine.refusal(tick.situation.standing)
            },
        }
    }
}

impl Behaviour for Footsteps {
    fn next(&mut self, situation: &Situation<'_>) -> Result<Decision, BehaviourError> {
        let tick = self.machine.read(situation);
        self.machine.keep_time(&tick);
        if self.is_walking() {
            return self.walk(&tick);
        }
        self.interrupt(&tick);
        let motion = self.act(&tick);
        let decision = self.decision(&tick, motion);
        if decision.goal_passed {
            self.begin_walk(&tick);
        }
        Ok(decision)
    }

    fn planned_footsteps(&self) -> Option<PlannedFootsteps<'_>> {
        let (plan, count) = &self.planned;
        Some(PlannedFootsteps {
            plan: plan.as_ref()?.as_ref().map_err(|none| *none),
            ground: self.ground.map(),
            times: self.layer.times(),
            count: *count,
            refused: self.list.refusal(),
        })
    }
}
