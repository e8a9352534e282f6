//! How fast the trunk's joints turn the inertial measurement unit against the robot's root.

use nalgebra::Vector3;
use robot::{Body, LinkPoses};

use crate::tuning::MotionTuning;

/// A joint between the root and the inertial measurement unit.
#[derive(Debug, Clone, Copy)]
struct ChainJoint {
    link: usize,
    joint: usize,
    axis_in_link: Vector3<f64>,
}

/// The joints between the root and the inertial measurement unit.
#[derive(Debug, Clone)]
pub(crate) struct TrunkChain {
    chain: Vec<ChainJoint>,
    floor_radps: f64,
}

impl TrunkChain {
    pub(crate) fn new(body: &Body, tuning: &MotionTuning) -> Self {
        let description = body.description();
        let mut chain = Vec::new();
        let mut at = description
            .links
            .iter()
            .position(|link| link.name == description.imu.link);
        while let Some(index) = at {
            let link = &description.links[index];
            if let Some(joint) = &link.joint
                && let Ok(joint_index) = body.joint("imu", &joint.name)
            {
                chain.push(ChainJoint {
                    link: index,
                    joint: joint_index,
                    axis_in_link: Vector3::from(joint.axis).normalize(),
                });
            }
            at = link.parent;
        }
        Self {
            chain,
            floor_radps: tuning.joint_speed_floor,
        }
    }

    /// Angular velocity that the trunk's joints give the inertial measurement unit against the root, rad/s.
    pub(crate) fn rate_radps(
        &self,
        links: &LinkPoses,
        joint_velocities_radps: &[f64],
    ) -> Vector3<f64> {
        let floor_radps = self.floor_radps;
        self.chain
            .iter()
            .map(|part| {
                let speed = joint_velocities_radps[part.joint];
                let sure = (speed.abs() - floor_radps).max(0.0).copysign(speed);
                links.torso_from_link[part.link].rotation * part.axis_in_link * sure
            })
            .sum()
    }
}
