//! What the walker promises of lists in which steps are walked, in a world where joints follow their targets at once.

use behaviour::{Footstep, Misstep, StepManner};
use proptest::prelude::*;

use super::climbing_tests::{HALF_SOLE_M, TREAD_M, climb, heights, run, step};
use super::*;
use crate::test_biped::{Ideal, config};
use crate::walker::Walker;

const WHOLE_M: [f64; 2] = [-HALF_SOLE_M, HALF_SOLE_M];
const UP_M: f64 = 0.03;
const LENGTH_M: f64 = 0.06;

fn walked(side: Side, x_m: f64, height_m: f64) -> Footstep {
    Footstep {
        manner: StepManner::Walked,
        ..step(side, x_m, height_m, WHOLE_M)
    }
}

/// Walked steps of the same length, left foot first, the feet together at the end.
fn ahead(length_m: f64, count: usize) -> Vec<Footstep> {
    let side = |index: usize| {
        if index.is_multiple_of(2) {
            Side::Left
        } else {
            Side::Right
        }
    };
    let place_m = |index: usize| length_m * (index + 1).min(count - 1) as f64;
    (0..count)
        .map(|index| walked(side(index), place_m(index), 0.0))
        .collect()
}

/// Two steps walked, both feet onto a step, and two walked on it.
fn up_and_on(length_m: f64) -> Vec<Footstep> {
    let places = [
        (length_m, 0.0),
        (length_m + TREAD_M, UP_M),
        (2.0 * length_m + TREAD_M, UP_M),
    ];
    let mut steps: Vec<_> = places
        .into_iter()
        .flat_map(|(x_m, z_m)| Side::BOTH.map(|side| walked(side, x_m, z_m)))
        .collect();
    steps[2].manner = StepManner::Careful;
    steps[3].manner = StepManner::Careful;
    steps
}

/// With a step between the places of [`up_and_on`].
fn world_with_a_step(length_m: f64, height_m: f64) -> Ideal {
    let mut world = Ideal::new();
    world.ground_beyond = vec![(length_m + 0.5 * TREAD_M, height_m)];
    world
}

/// Seconds from the start to each landing of a list.
fn landings_s(world: &mut Ideal, command: &Command) -> Vec<f64> {
    let mut landings = Vec::new();
    for tick in 1..2000 {
        world.tick(command);
        if world.walker.stepping().landed > landings.len() {
            landings.push(f64::from(tick) * TICK_S);
        }
        if world.walker.standing() && world.walker.list_is_over() {
            return landings;
        }
    }
    panic!("it goes on and on: {:?}", world.walker.stepping());
}

fn assert_near(found: f64, told: f64, within: f64) {
    assert!((found - told).abs() < within, "{found} for {told}");
}

fn assert_on(world: &Ideal, steps: &[Footstep]) {
    for step in steps {
        let foot = world.walker.foot_in_plan(step.side);
        assert!(
            foot.planar.distance_m(&step.pose) < 1e-9,
            "{foot:?} {step:?}"
        );
        assert_near(foot.z_m, step.height_m, 0.002);
    }
}

#[test]
fn walked_steps_land_where_they_are_told_and_as_fast_as_a_walk() {
    let mut world = Ideal::new();
    let steps = ahead(LENGTH_M, 6);
    let landings_s = landings_s(&mut world, &climb(&steps));
    let config = config();
    let first_s = config.shift_time + config.step_time - config.double_support;
    for (index, landing_s) in landings_s.iter().enumerate() {
        assert_near(
            *landing_s,
            first_s + index as f64 * config.step_time,
            2.5 * TICK_S,
        );
    }
    assert_eq!(landings_s.len(), 6);
    assert_on(&world, &steps[4..]);
    assert_eq!(world.walker.steps_taken(), 6);
}

