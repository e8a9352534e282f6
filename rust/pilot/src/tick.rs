//! One tick: from an observation to joint targets.

use std::sync::Arc;

use behaviour::{Behaviour, Command, Decision, GivingWay, PlannedFootsteps, Situation, SoleAt};
use geometry::{Map, Odometry, PlanarPose, Pose, Robot};
use localization::{Estimate, Localizer};
use mapping::FloorView;
use nalgebra::Vector3;
use planning::{Plan, Planner};
use proprioception::{
    BodyState, BodyStateHistory, Proprioception, ProprioceptionConfig, SenseWatch, SenseWatchConfig,
};
use robot::{Body, Side};
use sensing::{
    Frame, FrameWatch, FrameWatchConfig, Intrinsics, Observation, Scan, ScanConfig, SceneWatch,
    SceneWatchConfig, SelfFilter,
};
use settings::{Table as _, read};
use volume::octree::Octree;
use walking::relief::{Mapped, Slopes};
use walking::{GaitConfig, JointTargets, ReliefTuning, WalkError, Walker, WalkerSenses};

use crate::feeling;
use crate::goals::Goals;
use crate::moving::{Moving, eye_m};
use crate::perception::{Perception, PerceptionConfig};
use crate::registry::{self, Components, Making};
use crate::timing::{Stage, Timing};
use crate::watch;
use crate::{PilotError, Settings};

/// The whole core: the same on a real robot.
pub struct Pilot {
    body: Body,
    camera: Intrinsics,
    map_from_odometry_at_start: Pose<Map, Odometry>,
    proprioception: Proprioception,
    senses: SenseWatch,
    frames: FrameWatch,
    history: BodyStateHistory,
    /// The stages from the depth image to the map, with their products.
    pub perception: Perception,
    /// Where the robot is.
    pub localizer: Box<dyn Localizer>,
    /// Which way it goes.
    pub planner: Box<dyn Planner>,
    behaviour: Box<dyn Behaviour>,
    giving_way: GivingWay,
    /// What moves the legs.
    pub walker: Box<dyn Walker>,
    gait: GaitConfig,
    goals: Goals,
    /// The way to the current goal, once one was planned.
    pub plan: Option<Plan>,
    /// How often a way was planned anew after the first.
    pub replans: u64,
    time_ns: Option<u64>,
    /// How long each stage took at the last tick.
    pub timing: Timing,
}

/// The products of a tick.
#[derive(Debug)]
pub struct Tick<'a> {
    /// What the motors are told.
    pub targets: &'a JointTargets,
    /// Where the robot believes to be.
    pub estimate: Estimate,
    /// What it decided.
    pub decision: Decision,
    /// Where it would believe to be by leg odometry alone.
    pub dead_reckoning: Pose<Map, Robot>,
}

/// Moves the legs, on ground with the slopes that the map has where the robot believes to be.
fn walk<'a>(
    walker: &'a mut dyn Walker,
    (command, relief): (&Command, &ReliefTuning),
    (body, observation, state): (&Body, &Observation, &BodyState),
    (view, estimate): (&FloorView, &Estimate),
) -> Result<&'a JointTargets, WalkError> {
    let slopes = Mapped::around(view, &estimate.map_from_robot, relief);
    let senses = WalkerSenses {
        body,
        observation,
        state,
        slopes: slopes.as_ref().map(|slopes| slopes as &dyn Slopes),
    };
    walker.step(command, &senses)
}

/// The body's senses take note of what the motors are told.
fn note(targets: &JointTargets, senses: &mut SenseWatch, proprioception: &mut Proprioception) {
    senses.note_command(&targets.positions_rad);
    proprioception.note_command(
        &targets.positions_rad,
        &targets.velocities_radps,
        &targets.torques_nm,
    );
}

