//! The upright stance of a body, from its description, and the gait that goes with it.

use geometry::{GRAVITY_MPS2, PlanarPose};
use nalgebra::Vector3;
use robot::{Body, LinkPoses, Side};
use settings::{Table, TableDescription, overlay};

use crate::ankle_bend::toes_up_rad;
use crate::config::GaitConfig;
use crate::error::WalkError;
use crate::leg::LegSolver;
use crate::phase::FootPose;
use crate::tuning::LegTuning;

/// How the robot stands when it does nothing; the origin is midway between the soles' centres.
#[derive(Debug, Clone)]
pub struct UprightStance {
    /// All joint angles, the arms at rest, rad.
    pub rest: Vec<f64>,
    /// The feet.
    pub feet: [FootPose; 2],
    /// Centre of mass, m.
    pub com: Vector3<f64>,
    /// Mean height of the hips' centres over the soles, m.
    pub hip_height_m: f64,
}

impl UprightStance {
    /// Reads the stance from the body.
    pub fn upright(body: &Body, tuning: &LegTuning) -> Result<Self, WalkError> {
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
            hip_height_m += 0.5 * (LegSolver::new(body, side, 1.0, tuning)?.hip().z - middle.z);
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

impl GaitConfig {
    /// Reads `[gait]` of a body, and its upright stance; what it does not say has the default of a body of that size. Width and height
    /// of the stance are those of the upright one unless given.
    pub fn read(body: &Body) -> Result<(Self, UprightStance), WalkError> {
        let table = &body.description().gait;
        let mut sized = TableDescription::of::<Self>().defaults_at(&body.description().size());
        if !table.is_null() {
            overlay(&mut sized, table);
        }
        let mut config =
            Self::read_as(Self::KEY, &sized).map_err(|error| WalkError::Form(error.to_string()))?;
        config.tuning.check()?;
        let stance = UprightStance::upright(body, &config.tuning.leg)?;
        if table.get("stance_width").is_none() {
            config.stance_width = stance.width_m();
        }
        if table.get("hip_height").is_none() {
            config.hip_height = stance.hip_height_m;
        }
        let toes_up_rad = toes_up_rad(body, &stance.rest, &config.tuning.leg)?;
        let omega = (GRAVITY_MPS2 / stance.com.z).sqrt();
        config.fit_soles(body, table, omega, toes_up_rad);
        config.check()?;
        Ok((config, stance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::{biped, description};
    use serde_json::json;

    #[test]
    fn a_hidden_number_is_set_alone_and_refused_by_its_key() {
        let read = |gait: serde_json::Value| {
            let mut described = description();
            described.gait = gait;
            GaitConfig::read(&Body::new(described).unwrap())
        };
        let (plain, _) = GaitConfig::read(&biped()).unwrap();
        let (other, _) = read(json!({"tuning": {"pelvis": {"late": 3.0}}})).unwrap();
        assert_eq!(
            (plain.tuning.pelvis.late, other.tuning.pelvis.late),
            (2.5, 3.0)
        );
        assert_eq!(plain.tuning.swing, other.tuning.swing);
        assert_eq!(plain.stance_width, other.stance_width);
        for (tuning, said) in [
            (
                json!({"pelvis": {"apart": 0.0}}),
                "gait.tuning.pelvis.apart must be > 0 and <= 60, got 0",
            ),
            (
                json!({"swing": {"rise": [0.4, 0.2]}}),
                "gait.tuning.swing.rise.0 must be < rise.1 (0.2), got 0.4",
            ),
            (
                json!({"preview": {"steps": 9}}),
                "gait.tuning.preview.steps must be from 1 to 8, got 9",
            ),
        ] {
            let error = read(json!({ "tuning": tuning })).unwrap_err();
            assert_eq!(error.to_string(), said);
        }
        let error = read(json!({"tuning": {"pelvis": {"lat": 3.0}}})).unwrap_err();
        assert!(error.to_string().contains("unknown field `lat`"), "{error}");
    }
}
