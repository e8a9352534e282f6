//! What a climb without stops promises.

use geometry::PlanarPose;

use crate::Outcome;
use crate::climbing::Pace;
use crate::climbing::simulation::{Simulation, straight};
use crate::climbing::tests::{FOUR_UP, assert_refused_before_a_sunk_third_step, up};

#[test]
fn steps_too_high_for_a_climb_without_stops_are_climbed_with_both_feet_on_each() {
    let mut simulation = Simulation::new(
        PlanarPose::default(),
        straight(
            0.6,
            &[(0.05, 0.12), (0.05, 0.12), (0.05, 0.12), (0.05, 0.33)],
            0.33,
        ),
        [1.15, 0.0],
        Pace::Continuous,
    );
    let (outcome, _) = simulation.run(60.0);
    assert_eq!(outcome, Some(Outcome::GoalReached));
    for height_m in [0.05, 0.1, 0.15] {
        let on_it = simulation
            .landings
            .iter()
            .filter(|(_, foot)| (foot.height_m - height_m).abs() < 1e-6);
        assert_eq!(on_it.count(), 2, "{height_m}");
    }
}

#[test]
fn without_stops_the_stairs_take_less_time_and_one_foot_a_step() {
    let mut by_step = up(PlanarPose::default());
    let (_, step_by_step_s) = by_step.run(60.0);
    let mut simulation = Simulation::new(
        PlanarPose::default(),
        straight(0.6, &FOUR_UP, 0.33),
        [1.15, 0.0],
        Pace::Continuous,
    );
    let (outcome, after_s) = simulation.run(60.0);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{:?}",
        simulation.states
    );
    assert!((simulation.ground_m() - 0.12).abs() < 1e-6);
    assert!(after_s < step_by_step_s - 5.0, "{after_s} {step_by_step_s}");
    let on_second = simulation
        .landings
        .iter()
        .filter(|(_, foot)| (foot.height_m - 0.06).abs() < 1e-6);
    assert_eq!(on_second.count(), 1);
}

#[test]
fn a_climb_without_stops_that_fails_goes_on_step_by_step_or_is_refused_with_the_feet_together() {
    let mut simulation = Simulation::new(
        PlanarPose::default(),
        straight(0.6, &FOUR_UP, 0.33),
        [1.15, 0.0],
        Pace::Continuous,
    );
    simulation.run_until(60.0, |simulation| {
        simulation
            .landings
            .iter()
            .any(|(_, foot)| foot.height_m > 0.02)
    });
    assert_refused_before_a_sunk_third_step(&mut simulation);
    assert_eq!(simulation.feet[0].height_m, simulation.feet[1].height_m);
}