/// Where the soles are, left and right, by the joints.
fn soles(body: &Body, state: &BodyState) -> [SoleAt; 2] {
    Side::BOTH.map(|side| {
        let torso_from_sole = body.torso_from_sole(&state.links, side);
        let robot_from_sole = state.robot_from_torso.inner * torso_from_sole;
        let at = robot_from_sole.translation.vector;
        let [ahead, left] =
            [Vector3::x(), Vector3::y()].map(|axis| robot_from_sole.rotation * axis);
        SoleAt {
            pose: PlanarPose::new(at.x, at.y, libm::atan2(ahead.y, ahead.x)),
            height_m: at.z,
            slope: [ahead, left].map(|axis| axis.z / axis.xy().norm().max(f64::EPSILON)),
        }
    })
}

impl Pilot {
    /// Builds the core. A component that is given takes the place of the named one; `static_map` is what is known of the place
    /// beforehand.
    pub fn new(
        settings: &Settings,
        static_map: Option<&Arc<Octree>>,
        given: Components,
    ) -> Result<Self, PilotError> {
        let body = Body::new(settings.robot.clone())?;
        let settings = &settings.sized();
        let known_map = registry::known_map(settings, static_map)?;
        let (gait, _) = GaitConfig::read(&body)?;
        let mount = &body.description().camera;
        let camera = Intrinsics::from(mount);
        let tables = &settings.navigation.tables;
        let scan_config: ScanConfig = read(tables, "scan")?;
        scan_config.check()?;
        let scan = Scan::pooled(camera, mount.pool, scan_config);
        let making = Making {
            settings,
            body: &body,
            feet: registry::feet(&body, &gait),
            camera: scan.camera,
            known_map: known_map.as_ref(),
        };
        let senses: ProprioceptionConfig = read(tables, "proprioception")?;
        let frames: FrameWatchConfig = read(tables, "frame_watch")?;
        frames.check()?;
        let scenes: SceneWatchConfig = read(tables, "scene_watch")?;
        scenes.check()?;
        let watch: SenseWatchConfig = read(tables, "sense_watch")?;
        let segmenter = given.segmenter.map_or_else(|| making.segmenter(), Ok)?;
        let self_filter = SelfFilter::new(&body, &read(tables, "self_filter")?)?;
        let perception: PerceptionConfig = read(tables, "perception")?;
        perception.check()?;
        let world_model = (given.world_model).map_or_else(|| making.world_model(), Ok)?;
        let world_model = Box::new(making.overlay(world_model)?);
        Ok(Self {
            map_from_odometry_at_start: Pose::wrap(settings.start_or_origin().inner),
            proprioception: Proprioception::new(&body, senses.clone())?,
            senses: SenseWatch::new(&body, watch)?,
            frames: FrameWatch::new(frames),
            history: BodyStateHistory::for_pictures(&senses.tuning.history),
            perception: Perception::new(
                segmenter,
                world_model,
                making.recognizer()?,
                (scan, self_filter, SceneWatch::new(scenes)),
                Moving::new(read(tables, "moving")?)?,
                perception,
            ),
            localizer: (given.localizer).map_or_else(|| making.localizer(), Ok)?,
            planner: given.planner.map_or_else(|| making.planner(), Ok)?,
            giving_way: making.giving_way()?,
            behaviour: (given.behaviour).map_or_else(|| making.behaviour(), Ok)?,
            walker: given.walker.map_or_else(|| making.walker(), Ok)?,
            gait,
            goals: Goals::new(&settings.goals)?,
            plan: None,
            replans: 0,
            time_ns: None,
            timing: Timing::default(),
            camera,
            body,
        })
    }

    /// Begins a tick; tells the body's senses on what kind of ground the feet are put.
    fn begin(&mut self, time_ns: u64) {
        self.time_ns = Some(time_ns);
        self.timing = Timing::default();
        self.frames.pass(time_ns);
        self.proprioception.note_slopes(self.walker.on_slope());
        self.senses.note_uneven(self.walker.on_uneven());
    }

