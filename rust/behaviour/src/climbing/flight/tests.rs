//! The steps ahead as plans come and go.

use super::*;
use crate::climbing::simulation::stair;
use planning::{Climb, Path};
use stairs::EdgeFit;
use std::f64::consts::PI;

/// Two steps that are crossed along x at this offset to the left.
fn plan(aside_m: f64) -> Plan {
    let step = |x_m: f64, height_m: f64| Step {
        stair: stair([x_m, 0.0, 0.0], [x_m + 0.12, 0.0, 0.0], height_m, 1.0),
        rise_m: 0.03,
        crossing_m: [x_m, aside_m],
    };
    let climb = Climb {
        from_point: 0,
        to_point: 2,
        steps: vec![step(0.5, 0.03), step(0.62, 0.06)],
    };
    let path = Path {
        climbs: vec![climb],
        sidles: Vec::new(),
        ..Path::default()
    };
    Plan {
        way: Ok(path),
        replanned: true,
    }
}

#[test]
fn a_plan_that_crosses_a_wide_edge_elsewhere_does_not_move_the_lane() {
    let mut flight = Flight::default();
    let first = plan(0.1);
    flight.adopt(&first.way.as_ref().unwrap().climbs[0].steps);
    let (pose, config) = (PlanarPose::default(), ClimbingConfig::default());
    for aside_m in [-0.3, 0.25, 0.1] {
        let plan = plan(aside_m);
        flight.refresh(Some(&plan), &Staircase::default(), &pose, &config);
        assert_eq!(flight.steps.len(), 2);
        for step in &flight.steps {
            assert!((step.crossing_m[1] - 0.1).abs() < 1e-9, "{step:?}");
        }
    }
}

#[test]
fn the_lane_of_the_plan_is_taken_when_it_is_asked_for_and_is_another_one() {
    let (pose, config) = (PlanarPose::default(), ClimbingConfig::default());
    for (planned_m, taken_m) in [(0.05, 0.1), (-0.2, -0.2)] {
        let mut flight = Flight::default();
        flight.adopt(&plan(0.1).way.as_ref().unwrap().climbs[0].steps);
        flight.refresh(
            Some(&plan(planned_m)),
            &Staircase::default(),
            &pose,
            &config,
        );
        assert_eq!(flight.change_lane(), planned_m == taken_m);
        assert!(!flight.change_lane());
        for step in &flight.steps {
            assert!((step.crossing_m[1] - taken_m).abs() < 1e-9, "{step:?}");
        }
    }
}

/// The stairs of the plan's steps after their fronts were measured, further on by this much than they were thought.
fn measured(plan: &Plan, further_m: f64) -> Staircase {
    let steps = &plan.way.as_ref().unwrap().climbs[0].steps;
    let stairs = steps.iter().map(|step| {
        let [x_m, _] = step.crossing_m;
        let from_m = [x_m + further_m, 0.0, 0.0];
        let mut stair = stair(from_m, [x_m + 0.12, 0.0, 0.0], step.stair.height_m(), 1.0);
        stair.front_fit = Some(EdgeFit {
            place_sigma_m: 0.002,
            heading_sigma_rad: 0.01,
            frames: 9,
        });
        stair
    });
    Staircase {
        stairs: stairs.collect(),
        ..Staircase::default()
    }
}

#[test]
fn a_step_behind_those_of_the_plan_is_looked_up_among_the_stairs() {
    let mut flight = Flight::default();
    let mut short = plan(0.0);
    flight.adopt(&short.way.as_ref().unwrap().climbs[0].steps);
    let stairs = measured(&short, 0.02);
    short.way.as_mut().unwrap().climbs[0].steps.truncate(1);
    let config = ClimbingConfig::default();
    flight.refresh(Some(&short), &stairs, &PlanarPose::default(), &config);
    let second = flight.second().unwrap();
    assert!(second.stair.front_fit.is_some(), "{second:?}");
    assert!(second.stair.front.beyond_m([0.64, 0.0]).abs() < 1e-9);
}

#[test]
fn an_edge_that_was_never_measured_goes_where_it_is_measured_however_near_it_is() {
    let mut flight = Flight::default();
    let plan = plan(0.0);
    flight.adopt(&plan.way.as_ref().unwrap().climbs[0].steps);
    let at_the_edge = PlanarPose::new(0.45, 0.0, 0.0);
    let config = ClimbingConfig::default();
    flight.refresh(None, &measured(&plan, 0.02), &at_the_edge, &config);
    let first = *flight.first().unwrap();
    assert!(first.stair.front_fit.is_some(), "{first:?}");
    // From here it is out of view: what is said of it later is worth nothing.
    flight.refresh(None, &measured(&plan, 0.0), &at_the_edge, &config);
    assert_eq!(flight.first().unwrap().stair.front, first.stair.front);
}

#[test]
fn an_edge_of_which_but_a_piece_was_known_goes_where_more_of_it_is_however_near_it_is() {
    let plan = plan(0.0);
    let whole = measured(&plan, 0.0);
    let mut piece = plan.way.as_ref().unwrap().climbs[0].steps[0];
    piece.stair = whole.stairs[0];
    let middle = piece.stair.front.middle().inner.y;
    piece.stair.front.left.inner.y = middle + 0.005;
    piece.stair.front.right.inner.y = middle - 0.005;
    let mut flight = Flight::default();
    flight.adopt(&[piece]);
    let at_the_edge = PlanarPose::new(0.45, 0.0, 0.0);
    flight.refresh(None, &whole, &at_the_edge, &ClimbingConfig::default());
    let known_m = flight.first().unwrap().stair.front.length_m();
    assert!(
        (known_m - whole.stairs[0].front.length_m()).abs() < 1e-9,
        "{known_m}"
    );
}

