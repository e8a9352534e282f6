//! Pushes, jolts and starts as the robot that catches pushes feels them.

use super::*;
use crate::phase::GaitReference;
use crate::relief::Relief;
use crate::support::Soles;
use crate::test_biped::{biped, config, foot_at, on_its_way};
use nalgebra::{Vector2, Vector3};
use proptest::prelude::*;

const OMEGA: f64 = 6.0;
const TICK_S: f64 = 0.01;

struct Robot {
    gait: Gait,
    catching: Catching,
    soles: Soles,
    /// Share of the weight that the feet carry.
    carried: f64,
}

impl Robot {
    fn new(gait: Gait) -> Self {
        let (config, body) = (config(), biped());
        let planner = FootstepPlanner::new(&config, &body);
        Self {
            gait,
            catching: Catching::new(&config, planner),
            soles: Soles::new(&body, config.sole_margin),
            carried: 1.0,
        }
    }

    fn standing() -> Self {
        let (config, body) = (config(), biped());
        let feet = [foot_at(0.0, 0.0425), foot_at(0.0, -0.0425)];
        Self::new(Gait::new(
            &config,
            FootstepPlanner::new(&config, &body),
            feet,
        ))
    }

    /// The left foot is in the air, a third of its time behind it.
    fn stepping(manner: Manner) -> Self {
        let left = foot_at(0.0, 0.0425);
        let swing = Swing::new(Side::Left, manner, left, left);
        Self::new(on_its_way(swing, foot_at(0.0, -0.0425), 0.3))
    }

    /// So many ticks with this error of the divergent component of motion; the rate of the last.
    fn feels(&mut self, ticks: usize, x_m: f64, y_m: f64) -> Option<f64> {
        let mut rate = None;
        for _ in 0..ticks {
            let task = Task::Stand(Relief::LEVEL);
            let GaitReference { dcm, .. } = self.gait.reference(OMEGA, task);
            let falling = Falling {
                dcm: dcm + Vector2::new(x_m, y_m),
                com: dcm,
                reference: dcm,
                omega: OMEGA,
                soles: &self.soles,
                task,
                loads_n: [0.0; 2],
                carried: self.carried,
                soles_m: Side::BOTH.map(|side| {
                    let foot = self.gait.foot(side);
                    Vector3::new(foot.planar.x_m, foot.planar.y_m, foot.z_m)
                }),
                passed_s: TICK_S,
            };
            rate = self.catching.step(&mut self.gait, &falling);
        }
        rate
    }

    fn swing(&self) -> Option<Swing> {
        match self.gait.phase {
            GaitPhase::Single { swing, .. } => Some(swing),
            _ => None,
        }
    }
}

proptest! {
    #[test]
    fn a_robot_that_is_not_pushed_is_left_alone(
        errors in prop::collection::vec((-0.02..0.02f64, -0.02..0.02f64), 1..80),
    ) {
        for mut robot in [Robot::standing(), Robot::stepping(Manner::Walk)] {
            let before = robot.gait.phase;
            for (x_m, y_m) in &errors {
                prop_assert_eq!(robot.feels(1, *x_m, *y_m), None);
            }
            prop_assert_eq!(robot.gait.phase, before);
        }
    }

    #[test]
    fn a_push_from_a_stand_is_caught_by_a_step_its_way_and_within_reach(
        size_m in 0.06..0.12f64, ahead in any::<bool>(),
    ) {
        let x_m = if ahead { size_m } else { -size_m };
        let mut robot = Robot::standing();
        let _ = robot.feels(50, 0.0, 0.0);
        let _ = robot.feels(6, x_m, 0.0);
        let swing = robot.swing().unwrap();
        prop_assert!(swing.to.planar.x_m * x_m.signum() > 0.02, "{:?}", swing.to);
        let along_m = config().tuning.catching.along * config().hip_height;
        prop_assert!(swing.to.planar.x_m.abs() <= along_m + 1e-9);
        let apart_m = (swing.to.planar.y_m + swing.side.sign() * 0.0425).abs();
        prop_assert!(apart_m >= 0.075, "{apart_m}");
    }
}

#[test]
fn a_jolt_is_no_push_and_neither_is_a_start() {
    let mut robot = Robot::standing();
    let _ = robot.feels(50, 0.0, 0.0);
    assert_eq!(robot.feels(2, 0.1, 0.0), None);
    assert_eq!(robot.feels(50, 0.0, 0.0), None);
    assert_eq!(Robot::standing().feels(50, 0.1, 0.0), None);
}

#[test]
fn a_robot_that_its_own_leg_has_lifted_is_not_taken_to_be_pushed() {
    let caught = |carried: f64| {
        let mut config = config();
        config.tuning.catching.carried = 0.7;
        let mut robot = Robot::standing();
        robot.catching = Catching::new(&config, FootstepPlanner::new(&config, &biped()));
        let _ = robot.feels(50, 0.0, 0.0);
        robot.carried = carried;
        robot.feels(6, 0.1, 0.0)
    };
    assert_eq!(caught(0.4), None);
    assert!(caught(0.9).is_some());
}

