//! What the walker promises, in a world where joints follow their targets at once.

use behaviour::{Footstep, Gaze, Motion, StepManner, Velocity};
use geometry::PlanarPose;
use nalgebra::Vector3;
use proptest::prelude::*;

use super::*;
use crate::phase::GaitPhase;
use crate::test_biped::{Ideal, biped, config, description};
use crate::walker::Walker;

fn walk(x_mps: f64, y_mps: f64, yaw_radps: f64) -> Command {
    Command {
        motion: Motion::Walk(Velocity {
            x_mps,
            y_mps,
            yaw_radps,
        }),
        ..Command::default()
    }
}

fn stand() -> Command {
    Command::default()
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -0.5..0.5f64,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(-1e300),
    ]
}

fn any_command() -> impl Strategy<Value = Command> {
    let either = (any::<bool>(), any::<bool>());
    let step = (any_number(), any_number(), any_number(), either).prop_map(
        |(x_m, y_m, yaw_rad, (left, walked))| Footstep {
            side: if left { Side::Left } else { Side::Right },
            manner: if walked {
                StepManner::Walked
            } else {
                StepManner::Careful
            },
            pose: PlanarPose::new(x_m, y_m, yaw_rad),
            height_m: 0.0,
            slope: [0.0; 2],
            bearing_m: [-0.0525, 0.0525],
        },
    );
    let motion = prop_oneof![
        Just(Motion::Stand),
        (any_number(), any_number(), any_number()).prop_map(|(x_mps, y_mps, yaw_radps)| {
            Motion::Walk(Velocity {
                x_mps,
                y_mps,
                yaw_radps,
            })
        }),
        prop::collection::vec(step, 0..4).prop_map(Motion::Footsteps),
    ];
    (motion, any_number(), any_number()).prop_map(|(motion, pan_rad, down_rad)| Command {
        motion,
        gaze: Gaze { pan_rad, down_rad },
        ..Command::default()
    })
}

fn soles(world: &Ideal) -> [nalgebra::Isometry3<f64>; 2] {
    let links = world.links();
    Side::BOTH.map(|side| world.body.torso_from_sole(&links, side))
}

/// The foot that makes the first step of a walk that turns.
fn first_swing(yaw_radps: f64, carries_first: Option<Side>) -> Side {
    let mut world = Ideal::new();
    let command = Command {
        carries_first,
        ..walk(0.0, 0.0, yaw_radps)
    };
    loop {
        world.tick(&command);
        if let GaitPhase::Single { swing, .. } = world.walker.gait.phase {
            return swing.side;
        }
    }
}

