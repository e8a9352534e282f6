//! Claims about proprioception, tried on synthetic walks.

use super::*;
use geometry::{PlanarPose, angle_between};
use proptest::prelude::*;
use testkit::{TICK_NS, Walk, biped};

fn run(walk: &Walk) -> Vec<BodyState> {
    let mut proprioception =
        Proprioception::new(&walk.body, ProprioceptionConfig::default()).unwrap();
    walk.observations
        .iter()
        .map(|o| proprioception.update(o).unwrap().clone())
        .collect()
}

fn error_m(state: &BodyState, truth: &PlanarPose) -> f64 {
    let is = state.odometry_from_robot.inner.translation.vector;
    geometry::hypot(is.x - truth.x_m, is.y - truth.y_m)
}

#[test]
fn two_metres_of_perfect_sensors_are_measured_to_a_millimetre() {
    let walk = Walk::new().stand(100).walk(50, 0.04, 0.0).stand(20);
    let states = run(&walk);
    let truth = walk.truth.last().unwrap().0;
    assert!(truth.x_m > 1.9);
    let last = states.last().unwrap();
    assert!(
        error_m(last, &truth) < 1e-3,
        "{:?}",
        last.odometry_from_robot
    );
    assert_eq!(last.odometry_from_robot.inner.translation.z, 0.0);
}

#[test]
fn a_quarter_turn_is_measured_all_along() {
    let walk = Walk::new().stand(100).walk(16, 0.01, 0.1).stand(20);
    for (state, (truth, _)) in run(&walk).iter().zip(&walk.truth) {
        assert!(error_m(state, truth) < 1e-3);
        let yaw_error = angle_between(truth.yaw_rad, state.odometry_from_robot.yaw_rad());
        assert!(yaw_error.abs() < 1e-3, "{yaw_error}");
    }
}

#[test]
fn the_robots_frame_never_jumps_on_level_ground() {
    let walk = Walk::new().stand(50).walk(12, 0.03, 0.05);
    for pair in run(&walk).windows(2) {
        let [before, after] = pair else { continue };
        let moved = after.odometry_from_robot.inner.translation.vector
            - before.odometry_from_robot.inner.translation.vector;
        assert!(moved.norm() < 3e-3, "{} at {}", moved.norm(), after.time_ns);
    }
}

#[test]
fn a_step_up_and_down_is_taken_from_the_kinematics() {
    let up = PlanarPose::new(0.04, 0.0425, 0.0);
    let walk = Walk::new()
        .stand(300)
        .step(Side::Left, up, 0.03)
        .step(Side::Right, PlanarPose::new(0.04, -0.0425, 0.0), 0.03)
        .stand(10);
    let height = |states: &[BodyState]| states.last().unwrap().odometry_from_robot.origin().inner.z;
    let climbed_m = height(&run(&walk));
    assert!((climbed_m - 0.03).abs() < 1e-4, "{climbed_m}");
    let walk = walk
        .step(Side::Left, PlanarPose::new(0.08, 0.0425, 0.0), 0.0)
        .step(Side::Right, PlanarPose::new(0.08, -0.0425, 0.0), 0.0)
        .stand(10);
    let left_m = height(&run(&walk));
    assert!(left_m.abs() < 1e-4, "{left_m}");
}

#[test]
fn a_robot_that_rocks_as_it_is_put_down_stays_where_it_was_put() {
    let mut walk = Walk::new().stand(100);
    for (tick, observation) in walk.observations.iter_mut().enumerate().take(40).skip(2) {
        // All the load goes to one foot, then to the other, while the attitude is not known yet.
        let (load_n, roll_rad) = if tick < 20 {
            ([20.0, 0.0], 0.3)
        } else {
            ([0.0, 20.0], -0.3)
        };
        observation.foot_forces_n = load_n.map(|corner_n| [corner_n; 4]);
        let tilted = UnitQuaternion::from_euler_angles(roll_rad, 0.0, 0.0);
        let felt = tilted * Vector3::from(observation.specific_force_mps2);
        observation.specific_force_mps2 = felt.into();
    }
    for state in run(&walk) {
        let height_m = state.odometry_from_robot.origin().inner.z;
        assert!(height_m.abs() < 1e-4, "{height_m} at {}", state.time_ns);
    }
}

