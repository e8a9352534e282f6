//! Claim: an encoder moves when its joint's target does.

use robot::Body;
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
