//! Claims about the servos: within the motor's limits always, and stable with play.

use approx::assert_relative_eq;
use proptest::prelude::*;

use super::*;

const STEP_S: f64 = 0.002;
const PLAY_RAD: f64 = 0.005_236;

fn motor(kp: f64, kv: f64) -> Motor {
    Motor {
        kp,
        kv,
        peak_torque_nm: 6.0,
        stall_torque_nm: 8.5,
        no_load_speed_radps: 7.0,
        friction_nm: 0.0,
        inertia_kgm2: 0.0,
    }
}

fn rubbing() -> Servos {
    let motor = Motor {
        friction_nm: 0.05,
        inertia_kgm2: 0.008,
        ..motor(150.0, 3.0)
    };
    servo(motor, 0.0)
}

fn servo(motor: Motor, play_rad: f64) -> Servos {
    Servos::new(&[motor], play_rad, STEP_S, &ServoTuning::default()).unwrap()
}

fn ask(servo: &mut Servos, position_rad: f64, velocity_radps: f64, torque_nm: f64) {
    servo
        .command(&[position_rad], &[velocity_radps], &[torque_nm], &[0.0])
        .unwrap();
}

fn torque_nm(servo: &mut Servos, angle_rad: f64, speed_radps: f64) -> f64 {
    servo.torques(&[angle_rad], &[speed_radps]).sum()
}

proptest! {
    #[test]
    fn no_torque_is_outside_the_peak_or_the_torque_speed_line(
        asked in -1e6..1e6, feed in -1e6..1e6, angle in -3.0..3.0, speed in -50.0..50.0,
    ) {
        let mut servo = servo(motor(150.0, 3.0), PLAY_RAD);
        ask(&mut servo, asked, 0.0, feed);
        let torque = torque_nm(&mut servo, angle, speed);
        prop_assert!(torque.abs() <= 6.0);
        let line = (8.5 * (1.0 - speed.abs() / 7.0)).max(0.0);
        prop_assert!(torque * speed <= 0.0 || torque.abs() <= line + 1e-12);
    }

    #[test]
    fn friction_brakes_by_its_torque_at_most_and_drives_nothing(speed in -5.0..5.0) {
        let friction = torque_nm(&mut servo(motor(150.0, 3.0), 0.0), 0.0, speed) - torque_nm(&mut rubbing(), 0.0, speed);
        prop_assert!(friction.abs() <= 0.05 + 1e-12);
        prop_assert!(friction * speed >= 0.0);
        // The motor alone would turn the other way at once if more than its momentum were taken.
        prop_assert!((friction * STEP_S).abs() <= (0.008 * speed).abs() + 1e-15);
        prop_assert!(speed.abs() < 0.05 * STEP_S / 0.008 || (friction.abs() - 0.05).abs() < 1e-12);
    }

    #[test]
    fn the_encoder_leads_the_joint_by_half_the_play_at_most_and_with_the_torques_sign(torque in -6.0..6.0) {
        let mut servo = servo(motor(150.0, 3.0), PLAY_RAD);
        for _ in 0..100 {
            let lead = servo.lead_rad()[0];
            ask(&mut servo, lead, 0.0, torque);
            let _ = torque_nm(&mut servo, 0.0, 0.0);
            prop_assert!(lead.abs() <= 0.5 * PLAY_RAD);
            prop_assert!(lead * torque >= 0.0);
        }
        let lead = servo.lead_rad()[0];
        prop_assert!(torque.abs() <= 0.5 || (lead.abs() / (0.5 * PLAY_RAD) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_servo_with_any_play_brings_an_unloaded_joint_to_rest(
        kp in 5.0..300.0, inertia in 0.01..0.1, play in 0.0..0.03, start in -0.3..0.3,
    ) {
        let kv = 1.4 * f64::sqrt(kp * inertia);
        let mut servo = servo(motor(kp, kv), play);
        ask(&mut servo, 0.0, 0.0, 0.0);
        let (mut angle, mut speed) = (start, 0.0);
        for _ in 0..3000 {
            speed += STEP_S * torque_nm(&mut servo, angle, speed) / inertia;
            angle += STEP_S * speed;
        }
        prop_assert!(speed.abs() < 1e-3, "{speed}");
        prop_assert!(angle.abs() <= 0.5 * play + 1e-3, "{angle}");
    }
}

#[test]
fn at_the_no_load_speed_a_motor_can_only_brake() {
    let mut servo = servo(motor(150.0, 3.0), 0.0);
    ask(&mut servo, 10.0, 0.0, 0.0);
    assert_eq!(torque_nm(&mut servo, 0.0, 7.0), 0.0);
    assert_eq!(torque_nm(&mut servo, 0.0, -7.0), 6.0);
}

#[test]
fn a_motor_that_brakes_at_its_peak_is_helped_by_friction() {
    let mut servo = rubbing();
    ask(&mut servo, 10.0, 0.0, 0.0);
    assert_relative_eq!(torque_nm(&mut servo, 0.0, -3.0), 6.05, epsilon = 1e-12);
}

#[test]
fn without_play_and_within_limits_the_servo_is_its_formula() {
    let mut servo = servo(motor(150.0, 3.0), 0.0);
    ask(&mut servo, 0.51, 0.2, 0.7);
    assert_relative_eq!(
        torque_nm(&mut servo, 0.5, 0.1),
        150.0 * 0.01 + 3.0 * 0.1 + 0.7,
        epsilon = 1e-9
    );
}

#[test]
fn a_servo_holds_the_joint_off_by_its_encoders_offset() {
    let mut servo = servo(motor(150.0, 3.0), 0.0);
    servo.command(&[0.5], &[0.0], &[0.0], &[0.02]).unwrap();
    assert!(torque_nm(&mut servo, 0.48, 0.0).abs() < 1e-12);
}

#[test]
fn a_change_of_sign_loses_the_whole_play() {
    let mut servo = servo(motor(150.0, 3.0), PLAY_RAD);
    let mut leads = [0.0; 2];
    for (lead, torque) in leads.iter_mut().zip([4.0, -4.0]) {
        ask(&mut servo, 0.0, 0.0, torque);
        for _ in 0..100 {
            let _ = torque_nm(&mut servo, 0.0, 0.0);
        }
        *lead = servo.lead_rad()[0];
    }
    assert_relative_eq!(leads[0] - leads[1], PLAY_RAD, max_relative = 1e-6);
}

#[test]
fn targets_of_another_robot_are_refused() {
    let mut servo = servo(motor(150.0, 3.0), PLAY_RAD);
    let said = servo
        .command(&[0.0], &[0.0, 1.0], &[0.0], &[0.0])
        .unwrap_err();
    assert_eq!(
        said.to_string(),
        "velocity has 2 values, the robot has 1 joints"
    );
}

#[test]
fn a_weak_motor_gives_a_share_of_what_it_can_and_a_whole_one_all_again() {
    let mut servo = servo(motor(150.0, 3.0), 0.0);
    let gives = |servo: &mut Servos, asked_nm: f64| {
        ask(servo, 0.0, 0.0, asked_nm);
        torque_nm(servo, 0.0, 0.0)
    };
    servo.weaken(&[0.4]).unwrap();
    assert_relative_eq!(gives(&mut servo, 20.0), 2.4, epsilon = 1e-12);
    assert_relative_eq!(gives(&mut servo, -1.5), -1.5, epsilon = 1e-12);
    servo.weaken(&[1.0]).unwrap();
    assert_relative_eq!(gives(&mut servo, 20.0), 6.0, epsilon = 1e-12);
    assert!(servo.weaken(&[1.0, 1.0]).is_err());
}