#[test]
fn walked_and_careful_steps_follow_each_other_up_a_step() {
    let mut world = world_with_a_step(LENGTH_M, UP_M);
    let steps = up_and_on(LENGTH_M);
    let landings_s = landings_s(&mut world, &climb(&steps));
    let config = config();
    let apart_s: Vec<f64> = landings_s
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .collect();
    for walked in [0, 3, 4] {
        assert_near(apart_s[walked], config.step_time, 1.5 * TICK_S);
    }
    for careful in [1, 2] {
        assert!(apart_s[careful] > config.climb_double_support + config.climb_swing_time);
    }
    assert_on(&world, &steps[4..]);
    assert_eq!(world.walker.stepping().misstep, None);
}

#[test]
fn a_step_to_another_level_or_farther_than_a_walk_goes_is_taken_carefully() {
    let config = config();
    let careful_s = config.shift_time + config.climb_swing_time;
    for (told, edge_m) in [
        (walked(Side::Left, TREAD_M, UP_M), 0.06),
        (walked(Side::Left, config.max_forward + 0.02, 0.0), 1.0),
    ] {
        let mut world = Ideal::new();
        world.ground_beyond = vec![(edge_m, UP_M)];
        let landings_s = landings_s(&mut world, &climb(&[told]));
        assert!(landings_s[0] > careful_s, "{landings_s:?}");
        assert_on(&world, &[told]);
    }
    // As a map may be wrong.
    let mut world = Ideal::new();
    let told = walked(Side::Left, config.max_forward + 0.005, 0.004);
    let landings_s = landings_s(&mut world, &climb(&[told]));
    assert!(landings_s[0] < careful_s, "{landings_s:?}");
    let foot = world.walker.foot_in_plan(Side::Left);
    assert_near(foot.planar.x_m, config.max_forward, 1e-9);
}

#[test]
fn a_walked_foot_that_comes_upon_another_level_ends_the_list() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| if x_m > 0.1 { 0.018 } else { 0.0 };
    let command = climb(&ahead(LENGTH_M, 6));
    let mut stumbled = false;
    let mut met = None;
    for _ in 0..600 {
        world.tick(&command);
        stumbled |= world.walker.stepping().stumbled;
        met = met.or(world.walker.met());
    }
    let stepping = world.walker.stepping();
    assert!(world.walker.standing() && stumbled && met.is_some());
    assert_eq!(
        (stepping.landed, stepping.misstep),
        (1, Some(Misstep::Obstructed))
    );
    assert!(heights(&world).iter().all(|z_m| z_m.abs() < 0.002));
}

#[test]
fn a_walked_foot_tells_how_much_higher_than_told_it_landed() {
    for (ground_m, least_m) in [(0.006, 0.003), (0.0, -0.001)] {
        let mut world = Ideal::new();
        world.ground_beyond = vec![(0.03, ground_m)];
        run(&mut world, &climb(&[walked(Side::Left, LENGTH_M, 0.0)]));
        // Here the ground does not push back: the foot sinks in by what it goes down in two ticks.
        let error_m = world.walker.stepping().height_error_m;
        assert!(error_m > least_m && error_m < ground_m + 0.001, "{error_m}");
    }
}

#[test]
fn a_list_that_gets_shorter_ends_with_its_last_step_or_the_one_under_way() {
    let long = ahead(LENGTH_M, 6);
    for (given, landed) in [(3, 3), (2, 2), (1, 2), (0, 2)] {
        let mut world = Ideal::new();
        while world.walker.stepping().landed == 0 || world.walker.support().is_none() {
            world.tick(&climb(&long));
        }
        let short = climb(&long[..given]);
        for _ in 0..500 {
            world.tick(&short);
        }
        assert!(world.walker.standing());
        assert_eq!(world.walker.stepping().landed, landed, "{given} given");
        assert_eq!(world.walker.steps_taken(), landed as u64, "not begun anew");
    }
}

