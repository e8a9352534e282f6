//! Motors that sit elsewhere than on the joints that they turn: by gears or rods.

use robot::{Body, Follower, Side};

use crate::targets::JointTargets;

/// The motors of joints of the legs and the head that have none of their own.
#[derive(Debug, Clone)]
pub(crate) struct Drives(Vec<Follower>);

impl Drives {
    /// Those of a body. One motor for a joint of each leg is none of them: it is on one of the two.
    pub(crate) fn new(body: &Body) -> Self {
        let head = &body.description().head;
        let head = [&head.pan, &head.tilt].map(|name| {
            let name = name.as_ref()?;
            body.joint("head", name).ok()
        });
        let is_told = |joint: usize| {
            let mut sides = Side::BOTH.iter();
            head.contains(&Some(joint)) || sides.any(|&side| body.leg_joints(side).contains(&joint))
        };
        let ties = body.followers.iter();
        Self(
            ties.filter(|tie| is_told(tie.joint) && !is_told(tie.leader))
                .copied()
                .collect(),
        )
    }

    /// Writes what each has to do so that the joint that it turns gets where it is told to.
    pub(crate) fn turn(&self, targets: &mut JointTargets) {
        for tie in &self.0 {
            let angle_rad = targets.positions_rad[tie.joint];
            let speed_radps = targets.velocities_radps[tie.joint];
            targets.positions_rad[tie.leader] = tie.leader_rad(angle_rad);
            targets.velocities_radps[tie.leader] = speed_radps / tie.ratio;
        }
    }
}
