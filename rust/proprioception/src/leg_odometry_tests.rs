//! Levels that leg odometry measures.

use super::*;
use proptest::prelude::*;

#[test]
fn a_level_is_right_though_legs_give_way_under_load() {
    const SAG_M: f64 = 0.001;
    const RISE_M: f64 = 0.03;
    let config = ProprioceptionConfig::default();
    let mut contacts = FootContacts::new(65.0, &config);
    let mut odometry = LegOdometry::new();
    let legs = |soles_m: [f64; 2], left: f64| LegPosture {
        odometry_from_torso_rotation: UnitQuaternion::identity(),
        torso_from_sole: [(0.04, left), (-0.04, 1.0 - left)].map(|(y_m, share)| {
            let sole_m = if y_m > 0.0 { soles_m[0] } else { soles_m[1] };
            Isometry3::translation(0.0, y_m, sole_m - 0.2 - SAG_M * share)
        }),
        half_sole_m: 0.05,
    };
    odometry.start(&legs([0.0; 2], 0.5));
    let mut level_m = 0.0;
    // Onto the right foot, the left one up, onto it, the right one up, and onto both.
    for (soles_m, from, to) in [
        ([0.0, 0.0], 0.5, 0.0),
        ([RISE_M, 0.0], 0.0, 1.0),
        ([RISE_M, RISE_M], 1.0, 0.5),
    ] {
        for tick in 0..=100 {
            let left = from + (to - from) * f64::from(tick) / 100.0;
            let loads = [left, 1.0 - left].map(|share| [0.25 * 65.0 * share; 4]);
            contacts.update(&loads, &config);
            let robot = odometry.update(&legs(soles_m, left), &contacts, &config);
            level_m = robot.origin().inner.z;
        }
    }
    assert!((level_m - RISE_M).abs() < 2e-4, "{level_m}");
}

#[test]
fn a_heel_that_lifts_before_the_foot_lets_go_does_not_lower_the_other_level() {
    const RISE_M: f64 = 0.08;
    const HALF_M: f64 = 0.05;
    const LIFTED_RAD: f64 = 0.3;
    let config = ProprioceptionConfig::default();
    let mut contacts = FootContacts::new(65.0, &config);
    let mut odometry = LegOdometry::new();
    let legs = |left_m: f64, heel_rad: f64| {
        let edge = Translation3::new(HALF_M, 0.0, 0.0);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), heel_rad);
        LegPosture {
            odometry_from_torso_rotation: UnitQuaternion::identity(),
            torso_from_sole: [
                Isometry3::translation(0.1, 0.04, left_m - 0.2),
                Isometry3::translation(0.0, -0.04, -0.2) * edge * turn * edge.inverse(),
            ],
            half_sole_m: HALF_M,
        }
    };
    odometry.start(&legs(0.0, 0.0));
    let mut level_m = 0.0;
    for (left_m, heel_rad, share) in [
        (0.0, 0.0, 0.0),
        (-RISE_M, 0.0, 0.5),
        (-RISE_M, LIFTED_RAD, 0.8),
        (-RISE_M, LIFTED_RAD, 1.0),
    ] {
        for _ in 0..50 {
            let loads = [share, 1.0 - share].map(|share| [0.25 * 65.0 * share; 4]);
            contacts.update(&loads, &config);
            let robot = odometry.update(&legs(left_m, heel_rad), &contacts, &config);
            level_m = robot.origin().inner.z;
        }
    }
    assert!((level_m + RISE_M).abs() < 1e-3, "{level_m}");
}

