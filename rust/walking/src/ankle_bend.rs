//! How far the ankles bend beyond the upright stance: less than a step asks for, and a heel lifts while the weight goes to another level.

use nalgebra::Vector3;
use robot::{Body, LinkPoses, Side};

use crate::error::WalkError;
use crate::leg::LegSolver;
use crate::tuning::LegTuning;

/// How much further than in the upright stance, with the joints at `rest_rad`, both ankles turn the toes up, rad.
pub(crate) fn toes_up_rad(
    body: &Body,
    rest_rad: &[f64],
    tuning: &LegTuning,
) -> Result<f64, WalkError> {
    let mut poses = LinkPoses::default();
    body.pose_links(rest_rad, &mut poses)?;
    let mut least_rad = f64::INFINITY;
    for side in Side::BOTH {
        let leg = LegSolver::new(body, side, 1.0, tuning)?;
        let below_knee = &leg.joints()[leg.knee_slot() + 1..];
        let pitches = below_knee.iter().filter_map(|&joint| {
            let (link, hinge) = body.hinge(joint)?;
            let axis = poses.torso_from_link[link].rotation * Vector3::from(hinge.axis).normalize();
            let [low_rad, high_rad] = hinge.range;
            let left_rad = if axis.y > 0.0 {
                rest_rad[joint] - low_rad
            } else {
                high_rad - rest_rad[joint]
            };
            Some((axis.y.abs(), left_rad))
        });
        let most = pitches.max_by(|one, other| one.0.total_cmp(&other.0));
        least_rad = least_rad.min(most.map_or(f64::INFINITY, |(_, left_rad)| left_rad));
    }
    Ok(least_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stance::UprightStance;
    use crate::test_biped::{config, description};

    #[test]
    fn the_ankle_that_bends_least_counts_whichever_way_its_axis_points() {
        let tuning = config().tuning.leg;
        let left_rad = |turned_round: bool, room_rad: f64| {
            let mut described = description();
            let name = "left_ankle_pitch";
            let at = described
                .joints
                .iter()
                .position(|joint| joint == name)
                .unwrap();
            let at_rad = described.stand[at];
            let mut joints = described
                .links
                .iter_mut()
                .filter_map(|link| link.joint.as_mut());
            let joint = joints.find(|joint| joint.name == name).unwrap();
            joint.range = [at_rad - room_rad, at_rad + 0.7];
            if turned_round {
                joint.axis = joint.axis.map(|part| -part);
                joint.range = [-at_rad - 0.7, -at_rad + room_rad];
                described.stand[at] = -at_rad;
            }
            let body = Body::new(described).unwrap();
            let rest = UprightStance::upright(&body, &tuning).unwrap().rest;
            toes_up_rad(&body, &rest, &tuning).unwrap()
        };
        for turned_round in [false, true] {
            assert!((left_rad(turned_round, 0.3) - 0.3).abs() < 1e-9);
            // Then it is the right one.
            assert!(left_rad(turned_round, 3.0) < 2.9);
        }
    }
}
