//! Torques that hold a posture: what gravity and contact forces ask of the joints at rest.

use nalgebra::{Point3, Vector3};

use crate::{Body, LinkPoses};

impl Body {
    /// Adds to `torques` (N m, joint order) what `force` (N) does to each joint when it acts at `point` on `link`; point and
    /// force in the torso's frame. This is J^T f with the point's Jacobian; holding against it takes the opposite torques.
    pub fn add_force(
        &self,
        poses: &LinkPoses,
        link: usize,
        point: &Point3<f64>,
        force: &Vector3<f64>,
        torques: &mut [f64],
    ) {
        let mut at = Some(link);
        while let Some(index) = at {
            let link = &self.links[index];
            if let Some(hinge) = &link.hinge {
                let pose = &poses.torso_from_link[index];
                let arm = point - pose * Point3::from(hinge.anchor);
                let axis = pose.rotation * hinge.axis.into_inner();
                torques[hinge.index] += axis.dot(&arm.cross(force));
            }
            at = link.parent;
        }
    }

    /// Adds to `torques` (N m, joint order) what the weight of the links beyond each joint does to it, the root being held.
    /// `gravity_mps2` in the torso's frame: (0, 0, -9.81) when it is upright.
    pub fn add_gravity(&self, poses: &LinkPoses, gravity_mps2: &Vector3<f64>, torques: &mut [f64]) {
        for (index, link) in self.links.iter().enumerate() {
            let center = poses.torso_from_link[index] * link.center_of_mass;
            self.add_force(
                poses,
                index,
                &center,
                &(gravity_mps2 * link.mass_kg),
                torques,
            );
        }
    }

    /// Moves the links beyond a joint at 1 rad/s: velocity in m/s of `point` on `link`, in the torso's frame; zero where the
    /// joint does not carry the link. One column of the point's Jacobian.
    pub fn point_velocity(
        &self,
        poses: &LinkPoses,
        link: usize,
        point: &Point3<f64>,
        joint: usize,
    ) -> Vector3<f64> {
        let mut at = Some(link);
        while let Some(index) = at {
            let link = &self.links[index];
            if let Some(hinge) = link.hinge.as_ref().filter(|hinge| hinge.index == joint) {
                let pose = &poses.torso_from_link[index];
                let axis = pose.rotation * hinge.axis.into_inner();
                return axis.cross(&(point - pose * Point3::from(hinge.anchor)));
            }
            at = link.parent;
        }
        Vector3::zeros()
    }
}
