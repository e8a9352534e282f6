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
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A chain of three links with hinges about z, y and x.
    fn chain() -> Body {
        let link = |name: &str, parent: Option<usize>, axis: Option<[f64; 3]>| {
            serde_json::json!({
                "name": name, "parent": parent, "position": [0.05, 0.02, 0.1],
                "orientation": [1.0, 0.0, 0.0, 0.0], "mass": 1.5, "center_of_mass": [0.1, -0.03, 0.02],
                "inertia": [1e-3, 1e-3, 1e-3, 0.0, 0.0, 0.0],
                "joint": axis.map(|axis| serde_json::json!({
                    "name": name, "axis": axis, "anchor": [0.01, 0.0, 0.0], "range": [-3.0, 3.0],
                    "peak_torque": 1.0, "no_load_speed": 1.0, "kp": 1.0, "kv": 1.0,
                })),
            })
        };
        let leg = serde_json::json!({
            "joints": ["a", "b", "c", "a", "b", "c"],
            "sole": {"link": "c", "position": [0.0, 0.0, 0.0], "length": 0.1, "width": 0.1},
        });
        let description = serde_json::json!({
            "name": "chain", "joints": ["a", "b", "c"], "stand": [0.0, 0.0, 0.0], "torso": "root",
            "links": [link("root", None, None), link("a", Some(0), Some([0.0, 0.0, 1.0])),
                      link("b", Some(1), Some([0.0, 1.0, 0.0])), link("c", Some(2), Some([1.0, 0.0, 0.0]))],
            "legs": {"left": leg, "right": leg},
            "head": {"pan": "a", "tilt": "b"}, "arms_rest": {},
            "imu": {"link": "root", "position": [0.0, 0.0, 0.0], "orientation": [1.0, 0.0, 0.0, 0.0]},
            "camera": {"link": "root", "position": [0.0, 0.0, 0.0], "orientation": [1.0, 0.0, 0.0, 0.0],
                       "width": 8, "height": 8, "focal": 8.0, "period": 0.1,
                       "stereo": {"baseline": 0.1, "window": 5, "quantum": 0.1, "min_disparity": 1.0, "max_disparity": 9.0}},
            "body": {"radius": 0.1, "height": 0.5},
        });
        Body::new(serde_json::from_value(description).unwrap()).unwrap()
    }

    fn poses(body: &Body, angles: &[f64]) -> LinkPoses {
        let mut poses = LinkPoses::default();
        body.pose_links(angles, &mut poses).unwrap();
        poses
    }

    proptest! {
        #[test]
        fn gravity_torques_are_the_slope_of_the_potential_energy(angles in prop::array::uniform3(-1.5..1.5f64)) {
            let body = chain();
            let gravity = Vector3::new(0.5, -1.0, -9.81);
            let energy = |angles: &[f64]| {
                -body.mass_kg() * gravity.dot(&body.center_of_mass_in_torso(&poses(&body, angles)).coords)
            };
            let mut torques = [0.0; 3];
            body.add_gravity(&poses(&body, &angles), &gravity, &mut torques);
            for joint in 0..3 {
                let shifted = |by: f64| {
                    let mut angles = angles;
                    angles[joint] += by;
                    energy(&angles)
                };
                let slope = (shifted(1e-6) - shifted(-1e-6)) / 2e-6;
                prop_assert!((torques[joint] + slope).abs() < 1e-6);
            }
        }

        #[test]
        fn a_force_does_the_work_that_its_point_moves(angles in prop::array::uniform3(-1.5..1.5f64),
                                                      force in prop::array::uniform3(-5.0..5.0f64)) {
            let body = chain();
            let force = Vector3::from(force);
            let point = |angles: &[f64]| poses(&body, angles).torso_from_link[3] * Point3::new(0.1, 0.2, 0.3);
            let mut torques = [0.0; 3];
            body.add_force(&poses(&body, &angles), 3, &point(&angles), &force, &mut torques);
            for (joint, torque) in torques.iter().enumerate() {
                let shifted = |by: f64| {
                    let mut angles = angles;
                    angles[joint] += by;
                    point(&angles)
                };
                let velocity = (shifted(1e-6) - shifted(-1e-6)) / 2e-6;
                prop_assert!((torque - velocity.dot(&force)).abs() < 1e-6);
            }
        }
    }
}
