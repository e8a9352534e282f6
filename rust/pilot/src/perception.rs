//! What a depth frame sets off: scan, planes, pose, map.

use geometry::{Camera, Grid, Map, Pose, Robot};
use localization::{Estimate, Localizer};
use mapping::{FloorView, Insertion, Surface, Voxel, WorldModel};
use proprioception::BodyState;
use robot::Body;
use segmentation::{KnownFloor, Planes, Segmenter};
use sensing::{Frame, Scan, SelfFilter};
use settings::{POSITIVE, at_least, settings};
use stairs::{Recognizer, Staircase};

use crate::PilotError;
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
    world_model: Box<dyn WorldModel>,
    recognizer: Recognizer,
    scan: Scan,
    self_filter: SelfFilter,
    planes: Planes,
    insertion: Option<Insertion>,
    frames_used: u64,
    last_frame_ns: Option<u64>,
    tuning: PerceptionTuning,
}

/// The floor in the map as the robot remembers it from where it stands.
struct Remembered<'a> {
    view: &'a FloorView,
    /// The robot's frame in the map: origin, m, and sine and cosine of its heading.
    origin_m: [f64; 3],
    heading: (f64, f64),
    /// Frames that must have seen a cell's floor before its height counts as known.
    seen_often: u16,
}

impl<'a> Remembered<'a> {
    fn new(view: &'a FloorView, map_from_robot: &Pose<Map, Robot>, seen_often: u16) -> Self {
        let origin = map_from_robot.origin().inner;
        Self {
            view,
            origin_m: [origin.x, origin.y, origin.z],
            heading: libm::sincos(map_from_robot.yaw_rad()),
            seen_often,
        }
    }
}

impl KnownFloor for Remembered<'_> {
    fn height_m(&self, x_m: f64, y_m: f64) -> Option<f64> {
        let (sin, cos) = self.heading;
        let [origin_x_m, origin_y_m, origin_z_m] = self.origin_m;
        let cell = self.view.lattice.cell_at(
            origin_x_m + cos * x_m - sin * y_m,
            origin_y_m + sin * x_m + cos * y_m,
        );
        match self.view.cell(cell) {
            Surface::Floor(height_m) if *self.view.sightings.get(cell)? >= self.seen_often => {
                Some(f64::from(height_m) - origin_z_m)
            }
            _ => None,
        }
    }
}

/// Who took a frame.
#[derive(Clone, Copy)]
pub(crate) struct TakenBy<'a> {
    /// The body.
    pub(crate) body: &'a Body,
    /// Its state at the exposure.
    pub(crate) state: &'a BodyState,
    /// The steps it had taken.
    pub(crate) steps_taken: u64,
}

/// Whether what was mapped lies in the wrong place.
fn is_elsewhere(before: &Estimate, after: &Estimate, tuning: &PerceptionTuning) -> bool {
    let moved = before.map_from_odometry.inverse() * after.map_from_odometry;
    let robot_m = after.map_from_robot.origin().inner - before.map_from_robot.origin().inner;
    robot_m.norm() > tuning.elsewhere_distance || moved.yaw_rad().abs() > tuning.elsewhere_turn
}

impl Perception {
    pub(crate) fn new(
        segmenter: Box<dyn Segmenter>,
        world_model: Box<dyn WorldModel>,
        recognizer: Recognizer,
        self_filter: SelfFilter,
        scan: Scan,
        config: PerceptionConfig,
    ) -> Self {
        Self {
            segmenter,
            world_model,
            recognizer,
            planes: Planes::new(scan.disparity_px.len()),
            scan,
            self_filter,
            insertion: None,
            frames_used: 0,
            last_frame_ns: None,
            tuning: config.tuning,
        }
    }

    /// Takes in a frame that a body took. Whether the robot found itself elsewhere than it believed, so that what was mapped is
    /// forgotten.
    pub(crate) fn see(
        &mut self,
        frame: &Frame,
        taken_by: &TakenBy<'_>,
        localizer: &mut dyn Localizer,
        timing: &mut Timing,
    ) -> Result<bool, PilotError> {
        let TakenBy {
            body,
            state: body_then,
            steps_taken,
        } = *taken_by;
        let torso_from_camera = body.torso_from_camera(&body_then.links);
        let robot_from_camera: Pose<Robot, Camera> = body_then.robot_from_torso * torso_from_camera;
        self.scan.read(frame, robot_from_camera)?;
        let _own_pixels =
            self.self_filter
                .mask(&mut self.scan, &body_then.links, &torso_from_camera);
        let predicted = timing.measure(Stage::Localize, || localizer.estimate(body_then))?;
        timing.measure(Stage::Segment, || {
            let remembered = Remembered::new(
                self.world_model.view(),
                &predicted.map_from_robot,
                self.tuning.seen_often,
            );
            self.segmenter
                .segment_known(&self.scan, &remembered, &mut self.planes)
        })?;
        let estimate = timing.measure(Stage::Localize, || {
            localizer.correct(body_then, &self.planes, self.world_model.view())?;
            localizer.estimate(body_then)
        })?;
        let elsewhere = is_elsewhere(&predicted, &estimate, &self.tuning);
        if elsewhere {
            self.world_model.forget();
            self.recognizer.forget();
        }
        let insertion = timing.measure(Stage::Map, || {
            self.world_model
                .insert(&self.planes, &estimate.map_from_robot)
        })?;
        let _staircase = timing.measure(Stage::Stairs, || {
            let map_from_robot = &estimate.map_from_robot;
            self.recognizer.leave_slopes(self.world_model.view());
            self.recognizer
                .update(&self.scan, &self.planes, map_from_robot, steps_taken)
        })?;
        if insertion.used {
            self.frames_used += 1;
            self.last_frame_ns = Some(frame.arrival_ns);
        }
        self.insertion = Some(insertion);
        Ok(elsewhere)
    }

    /// The planes of the last frame.
    pub const fn planes(&self) -> &Planes {
        &self.planes
    }

    /// The map's view.
    pub fn view(&self) -> &mapping::FloorView {
        self.world_model.view()
    }

    /// Where what hangs above the view's cells begins, m, where the map keeps it.
    pub fn ceilings(&self) -> Option<Grid<f32>> {
        self.world_model.ceilings()
    }

    /// What was seen to be occupied, where the model keeps the space in three dimensions.
    pub fn occupied(&self) -> Vec<Voxel> {
        self.world_model.occupied()
    }

    /// The stairs that are seen or remembered.
    pub const fn staircase(&self) -> &Staircase {
        self.recognizer.staircase()
    }

    /// What the last frame did to the map.
    pub const fn insertion(&self) -> Option<&Insertion> {
        self.insertion.as_ref()
    }

    /// Frames taken into the map so far.
    pub const fn frames_used(&self) -> u64 {
        self.frames_used
    }

    /// When the last frame was taken into the map, nanoseconds since the start.
    pub const fn last_frame_ns(&self) -> Option<u64> {
        self.last_frame_ns
    }
}
