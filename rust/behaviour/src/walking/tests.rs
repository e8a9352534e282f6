//! Claims about the behaviour `walking`, tried on a simulated plane and on random situations.

use geometry::{PlanarPose, Pose};
use localization::Estimate;
use mapping::Surface;
use planning::{Goal, NoWay, Plan, Refusal};
use proptest::prelude::*;

use super::simulation::{Simulation, TICK_NS, walking};
use super::state::State;
use super::track::tests::straight;
use crate::machine::State as _;
use crate::{Behaviour, Gaze, Motion, Outcome, Situation, WalkingBehaviour, WalkingConfig};

#[test]
fn a_path_that_ends_at_the_rim_of_the_disc_is_followed_to_its_middle() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.1]);
    simulation.ends_at_the_rim = true;
    let (outcome, _) = simulation.run(60.0);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{:?}",
        simulation.states
    );
    let miss_m = geometry::hypot(simulation.pose.x_m - 1.0, simulation.pose.y_m - 0.1);
    assert!(miss_m < 0.08, "{miss_m}");
}

#[test]
fn beside_an_obstacle_in_the_disc_the_rim_will_do() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.1]);
    simulation.ends_at_the_rim = true;
    simulation.obstacles.push([1.25, 0.1, 0.08]);
    simulation.goal.radius_m = 0.2;
    let (outcome, _) = simulation.run(60.0);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{:?}",
        simulation.states
    );
    assert!(simulation.pose.x_m < 0.92, "{:?}", simulation.pose);
}

#[test]
fn the_robot_looks_around_before_its_first_step() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.5, 0.0]);
    let _ = simulation.run(60.0);
    assert_eq!(simulation.states[0].0, "look_around");
    let first_walk = simulation.states.iter().find(|(name, _)| *name == "walk");
    assert_eq!(
        first_walk.map(|(_, pose)| *pose),
        Some(PlanarPose::default())
    );
}

#[test]
fn an_obstacle_that_appears_stops_the_robot_and_is_walked_round() {
    let mut simulation = Simulation::new(PlanarPose::new(-1.0, 0.0, 0.0), [1.2, 0.0]);
    while simulation.pose.x_m < 0.0 {
        let _ = simulation.tick();
    }
    simulation.obstacles.push([0.34, 0.0, 0.1]);
    let (outcome, _) = simulation.run(150.0);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{:?}",
        simulation.states
    );
    assert!(simulation.was_in("stop"), "{:?}", simulation.states);
    let stopped_at = simulation
        .states
        .iter()
        .find(|(name, _)| *name == "stop")
        .unwrap()
        .1;
    assert!(stopped_at.x_m < 0.12, "{stopped_at:?}");
}

#[test]
fn who_sees_a_wall_in_time_goes_round_it_without_a_stop() {
    let mut simulation = Simulation::new(PlanarPose::new(-1.0, 0.0, 0.0), [1.2, 0.0]);
    simulation
        .obstacles
        .extend((-3..=3).map(|i| [0.2, f64::from(i) * 0.08, 0.06]));
    let (outcome, _) = simulation.run(150.0);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{:?}",
        simulation.states
    );
    assert!(!simulation.was_in("stop"), "{:?}", simulation.states);
}

#[test]
fn no_way_is_refused_with_the_planners_reason_after_looking_all_around() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.5, 0.0]);
    simulation.closed = true;
    let (outcome, after_s) = simulation.run(120.0);
    assert_eq!(
        outcome,
        Some(Outcome::Refused("blocked: walls all around".to_owned()))
    );
    assert!(after_s > 15.0 && after_s < 75.0, "{after_s}");
    let turns = simulation
        .states
        .iter()
        .filter(|(name, _)| *name == "turn")
        .count();
    assert_eq!(turns, 1, "{:?}", simulation.states);
    assert!(geometry::hypot(simulation.pose.x_m, simulation.pose.y_m) < 1e-9);
}

#[test]
fn a_goal_that_is_shut_in_is_looked_at_and_not_what_lies_elsewhere() {
    for (goal_m, turns) in [([1.5, 0.0], 0), ([-1.5, 0.0], 1)] {
        let mut simulation = Simulation::new(PlanarPose::default(), goal_m);
        simulation.closed = true;
        simulation.goal_is_shut_in = true;
        let (outcome, after_s) = simulation.run(120.0);
        assert!(matches!(outcome, Some(Outcome::Refused(_))));
        assert!(after_s < if turns == 0 { 15.0 } else { 60.0 }, "{after_s}");
        let turned = simulation.states.iter().filter(|(name, _)| *name == "turn");
        assert_eq!(turned.count(), turns, "{:?}", simulation.states);
    }
}

