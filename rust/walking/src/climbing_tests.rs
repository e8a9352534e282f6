//! What the walker promises of listed footsteps, in a world where joints follow their targets at once.

use behaviour::{Footstep, Misstep, Motion, StepManner};
use geometry::PlanarPose;
use proptest::prelude::*;

use super::*;
use crate::phase::Bearing;
use crate::test_biped::{Ideal, config};
use crate::walker::Walker;

pub(super) const TREAD_M: f64 = 0.12;
pub(super) const HALF_SOLE_M: f64 = 0.0525;

pub(super) fn step(side: Side, x_m: f64, height_m: f64, bearing_m: [f64; 2]) -> Footstep {
    Footstep {
        side,
        manner: StepManner::Careful,
        pose: PlanarPose::new(x_m, side.sign() * 0.5 * config().stance_width, 0.0),
        height_m,
        slope: [0.0; 2],
        bearing_m,
    }
}

/// Both feet one tread forward.
pub(super) fn stair(height_m: f64) -> Vec<Footstep> {
    Side::BOTH
        .map(|side| step(side, TREAD_M, height_m, [-0.04, HALF_SOLE_M]))
        .to_vec()
}

pub(super) fn climb(steps: &[Footstep]) -> Command {
    Command {
        motion: Motion::Footsteps(steps.to_vec()),
        ..Command::default()
    }
}

/// Ticks until the list is behind the robot and it stands.
pub(super) fn run(world: &mut Ideal, command: &Command) {
    for _ in 0..1500 {
        world.tick(command);
        if world.walker.standing() && world.walker.list_is_over() {
            return;
        }
    }
    panic!("it goes on and on: {:?}", world.walker.stepping());
}

/// The fastest that a joint's target turns on the way through a command and the stand behind it, rad/s.
fn fastest_radps(world: &mut Ideal, command: &Command) -> f64 {
    let mut fastest_radps = 0.0_f64;
    for _ in 0..800 {
        let before = world.targets.positions_rad.clone();
        world.tick(command);
        for (before, now) in before.iter().zip(&world.targets.positions_rad) {
            fastest_radps = fastest_radps.max((now - before).abs() / TICK_S);
        }
    }
    fastest_radps
}

pub(super) fn heights(world: &Ideal) -> [f64; 2] {
    Side::BOTH.map(|side| world.walker.foot_in_plan(side).z_m)
}

#[test]
fn it_climbs_stair_after_stair_and_down_again() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| {
        let tread = ((x_m + 0.06) / TREAD_M).floor().clamp(0.0, 5.0);
        [0.0, 0.04, 0.08, 0.08, 0.04, 0.0][tread as usize]
    };
    let before = world.walker.steps_taken();
    for (stairs, height_m) in [(2, 0.04), (1, 0.0), (2, -0.04)] {
        for _ in 0..stairs {
            run(&mut world, &climb(&stair(height_m)));
            world.tick(&Command::default());
            assert_eq!(world.walker.stepping().landed, 2);
            assert_eq!(world.walker.stepping().misstep, None);
        }
    }
    assert_eq!(world.walker.steps_taken() - before, 10);
    for z_m in heights(&world) {
        assert!(z_m.abs() < 0.004, "{z_m}");
    }
}

#[test]
fn a_step_seen_wrong_is_stood_on_where_it_is() {
    for found_m in [0.022, 0.038] {
        let mut world = Ideal::new();
        world.ground_m = if found_m > 0.03 {
            |x_m, _| if x_m > 0.06 { 0.038 } else { 0.0 }
        } else {
            |x_m, _| if x_m > 0.06 { 0.022 } else { 0.0 }
        };
        let command = climb(&stair(0.03));
        while world.walker.stepping().landed == 0 {
            world.tick(&command);
        }
        let error_m = world.walker.stepping().height_error_m;
        assert!((error_m - (found_m - 0.03)).abs() < 0.002, "{error_m}");
        run(&mut world, &command);
        // The second foot is told the corrected height.
        assert!(world.walker.stepping().height_error_m.abs() < 0.002);
        for z_m in heights(&world) {
            assert!((z_m - found_m).abs() < 0.002, "{z_m}");
        }
    }
}

#[test]
fn a_foot_that_finds_no_ground_goes_back_and_the_list_is_given_up() {
    let mut world = Ideal::new();
    let before = *world.walker.foot_in_plan(Side::Left);
    let command = climb(&stair(0.05));
    run(&mut world, &command);
    let stepping = world.walker.stepping();
    assert_eq!(
        (stepping.landed, stepping.misstep),
        (0, Some(Misstep::NoGround))
    );
    let foot = world.walker.foot_in_plan(Side::Left);
    assert!(foot.planar.distance_m(&before.planar) < 1e-9 && foot.z_m.abs() < 0.002);
    for _ in 0..100 {
        world.tick(&command);
        assert!(world.walker.standing(), "the same list is not begun again");
    }
    world.ground_m = |x_m, _| if x_m > 0.06 { 0.03 } else { 0.0 };
    run(&mut world, &climb(&stair(0.03)));
    assert_eq!(world.walker.stepping().misstep, None);
    assert_eq!(world.walker.stepping().landed, 2);
}

