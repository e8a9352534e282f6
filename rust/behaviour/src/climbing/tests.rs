//! Courses of stairs climbed in a kinematic world: outcomes, bad luck, and laws.

use geometry::PlanarPose;
use proptest::prelude::*;

use super::simulation::{Simulation, stair, straight};
use super::state::State;
use crate::machine::State as _;
use crate::{Motion, Outcome, Pace};

pub(super) const FOUR_UP: [(f64, f64); 4] =
    [(0.03, 0.12), (0.03, 0.12), (0.03, 0.12), (0.03, 0.33)];

pub(super) fn up(start: PlanarPose) -> Simulation {
    Simulation::new(
        start,
        straight(0.6, &FOUR_UP, 0.33),
        [1.15, 0.0],
        Pace::StepByStep,
    )
}

fn down() -> Simulation {
    let steps = [(-0.03, 0.12), (-0.03, 0.12), (-0.03, 0.12), (-0.03, 1.5)];
    Simulation::new(
        PlanarPose::default(),
        straight(0.5, &steps, 0.33),
        [1.3, 0.0],
        Pace::StepByStep,
    )
}

fn assert_on_top(simulation: &mut Simulation, height_m: f64, limit_s: f64) {
    let (outcome, after_s) = simulation.run(limit_s);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{after_s} {:?}",
        simulation.states
    );
    assert!((simulation.ground_m() - height_m).abs() < 1e-6);
}

#[test]
fn four_steps_are_climbed_through_all_states_in_the_papers_order() {
    let mut simulation = up(PlanarPose::default());
    assert_on_top(&mut simulation, 0.12, 60.0);
    let mut order: Vec<_> = simulation.states.iter().map(|(name, _)| *name).collect();
    order.dedup();
    order.retain(|name| ["search", "align", "approach", "climb", "finish"].contains(name));
    assert_eq!(
        order,
        ["search", "align", "approach", "climb", "finish"],
        "{:?}",
        simulation.states
    );
    assert!(simulation.arms_raised);
}

#[test]
fn both_feet_are_together_after_each_step_and_the_number_of_steps_is_found() {
    let mut simulation = up(PlanarPose::default());
    assert_on_top(&mut simulation, 0.12, 60.0);
    for level in 1..=4 {
        let height_m = 0.03 * f64::from(level);
        let on_it: Vec<_> = simulation
            .landings
            .iter()
            .filter(|(_, foot)| (foot.height_m - height_m).abs() < 1e-6)
            .collect();
        assert!(on_it.len() >= 2);
        assert_ne!(on_it[0].0.side, on_it[1].0.side);
        let apart = on_it[0].1.pose.relative(&on_it[1].1.pose);
        assert!(
            apart.x_m.abs() < 0.005 && (apart.y_m.abs() - 0.085).abs() < 0.005,
            "{apart:?}"
        );
    }
}

#[test]
fn four_steps_are_descended() {
    let mut simulation = down();
    assert_on_top(&mut simulation, -0.12, 60.0);
}

#[test]
fn a_goal_on_the_landing_is_not_left_down_the_step_behind_it() {
    let course = straight(0.6, &[(0.02, 0.13), (0.02, 0.4), (-0.04, 0.6)], 0.4);
    let mut simulation =
        Simulation::new(PlanarPose::default(), course, [0.93, 0.0], Pace::StepByStep);
    assert_on_top(&mut simulation, 0.04, 60.0);
    let furthest_m = simulation.landings.iter().map(|(_, foot)| foot.pose.x_m);
    assert!(
        furthest_m.fold(0.0, f64::max) < 1.13,
        "{:?}",
        simulation.landings
    );
}

#[test]
fn a_sill_of_9_cm_is_crossed_with_both_feet_on_it() {
    let sill = [(0.038, 0.09), (-0.038, 1.5)];
    let mut simulation = Simulation::new(
        PlanarPose::default(),
        straight(0.5, &sill, 0.8),
        [1.2, 0.0],
        Pace::StepByStep,
    );
    assert_on_top(&mut simulation, 0.0, 60.0);
    let on_it = simulation
        .landings
        .iter()
        .filter(|(_, foot)| foot.height_m > 0.03)
        .count();
    assert_eq!(on_it, 2);
}

fn basin(width_m: f64, planner_checks: bool) -> Simulation {
    let steps = [(-0.03, width_m), (0.03, 1.5)];
    let mut simulation = Simulation::new(
        PlanarPose::default(),
        straight(0.5, &steps, 0.8),
        [1.2, 0.0],
        Pace::StepByStep,
    );
    simulation.planner_checks = planner_checks;
    simulation
}

#[test]
fn a_basin_of_13_cm_is_entered_and_left() {
    let mut simulation = basin(0.13, true);
    assert_on_top(&mut simulation, 0.0, 60.0);
    assert!(
        simulation
            .landings
            .iter()
            .any(|(_, foot)| foot.height_m < -0.02)
    );
}

