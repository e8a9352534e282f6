//! What a walk promises that comes upon a step which nobody saw, and a climb whose next step was a glance of something else or turns
//! out to be higher.

use geometry::{PlanarPose, Pose};
use planning::Step;
use stairs::EdgeFit;

use crate::climbing::simulation::{Simulation, stair, straight};
use crate::climbing::tests::{FOUR_UP, up};
use crate::{Outcome, Pace};

fn before_an_unseen_edge() -> Simulation {
    let mut simulation = up(PlanarPose::default());
    simulation.unseen_edge_m = Some(0.2);
    simulation
}

fn assert_reaches_the_goal(simulation: &mut Simulation) {
    let (outcome, _) = simulation.run(120.0);
    let states = &simulation.states;
    assert_eq!(outcome, Some(Outcome::GoalReached), "{states:?}");
}

#[test]
fn a_walk_that_comes_upon_an_unseen_step_looks_and_goes_on() {
    let mut simulation = before_an_unseen_edge();
    simulation.run_until(60.0, Simulation::has_stumbled);
    simulation.run_until(5.0 + simulation.now_s(), Simulation::stands);
    simulation.unseen_edge_m = None;
    assert_reaches_the_goal(&mut simulation);
}

#[test]
fn a_walk_that_comes_upon_it_again_and_again_is_given_up_where_it_is() {
    let mut simulation = before_an_unseen_edge();
    let (outcome, _) = simulation.run(120.0);
    assert!(
        matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("blocked: ")),
        "{outcome:?} {:?}",
        simulation.states
    );
    assert!(simulation.pose().x_m <= 0.2);
}

#[test]
fn a_robot_whose_leg_buckles_on_a_step_tries_no_other_and_says_which_leg_it_was() {
    let mut simulation = up(PlanarPose::default());
    simulation.weak = true;
    let (outcome, _) = simulation.run(120.0);
    let Some(Outcome::Refused(reason)) = &outcome else {
        panic!("{outcome:?} {:?}", simulation.states);
    };
    let stands_higher = usize::from(simulation.feet[1].height_m > 0.01);
    let leg = ["left", "right"][stands_higher];
    assert!(
        reason.starts_with(&format!("sensor: the {leg} leg")),
        "{reason}"
    );
    assert_eq!(on_stairs(&simulation), 1);
}

fn on_stairs(simulation: &Simulation) -> usize {
    simulation
        .feet
        .iter()
        .filter(|foot| foot.height_m > 0.01)
        .count()
}

#[test]
fn a_step_in_view_that_was_measured_is_not_in_doubt_however_long_plans_lead_elsewhere() {
    let fit = EdgeFit {
        frames: 9,
        place_sigma_m: 0.002,
        heading_sigma_rad: 0.01,
    };
    for (front_fit, lost_s, in_doubt) in [
        (Some(fit), 0.0, false),
        (Some(fit), 2.0, true),
        (None, 0.0, true),
    ] {
        let mut behaviour = up(PlanarPose::default()).behaviour;
        let mut step = Step {
            stair: stair([0.1, 0.0, 0.0], [0.22, 0.0, 0.0], 0.018, 0.5),
            rise_m: 0.018,
            crossing_m: [0.1, 0.0],
        };
        step.stair.front_fit = front_fit;
        behaviour.flight.adopt(&[step]);
        behaviour.flight.unplanned_s = 5.0;
        behaviour.flight.lost_s = lost_s;
        assert_eq!(behaviour.is_in_doubt(), in_doubt, "{front_fit:?} {lost_s}");
    }
}

/// The robot has taken its first step, or is about to, when it takes a glance of something beside it for the next one.
#[test]
fn a_step_that_is_neither_seen_nor_planned_any_more_is_dropped() {
    for landings in [0, 2] {
        let mut simulation = up(PlanarPose::default());
        simulation.run_until(60.0, |simulation| {
            let climbs = simulation
                .states
                .last()
                .is_some_and(|(name, _)| *name == "climb");
            climbs && simulation.stands() && on_stairs(simulation) == landings
        });
        let here = simulation.pose();
        let glance = Step {
            stair: stair([here.x_m, 0.2, 1.57], [here.x_m, 0.5, 1.57], -0.033, 0.3),
            rise_m: -0.033,
            crossing_m: [here.x_m, 0.2],
        };
        simulation.behaviour.flight.adopt(&[glance]);
        assert_reaches_the_goal(&mut simulation);
    }
}

/// The wide floor below a narrow tread may be planned to be crossed anywhere.
#[test]
fn on_a_tread_the_robot_goes_straight_on_wherever_a_plan_crosses_the_next_edge() {
    let (start, goal_m) = (PlanarPose::default(), [1.15, 0.0]);
    let mut simulation = Simulation::new(
        start,
        straight(0.6, &FOUR_UP, 1.0),
        goal_m,
        Pace::StepByStep,
    );
    simulation.run_until(60.0, |simulation| {
        on_stairs(simulation) == 2 && simulation.behaviour.memory.on.is_some()
    });
    let mut next = *simulation.behaviour.flight.first().unwrap();
    next.crossing_m[1] += 0.12;
    simulation.behaviour.flight.adopt(&[next]);
    assert_reaches_the_goal(&mut simulation);
    let furthest_m = simulation
        .landings
        .iter()
        .map(|(_, foot)| foot.pose.y_m.abs());
    let furthest_m = furthest_m.fold(0.0, f64::max);
    assert!(furthest_m < 0.07, "{furthest_m}");
}

/// Planned at the limit, a step is not given up for a millimetre that it seems higher from near by.
#[test]
fn a_step_at_the_limit_is_climbed_though_what_is_seen_of_its_height_varies() {
    let course = straight(0.6, &[(0.052, 0.6)], 1.0);
    let start = PlanarPose::default();
    let mut simulation = Simulation::new(start, course, [1.0, 0.0], Pace::StepByStep);
    simulation.run_until(60.0, |simulation| simulation.was_in("align"));
    for stair in &mut simulation.steps {
        *stair = stair.transformed(&Pose::from_yaw(0.0, 0.0, 0.0014, 0.0));
    }
    assert_reaches_the_goal(&mut simulation);
}

/// 003, section V.C: the conditions are checked again before the step is taken.
#[test]
fn a_step_that_turns_out_too_high_from_near_by_is_not_climbed() {
    for seen_m in [0.049, 0.052] {
        let course = straight(0.6, &[(seen_m, 0.6)], 1.0);
        let start = PlanarPose::default();
        let mut simulation = Simulation::new(start, course, [1.0, 0.0], Pace::StepByStep);
        simulation.run_until(60.0, |simulation| simulation.was_in("align"));
        for stair in &mut simulation.steps {
            *stair = stair.transformed(&Pose::from_yaw(0.0, 0.0, 0.055 - seen_m, 0.0));
        }
        let (outcome, _) = simulation.run(120.0);
        let states = &simulation.states;
        let Some(Outcome::Refused(reason)) = outcome else {
            panic!("{seen_m} {outcome:?} {states:?}");
        };
        assert!(reason.starts_with("step_too_high"), "{reason} {states:?}");
        assert!(
            simulation
                .landings
                .iter()
                .all(|(_, foot)| foot.height_m < 0.01)
        );
    }
}