#[test]
fn a_step_is_crossed_at_its_edge_wherever_that_is_measured() {
    let mut flight = Flight::default();
    let plan = plan(0.1);
    flight.adopt(&plan.way.as_ref().unwrap().climbs[0].steps);
    let (pose, config) = (PlanarPose::default(), ClimbingConfig::default());
    for further_m in [0.07, 0.075, 0.08] {
        flight.refresh(None, &measured(&plan, further_m), &pose, &config);
        let crossings_m = flight.steps.iter().map(|step| step.crossing_m);
        for ([x_m, y_m], was_m) in crossings_m.zip([0.5, 0.62]) {
            assert!((x_m - was_m - further_m).abs() < 1e-9, "{x_m} {further_m}");
            assert!((y_m - 0.1).abs() < 1e-9);
        }
    }
}

#[test]
fn a_step_that_comes_to_be_seen_before_the_first_one_is_not_stepped_over() {
    let config = ClimbingConfig::default();
    let plan = plan(0.0);
    let steps = &plan.way.as_ref().unwrap().climbs[0].steps;
    // Before both edges, and on the first step.
    for (x_m, ahead) in [(0.4, 2), (0.55, 1)] {
        let mut flight = Flight::default();
        flight.adopt(&steps[1..]);
        let pose = PlanarPose::new(x_m, 0.0, 0.0);
        flight.refresh(Some(&plan), &Staircase::default(), &pose, &config);
        assert_eq!(&flight.steps, &steps[2 - ahead..], "{x_m}");
    }
}

#[test]
fn a_plan_that_begins_with_going_back_over_the_edge_is_not_followed_in_the_middle_of_the_step() {
    let config = ClimbingConfig::default();
    let mut plan = plan(0.0);
    let steps = &mut plan.way.as_mut().unwrap().climbs[0].steps;
    let ahead = steps.clone();
    let back = Step {
        stair: stair([0.5, 0.0, PI], [0.3, 0.0, PI], 0.0, 1.0),
        rise_m: -0.03,
        crossing_m: [0.5, 0.0],
    };
    steps.insert(0, back);
    let mut flight = Flight::default();
    flight.adopt(&ahead);
    let pose = PlanarPose::new(0.57, 0.0, 0.0);
    flight.refresh(Some(&plan), &Staircase::default(), &pose, &config);
    assert_eq!(flight.steps, ahead);
}

#[test]
fn two_low_steps_that_were_one_from_far_away_are_two_once_the_plan_has_both_whatever_it_walks_between()
 {
    let config = ClimbingConfig::default();
    let mut plan = plan(0.0);
    let path = plan.way.as_mut().unwrap();
    let steps = path.climbs[0].steps.clone();
    path.climbs = steps
        .iter()
        .map(|step| Climb {
            from_point: 0,
            to_point: 1,
            steps: vec![*step],
        })
        .collect();
    let both_in_one = Step {
        rise_m: 0.06,
        ..steps[1]
    };
    let mut flight = Flight::default();
    flight.adopt(&[both_in_one]);
    let pose = PlanarPose::new(0.4, 0.0, 0.0);
    flight.refresh(Some(&plan), &Staircase::default(), &pose, &config);
    assert_eq!(flight.steps, steps);
}

#[test]
fn a_step_that_a_plan_once_had_further_back_is_not_taken_behind_the_last_one() {
    let config = ClimbingConfig::default();
    let plan = plan(0.0);
    let steps = plan.way.as_ref().unwrap().climbs[0].steps.clone();
    let further_back = Step {
        stair: stair([0.58, 0.0, 0.0], [0.9, 0.0, 0.0], 0.075, 1.0),
        rise_m: 0.015,
        crossing_m: [0.58, 0.0],
    };
    let stairs = Staircase {
        stairs: vec![further_back.stair],
        ..Staircase::default()
    };
    let mut flight = Flight::default();
    flight.adopt(&[steps[0], steps[1], further_back]);
    flight.refresh(Some(&plan), &stairs, &PlanarPose::default(), &config);
    assert_eq!(flight.steps, steps);
}

#[test]
fn without_a_plan_steps_rise_as_the_stairs_are_seen_by_now() {
    let mut flight = Flight::default();
    flight.adopt(&plan(0.0).way.as_ref().unwrap().climbs[0].steps);
    let seen = |heights_m: [f64; 2]| Staircase {
        stairs: vec![
            stair([0.5, 0.0, 0.0], [0.62, 0.0, 0.0], heights_m[0], 1.0),
            stair([0.62, 0.0, 0.0], [0.74, 0.0, 0.0], heights_m[1], 1.0),
        ],
        ..Staircase::default()
    };
    let (pose, config) = (PlanarPose::default(), ClimbingConfig::default());
    for heights_m in [[0.033, 0.061], [0.028, 0.064], [0.034, 0.06]] {
        flight.refresh(None, &seen(heights_m), &pose, &config);
        let rises_m = [heights_m[0], heights_m[1] - heights_m[0]];
        for (step, rise_m) in flight.steps.iter().zip(rises_m) {
            assert!(
                (step.rise_m - rise_m).abs() < 1e-9,
                "{heights_m:?} {step:?}"
            );
        }
    }
}
