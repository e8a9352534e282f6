//! The arms: at rest while the legs walk, raised in joy (003, section V.D).

use behaviour::Arms;
use robot::Body;

use crate::{error::WalkError, swing::minimum_jerk, targets::JointTargets};

/// Moves the arms slowly between two postures.
#[derive(Debug, Clone)]
pub(crate) struct ArmsControl {
    joints: Vec<Joint>,
    time_s: f64,
    share: f64,
}

#[derive(Debug, Clone, Copy)]
struct Joint {
    index: usize,
    rest_rad: f64,
    raised_rad: f64,
}

impl ArmsControl {
    /// Arms at rest as in `rest_rad` (joint order); raised, the joints that the body names are elsewhere. The way takes `time_s`.
    pub(crate) fn new(body: &Body, rest_rad: &[f64], time_s: f64) -> Result<Self, WalkError> {
        let mut joints = Vec::new();
        for (name, &raised_rad) in &body.description().arms_raised {
            let index = body.joint("arms.raised", name)?;
            joints.push(Joint {
                index,
                rest_rad: rest_rad[index],
                raised_rad,
            });
        }
        Ok(Self {
            joints,
            time_s,
            share: 0.0,
        })
    }

    /// Moves them for `passed_s`; they are raised only while the robot stands. Writes angles and speeds of their joints.
    pub(crate) fn turn(
        &mut self,
        arms: Arms,
        standing: bool,
        passed_s: f64,
        targets: &mut JointTargets,
    ) {
        let most = passed_s / self.time_s;
        let step = match arms {
            Arms::AtRest => -most,
            Arms::Raised if standing => most,
            Arms::Raised => 0.0,
        };
        self.share = (self.share + step).clamp(0.0, 1.0);
        let along = minimum_jerk(self.share);
        for joint in &self.joints {
            let angle = joint.rest_rad + (joint.raised_rad - joint.rest_rad) * along;
            let before = targets.positions_rad[joint.index];
            targets.velocities_radps[joint.index] = (angle - before) / passed_s;
            targets.positions_rad[joint.index] = angle;
        }
    }
}
