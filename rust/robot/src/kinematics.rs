//! Forward kinematics: the pose of every link in the root's frame.

use std::collections::BTreeMap;

use geometry::{Camera, Pose, Torso};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use crate::links::{Follower, Link, build_links, find, find_followers, isometry};
use crate::{BodyError, Description, LEAST_LEG_JOINTS, MOST_LEG_JOINTS, Side};

/// A robot's body, ready to compute with. The frame of all results is [`Torso`]: the root link.
#[derive(Debug, Clone)]
pub struct Body {
    description: Description,
    pub(crate) links: Vec<Link>,
    link_index: BTreeMap<String, usize>,
    joint_index: BTreeMap<String, usize>,
    leg_joints: [Vec<usize>; 2],
    /// Joints without a motor of their own, each with the one whose motor turns it too.
    pub followers: Vec<Follower>,
    sole_links: [usize; 2],
    link_from_sole: [Isometry3<f64>; 2],
    camera_link: usize,
    link_from_camera: Isometry3<f64>,
    imu_link: usize,
    link_from_imu: Isometry3<f64>,
}

/// The pose of every link in the torso's frame, in the order of the description's links.
#[derive(Debug, Clone, Default)]
pub struct LinkPoses {
    /// `torso_from_link`, one a link.
    pub torso_from_link: Vec<Isometry3<f64>>,
}

impl Body {
    /// Checks a description and prepares it.
    pub fn new(description: Description) -> Result<Self, BodyError> {
        description.check_size()?;
        let joint_index: BTreeMap<_, _> = description
            .joints
            .iter()
            .enumerate()
            .map(|(i, name)| (name.clone(), i))
            .collect();
        let link_index: BTreeMap<_, _> = description
            .links
            .iter()
            .enumerate()
            .map(|(i, link)| (link.name.clone(), i))
            .collect();
        let links = build_links(&description, &joint_index)?;
        let followers = find_followers(&description, &joint_index)?;
        let leg = |side: Side| description.legs.get(side);
        let mut leg_joints = [Vec::new(), Vec::new()];
        let mut sole_links = [0; 2];
        let mut link_from_sole = [Isometry3::identity(); 2];
        for side in Side::BOTH {
            let joints = &leg(side).joints;
            if !(LEAST_LEG_JOINTS..=MOST_LEG_JOINTS).contains(&joints.len()) {
                return Err(BodyError::BadValue {
                    what: format!("legs: joints of the {side:?} leg"),
                    allowed: "5 to 7",
                    found: joints.len().to_string(),
                });
            }
            leg_joints[side.index()] = (joints.iter())
                .map(|name| find(&joint_index, "joint", "legs", name))
                .collect::<Result<_, _>>()?;
            sole_links[side.index()] = find(&link_index, "link", "sole", &leg(side).sole.link)?;
            link_from_sole[side.index()] = isometry(leg(side).sole.position, [1.0, 0.0, 0.0, 0.0]);
        }
        if description.stand.len() != description.joints.len() {
            return Err(BodyError::WrongJointCount {
                expected: description.joints.len(),
                found: description.stand.len(),
            });
        }
        let camera_link = find(&link_index, "link", "camera", &description.camera.link)?;
        let imu_link = find(&link_index, "link", "imu", &description.imu.link)?;
        Ok(Self {
            link_from_camera: isometry(description.camera.position, description.camera.orientation),
            link_from_imu: isometry(description.imu.position, description.imu.orientation),
            camera_link,
            imu_link,
            leg_joints,
            followers,
            sole_links,
            link_from_sole,
            links,
            link_index,
            joint_index,
            description,
        })
    }

    /// What it was made from.
    pub const fn description(&self) -> &Description {
        &self.description
    }

    /// Number of joints.
    pub fn joint_count(&self) -> usize {
        self.description.joints.len()
    }

    /// Index of a joint by its name; `role` says who asks, for the error.
    pub fn joint(&self, role: &str, name: &str) -> Result<usize, BodyError> {
        find(&self.joint_index, "joint", role, name)
    }

    /// Index of a link by its name; `role` says who asks, for the error.
    pub fn link(&self, role: &str, name: &str) -> Result<usize, BodyError> {
        find(&self.link_index, "link", role, name)
    }

    /// Joint indices of a leg, from the hip down.
    pub fn leg_joints(&self, side: Side) -> &[usize] {
        &self.leg_joints[side.index()]
    }

    /// The link that a joint turns, by the joint's index, with what is known of the joint.
    pub fn hinge(&self, joint: usize) -> Option<(usize, &crate::JointDescription)> {
        let turned = |link: &Link| {
            link.hinge
                .as_ref()
                .is_some_and(|hinge| hinge.index == joint)
        };
        let link = self.links.iter().position(turned)?;
        Some((link, self.description.links[link].joint.as_ref()?))
    }

    /// Index of the link that carries the sole.
    pub const fn sole_link(&self, side: Side) -> usize {
        self.sole_links[side.index()]
    }

    /// Fills `poses` with the pose of every link at these joint angles (rad, joint order). Allocates on the first call only.
    pub fn pose_links(
        &self,
        joint_positions_rad: &[f64],
        poses: &mut LinkPoses,
    ) -> Result<(), BodyError> {
        if joint_positions_rad.len() != self.joint_count() {
            return Err(BodyError::WrongJointCount {
                expected: self.joint_count(),
                found: joint_positions_rad.len(),
            });
        }
        poses.torso_from_link.clear();
        for link in &self.links {
            let Some(parent) = link.parent else {
                poses.torso_from_link.push(Isometry3::identity());
                continue;
            };
            let mut pose = poses.torso_from_link[parent] * link.parent_from_link_at_zero;
            if let Some(hinge) = &link.hinge {
                let turn =
                    UnitQuaternion::from_axis_angle(&hinge.axis, joint_positions_rad[hinge.index]);
                let shift = hinge.anchor - turn * hinge.anchor;
                pose *= Isometry3::from_parts(Translation3::from(shift), turn);
            }
            poses.torso_from_link.push(pose);
        }
        Ok(())
    }

    /// Pose of a sole in the torso.
    pub fn torso_from_sole(&self, poses: &LinkPoses, side: Side) -> Isometry3<f64> {
        poses.torso_from_link[self.sole_links[side.index()]] * self.link_from_sole[side.index()]
    }

    /// Pose of the camera's optical frame in the torso.
    pub fn torso_from_camera(&self, poses: &LinkPoses) -> Pose<Torso, Camera> {
        Pose::wrap(poses.torso_from_link[self.camera_link] * self.link_from_camera)
    }

    /// Pose of the inertial measurement unit in the torso.
    pub fn torso_from_imu(&self, poses: &LinkPoses) -> Isometry3<f64> {
        poses.torso_from_link[self.imu_link] * self.link_from_imu
    }

    /// Whole mass, kg.
    pub fn mass_kg(&self) -> f64 {
        self.links.iter().map(|link| link.mass_kg).sum()
    }

    /// Centre of mass of the whole body in the torso's frame.
    pub fn center_of_mass_in_torso(&self, poses: &LinkPoses) -> Point3<f64> {
        let mut sum = Vector3::zeros();
        for (link, pose) in self.links.iter().zip(&poses.torso_from_link) {
            sum += (pose * link.center_of_mass).coords * link.mass_kg;
        }
        Point3::from(sum / self.mass_kg())
    }
}