#[test]
fn a_way_that_opens_while_looking_is_taken() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.2, 0.0]);
    simulation.closed = true;
    let _ = simulation.run(15.0);
    simulation.closed = false;
    let (outcome, _) = simulation.run(120.0);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{:?}",
        simulation.states
    );
}

#[test]
fn a_blind_robot_stands_and_goes_on_when_it_sees_again() {
    let mut simulation = Simulation::new(PlanarPose::new(-1.0, 0.0, 0.0), [1.0, 0.0]);
    while simulation.pose.x_m < -0.5 {
        let _ = simulation.tick();
    }
    simulation.blind = true;
    for _ in 0..200 {
        let _ = simulation.tick();
    }
    let held = simulation.pose;
    let decision = simulation.tick();
    assert_eq!(
        (decision.state, decision.command.motion),
        ("blind", Motion::Stand)
    );
    for _ in 0..300 {
        let _ = simulation.tick();
    }
    assert_eq!(simulation.pose, held);
    simulation.blind = false;
    assert_eq!(simulation.run(120.0).0, Some(Outcome::GoalReached));
}

#[test]
fn who_stays_blind_is_lost() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
    simulation.blind = true;
    let (outcome, after_s) = simulation.run(90.0);
    assert!(
        matches!(outcome, Some(Outcome::Refused(reason)) if reason.starts_with("lost: no ground has been seen"))
    );
    assert!(after_s < 60.0);
}

#[test]
fn who_does_not_know_where_it_is_turns_until_it_does_and_goes_on() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.0, 0.0]);
    simulation.lost_until_s = 12.0;
    let (outcome, after_s) = simulation.run(120.0);
    assert_eq!(outcome, Some(Outcome::GoalReached));
    assert!(after_s > 12.0 && simulation.was_in("locate"));
    // It is where it was: no need to look round twice.
    let after = simulation
        .states
        .iter()
        .skip_while(|(name, _)| *name != "locate");
    assert!(after.clone().all(|(name, _)| *name != "look_around"));
}

#[test]
fn who_never_finds_out_where_it_is_gives_up_and_arrives_nowhere() {
    // It believes to stand at the goal.
    let mut simulation = Simulation::new(PlanarPose::default(), [0.0, 0.0]);
    simulation.lost_until_s = f64::INFINITY;
    let (outcome, after_s) = simulation.run(120.0);
    assert!(
        matches!(outcome, Some(Outcome::Refused(reason)) if reason.starts_with("lost: the robot has not found out"))
    );
    assert!(after_s > 55.0 && after_s < 75.0);
}

#[test]
fn a_hole_in_the_depth_image_is_looked_at_then_crossed_slowly() {
    let mut simulation = Simulation::new(PlanarPose::new(-1.0, 0.0, 0.0), [1.0, 0.0]);
    simulation.holes.push([0.0, 0.0, 0.2]);
    let (outcome, _) = simulation.run(150.0);
    assert_eq!(
        outcome,
        Some(Outcome::GoalReached),
        "{:?}",
        simulation.states
    );
    let looks: Vec<_> = simulation
        .states
        .iter()
        .filter(|(name, _)| *name == "look_around")
        .collect();
    assert!(looks.len() >= 2, "{:?}", simulation.states);
    assert!(looks[1].1.x_m < -0.2);
}

#[test]
fn a_via_point_is_passed_without_standing() {
    let mut simulation = Simulation::new(PlanarPose::new(-1.0, 0.0, 0.0), [0.0, 0.0]);
    simulation.last_goal = false;
    let mut passed = false;
    for _ in 0..12_000 {
        let decision = simulation.tick();
        if decision.goal_passed {
            passed = true;
            simulation.goal.x_m = 1.0;
            simulation.last_goal = true;
            simulation.plan = None;
        }
        if passed {
            let stands = decision.command.motion == Motion::Stand;
            assert!(
                !stands || simulation.pose.x_m > 0.8,
                "{:?}",
                simulation.states
            );
        }
        if decision.outcome == Some(Outcome::GoalReached) {
            assert!(passed && simulation.pose.x_m > 0.85);
            return;
        }
    }
    panic!("the goal was not reached: {:?}", simulation.states);
}

#[test]
fn a_robot_that_does_not_get_on_gives_up() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.5, 0.0]);
    let held = simulation.pose;
    for _ in 0..30_000 {
        let decision = simulation.tick();
        simulation.pose = held;
        if let Some(outcome) = decision.outcome {
            assert!(
                matches!(outcome, Outcome::Refused(reason) if reason.starts_with("blocked: no headway"))
            );
            return;
        }
    }
    panic!("it never gave up: {:?}", simulation.states);
}