    /// Takes in an observation and says what the motors shall do. On an error nothing was taken in.
    pub fn tick(&mut self, measured: &Observation) -> Result<Tick<'_>, PilotError> {
        measured.check(self.body.joint_count(), &self.camera, self.time_ns)?;
        self.begin(measured.time_ns);
        let repaired = self.senses.repaired(measured);
        let observation = repaired.as_ref().unwrap_or(measured);
        let state = self
            .timing
            .measure(Stage::Localize, || self.proprioception.update(observation))?;
        self.history.push(state);
        let body = (&mut self.senses, measured, state);
        let fault = watch::fault(body, (&self.perception, &*self.localizer));
        if let Some(frame) = measured.depth.as_ref().filter(|_| fault.is_none()) {
            self.see_and_plan(frame)?;
        }
        let state = self.proprioception.state();
        let estimate = self
            .timing
            .measure(Stage::Localize, || self.localizer.estimate(state))?;
        feeling::tell(self.walker.as_ref(), &estimate, &mut self.perception);
        let situation = Situation {
            time_ns: observation.time_ns,
            estimate: &estimate,
            view: self.perception.world_model.view(),
            stairs: &self.perception.recognizer.staircase,
            plan: self.plan.as_ref(),
            goal: self.goals.current(),
            last_goal: self.goals.is_last(),
            soles: soles(&self.body, state),
            standing: self.walker.standing(),
            takes_footsteps: self.walker.takes_footsteps(),
            stepping: self.walker.stepping(),
            gaze: self.walker.gaze(),
            frames_used: self.perception.frames_used,
            last_frame_ns: self.perception.last_frame_ns,
            measured_share: self.frames.measured_share(observation.time_ns),
        };
        let movers = self.perception.movers(observation.time_ns);
        let watched = (fault.as_ref(), &movers[..], eye_m(&self.body, state));
        let (behaviour, giving_way) = (self.behaviour.as_mut(), &mut self.giving_way);
        let decision = self.timing.measure(Stage::Behave, || {
            watch::decide(behaviour, giving_way, &situation, watched, &self.frames)
        })?;
        if decision.goal_passed {
            self.goals.advance();
            self.plan = None;
            self.perception.world_model.doubt();
        }
        let told = (&decision.command, &self.gait.tuning.relief);
        let felt = (&self.body, observation, state);
        let seen = (self.perception.world_model.view(), &estimate);
        let targets = self
            .timing
            .measure(Stage::Walk, || walk(self.walker.as_mut(), told, felt, seen))?;
        let dead_reckoning = self.map_from_odometry_at_start * state.odometry_from_robot;
        note(targets, &mut self.senses, &mut self.proprioception);
        Ok(Tick {
            targets,
            estimate,
            decision,
            dead_reckoning,
        })
    }

    fn see_and_plan(&mut self, frame: &Frame) -> Result<(), PilotError> {
        let Some(body_then) = self.history.at(frame.exposure_ns) else {
            return Ok(());
        };
        let (localizer, timing) = (self.localizer.as_mut(), &mut self.timing);
        let robot_from_camera =
            body_then.robot_from_torso * self.body.torso_from_camera(&body_then.links);
        if !self.frames.is_new(frame, &robot_from_camera) {
            return Ok(());
        }
        let (body, steps) = ((&self.body, body_then), self.walker.steps_taken());
        if (self.perception).see(frame, body, steps, localizer, timing)? {
            self.planner.forget();
        }
        let estimate = self.localizer.estimate(self.proprioception.state())?;
        let plan = self.timing.measure(Stage::Plan, || {
            self.planner.plan(
                self.perception.world_model.view(),
                &self.perception.recognizer.staircase,
                &estimate.map_from_robot,
                self.goals.current(),
            )
        })?;
        self.replans += u64::from(plan.replanned && self.plan.is_some());
        self.plan = Some(plan);
        Ok(())
    }

    /// The footsteps that the behaviour planned last, to look at.
    pub fn planned_footsteps(&self) -> Option<PlannedFootsteps<'_>> {
        self.behaviour.planned_footsteps()
    }

    /// Via points passed so far.
    pub const fn goals_passed(&self) -> usize {
        self.goals.passed
    }
}
