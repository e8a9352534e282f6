//! What legs with slanting yaw axes and one motor for both promise.

use behaviour::{Command, Motion, Velocity};
use proptest::prelude::*;
use robot::LinkPoses;

use super::*;
use crate::test_biped::{Ideal, biped, shared_hip_description};
use crate::tuning::LegTuning;
use crate::walker::Walker;

fn body() -> Body {
    Body::new(shared_hip_description()).unwrap()
}

fn legs(body: &Body) -> [LegSolver; 2] {
    Side::BOTH.map(|side| LegSolver::new(body, side, 0.9999, &LegTuning::default()).unwrap())
}

fn rest(legs: &[LegSolver; 2]) -> [[f64; MOST_LEG_JOINTS]; 2] {
    [0, 1].map(|index: usize| *legs[index].rest_rad())
}

fn of_six(angles: [f64; 6]) -> [f64; MOST_LEG_JOINTS] {
    let [a, b, c, d, e, f] = angles;
    [a, b, c, d, e, f, 0.0]
}

fn soles_at(body: &Body, angles: &[[f64; MOST_LEG_JOINTS]; 2]) -> [Isometry3<f64>; 2] {
    let mut all = vec![0.0; body.joint_count()];
    for side in Side::BOTH {
        for (&joint, &angle) in body.leg_joints(side).iter().zip(&angles[side.index()]) {
            all[joint] = angle;
        }
    }
    let mut poses = LinkPoses::default();
    body.pose_links(&all, &mut poses).unwrap();
    Side::BOTH.map(|side| body.torso_from_sole(&poses, side))
}

/// A sole about where one is while the robot walks.
fn sole() -> impl Strategy<Value = (f64, f64, f64, [f64; 3])> {
    let tilt = [-0.1..0.1f64, -0.1..0.1f64, -0.3..0.3f64];
    (-0.06..0.06f64, -0.02..0.04f64, -0.23..-0.17f64, tilt)
}

fn placed([left, right]: [(f64, f64, f64, [f64; 3]); 2]) -> [Isometry3<f64>; 2] {
    [(left, 1.0), (right, -1.0)].map(|((x, outward, z, [roll, pitch, yaw]), sign)| {
        let place = Translation3::new(x, sign * (0.0425 + outward), z);
        Isometry3::from_parts(place, UnitQuaternion::from_euler_angles(roll, pitch, yaw))
    })
}

fn assert_same(found: &Isometry3<f64>, wanted: &Isometry3<f64>) -> Result<(), TestCaseError> {
    let apart = wanted.inverse() * found;
    prop_assert!(apart.translation.vector.norm() < 1e-6, "{apart}");
    prop_assert!(apart.rotation.angle() < 1e-6, "{apart}");
    Ok(())
}