#[test]
fn the_first_step_is_that_of_the_foot_that_turns_outward_unless_told_which_carries() {
    assert_eq!(first_swing(0.3, None), Side::Left);
    assert_eq!(first_swing(-0.3, None), Side::Right);
    for yaw_radps in [-0.3, 0.3] {
        assert_eq!(first_swing(yaw_radps, Some(Side::Left)), Side::Right);
        assert_eq!(first_swing(yaw_radps, Some(Side::Right)), Side::Left);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_command_gives_a_target_that_is_no_number(commands in prop::collection::vec((any_command(), 1..80usize), 1..8)) {
        let mut world = Ideal::new();
        for (command, ticks) in commands {
            for _ in 0..ticks {
                world.tick(&command);
                let targets = &world.targets;
                for values in [&targets.positions_rad, &targets.velocities_radps, &targets.torques_nm] {
                    prop_assert!(values.iter().all(|value| value.is_finite()));
                }
            }
        }
    }

    #[test]
    fn it_comes_to_stand_side_by_side_from_any_point_of_a_step(
        x in -0.1..0.15f64, y in -0.1..0.1f64, yaw in -0.5..0.5f64, ticks in 1..400usize,
    ) {
        let mut world = Ideal::new();
        for _ in 0..ticks {
            world.tick(&walk(x, y, yaw));
        }
        for _ in 0..400 {
            world.tick(&stand());
        }
        prop_assert!(world.walker.standing());
        let [left, right] = soles(&world);
        let apart = left.translation.vector - right.translation.vector;
        let width = config().stance_width;
        prop_assert!((apart - Vector3::new(0.0, width, 0.0)).norm() < 0.015, "{apart}");
    }

    #[test]
    fn feet_move_without_a_jump(x in -0.1..0.15f64, y in -0.1..0.1f64, yaw in -0.5..0.5f64) {
        let mut world = Ideal::new();
        let mut before = soles(&world);
        for _ in 0..300 {
            world.tick(&walk(x, y, yaw));
            let now = soles(&world);
            for (before, now) in before.iter().zip(&now) {
                let speed = (now.translation.vector - before.translation.vector).norm() / 0.01;
                prop_assert!(speed < 1.5, "a sole moves with {speed} m/s against the torso");
            }
            before = now;
        }
    }
}

#[test]
fn standing_it_keeps_the_stance_with_its_weight_over_the_feet() {
    let mut world = Ideal::new();
    for _ in 0..200 {
        world.tick(&stand());
    }
    assert!(world.walker.standing());
    assert_eq!(world.walker.steps_taken(), 0);
    let links = world.links();
    let [left, right] = soles(&world);
    let middle = 0.5 * (left.translation.vector + right.translation.vector);
    let com = world.body.center_of_mass_in_torso(&links).coords - middle;
    assert!(com.xy().norm() < 1e-4, "{com}");
    for side in Side::BOTH {
        for &joint in world.body.leg_joints(side) {
            let turned = world.targets.positions_rad[joint] - world.body.description().stand[joint];
            assert!(turned.abs() < 0.12, "joint {joint} turned by {turned}");
        }
    }
    assert!(left.rotation.angle() < 1e-6 && right.rotation.angle() < 1e-6);
}

#[test]
fn walking_forward_takes_steps_of_the_right_length() {
    let mut world = Ideal::new();
    for _ in 0..1000 {
        world.tick(&walk(0.1, 0.0, 0.0));
    }
    let steps = world.walker.steps_taken();
    let place = Gait::center_of(&world.walker.gait.feet).x_m;
    let step = 0.1 * config().step_time;
    assert!(steps > 10);
    assert!(
        (place - step * (steps as f64 - 0.5)).abs() < 1e-6,
        "{place} after {steps}"
    );
}

#[test]
fn listed_footsteps_are_taken_and_then_it_stands() {
    let steps = vec![
        Footstep {
            side: Side::Left,
            manner: StepManner::Careful,
            pose: PlanarPose::new(0.05, 0.045, 0.0),
            height_m: 0.0,
            slope: [0.0; 2],
            bearing_m: [-0.0525, 0.0525],
        },
        Footstep {
            side: Side::Right,
            manner: StepManner::Careful,
            pose: PlanarPose::new(0.05, -0.045, 0.0),
            height_m: 0.0,
            slope: [0.0; 2],
            bearing_m: [-0.0525, 0.0525],
        },
    ];
    let command = Command {
        motion: Motion::Footsteps(steps.clone()),
        ..Command::default()
    };
    let mut world = Ideal::new();
    for _ in 0..400 {
        world.tick(&command);
    }
    assert!(world.walker.standing());
    assert_eq!(world.walker.steps_taken(), 2);
    for (foot, step) in world.walker.gait.feet.iter().zip(&steps) {
        assert!(foot.planar.distance_m(&step.pose) < 1e-9);
    }
}

#[test]
fn the_camera_looks_where_the_command_says() {
    let mut world = Ideal::new();
    let command = Command {
        motion: Motion::Stand,
        gaze: Gaze {
            pan_rad: 0.4,
            down_rad: 0.6,
        },
        ..Command::default()
    };
    let before = world.walker.gaze();
    world.tick(&command);
    let most = config().gaze_speed * 0.01 + 1e-9;
    assert!((world.walker.gaze().pan_rad - before.pan_rad).abs() <= most);
    for _ in 0..100 {
        world.tick(&command);
    }
    let axis = world.body.torso_from_camera(&world.links()).inner.rotation * Vector3::z();
    assert!((libm::atan2(axis.y, axis.x) - 0.4).abs() < 1e-9);
    assert!((-libm::asin(axis.z) - 0.6).abs() < 1e-9);
}

#[test]
fn a_bad_setting_is_refused_by_its_key() {
    for (key, value, message) in [
        (
            "step_time",
            0.0,
            "gait.step_time must be > 0 and <= 60, got 0",
        ),
        (
            "dcm_gain",
            0.5,
            "gait.dcm_gain must be > 1 and < 100, got 0.5",
        ),
        (
            "double_support",
            0.9,
            "gait.double_support must be < step_time (0.5), got 0.9",
        ),
    ] {
        let mut bad = description();
        bad.gait = serde_json::json!({ key: value });
        let error = DcmWalker::new(&Body::new(bad).unwrap()).unwrap_err();
        assert_eq!(error.to_string(), message);
    }
    let mut unknown = description();
    unknown.gait = serde_json::json!({ "step_tim": 0.5 });
    let error = DcmWalker::new(&Body::new(unknown).unwrap()).unwrap_err();
    assert!(error.to_string().contains("step_tim"), "{error}");
}

#[test]
fn at_rest_the_torques_carry_the_weight() {
    let mut world = Ideal::new();
    for _ in 0..50 {
        world.tick(&stand());
    }
    let knee = biped().leg_joints(Side::Left)[3];
    let torque = world.targets.torques_nm[knee];
    assert!(
        torque.abs() > 0.3,
        "a bent knee carries half the robot, got {torque}"
    );
    let roll = biped().leg_joints(Side::Left)[1];
    let mirrored = biped().leg_joints(Side::Right)[1];
    let sum = world.targets.torques_nm[roll] + world.targets.torques_nm[mirrored];
    assert!(sum.abs() < 1e-6, "both sides carry alike, got {sum}");
}
