//! What a depth frame sets off: scan, planes, pose, map.

use behaviour::Mover;
use dynamic_scenes::MovingTrack;
use geometry::{Camera, Map, Pose, Robot};
use localization::{Estimate, Localizer};
use mapping::{FloorView, Surface, WorldModel};
use nalgebra::Vector3;
use proprioception::BodyState;
use robot::Body;
use segmentation::{Planes, Segmenter};
use sensing::{Frame, Scan, SceneWatch, SelfFilter, SenseFault};
use settings::{POSITIVE, at_least, settings};
use stairs::{CarryingSole, Recognizer};

use crate::PilotError;
use crate::moving::Moving;
use crate::timing::{Stage, Timing};

settings! {
    /// What a depth frame sets off.
    pub struct PerceptionConfig("navigation.perception") {
        /// Numbers of perception that few will want to turn.
        tuning: PerceptionTuning;
    }
}

settings! {
    /// When the floor in the map is known, and when the robot was somewhere else all along.
    pub struct PerceptionTuning("navigation.perception.tuning") {
        /// Frames that must have seen a cell's floor before the segmenter is told its height as known.
        seen_often: u16 = 4, "1", at_least(1.0);
        /// A frame that moves the robot further in the map tells that it was somewhere else all along, and that the map lies in
        /// the wrong place.
        elsewhere_distance: f64 = 0.3, "m", POSITIVE;
        /// A frame that turns the robot by more in the map tells that it was somewhere else all along, and that the map lies in
        /// the wrong place.
        elsewhere_turn: f64 = 0.35, "rad", POSITIVE;
    }
}

/// The stages from the depth image to map and stairs, with their products.
pub struct Perception {
    segmenter: Box<dyn Segmenter>,
    /// The map.
    pub world_model: Box<dyn WorldModel>,
    /// The stairs that are seen or remembered.
    pub recognizer: Recognizer,
    scan: Scan,
    moving: Moving,
    self_filter: SelfFilter,
    scenes: SceneWatch,
    /// The planes of the last frame.
    pub planes: Planes,
    /// Frames taken into the map so far.
    pub frames_used: u64,
    /// How often the robot found itself elsewhere, and all that was mapped till then was forgotten.
    pub forgotten: u64,
    /// When the last frame was taken into the map, nanoseconds since the start.
    pub last_frame_ns: Option<u64>,
    tuning: PerceptionTuning,
}

/// What the map remembers of the floor around the robot, where it was seen often enough: heights above the robot's ground.
fn remembered(
    view: &FloorView,
    map_from_robot: &Pose<Map, Robot>,
    seen_often: u16,
) -> impl Fn(f64, f64) -> Option<f64> {
    let origin_m = map_from_robot.origin().inner;
    let (sin, cos) = libm::sincos(map_from_robot.yaw_rad());
    move |x_m, y_m| {
        let cell = view.lattice.cell_at(
            origin_m.x + cos * x_m - sin * y_m,
            origin_m.y + sin * x_m + cos * y_m,
        );
        match view.cell(cell) {
            Surface::Floor(height_m) if *view.sightings.get(cell)? >= seen_often => {
                Some(f64::from(height_m) - origin_m.z)
            }
            _ => None,
        }
    }
}

/// Whether what was mapped lies in the wrong place.
fn is_elsewhere(before: &Estimate, after: &Estimate, tuning: &PerceptionTuning) -> bool {
    let moved = before.map_from_odometry.inverse() * after.map_from_odometry;
    let robot_m = after.map_from_robot.origin().inner - before.map_from_robot.origin().inner;
    robot_m.norm() > tuning.elsewhere_distance || moved.yaw_rad().abs() > tuning.elsewhere_turn
}

/// The sole that carries the robot.
fn carrying_sole(
    body: &Body,
    state: &BodyState,
    map_from_robot: &Pose<Map, Robot>,
) -> CarryingSole {
    let torso_from_sole = body.torso_from_sole(&state.links, state.support);
    let map_from_sole = map_from_robot.inner * state.robot_from_torso.inner * torso_from_sole;
    let up = map_from_sole.rotation * Vector3::z();
    CarryingSole {
        middle_m: map_from_sole.translation.vector.xy().into(),
        gradient: [-up.x / up.z, -up.y / up.z],
        half_length_m: 0.5 * body.description().legs.get(state.support).sole.length,
    }
}