/// One random tick: plan (none, way, no way), standing, frame, lost, distance to the goal.
type Event = (u8, bool, bool, bool, f64);

fn decide(
    behaviour: &mut WalkingBehaviour,
    tick: u64,
    event: Event,
    frames: &mut u64,
) -> (&'static str, Motion) {
    let (plan, standing, frame, lost, goal_x) = event;
    *frames += u64::from(frame);
    let simulation = Simulation::new(PlanarPose::default(), [goal_x, 0.1]);
    let way = match plan {
        0 => None,
        1 => Some(Ok(straight([0.0, 0.0], [goal_x, 0.1]))),
        _ => Some(Err(NoWay::new(Refusal::TooNarrow, "s".to_owned()))),
    };
    let plan = way.map(|way| Plan {
        way,
        replanned: false,
    });
    let estimate = Estimate {
        time_ns: tick * TICK_NS * 30,
        map_from_robot: Pose::identity(),
        map_from_odometry: Pose::identity(),
        lost,
    };
    let goal = Goal {
        x_m: goal_x,
        y_m: 0.1,
        radius_m: 0.15,
        height_m: None,
    };
    let decision = behaviour
        .next(&Situation {
            time_ns: tick * TICK_NS * 30,
            estimate: &estimate,
            view: &simulation.view,
            stairs: &stairs::Staircase::default(),
            takes_footsteps: true,
            stepping: crate::Stepping::default(),
            plan: plan.as_ref(),
            goal: &goal,
            last_goal: true,
            soles: crate::walking::simulation::SOLES,
            standing,
            gaze: Gaze::default(),
            frames_used: *frames,
            measured_share: Some(1.0),
            last_frame_ns: (*frames > 0)
                .then_some(tick * TICK_NS * 30 - u64::from(!frame) * TICK_NS * 60),
        })
        .unwrap();
    (decision.state, decision.command.motion)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn whatever_happens_only_legal_states_follow_and_the_feet_obey_them(
        events in prop::collection::vec((0..3u8, any::<bool>(), any::<bool>(), prop::bool::weighted(0.05), -2.0..2.0f64), 1..150)
    ) {
        let mut behaviour = walking(WalkingConfig::default());
        let by_name = |name: &str| State::all().into_iter().find(|state| state.name() == name).unwrap();
        let (mut before, mut frames) = (by_name("look_around"), 0);
        for (tick, event) in events.into_iter().enumerate() {
            let (name, motion) = decide(&mut behaviour, tick as u64 + 10, event, &mut frames);
            let state = by_name(name);
            prop_assert!(state.is_kind_of(&before) || before.may_become(&state), "{:?} -> {:?}", before, state);
            if let Motion::Walk(velocity) = motion {
                prop_assert!((velocity.x_mps + velocity.y_mps + velocity.yaw_radps).is_finite());
                prop_assert!(state.moves() || before.moves(), "{:?} walks", state);
            }
            before = state;
        }
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

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]
        #[test]
        fn every_goal_in_the_open_is_reached(
            x in -1.2..1.2f64, y in -1.2..1.2f64, yaw in -3.1..3.1f64, goal_x in -1.2..1.2f64, goal_y in -1.2..1.2f64,
        ) {
            let mut simulation = Simulation::new(PlanarPose::new(x, y, yaw), [goal_x, goal_y]);
            let (outcome, _) = simulation.run(150.0);
            prop_assert_eq!(outcome, Some(Outcome::GoalReached), "{:?}", simulation.states);
            let miss_m = geometry::hypot(simulation.pose.x_m - goal_x, simulation.pose.y_m - goal_y);
            prop_assert!(miss_m < 0.12, "{}", miss_m);
        }

        #[test]
        fn no_ground_is_stepped_on_that_was_not_seen(yaw in -3.1..3.1f64, goal_x in -1.2..1.2f64, goal_y in -1.2..1.2f64) {
            let mut simulation = Simulation::new(PlanarPose::new(0.0, 0.0, yaw), [goal_x, goal_y]);
            for _ in 0..12_000 {
                let decision = simulation.tick();
                let (x, y) = simulation.pose.apply(0.08, 0.0);
                let forward = matches!(decision.command.motion, Motion::Walk(v) if v.x_mps > 0.02);
                if forward && geometry::hypot(x, y) > 0.3 {
                    prop_assert!(simulation.view.at(x, y) != Surface::Unknown, "{} {} {:?}", x, y, simulation.states);
                }
                if decision.outcome.is_some() {
                    break;
                }
            }
        }
    }
}
