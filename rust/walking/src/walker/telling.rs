//! What a walker tells of itself.

use behaviour::{Gaze, Stepping};
use nalgebra::Vector2;
use robot::Side;

use super::Walker;
use crate::{met::Met, phase::GaitPhase, tuning::ReliefTuning};

impl Walker {
    /// Whether it stands still on both soles.
    pub fn standing(&self) -> bool {
        self.gait.is_standing()
    }

    /// Distance between the soles' centres when it stands, m.
    pub const fn stance_width_m(&self) -> f64 {
        self.config.stance_width
    }

    /// How slopes of the ground are asked for.
    pub const fn relief_tuning(&self) -> &ReliefTuning {
        &self.config.tuning.relief
    }

    /// Landings so far.
    pub const fn steps_taken(&self) -> u64 {
        self.gait.steps_taken
    }

    /// How the listed footsteps go.
    pub fn stepping(&self) -> Stepping {
        self.gait.stepping()
    }

    /// What a foot of a walk met at the last tick, in the robot's frame.
    pub const fn met(&self) -> Option<Met> {
        self.met
    }

    /// The foot that stands while the other moves; `None` while both carry.
    pub const fn support(&self) -> Option<Side> {
        match &self.gait.phase {
            GaitPhase::Single { swing, .. } => Some(swing.side.other()),
            GaitPhase::Standing | GaitPhase::Double { .. } => None,
        }
    }

    /// Whether each foot stands, or is to land, on a slope.
    pub fn on_slope(&self) -> [bool; 2] {
        let mut feet = self.gait.feet;
        if let GaitPhase::Single { swing, .. } = &self.gait.phase {
            feet[swing.side.index()] = swing.to;
        }
        feet.map(|foot| foot.gradient != Vector2::zeros())
    }

    /// Whether each foot stands, or is to land, on a slope or where a foot met something: such a sole turns under the robot.
    pub fn on_uneven(&self) -> [bool; 2] {
        let on_slope = self.on_slope();
        Side::BOTH.map(|side| on_slope[side.index()] || self.gait.lies_on_what_it_met(side))
    }

    /// Where the head was told to look at the last tick.
    pub fn gaze(&self) -> Gaze {
        self.head.gaze()
    }
}
