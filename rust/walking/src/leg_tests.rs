//! Claims about the inverse kinematics of a leg.

use super::*;
use crate::test_biped::{biped, description};
use nalgebra::Translation3;
use proptest::prelude::*;
use robot::LinkPoses;

fn sole_at(body: &Body, side: Side, angles: &[f64]) -> Isometry3<f64> {
    let mut all = vec![0.0; body.joint_count()];
    for (&joint, &angle) in body.leg_joints(side).iter().zip(angles) {
        all[joint] = angle;
    }
    let mut poses = LinkPoses::default();
    body.pose_links(&all, &mut poses).unwrap();
    body.torso_from_sole(&poses, side)
}

fn reachable() -> impl Strategy<Value = [f64; 6]> {
    (
        -0.6..0.6f64,
        -0.5..0.5f64,
        -1.4..0.6f64,
        0.1..2.2f64,
        -1.2..0.8f64,
        -0.5..0.5f64,
    )
        .prop_map(|(a, b, c, d, e, f)| [a, b, c, d, e, f])
}

proptest! {
    #[test]
    fn inverse_kinematics_finds_back_the_angles_of_any_reachable_pose(angles in reachable(), left in any::<bool>()) {
        let side = if left { Side::Left } else { Side::Right };
        let body = biped();
        let leg = LegSolver::new(&body, side, 0.9999, &LegTuning::default()).unwrap();
        let sole = sole_at(&body, side, &angles);
        let hip_in_sole = sole.inverse_transform_vector(&(leg.hip() - sole.translation.vector));
        prop_assume!(hip_in_sole.z > 0.06);
        let found = leg.solve(&sole, leg.rest_rad());
        prop_assert!(found.reached);
        for (a, b) in found.angles_rad.iter().zip(&angles) {
            prop_assert!((a - b).abs() < 1e-6, "{:?} became {:?}", angles, found.angles_rad);
        }
    }

    #[test]
    fn no_pose_gives_anything_but_finite_angles(
        xyz in prop::array::uniform3(-0.5..0.5f64),
        turn in prop::array::uniform3(-3.0..3.0f64),
    ) {
        let leg = LegSolver::new(&biped(), Side::Left, 0.985, &LegTuning::default()).unwrap();
        let rotation = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::from(turn));
        let pose = Isometry3::from_parts(Translation3::from(xyz), rotation);
        prop_assert!(leg.solve(&pose, leg.rest_rad()).angles_rad.iter().all(|angle| angle.is_finite()));
    }
}

#[test]
fn at_the_greatest_height_for_a_thigh_it_stretches_back_just_so_far() {
    let leg = LegSolver::new(&biped(), Side::Left, 0.9999, &LegTuning::default()).unwrap();
    for (back_m, aside_m) in [(0.11, 0.0), (0.13, 0.0), (0.12, 0.03)] {
        let rise_m = leg.stretched_m(back_m, aside_m, 0.45);
        let ankle_m = leg.ankle_height_m();
        let place = leg.hip() - Vector3::new(back_m, aside_m, rise_m + ankle_m);
        let found = leg.solve(
            &Isometry3::translation(place.x, place.y, place.z),
            leg.rest_rad(),
        );
        assert!(found.reached);
        assert!((found.angles_rad[2] - 0.45).abs() < 1e-6, "{found:?}");
    }
    assert!(leg.stretched_m(0.08, 0.0, 0.45).is_infinite());
}

#[test]
fn a_pose_out_of_reach_is_said_to_be_so() {
    let leg = LegSolver::new(&biped(), Side::Left, 0.985, &LegTuning::default()).unwrap();
    let far = Isometry3::translation(0.0, 0.0425, -0.4);
    let found = leg.solve(&far, leg.rest_rad());
    assert!(
        !found.reached && (0.1..0.2).contains(&found.short_m),
        "{found:?}"
    );
}

#[test]
fn a_leg_whose_yaw_axis_slants_forward_is_solved_otherwise_and_says_by_which_joint() {
    let mut slanting = description();
    slanting.links[1].joint.as_mut().unwrap().axis = [0.7, 0.0, -0.7];
    let (body, tuning) = (Body::new(slanting).unwrap(), LegTuning::default());
    let leg = LegSolver::new(&body, Side::Left, 0.985, &tuning).unwrap();
    let why = leg.not_closed().unwrap();
    assert!(why.contains("left_hip_yaw"), "{why}");
}

#[test]
fn a_leg_whose_hip_axes_do_not_meet_is_solved_otherwise() {
    let mut apart = description();
    apart.links[3].position = [0.02, 0.0, 0.0];
    let (body, tuning) = (Body::new(apart).unwrap(), LegTuning::default());
    let leg = LegSolver::new(&body, Side::Left, 0.985, &tuning).unwrap();
    let why = leg.not_closed().unwrap();
    assert!(why.contains("must meet"), "{why}");
}

#[test]
fn hip_axes_that_miss_each_other_by_a_tenth_of_a_millimetre_put_the_sole_that_near() {
    let mut apart = description();
    apart.links[3].position = [1e-4, 0.0, 0.0];
    let body = Body::new(apart).unwrap();
    let leg = LegSolver::new(&body, Side::Left, 0.985, &LegTuning::default()).unwrap();
    let wanted = Isometry3::translation(0.03, 0.05, -0.22);
    let found = leg.solve(&wanted, leg.rest_rad());
    assert!(found.reached);
    let sole = sole_at(&body, Side::Left, &found.angles_rad);
    let off = wanted.inverse() * sole;
    assert!(off.translation.vector.norm() < 2e-4, "{off}");
}