impl Perception {
    pub(crate) fn new(
        segmenter: Box<dyn Segmenter>,
        world_model: Box<dyn WorldModel>,
        recognizer: Recognizer,
        (scan, self_filter, scenes): (Scan, SelfFilter, SceneWatch),
        moving: Moving,
        config: PerceptionConfig,
    ) -> Self {
        Self {
            segmenter,
            world_model,
            recognizer,
            planes: Planes::new(scan.disparity_px.len()),
            scan,
            moving,
            self_filter,
            scenes,
            frames_used: 0,
            forgotten: 0,
            last_frame_ns: None,
            tuning: config.tuning,
        }
    }

    /// What moves and is followed, or came into view lately.
    pub fn moving_things(&self) -> &[MovingTrack] {
        self.moving.tracks()
    }

    /// What moves, or may, and where it will be from now on.
    pub(crate) fn movers(&self, now_ns: u64) -> Vec<Mover> {
        self.moving.movers(now_ns)
    }

    /// What the pictures contradict, if anything: the camera's place in the head, or the way that the legs tell, unless the localizer
    /// needs no such way.
    pub(crate) fn fault(&self, localizer: &dyn Localizer) -> Option<&SenseFault> {
        let carried = self.scenes.carried();
        (self.scenes.turned()).or_else(|| carried.filter(|_| localizer.needs_unbroken_way()))
    }

    /// Takes in a frame that a body took. Whether the robot found itself elsewhere than it believed, so that what was mapped is
    /// forgotten.
    pub(crate) fn see(
        &mut self,
        frame: &Frame,
        (body, body_then): (&Body, &BodyState),
        steps_taken: u64,
        localizer: &mut dyn Localizer,
        timing: &mut Timing,
    ) -> Result<bool, PilotError> {
        let torso_from_camera = body.torso_from_camera(&body_then.links);
        let robot_from_camera: Pose<Robot, Camera> = body_then.robot_from_torso * torso_from_camera;
        self.scan.read(frame, robot_from_camera)?;
        self.scan.on_slope = body_then.on_slope;
        let _own_pixels =
            self.self_filter
                .mask(&mut self.scan, &body_then.links, &torso_from_camera);
        self.scenes.look(
            &self.scan,
            &body_then.odometry_from_robot,
            body_then.tilt_rad(),
        );
        let predicted = timing.measure(Stage::Localize, || {
            localizer.see(&self.scan)?;
            localizer.estimate(body_then)
        })?;
        timing.measure(Stage::Segment, || {
            let (view, seen_often) = (self.world_model.view(), self.tuning.seen_often);
            let remembered = remembered(view, &predicted.map_from_robot, seen_often);
            self.segmenter
                .segment_known(&self.scan, &remembered, &mut self.planes)
        })?;
        let estimate = timing.measure(Stage::Localize, || {
            localizer.correct(body_then, &self.planes, self.world_model.view())?;
            localizer.estimate(body_then)
        })?;
        let elsewhere = is_elsewhere(&predicted, &estimate, &self.tuning);
        if elsewhere {
            self.forgotten += 1;
            self.world_model.forget();
            self.recognizer.forget();
            self.moving.forget();
        }
        let foreseen = timing.measure(Stage::Map, || {
            self.moving.see(&mut self.planes, &estimate.map_from_robot)
        });
        let insertion = timing.measure(Stage::Map, || {
            self.world_model
                .insert(&self.planes, &estimate.map_from_robot)
        })?;
        self.world_model.foresee(&foreseen);
        let _staircase = timing.measure(Stage::Stairs, || {
            let map_from_robot = &estimate.map_from_robot;
            self.recognizer.leave_slopes(self.world_model.view());
            self.recognizer
                .stand_on(&carrying_sole(body, body_then, map_from_robot));
            self.recognizer
                .update(&self.scan, &self.planes, map_from_robot, steps_taken)
        })?;
        self.world_model.lay(&self.recognizer.bevels);
        if insertion.used {
            self.frames_used += 1;
            self.last_frame_ns = Some(frame.arrival_ns);
        }
        Ok(elsewhere)
    }
}