/// The first foot met something and stands where it came from.
fn assert_went_back(world: &Ideal) {
    let stepping = world.walker.stepping();
    assert_eq!(
        (stepping.landed, stepping.misstep),
        (0, Some(Misstep::Obstructed))
    );
    assert!(heights(world).iter().all(|z_m| z_m.abs() < 0.002));
}

#[test]
fn a_foot_that_meets_something_on_its_way_goes_back() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| if x_m > 0.05 { 0.2 } else { 0.0 };
    run(&mut world, &climb(&stair(0.03)));
    assert_went_back(&world);
}

#[test]
fn a_foot_that_brushes_the_next_riser_comes_down_before_it() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| match x_m {
        // The centre of the sole cannot come nearer to its place than 4 mm.
        x_m if x_m > TREAD_M - 0.004 => 0.2,
        x_m if x_m > 0.06 => 0.03,
        _ => 0.0,
    };
    run(&mut world, &climb(&stair(0.03)));
    let stepping = world.walker.stepping();
    assert_eq!((stepping.landed, stepping.misstep), (2, None));
    for side in Side::BOTH {
        let foot = world.walker.foot_in_plan(side);
        let short_m = TREAD_M - foot.planar.x_m;
        assert!(
            (0.0..=0.01).contains(&short_m) && (foot.z_m - 0.03).abs() < 0.002,
            "{foot:?}"
        );
    }
}

#[test]
fn a_foot_that_goes_down_and_comes_to_stand_on_the_next_riser_goes_back() {
    let mut world = Ideal::new();
    // A basin too short for the foot: it is told the bottom and meets the far side's level.
    world.ground_beyond = vec![(0.03, -0.03), (0.11, 0.0)];
    run(&mut world, &climb(&stair(-0.03)));
    assert_went_back(&world);
}

/// Two steps taken for one: the toes meet the edge of the second one's tread, half a step above the level that was told.
#[test]
fn a_foot_that_meets_a_level_half_a_step_higher_than_told_goes_back() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| if x_m > 0.06 { 0.045 } else { 0.0 };
    run(&mut world, &climb(&stair(0.03)));
    assert_went_back(&world);
}

/// Forward on a tread that is too short: the toes come down on the edge of the next riser.
#[test]
fn a_foot_that_hangs_above_the_level_it_left_goes_back() {
    for (jammed_m, misstep) in [(0.009, Some(Misstep::Obstructed)), (0.003, None)] {
        let mut world = Ideal::new();
        world.ground_m = |_, _| 0.0;
        world.ground_beyond = vec![(0.02, jammed_m)];
        run(
            &mut world,
            &climb(&[step(Side::Left, 0.03, 0.0, [-0.04, HALF_SOLE_M])]),
        );
        assert_eq!(world.walker.stepping().misstep, misstep);
    }
}

#[test]
fn feet_push_only_where_they_bear_also_when_the_robot_then_stands() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| if x_m > 0.06 { 0.03 } else { 0.0 };
    let bearing_m = [-0.01, HALF_SOLE_M];
    let steps = Side::BOTH.map(|side| step(side, TREAD_M, 0.03, bearing_m));
    run(&mut world, &climb(&steps));
    for _ in 0..200 {
        world.tick(&Command::default());
        for side in Side::BOTH {
            let foot = world.walker.foot_in_plan(side).planar;
            let point = world.walker.pressure.point[side.index()];
            let (x_m, _) = foot.inverse().apply(point.x, point.y);
            assert!(x_m > bearing_m[0] && x_m < bearing_m[1], "{x_m}");
        }
    }
    let middle_m = 0.5 * (bearing_m[0] + bearing_m[1]);
    let com_m = world.walker.balance.com.x - TREAD_M;
    assert!((com_m - middle_m).abs() < 0.003, "{com_m}");
}

#[test]
fn a_foot_above_the_other_one_carries_further_forward() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| if x_m > 0.06 { 0.05 } else { 0.0 };
    let command = climb(&stair(0.05));
    let forward_m = |world: &Ideal, side| {
        let point = world.walker.gait.stance_point(side);
        let foot = world.walker.foot_in_plan(side).planar;
        foot.inverse().apply(point.x, point.y).0
    };
    while world.walker.stepping().landed == 0 {
        world.tick(&command);
    }
    let [left_m, right_m] = Side::BOTH.map(|side| world.walker.foot_in_plan(side).z_m);
    let middle_m = 0.5 * (HALF_SOLE_M - 0.04);
    let wanted_m = middle_m + config().support_forward * (left_m - right_m);
    assert!(wanted_m > middle_m + 0.005);
    assert!((forward_m(&world, Side::Left) - wanted_m).abs() < 1e-9);
    assert!(forward_m(&world, Side::Right).abs() < 1e-9);
    run(&mut world, &command);
    for side in Side::BOTH {
        assert!((forward_m(&world, side) - middle_m).abs() < 0.001);
    }
}

