//! What the walker promises of lists of footsteps: when one is new, when it is over, what may change.

use behaviour::Motion;

use super::climbing_tests::{HALF_SOLE_M, TREAD_M, climb, heights, run, stair, step};
use super::*;
use crate::test_biped::Ideal;
use crate::walker::Walker;

#[test]
fn a_list_that_is_done_is_not_walked_again_but_a_new_one_is() {
    let mut world = Ideal::new();
    let command = climb(&stair(0.0));
    run(&mut world, &command);
    for _ in 0..300 {
        world.tick(&command);
    }
    assert_eq!(world.walker.steps_taken(), 2);
    // Another list, or the same one after something else.
    run(
        &mut world,
        &climb(&[step(Side::Right, 0.05, 0.0, [-HALF_SOLE_M, HALF_SOLE_M])]),
    );
    assert_eq!(world.walker.steps_taken(), 3);
    world.tick(&Command::default());
    world.tick(&command);
    run(&mut world, &command);
    assert_eq!(world.walker.steps_taken(), 5);
}

#[test]
fn a_list_grows_while_it_is_walked_but_takes_no_other_steps() {
    let on = |side, stair: f64| step(side, stair * TREAD_M, 0.0, [-0.04, HALF_SOLE_M]);
    let short = [on(Side::Left, 1.0), on(Side::Right, 1.0)];
    let long = [
        on(Side::Left, 1.0),
        on(Side::Right, 2.0),
        on(Side::Left, 2.0),
    ];
    let other = [
        on(Side::Left, 0.5),
        on(Side::Right, 0.5),
        on(Side::Left, 1.0),
    ];
    for (given, steps) in [(&long, 3), (&other, 2)] {
        let mut world = Ideal::new();
        while world.walker.support().is_none() {
            world.tick(&climb(&short));
        }
        while !world.walker.standing() {
            world.tick(&climb(given));
        }
        assert_eq!(world.walker.stepping().landed, steps);
    }
    // Too late: the last foot is on its way.
    let mut world = Ideal::new();
    while world.walker.stepping().landed == 0 {
        world.tick(&climb(&short));
    }
    while !world.walker.standing() {
        world.tick(&climb(&long));
    }
    assert_eq!(world.walker.stepping().landed, 2);
}

#[test]
fn a_list_that_is_taken_away_ends_with_the_step_under_way() {
    let mut world = Ideal::new();
    world.ground_m = |x_m, _| if x_m > 0.06 { 0.03 } else { 0.0 };
    let command = climb(&stair(0.03));
    while world.walker.support().is_none() {
        world.tick(&command);
    }
    for _ in 0..400 {
        world.tick(&Command::default());
    }
    assert!(world.walker.standing());
    let [left_m, right_m] = heights(&world);
    assert!((left_m - 0.03).abs() < 0.002 && right_m == 0.0);
}

#[test]
fn a_list_given_on_a_walk_is_begun_from_a_stand_and_counts_from_where_it_was_given() {
    let mut world = Ideal::new();
    let walk = Command {
        motion: Motion::Walk(behaviour::Velocity {
            x_mps: 0.08,
            ..behaviour::Velocity::default()
        }),
        ..Command::default()
    };
    for _ in 0..230 {
        world.tick(&walk);
    }
    let given = Gait::center_of(&Side::BOTH.map(|side| world.walker.gait.foot(side)));
    run(&mut world, &climb(&stair(0.0)));
    let reached = Gait::center_of(&world.walker.gait.feet);
    let ahead_m = reached.x_m - given.x_m;
    assert!((ahead_m - TREAD_M).abs() < 0.006, "{ahead_m}");
}