#[test]
fn a_basin_of_10_or_12_cm_is_refused_before_it_is_entered_whoever_notices() {
    for (width_m, planner_checks) in [(0.10, true), (0.10, false), (0.12, false)] {
        let mut simulation = basin(width_m, planner_checks);
        let (outcome, _) = simulation.run(120.0);
        assert!(
            matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("gap_too_short: ")),
            "{outcome:?} {:?}",
            simulation.states
        );
        assert!(
            simulation
                .landings
                .iter()
                .all(|(_, foot)| foot.height_m == 0.0)
        );
    }
}

#[test]
fn steps_that_are_too_high_are_refused_on_the_ground() {
    for rise_m in [0.055, -0.055, 0.065] {
        let steps = [(rise_m, 0.15), (rise_m, 0.5)];
        let mut simulation = Simulation::new(
            PlanarPose::default(),
            straight(0.5, &steps, 0.33),
            [1.0, 0.0],
            Pace::StepByStep,
        );
        simulation.planner_checks = false;
        let (outcome, _) = simulation.run(120.0);
        assert!(
            matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("step_too_high: ")),
            "{outcome:?} {:?}",
            simulation.states
        );
        assert_eq!(simulation.ground_m(), 0.0);
    }
}

#[test]
fn a_staircase_that_turns_by_a_few_degrees_a_step_is_climbed() {
    let turn_rad = 5.0_f64.to_radians();
    let mut at = PlanarPose::new(0.6, 0.0, 0.0);
    let steps = (1..=5)
        .map(|i| {
            let tread_m = if i == 5 { 0.4 } else { 0.13 };
            let next = at.compose(&PlanarPose::new(tread_m, 0.0, turn_rad));
            let front = [at.x_m, at.y_m, at.yaw_rad];
            let back = [next.x_m, next.y_m, next.yaw_rad];
            at = next;
            stair(front, back, 0.03 * f64::from(i), 0.4)
        })
        .collect();
    let goal = at.compose(&PlanarPose::new(-0.2, 0.0, 0.0));
    let mut simulation = Simulation::new(
        PlanarPose::default(),
        steps,
        [goal.x_m, goal.y_m],
        Pace::StepByStep,
    );
    assert_on_top(&mut simulation, 0.15, 80.0);
}

#[test]
fn stairs_are_climbed_from_45_degrees_askew() {
    for yaw_rad in [0.785, -0.785] {
        let mut simulation = up(PlanarPose::new(0.1, 0.1, yaw_rad));
        assert_on_top(&mut simulation, 0.12, 70.0);
    }
}

#[test]
fn treads_of_11_to_20_cm_are_climbed() {
    for tread_m in [0.11, 0.14, 0.17, 0.20] {
        let steps = [(0.04, tread_m), (0.04, tread_m), (0.04, 0.4)];
        let mut simulation = Simulation::new(
            PlanarPose::default(),
            straight(0.6, &steps, 0.33),
            [0.8 + 2.0 * tread_m, 0.0],
            Pace::StepByStep,
        );
        assert_on_top(&mut simulation, 0.12, 80.0);
    }
}

#[test]
fn a_missing_step_is_refused_without_a_fall() {
    let mut simulation = up(PlanarPose::default());
    simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.05);
    assert_refused_before_a_sunk_third_step(&mut simulation);
}

pub(super) fn assert_refused_before_a_sunk_third_step(simulation: &mut Simulation) {
    simulation.sunk_m[2] = 0.03;
    let (outcome, _) = simulation.run(120.0);
    assert!(
        matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("blocked: ")),
        "{outcome:?} {:?}",
        simulation.states
    );
    assert!((simulation.ground_m() - 0.06).abs() < 1e-6);
}

#[test]
fn who_is_blind_on_the_stairs_stands_and_is_lost_in_the_end_or_goes_on_when_it_sees() {
    for comes_back in [false, true] {
        let mut simulation = up(PlanarPose::default());
        simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.05);
        simulation.blind = true;
        let blind_at_s = simulation.now_s();
        simulation.run_until(60.0, |simulation| simulation.was_in("blind"));
        let held = simulation.pose();
        // It looks to both sides for something that can be seen.
        for side in [1.0, -1.0] {
            simulation.run_until(60.0, |simulation| side * simulation.gaze().pan_rad > 0.4);
        }
        if comes_back {
            simulation.run_until(90.0, |simulation| simulation.now_s() > blind_at_s + 8.0);
            assert_eq!(simulation.pose(), held);
            simulation.blind = false;
            assert_on_top(&mut simulation, 0.12, 90.0);
        } else {
            let (outcome, after_s) = simulation.run(90.0);
            assert!(
                matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("lost: "))
            );
            assert!(after_s < blind_at_s + 25.0);
            assert_eq!(simulation.pose(), held);
        }
    }
}

