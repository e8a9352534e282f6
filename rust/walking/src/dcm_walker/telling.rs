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
    /// DEBUG
    pub fn debug(&self) -> String {
        let d = self.balance.dcm() * 1e3;
        let e = (self.balance.dcm() - self.reference.dcm) * 1e3;
        let ph = match &self.gait.phase {
            GaitPhase::Standing => "stand".to_owned(),
            GaitPhase::Double { elapsed_s, duration_s, next, .. } => format!("D {:.2}/{:.2} {:?}", elapsed_s, duration_s, next.map(|n| n.side)),
            GaitPhase::Single { elapsed_s, duration_s, swing } => format!("S {:.2}/{:.2} {:?} {:?} to {:.0} {:.0} (pl {:.0} {:.0})", elapsed_s, duration_s, swing.side, swing.manner, swing.to.planar.x_m*1e3, swing.to.planar.y_m*1e3, swing.planned.planar.x_m*1e3, swing.planned.planar.y_m*1e3),
        };
        format!("xi {:.0} {:.0} err {:.0} {:.0} zmp {:.0} {:.0} {} {}", d.x, d.y, e.x, e.y, self.pressure.zmp.x*1e3, self.pressure.zmp.y*1e3, if self.catching.is_active() {"CATCH"} else {""}, ph)
    }

    /// The foot that stands while the other moves; `None` while both carry.
    pub(crate) const fn support(&self) -> Option<Side> {
        match &self.gait.phase {
            GaitPhase::Single { swing, .. } => Some(swing.side.other()),
            GaitPhase::Standing | GaitPhase::Double { .. } => None,
        }
    }
}