#[test]
fn a_trunk_encoder_that_is_off_neither_bends_the_way_nor_lets_it_climb() {
    let mut walk = Walk::new().stand(200).walk(30, 0.04, 0.0);
    for observation in &mut walk.observations {
        observation.joint_positions_rad[12] += 0.025;
    }
    let states = run(&walk);
    let (truth, _) = walk.truth.last().unwrap();
    let last = states.last().unwrap();
    assert!(error_m(last, truth) < 2e-3);
    assert_eq!(last.odometry_from_robot.origin().inner.z, 0.0);
    let up = last.odometry_from_torso_rotation * Vector3::z();
    assert!(up.angle(&Vector3::z()) < 0.012);
}

#[test]
fn a_biased_gyroscope_is_unmasked_by_standing() {
    let mut walk = Walk::new().stand(200).walk(50, 0.04, 0.0);
    for observation in &mut walk.observations {
        observation.angular_velocity_radps[2] += 0.000_87;
    }
    let states = run(&walk);
    let yaw_rad = states.last().unwrap().odometry_from_robot.yaw_rad();
    assert!(yaw_rad.abs() < 0.005, "{yaw_rad}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn standing_leaves_the_pose_as_it_is(seed in 0..1000u32) {
        let mut walk = Walk::new().stand(300);
        let mut random = seed;
        for observation in &mut walk.observations {
            for value in observation.joint_positions_rad.iter_mut()
                .chain(&mut observation.angular_velocity_radps)
                .chain(observation.foot_forces_n.as_flattened_mut()) {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let noise = f64::from(random >> 8) / f64::from(1 << 24) - 0.5;
                *value += noise * if *value > 2.0 { 1.0 } else { 0.001 };
            }
        }
        let states = run(&walk);
        let pose = states.last().unwrap().odometry_from_robot;
        prop_assert!(pose.inner.translation.vector.norm() < 1e-3);
        prop_assert!(pose.yaw_rad().abs() < 1e-3);
    }
}

#[test]
fn who_stands_is_still_also_by_rates_that_are_not_smoothed() {
    let config = ProprioceptionConfig {
        still_filter_time: 0.0,
        ..ProprioceptionConfig::default()
    };
    let walk = Walk::new().stand(100);
    let mut proprioception = Proprioception::new(&walk.body, config).unwrap();
    for observation in &walk.observations {
        let _ = proprioception.update(observation).unwrap();
    }
    assert!(proprioception.is_still());
}

#[test]
fn the_torso_stands_over_the_robots_frame() {
    let walk = Walk::new().stand(20);
    let state = run(&walk).pop().unwrap();
    let torso = state.robot_from_torso.origin().inner;
    assert!(torso.x.abs() < 1e-9 && torso.y.abs() < 1e-9);
    assert!((torso.z - 0.2).abs() < 1e-9);
}

#[test]
fn a_bad_observation_is_refused_and_changes_nothing() {
    let walk = Walk::new().stand(3);
    let mut proprioception =
        Proprioception::new(&biped(), ProprioceptionConfig::default()).unwrap();
    let _ = proprioception.update(&walk.observations[1]).unwrap();
    let before = format!("{proprioception:?}");
    let back = proprioception.update(&walk.observations[0]).unwrap_err();
    assert_eq!(
        back.to_string(),
        format!("time must advance: 0 ns came after {TICK_NS} ns")
    );
    let mut short = walk.observations[2].clone();
    let _ = short.joint_positions_rad.pop();
    assert!(proprioception.update(&short).is_err());
    let mut nan = walk.observations[2].clone();
    nan.specific_force_mps2[1] = f64::NAN;
    assert!(proprioception.update(&nan).is_err());
    assert_eq!(format!("{proprioception:?}"), before);
    assert!(proprioception.update(&walk.observations[2]).is_ok());
}