#[test]
fn what_stands_on_the_next_step_is_waited_for_and_then_refused() {
    for leaves in [true, false] {
        let mut simulation = up(PlanarPose::default());
        simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.02);
        simulation.obstacle = Some([0.9, 0.0, 0.1]);
        simulation.paint();
        simulation.run_until(60.0, |simulation| simulation.was_in("stop"));
        if leaves {
            simulation.obstacle = None;
            simulation.paint();
            assert_on_top(&mut simulation, 0.12, 90.0);
        } else {
            let (outcome, _) = simulation.run(90.0);
            assert!(
                matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("blocked: something"))
            );
        }
    }
}

#[test]
fn on_the_stairs_the_memorised_steps_are_climbed_without_a_plan() {
    let mut simulation = up(PlanarPose::default());
    simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.02);
    simulation.planning = false;
    simulation.run_until(60.0, |simulation| simulation.ground_m() > 0.115);
    simulation.planning = true;
    assert_on_top(&mut simulation, 0.12, 80.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]
    #[test]
    fn from_wherever_the_paper_starts_the_stairs_are_climbed_in_time(
        away_m in 0.4..0.8f64, aside_m in -0.1..0.1f64, yaw_rad in -0.35..0.35f64,
        ex in -0.004..0.004f64, ey in -0.003..0.003f64, eyaw in -0.02..0.02f64,
    ) {
        let start = PlanarPose::new(0.6 - away_m, aside_m, yaw_rad);
        let mut simulation = up(start);
        simulation.landing_error = PlanarPose::new(ex, ey, eyaw);
        let (outcome, after_s) = simulation.run(90.0);
        prop_assert_eq!(outcome, Some(Outcome::GoalReached), "{:?}", simulation.states);
        prop_assert!(after_s < 60.0, "{}", after_s);
    }

    #[test]
    fn every_course_ends_in_bounded_time_and_only_legal_states_follow(
        rises in prop::collection::vec(prop_oneof![-0.06..-0.014f64, 0.014..0.06f64], 1..4), treads in prop::collection::vec(0.06..0.3f64, 4),
        width_m in 0.1..0.5f64, yaw_rad in -1.0..1.0f64, blind_at_s in 0.0..60.0f64, planner_checks in any::<bool>(),
        sunk in prop::collection::vec(prop::bool::weighted(0.2), 4),
    ) {
        let steps: Vec<_> = rises.iter().copied().zip(treads.iter().copied()).collect();
        let mut simulation = Simulation::new(
            PlanarPose::new(0.0, 0.0, yaw_rad), straight(0.5, &steps, width_m), [0.9, 0.0], Pace::StepByStep,
        );
        simulation.planner_checks = planner_checks;
        let (mut before, mut outcome) = (State::Walk, None);
        for _ in 0..30_000 {
            simulation.blind = simulation.now_s() > blind_at_s && simulation.now_s() < blind_at_s + 5.0;
            for (at, sunk) in sunk.iter().take(rises.len()).enumerate() {
                // What carries the robot does not sink: it would fall with it. The last step goes on for ever.
                let begins_m = 0.5 + treads[..at].iter().sum::<f64>();
                let ends_m = if at + 1 < rises.len() { begins_m + treads[at] } else { f64::INFINITY };
                let away_m = (begins_m - simulation.pose().x_m).max(simulation.pose().x_m - ends_m);
                if *sunk && simulation.now_s() > 25.0 && away_m > 0.1 {
                    simulation.sunk_m[at] = 0.05;
                }
            }
            let stood = simulation.stands();
            let decision = simulation.tick();
            let state = simulation.behaviour.machine.state().clone();
            prop_assert!(state.is_kind_of(&before) || before.may_become(&state), "{:?} -> {:?}", before, state);
            if state.refusal().is_some() && before.refusal().is_some() {
                prop_assert_eq!(&decision.command.motion, &Motion::Stand);
            }
            prop_assert!(decision.outcome.is_none() || stood);
            before = state;
            outcome = decision.outcome;
            if outcome.is_some() {
                break;
            }
        }
        prop_assert!(outcome.is_some(), "{:?}", simulation.states);
    }
}

#[test]
fn refusing_is_final_and_every_other_state_can_be_left() {
    for state in State::all() {
        let ways_out = State::all()
            .iter()
            .filter(|next| !next.is_kind_of(&state) && state.may_become(next))
            .count();
        assert_eq!(ways_out == 0, state.refusal().is_some(), "{state:?}");
    }
}

/// The planner may lead over an edge a hand's breadth beside where the feet go: what matters is the part before the feet.
#[test]
fn on_the_stairs_the_head_looks_where_the_feet_will_go_and_not_where_the_way_does() {
    let mut simulation = down();
    simulation.way_aside_m = 0.05;
    let mut pans_rad = Vec::new();
    while simulation.now_s() < 60.0 && simulation.tick().outcome.is_none() {
        if simulation
            .states
            .last()
            .is_some_and(|(name, _)| *name == "climb")
        {
            pans_rad.push(simulation.gaze().pan_rad);
        }
    }
    assert!(simulation.was_in("finish"), "{:?}", simulation.states);
    let mean_rad = pans_rad.iter().sum::<f64>() / pans_rad.len() as f64;
    assert!(mean_rad.abs() < 0.05, "{mean_rad}");
}