#[test]
fn a_foot_carries_where_it_is_told_to_within_the_middle_half_of_what_bears() {
    let mut described = crate::test_biped::description();
    described.gait = serde_json::json!({"support_ahead": -0.01});
    let world = Ideal::of(Body::new(described).unwrap());
    let feet = |bearing_m: [f64; 2]| {
        let mut feet = world.walker.gait.feet;
        let [from_m, to_m] = bearing_m;
        feet[0].bearing = Bearing { from_m, to_m };
        feet
    };
    for (bearing_m, wanted_m) in [
        ([-HALF_SOLE_M, HALF_SOLE_M], -0.01),
        ([-0.02, HALF_SOLE_M], -0.02 + 0.25 * (HALF_SOLE_M + 0.02)),
    ] {
        let feet = feet(bearing_m);
        let point = world.walker.gait.support_point(&feet, Side::Left);
        let (x, _) = feet[0].planar.inverse().apply(point.x, point.y);
        assert!((x - wanted_m).abs() < 1e-9, "{x} {wanted_m}");
    }
}

#[test]
fn arms_are_raised_slowly_and_lowered_again() {
    let mut world = Ideal::new();
    let raised = Command {
        arms: behaviour::Arms::Raised,
        ..Command::default()
    };
    let pan = world.body.joint("test", "left_arm").unwrap();
    let mut before = world.targets.positions_rad[pan];
    for _ in 0..300 {
        world.tick(&raised);
        let now = world.targets.positions_rad[pan];
        assert!((now - before).abs() < 0.04);
        before = now;
    }
    assert_eq!(before, -2.0);
    for _ in 0..300 {
        world.tick(&Command::default());
    }
    assert_eq!(world.targets.positions_rad[pan], 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_joint_is_told_to_turn_faster_than_its_motor_on_any_stair(
        height_m in -0.05..0.05f64, x_m in 0.0..0.13f64, error_m in -0.008..0.008f64,
    ) {
        let mut world = Ideal::new();
        world.ground_beyond = vec![(0.5 * x_m, height_m + error_m)];
        let steps = Side::BOTH.map(|side| step(side, x_m, height_m, [-0.03, 0.04]));
        let fastest_radps = fastest_radps(&mut world, &climb(&steps));
        prop_assert!(fastest_radps < 7.0, "{fastest_radps}");
        prop_assert!(world.walker.standing());
        // Ground that is higher than told may be something in the way; lower ground is found.
        let stepping = world.walker.stepping();
        prop_assert!(error_m > 0.0 || stepping.landed == 2, "{stepping:?}");
    }

    #[test]
    fn no_joint_is_told_to_turn_faster_than_its_motor_on_any_flight_without_a_stop(
        height_m in -0.05..0.05f64, x_m in 0.05..0.13f64,
    ) {
        let mut world = Ideal::new();
        world.ground_beyond = vec![(0.5 * x_m, height_m), (1.5 * x_m, 2.0 * height_m)];
        let on = |side, stair: f64| step(side, stair * x_m, stair * height_m, [-0.03, 0.04]);
        let steps = [on(Side::Left, 1.0), on(Side::Right, 2.0), on(Side::Left, 2.0)];
        let fastest_radps = fastest_radps(&mut world, &climb(&steps));
        prop_assert!(fastest_radps < 7.0, "{fastest_radps}");
        prop_assert_eq!(world.walker.stepping().landed, 3);
    }

    #[test]
    fn no_list_brings_a_foot_farther_from_the_other_than_the_gait_allows(
        x_m in -1.0..1.0f64, y_m in -1.0..1.0f64, yaw_rad in -2.0..2.0f64, height_m in -1.0..1.0f64,
    ) {
        let mut world = Ideal::new();
        let mut wild = step(Side::Left, x_m, height_m, [-0.03, 0.04]);
        wild.pose = PlanarPose::new(x_m, y_m, yaw_rad);
        let command = climb(&[wild]);
        for _ in 0..700 {
            world.tick(&command);
            let gait = &world.walker.gait;
            let [left, right] = Side::BOTH.map(|side| gait.foot(side));
            let apart = right.planar.relative(&left.planar);
            let config = config();
            prop_assert!(apart.x_m.abs() <= config.climb_forward + 1e-9);
            prop_assert!((left.z_m - right.z_m).abs() <= config.climb_rise + config.climb_clearance + 1e-9);
        }
        prop_assert!(world.walker.standing());
    }
}
