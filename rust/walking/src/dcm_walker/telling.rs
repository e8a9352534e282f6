//! What the walker `dcm` tells of itself, and how it is made by its name.

use behaviour::{Command, Gaze, Stepping};
use nalgebra::Vector2;
use robot::Side;
use settings::MakeError;

use super::DcmWalker;
use crate::walker::{Walker, WalkerPart, WalkerSenses};
use crate::{error::WalkError, met::Met, phase::GaitPhase, targets::JointTargets};

pub(crate) const PART: WalkerPart = WalkerPart {
    name: "dcm",
    about: "steps by the divergent component of motion, as `[gait]` of robot.toml says",
    source: Some("Englsberger, Ott and Albu-Schäffer 2015"),
    tables: &[],
    make: |needs| {
        let walker = DcmWalker::new(needs.body);
        let refused = |error: WalkError| MakeError::Text(format!("walker: {error}"));
        Ok(Box::new(walker.map_err(refused)?))
    },
};

impl Walker for DcmWalker {
    fn step(
        &mut self,
        command: &Command,
        senses: &WalkerSenses<'_>,
    ) -> Result<&JointTargets, WalkError> {
        self.targets(command, senses)
    }

    fn standing(&self) -> bool {
        self.gait.is_standing()
    }

    fn steps_taken(&self) -> u64 {
        self.gait.steps_taken
    }

    fn gaze(&self) -> Gaze {
        self.head.gaze()
    }

    fn takes_footsteps(&self) -> bool {
        true
    }

    fn stepping(&self) -> Stepping {
        self.gait.stepping()
    }

    fn met(&self) -> Option<Met> {
        self.met
    }

    fn on_slope(&self) -> [bool; 2] {
        let mut feet = self.gait.feet;
        if let GaitPhase::Single { swing, .. } = &self.gait.phase {
            feet[swing.side.index()] = swing.to;
        }
        feet.map(|foot| foot.gradient != Vector2::zeros())
    }

    fn on_uneven(&self) -> [bool; 2] {
        let on_slope = self.on_slope();
        Side::BOTH.map(|side| on_slope[side.index()] || self.gait.lies_on_what_it_met(side))
    }
}

impl DcmWalker {
    /// The foot that stands while the other moves; `None` while both carry.
    pub(crate) const fn support(&self) -> Option<Side> {
        match &self.gait.phase {
            GaitPhase::Single { swing, .. } => Some(swing.side.other()),
            GaitPhase::Standing | GaitPhase::Double { .. } => None,
        }
    }
}
