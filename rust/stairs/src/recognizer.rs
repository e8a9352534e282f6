//! The recognizer: from planes to stairs in the map.

use geometry::{Map, Pose, Robot};
use mapping::{Bevel, FloorView};
use segmentation::Planes;
use sensing::{Intrinsics, Scan};
use settings::{ConfigError, Table};

use crate::edges::fits::Fits;
use crate::edges::joints::{cut_off, join};
use crate::frame::extract::Extraction;
use crate::frame::view::PlanesView;
use crate::treads::memory::TreadMemory;
use crate::{CarryingSole, Stair, Staircase, StairsConfig};

/// Why a frame was not searched for stairs. The stairs are unchanged.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StairsError {
    /// A pose with a component that is no number.
    #[error("the robot's pose must be finite")]
    PoseNotFinite,
    /// The planes are those of another camera.
    #[error("planes must have {expected} pixels, got {found}")]
    WrongSize {
        /// Pixels of the camera.
        expected: usize,
        /// Pixels found.
        found: usize,
    },
}

/// Finds, merges and remembers stairs.
#[derive(Debug, Clone)]
pub struct Recognizer {
    config: StairsConfig,
    camera: Intrinsics,
    extraction: Extraction,
    memory: TreadMemory,
    fits: Fits,
    steps_taken: u64,
    /// The stairs as of the last frame.
    pub staircase: Staircase,
    /// Changes of height that are short slopes and no steps, as of the last frame.
    pub bevels: Vec<Bevel>,
}

impl Recognizer {
    /// Knows no stair yet.
    pub fn new(config: StairsConfig, camera: Intrinsics) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            camera,
            extraction: Extraction::default(),
            memory: TreadMemory::default(),
            fits: Fits::new(camera, &config.tuning),
            steps_taken: 0,
            staircase: Staircase::default(),
            bevels: Vec::new(),
            config,
        })
    }

    /// Drops what was seen: the robot found itself at another place than it had believed.
    pub fn forget(&mut self) {
        self.memory = TreadMemory::default();
        self.fits.forget();
        self.staircase = Staircase::default();
        self.bevels.clear();
    }

    /// Takes in a frame seen from `map_from_robot` after `steps_taken` steps in all. Frames whose planes are not reliable
    /// teach nothing.
    pub fn update(
        &mut self,
        scan: &Scan,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
        steps_taken: u64,
    ) -> Result<&Staircase, StairsError> {
        let isometry = &map_from_robot.inner;
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        if !finite(isometry.translation.vector.as_slice())
            || !finite(isometry.rotation.coords.as_slice())
        {
            return Err(StairsError::PoseNotFinite);
        }
        let expected = self.camera.width * self.camera.height;
        for found in [planes.points_in_robot_m.len(), planes.floor_height_m.len()] {
            if found != expected {
                return Err(StairsError::WrongSize { expected, found });
            }
        }
        let stepped = steps_taken.saturating_sub(self.steps_taken);
        if stepped > 0 {
            self.memory.step(stepped, &self.config);
            self.fits.step(stepped, &self.config);
            self.steps_taken = steps_taken;
        }
        let view = PlanesView::new(planes, self.camera, &self.config.tuning.view);
        if planes.reliable {
            self.extraction.read(planes, self.camera, &self.config);
            self.memory
                .see(&self.extraction.found, &view, map_from_robot, &self.config);
        }
        let stairs = &mut self.staircase.stairs;
        self.memory.stairs(&self.config, stairs);
        cut_off(stairs, &self.config);
        join(stairs, &self.config);
        self.fits.apply(stairs, &self.config.tuning.edges);
        if planes.reliable {
            let seen = (scan, planes);
            self.fits
                .see(seen, &view, stairs, map_from_robot, &self.config);
        }
        self.fits.apply(stairs, &self.config.tuning.edges);
        self.fits
            .sure(&mut self.staircase.edges, &self.config.tuning.edges.fits);
        self.fits
            .bevels(&mut self.bevels, &self.config.tuning.edges);
        sort_by_nearness(stairs, map_from_robot);
        self.staircase.frames = self.memory.frames;
        Ok(&self.staircase)
    }

    /// Takes in which sole carries the robot: on a slope it is tilted.
    pub fn stand_on(&mut self, sole: &CarryingSole) {
        self.fits.stand_on(sole, &self.config.tuning.edges);
    }

    /// Takes in where the map has slopes: what lies on them is no stair.
    pub fn leave_slopes(&mut self, floor: &FloorView) {
        self.memory.leave_slopes(floor, &self.config.tuning);
    }
}

/// Puts the stairs ahead before those behind, the nearest first along the walking direction.
fn sort_by_nearness(stairs: &mut [Stair<Map>], map_from_robot: &Pose<Map, Robot>) {
    let robot_from_map = map_from_robot.inverse();
    let ahead_m = |stair: &Stair<Map>| (robot_from_map * stair.reference).inner.x;
    stairs.sort_by(|a, b| {
        let (a_m, b_m) = (ahead_m(a), ahead_m(b));
        let behind = (a_m < 0.0).cmp(&(b_m < 0.0));
        behind.then(a_m.abs().total_cmp(&b_m.abs()))
    });
}