#[test]
fn what_both_feet_hold_is_no_reason_to_step() {
    let mut robot = Robot::standing();
    let _ = robot.feels(50, 0.0, 0.0);
    assert_eq!(robot.feels(50, 0.0, 0.06), Some(1.0));
    assert!(robot.gait.is_standing());
    assert_eq!(robot.feels(50, 0.0, 0.0), None);
}

#[test]
fn a_push_to_the_foot_in_the_air_widens_its_step_and_hurries_it() {
    let mut robot = Robot::stepping(Manner::Walk);
    let _ = robot.feels(50, 0.0, 0.0);
    let rate = robot.feels(10, 0.0, 0.05).unwrap();
    assert!(rate > 1.0, "{rate}");
    assert!(robot.swing().unwrap().to.planar.y_m > 0.06);
}

#[test]
fn over_the_outer_edge_the_foot_in_the_air_goes_out_and_waits_but_not_for_ever() {
    let mut robot = Robot::stepping(Manner::Walk);
    let _ = robot.feels(50, 0.0, 0.0);
    let hurries = config().tuning.catching.out_rate;
    assert_eq!(robot.feels(8, 0.0, -0.12), Some(hurries));
    let weigh_m = config().tuning.catching.weigh * config().hip_height;
    let swing = robot.swing().unwrap();
    assert!(swing.to.planar.y_m > 0.0425 + 0.4 * weigh_m);
    assert!(swing.to.z_m > 0.02, "{}", swing.to.z_m);
    if let GaitPhase::Single {
        elapsed_s,
        duration_s,
        ..
    } = &mut robot.gait.phase
    {
        *elapsed_s = 0.6 * *duration_s;
    }
    assert_eq!(robot.feels(5, 0.0, -0.12), Some(0.0));
    let patience = (config().capture_patience / TICK_S) as usize;
    assert!(robot.feels(patience + 2, 0.0, -0.12).unwrap() > 0.0);
}

#[test]
fn over_the_outer_edge_the_torso_rolls_to_where_the_robot_falls_and_comes_back() {
    let most_rad = config().tuning.catching.roll;
    for (mut robot, y_m, to_right) in [
        (Robot::stepping(Manner::Walk), -0.12, 1.0),
        (Robot::stepping(Manner::Walk), 0.05, 0.0),
    ] {
        let _ = robot.feels(50, 0.0, 0.0);
        assert_eq!(robot.catching.roll_rad(), 0.0);
        let _ = robot.feels(20, 0.0, y_m);
        let rolled_rad = robot.catching.roll_rad();
        assert!(
            (rolled_rad - to_right * most_rad).abs() < 1e-9,
            "{rolled_rad}"
        );
        let _ = robot.feels(100, 0.0, 0.0);
        assert_eq!(robot.catching.roll_rad(), 0.0);
    }
}

#[test]
fn a_foot_that_touches_the_ground_lands_where_it_is() {
    let mut robot = Robot::stepping(Manner::Walk);
    let _ = robot.feels(50, 0.0, 0.0);
    let _ = robot.feels(5, 0.0, 0.05);
    if let GaitPhase::Single {
        elapsed_s,
        duration_s,
        ..
    } = &mut robot.gait.phase
    {
        *elapsed_s = 0.7 * *duration_s;
    }
    let task = Task::Stand(Relief::LEVEL);
    let reference = robot.gait.reference(OMEGA, task).dcm;
    let falling = Falling {
        dcm: reference + Vector2::new(0.0, 0.05),
        com: reference,
        reference,
        omega: OMEGA,
        soles: &robot.soles,
        task,
        loads_n: [20.0, 40.0],
        carried: 1.0,
        soles_m: [Vector3::new(0.013, 0.071, 0.0), Vector3::zeros()],
        passed_s: TICK_S,
    };
    let rate = robot.catching.step(&mut robot.gait, &falling).unwrap();
    robot
        .gait
        .advance(rate * TICK_S, task, &crate::felt::KnownGround::AsTold);
    let landed = robot.gait.feet[0].planar;
    assert_eq!((landed.x_m, landed.y_m), (0.013, 0.071));
}

#[test]
fn steps_of_a_list_are_left_where_they_were_told() {
    for manner in [Manner::Careful, Manner::Placed] {
        let mut robot = Robot::stepping(manner);
        let before = robot.gait.phase;
        assert_eq!(robot.feels(50, 0.0, 0.0), None);
        assert_eq!(robot.feels(50, 0.08, 0.08), None);
        assert_eq!(robot.gait.phase, before);
    }
}
