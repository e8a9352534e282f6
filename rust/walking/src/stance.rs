//! The upright stance of a body, from its description.

use geometry::PlanarPose;
use nalgebra::Vector3;
use robot::{Body, LinkPoses, Side};

use crate::WalkError;
use crate::gait::FootPose;
use crate::leg_geometry::LegGeometry;

/// How the robot stands when it does nothing; the origin is midway between the soles' centres.
#[derive(Debug, Clone)]
pub struct Stance {
    /// All joint angles, the arms at rest, rad.
    pub rest: Vec<f64>,
    /// The feet.
    pub feet: [FootPose; 2],
    /// Centre of mass, m.
    pub com: Vector3<f64>,
    /// Mean height of the hips' centres over the soles, m.
    pub hip_height_m: f64,
}

impl Stance {
    /// Reads it from the body.
    pub fn upright(body: &Body) -> Result<Self, WalkError> {
        let description = body.description();
        let mut rest = description.stand.clone();
        for (name, angle) in &description.arms_rest {
            rest[body.joint("arms.rest", name)?] = *angle;
        }
        let mut poses = LinkPoses::default();
        body.pose_links(&rest, &mut poses)?;
        let soles = Side::BOTH.map(|side| body.torso_from_sole(&poses, side).translation.vector);
        let middle = 0.5 * (soles[0] + soles[1]);
        let mut hip_height_m = 0.0;
        for side in Side::BOTH {
            hip_height_m += 0.5 * (LegGeometry::read(body, side)?.hip.z - middle.z);
        }
        Ok(Self {
            feet: soles.map(|sole| FootPose {
                planar: PlanarPose::new(sole.x - middle.x, sole.y - middle.y, 0.0),
                ..FootPose::default()
            }),
            com: body.center_of_mass_in_torso(&poses).coords - middle,
            rest,
            hip_height_m,
        })
    }

    /// Distance between the soles' centres, m.
    pub fn width_m(&self) -> f64 {
        self.feet[0].planar.distance_m(&self.feet[1].planar)
    }
}