#[test]
fn a_foot_that_leaves_level_ground_for_a_bevel_has_not_lifted_its_heel() {
    const RISE_M: f64 = 0.02;
    const BEVEL_RAD: f64 = 0.2;
    let config = ProprioceptionConfig::default();
    let mut contacts = FootContacts::new(65.0, &config);
    let mut odometry = LegOdometry::new();
    let legs = |left_m: f64, toes_up_rad: f64| LegPosture {
        odometry_from_torso_rotation: UnitQuaternion::identity(),
        torso_from_sole: [
            Isometry3::from_parts(
                Translation3::new(0.1, 0.04, left_m - 0.2),
                UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -toes_up_rad),
            ),
            Isometry3::translation(0.0, -0.04, -0.2),
        ],
        half_sole_m: 0.05,
    };
    odometry.start(&legs(0.0, 0.0));
    let mut level_m = 0.0;
    for (left_m, toes_up_rad, share) in [
        (0.0, 0.0, 0.0),
        (RISE_M, BEVEL_RAD, 0.5),
        (RISE_M, BEVEL_RAD, 1.0),
    ] {
        for _ in 0..50 {
            let loads = [share, 1.0 - share].map(|share| [0.25 * 65.0 * share; 4]);
            contacts.update(&loads, &config);
            let robot = odometry.update(&legs(left_m, toes_up_rad), &contacts, &config);
            level_m = robot.origin().inner.z;
        }
    }
    assert!((level_m - RISE_M).abs() < 1e-3, "{level_m}");
}

/// Height of the robot after steps, told or not told that they are a slope's: the left foot's first, then in turn. By the number of a step,
/// how high the soles are once it is taken, m.
fn level_m(on_slope: bool, steps: usize, soles_after_m: impl Fn(usize) -> [f64; 2]) -> f64 {
    let config = ProprioceptionConfig::default();
    let mut contacts = FootContacts::new(65.0, &config);
    let mut odometry = LegOdometry::new();
    let legs = |soles_m: [f64; 2]| LegPosture {
        odometry_from_torso_rotation: UnitQuaternion::identity(),
        torso_from_sole: [(0.04, soles_m[0]), (-0.04, soles_m[1])]
            .map(|(y_m, sole_m)| Isometry3::translation(0.0, y_m, sole_m - 0.2)),
        half_sole_m: 0.05,
    };
    odometry.start(&legs([0.0; 2]));
    let mut soles_m = [0.0; 2];
    let mut level_m = 0.0;
    for step in 0..steps {
        let side = step % 2;
        for lifted in [true, false] {
            if !lifted {
                soles_m = soles_after_m(step);
            }
            let mut shares = [1.0; 2];
            shares[side] = if lifted { 0.0 } else { 1.0 };
            for _ in 0..20 {
                odometry.on_slope = [on_slope; 2];
                contacts.update(&shares.map(|share| [0.12 * 65.0 * share; 4]), &config);
                let robot = odometry.update(&legs(soles_m), &contacts, &config);
                level_m = robot.origin().inner.z;
            }
        }
    }
    level_m
}

#[test]
fn small_steps_add_up_on_a_slope_and_are_none_on_level_ground() {
    const STEP_M: f64 = 0.005;
    let soles_after_m = |step: usize| {
        let mut soles_m = [STEP_M * step as f64; 2];
        soles_m[step % 2] += STEP_M;
        soles_m
    };
    let (sloped_m, level_m) = (
        level_m(true, 8, soles_after_m),
        level_m(false, 8, soles_after_m),
    );
    assert!((sloped_m - 0.0375).abs() < 1e-3, "{sloped_m}");
    assert!(level_m.abs() < 1e-9, "{level_m}");
}

proptest! {
    /// Who turned on the spot over a cable was 70 mm higher afterwards: a sole that lands on it sinks as it takes the load, from above the
    /// band in which two levels are one to below it.
    #[test]
    fn a_foot_that_lands_on_a_cable_again_and_again_does_not_climb(
        landed_m in 0.0..0.03f64, sinks_m in 0.0..0.003f64, steps in 5..40usize,
    ) {
        let right_m = [(landed_m - sinks_m).max(0.0), landed_m];
        let soles_after_m = |step: usize| [0.0, if step == 0 { 0.0 } else { right_m[step % 2] }];
        let level_m = level_m(false, steps, soles_after_m);
        prop_assert!(level_m > -1e-9 && level_m < landed_m + sinks_m + 1e-9, "{}", level_m);
    }
}