proptest! {
    #[test]
    fn a_leg_with_a_slanting_yaw_axis_finds_back_the_angles_of_any_reachable_pose(
        angles in [-0.5..0.5f64, -0.3..0.3f64, -1.2..0.3f64, 0.1..2.0f64, -1.0..0.6f64, -0.4..0.4f64],
    ) {
        let body = body();
        let soles = soles_at(&body, &[of_six(angles); 2]);
        for (leg, sole) in legs(&body).iter().zip(&soles) {
            let hip_in_sole = sole.inverse_transform_vector(&(leg.hip() - sole.translation.vector));
            prop_assume!(hip_in_sole.z > 0.06);
            let found = leg.solve(sole, leg.rest_rad());
            prop_assert!(found.reached);
            for (a, b) in found.angles_rad.iter().zip(&angles) {
                prop_assert!((a - b).abs() < 1e-6, "{:?} became {:?}", angles, found.angles_rad);
            }
        }
    }

    #[test]
    fn with_the_yaw_joint_held_the_ankle_and_the_soles_normal_are_where_they_should_be(
        soles in [sole(), sole()], yaw in -0.4..0.4f64,
    ) {
        let (body, wanted) = (body(), placed(soles));
        let legs = legs(&body);
        let found = [0, 1].map(|index| legs[index].solve_turned(&wanted[index], 0, yaw, legs[index].rest_rad()));
        let reached = soles_at(&body, &found.map(|leg| leg.angles_rad));
        for (index, (reached, wanted)) in reached.iter().zip(&wanted).enumerate() {
            prop_assert!(found[index].reached);
            prop_assert!((found[index].angles_rad[0] - yaw).abs() < 1e-12);
            let ankle = nalgebra::Point3::new(0.0, 0.0, 0.045);
            prop_assert!((reached * ankle - wanted * ankle).norm() < 1e-9);
            let normals = [reached, wanted].map(|sole| sole.rotation * Vector3::z());
            prop_assert!((normals[0] - normals[1]).norm() < 1e-9);
        }
    }

    #[test]
    fn the_torso_turns_until_one_angle_serves_both_soles(soles in [sole(), sole()]) {
        let (body, wanted) = (body(), placed(soles));
        let legs = legs(&body);
        let shared = SharedHip::read(&body, &legs, &SharedHipTuning::default()).unwrap().unwrap();
        let about = Point3::new(0.01, 0.02, 0.1);
        let agreed = shared.agree(&legs, &wanted, &about, &rest(&legs));
        let [left, right] = agreed.legs;
        prop_assert!(left.reached && right.reached);
        prop_assert_eq!(left.angles_rad[0], right.angles_rad[0]);
        let turned = turn_back(&about, agreed.turn_rad);
        let reached = soles_at(&body, &agreed.legs.map(|leg| leg.angles_rad));
        for (reached, wanted) in reached.iter().zip(&wanted) {
            assert_same(reached, &(turned * wanted))?;
        }
    }
}

#[test]
fn soles_turned_out_by_the_same_angle_leave_the_torso_as_it_is() {
    let body = body();
    let legs = legs(&body);
    let shared = SharedHip::read(&body, &legs, &SharedHipTuning::default())
        .unwrap()
        .unwrap();
    let soles = placed([
        (0.0, 0.0, -0.2, [0.0, 0.0, 0.2]),
        (0.0, 0.0, -0.2, [0.0, 0.0, -0.2]),
    ]);
    let agreed = shared.agree(&legs, &soles, &Point3::origin(), &rest(&legs));
    assert!(agreed.turn_rad.abs() < 1e-12);
    assert!(agreed.legs[0].angles_rad[0] < -0.2);
}

#[test]
fn legs_with_motors_of_their_own_share_nothing() {
    let body = biped();
    assert!(
        SharedHip::read(&body, &legs(&body), &SharedHipTuning::default())
            .unwrap()
            .is_none()
    );
}

#[test]
fn one_motor_that_turns_both_legs_to_the_same_side_is_refused() {
    let mut same = shared_hip_description();
    same.links[7].joint.as_mut().unwrap().axis = [0.0, -1.0, -1.0];
    let body = Body::new(same).unwrap();
    let error = SharedHip::read(&body, &legs(&body), &SharedHipTuning::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("opposite sides"), "{error}");
}

#[test]
fn on_a_curve_both_hips_turn_alike_and_the_leaders_motor_bears_for_both() {
    let mut world = Ideal::of(body());
    let [leader, follower] = Side::BOTH.map(|side| world.body.leg_joints(side)[0]);
    let motion = Motion::Walk(Velocity {
        x_mps: 0.05,
        y_mps: 0.0,
        yaw_radps: 0.3,
    });
    let command = Command {
        motion,
        ..Command::default()
    };
    let mut widest_rad: f64 = 0.0;
    for _ in 0..600 {
        world.tick(&command);
        let targets = &world.targets;
        assert_eq!(
            targets.positions_rad[leader],
            targets.positions_rad[follower]
        );
        assert_eq!(targets.torques_nm[follower], 0.0);
        widest_rad = widest_rad.max(targets.positions_rad[leader].abs());
    }
    assert!(world.walker.steps_taken() > 5);
    assert!(widest_rad > 0.05, "{widest_rad}");
}