#[test]
fn other_steps_behind_the_one_under_way_are_taken_instead() {
    let mut world = world_with_a_step(LENGTH_M, UP_M);
    let (on, up) = (ahead(LENGTH_M, 4), up_and_on(LENGTH_M));
    while world.walker.support().is_none() {
        world.tick(&climb(&on));
    }
    run(&mut world, &climb(&up));
    assert_on(&world, &up[4..]);
}

fn manner(careful: bool) -> StepManner {
    if careful {
        StepManner::Careful
    } else {
        StepManner::Walked
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_list_on_the_level_lands_where_told_and_keeps_its_balance(
        careful in prop::collection::vec(any::<bool>(), 3..7), length_m in -0.05..0.07f64,
    ) {
        let mut world = Ideal::new();
        let mut steps = ahead(length_m, careful.len());
        for (step, careful) in steps.iter_mut().zip(&careful) {
            step.manner = manner(*careful);
        }
        let command = climb(&steps);
        let omega = world.walker.balance.omega;
        let grows = libm::exp(omega * TICK_S);
        for _ in 0..1500 {
            let (before, stood) = (world.walker.reference, world.walker.standing());
            world.tick(&command);
            if stood {
                continue;
            }
            // The reference is what a pendulum does, to what lies beyond the steps that are looked ahead.
            let now = before.zmp + (before.dcm - before.zmp) * grows;
            let off_m = (world.walker.reference.dcm - now).norm();
            prop_assert!(off_m < 0.004, "{off_m}");
        }
        prop_assert!(world.walker.standing());
        prop_assert_eq!(world.walker.stepping().landed, steps.len());
        assert_on(&world, &steps[steps.len() - 2..]);
    }

    #[test]
    fn told_to_stand_at_any_time_it_ends_the_step_under_way_and_leaves_the_feet_there(ticks in 1..500usize) {
        let mut world = world_with_a_step(LENGTH_M, UP_M);
        let steps = up_and_on(LENGTH_M);
        let command = climb(&steps);
        for _ in 0..ticks {
            world.tick(&command);
        }
        let before = world.walker.stepping().landed;
        for _ in 0..400 {
            world.tick(&Command::default());
        }
        let landed = world.walker.stepping().landed;
        prop_assert!(world.walker.standing());
        prop_assert!(landed - before <= 1);
        for side in Side::BOTH {
            let last = steps[..landed].iter().copied().rfind(|step| step.side == side);
            assert_on(&world, last.as_slice());
        }
        let middle = world.walker.gait.middle();
        prop_assert!((world.walker.com - middle).norm() < 0.002);
    }

    #[test]
    fn no_joint_is_told_to_turn_faster_than_its_motor_in_a_mixed_list(
        length_m in 0.03..0.07f64, error_m in -0.006..0.006f64,
    ) {
        let mut world = world_with_a_step(length_m, UP_M + error_m);
        let command = climb(&up_and_on(length_m));
        let mut fastest_radps = 0.0_f64;
        for _ in 0..1200 {
            let before = world.targets.positions_rad.clone();
            world.tick(&command);
            for (before, now) in before.iter().zip(&world.targets.positions_rad) {
                fastest_radps = fastest_radps.max((now - before).abs() / TICK_S);
            }
        }
        prop_assert!(fastest_radps < 7.0, "{fastest_radps}");
        prop_assert_eq!(world.walker.stepping().landed, 6);
    }
}

#[test]
fn a_step_out_of_a_longer_stance_than_a_walks_is_taken_carefully() {
    let config = config();
    let careful_s = config.climb_double_support + config.climb_swing_time;
    for (length_m, careful) in [
        (config.max_forward - 0.01, false),
        (config.max_forward + 0.03, true),
    ] {
        let first = step(Side::Left, length_m, 0.0, WHOLE_M);
        let list = [first, walked(Side::Right, length_m, 0.0)];
        let landings_s = landings_s(&mut Ideal::new(), &climb(&list));
        let apart_s = landings_s[1] - landings_s[0];
        assert_eq!(apart_s > careful_s, careful, "{length_m} {landings_s:?}");
    }
}
