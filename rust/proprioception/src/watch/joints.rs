//! Claims: an encoder moves when its joint's target does; and a joint is near its target.

use robot::{Body, Side};
use sensing::SenseFault;

use super::repair::Repair;
use super::{Check, Finding, Lasting, Moment};

/// Since each encoder changed last: the least and the largest target.
#[derive(Debug, Clone)]
pub(super) struct Stuck {
    before_rad: Vec<f64>,
    targets_rad: Vec<[f64; 2]>,
    same: Vec<Lasting>,
}

impl Stuck {
    pub(super) fn new(body: &Body) -> Self {
        Self {
            before_rad: vec![f64::NAN; body.joint_count()],
            targets_rad: vec![[0.0; 2]; body.joint_count()],
            same: vec![Lasting::default(); body.joint_count()],
        }
    }
}

/// The joint's name.
fn name(body: &Body, joint: usize) -> String {
    let named = body.hinge(joint);
    named.map_or_else(|| joint.to_string(), |(_, hinge)| hinge.name.clone())
}

impl Check for Stuck {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let read_rad = &moment.observation.joint_positions_rad;
        let mut found = None;
        for (joint, (&told_rad, &now_rad)) in moment.told_rad.iter().zip(read_rad).enumerate() {
            let (before_rad, targets) = (&mut self.before_rad[joint], &mut self.targets_rad[joint]);
            let same = before_rad.to_bits() == now_rad.to_bits();
            if !same {
                *targets = [told_rad; 2];
            }
            let lasted_s = self.same[joint].count(same, moment.passed_s);
            *before_rad = now_rad;
            *targets = [targets[0].min(told_rad), targets[1].max(told_rad)];
            let moved = targets[1] - targets[0] > moment.config.stuck;
            if moved && lasted_s > moment.config.stuck_time && found.is_none() {
                found = Some(Finding {
                    fault: SenseFault::new(
                        format!("the encoder of {}", name(moment.body, joint)),
                        format!("is stuck at {now_rad:.3} rad"),
                    ),
                    repair: Repair::Nothing,
                });
            }
        }
        found
    }
}

/// How long each leg joint has been far from its target.
#[derive(Debug, Clone)]
pub(super) struct Weak {
    joints: Vec<(usize, Lasting)>,
}

impl Weak {
    pub(super) fn new(body: &Body) -> Self {
        let legs = Side::BOTH.map(|side| *body.leg_joints(side));
        let joints = legs.as_flattened().iter();
        Self {
            joints: joints.map(|&joint| (joint, Lasting::default())).collect(),
        }
    }
}

impl Check for Weak {
    fn look(&mut self, moment: &Moment<'_>) -> Option<Finding> {
        let mut found = None;
        for (joint, far) in &mut self.joints {
            let (Some(told_rad), Some(read_rad)) = (
                moment.told_rad.get(*joint),
                moment.observation.joint_positions_rad.get(*joint),
            ) else {
                continue;
            };
            let off_rad = (told_rad - read_rad).abs();
            let lasted_s = far.count(off_rad > moment.config.weak, moment.passed_s);
            if lasted_s > moment.config.weak_time && found.is_none() {
                found = Some(Finding {
                    fault: SenseFault::new(
                        format!("the motor of {}", name(moment.body, *joint)),
                        format!("is too weak: the joint is {off_rad:.2} rad from its target"),
                    ),
                    repair: Repair::Nothing,
                });
            }
        }
        found
    }
}
