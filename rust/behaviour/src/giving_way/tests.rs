//! Somebody comes, and the robot is where it was told to be.

use geometry::{Grid, Lattice, Map, Odometry, Pose, Robot};
use localization::Estimate;
use mapping::{FloorView, Surface};
use planning::Goal;
use proptest::prelude::*;
use stairs::Staircase;

use super::*;
use crate::walking::simulation::{EXTENT, SOLES};
use crate::{Command, Stepping};

const EYE_M: f64 = 0.5;
const SAME_M: f64 = 0.012;
const STEP_S: f64 = 0.25;

fn view(surface: Surface) -> FloorView {
    let lattice = Lattice {
        origin_m: [-2.0, -2.0],
        cell_m: 0.04,
    };
    FloorView::new(lattice, Grid::filled(100, 100, surface), 1)
}

/// Paints a strip across x.
fn paint(view: &mut FloorView, from_x_m: f64, to_x_m: f64, surface: Surface) {
    for cell in view.cells.area().cells() {
        let [x_m, _] = view.lattice.center_of(cell);
        if (from_x_m..to_x_m).contains(&x_m) {
            *view.cells.get_mut(cell).unwrap() = surface;
        }
    }
}

/// Somebody of 12 cm radius, with 5 cm of room, who walks evenly.
fn walker(from_m: [f64; 2], velocity_mps: [f64; 2]) -> Mover {
    let at = |step: u32| {
        let time_s = f64::from(step) * STEP_S;
        [0, 1].map(|axis| from_m[axis] + time_s * velocity_mps[axis])
    };
    Mover {
        places_m: (0..=16).map(at).collect(),
        step_s: STEP_S,
        radius_m: 0.12,
        room_m: 0.05,
        is_sure: true,
    }
}

fn decision(motion: Motion) -> Decision {
    Decision {
        command: Command {
            motion,
            ..Command::default()
        },
        state: "walk",
        goal_passed: false,
        outcome: None,
    }
}

fn ahead() -> Motion {
    Motion::Walk(Velocity {
        x_mps: 0.1,
        ..Velocity::default()
    })
}

/// What becomes of a decision of a robot at a place that heads for x.
fn changed(
    giving_way: &mut GivingWay,
    motion: Motion,
    (place_m, view, goal_m): ([f64; 2], &FloorView, [f64; 2]),
    movers: &[Mover],
) -> Decision {
    let pose: Pose<Map, Robot> = Pose::from_yaw(place_m[0], place_m[1], 0.0, 0.0);
    let estimate = Estimate {
        time_ns: 0,
        map_from_robot: pose,
        map_from_odometry: Pose::<Map, Odometry>::identity(),
        lost: false,
    };
    let goal = Goal {
        x_m: goal_m[0],
        y_m: goal_m[1],
        radius_m: 0.15,
        height_m: None,
    };
    let situation = Situation {
        time_ns: 0,
        estimate: &estimate,
        view,
        stairs: &Staircase::default(),
        plan: None,
        goal: &goal,
        last_goal: true,
        standing: false,
        soles: SOLES,
        takes_footsteps: true,
        stepping: Stepping::default(),
        gaze: Gaze::default(),
        frames_used: 1,
        last_frame_ns: Some(0),
        measured_share: Some(1.0),
    };
    let mut decision = decision(motion);
    giving_way.change(&mut decision, &situation, (movers, EYE_M));
    decision
}

fn giving_way() -> GivingWay {
    GivingWay::new(GivingWayConfig::default(), &EXTENT, SAME_M).unwrap()
}

const FAR_M: [f64; 2] = [1.9, 0.0];

/// What becomes of walking ahead over a level floor where somebody is met.
fn on_the_way_meets(somebody: &Mover) -> Decision {
    let at = ([0.0; 2], &view(Surface::Floor(0.0)), FAR_M);
    changed(
        &mut giving_way(),
        ahead(),
        at,
        std::slice::from_ref(somebody),
    )
}

#[test]
fn where_nothing_moves_no_decision_is_changed() {
    let view = view(Surface::Floor(0.0));
    for motion in [ahead(), Motion::Stand] {
        let found = changed(
            &mut giving_way(),
            motion.clone(),
            ([0.0; 2], &view, FAR_M),
            &[],
        );
        assert_eq!(found, decision(motion));
    }
}

#[test]
fn who_comes_by_far_off_or_goes_away_is_no_reason_to_stop() {
    for somebody in [
        walker([1.5, 1.5], [-0.3, 0.0]),
        walker([0.4, 0.1], [0.3, 0.0]),
    ] {
        let found = on_the_way_meets(&somebody);
        assert_eq!(found.command.motion, ahead());
    }
}

#[test]
fn who_will_cross_the_way_ahead_is_waited_for_before_it() {
    // Two seconds on it is where the robot would then be; the place where the robot is stays free.
    let somebody = walker([0.55, -0.9], [0.0, 0.3]);
    let found = on_the_way_meets(&somebody);
    assert_eq!((found.command.motion, found.state), (Motion::Stand, "stop"));
}

#[test]
fn who_is_not_known_yet_is_looked_at_and_not_given_way() {
    let somebody = Mover {
        is_sure: false,
        ..walker([1.3, 0.5], [-0.3, -0.15])
    };
    let found = on_the_way_meets(&somebody);
    assert_eq!(found.command.motion, ahead());
    let away_m = geometry::hypot(1.3, 0.5);
    assert!((found.command.gaze.pan_rad - libm::atan2(0.5, 1.3)).abs() < 1e-9);
    assert!((found.command.gaze.down_rad - libm::atan2(EYE_M, away_m)).abs() < 1e-9);
}

#[test]
fn who_is_near_and_not_known_yet_is_waited_for_until_it_is() {
    let somebody = Mover {
        is_sure: false,
        ..walker([0.8, 0.5], [0.0, 0.0])
    };
    let found = on_the_way_meets(&somebody);
    assert_eq!((found.command.motion, found.state), (Motion::Stand, "stop"));
}

#[test]
fn who_would_be_touched_all_the_same_stands() {
    let somebody = walker([0.35, 0.0], [-0.3, 0.0]);
    let found = on_the_way_meets(&somebody);
    assert_eq!(found.command.motion, Motion::Stand);
}

/// Walks as it is told, at once, until all has passed; how near they came, m, rim to rim.
fn least_m(somebody: [[f64; 2]; 2], view: &FloorView, goal_m: [f64; 2]) -> f64 {
    let (mut giving_way, mut place_m) = (giving_way(), [0.0; 2]);
    let mut least_m = f64::INFINITY;
    for tick in 0..60 {
        let time_s = 0.1 * f64::from(tick);
        let [from_m, velocity_mps] = somebody;
        let now_m = [0, 1].map(|axis| from_m[axis] + time_s * velocity_mps[axis]);
        // Each tick has a frame of its own.
        giving_way.frame_ns = None;
        let movers = [walker(now_m, velocity_mps)];
        let found = changed(
            &mut giving_way,
            Motion::Stand,
            (place_m, view, goal_m),
            &movers,
        );
        if let Motion::Walk(velocity) = found.command.motion {
            place_m[0] += 0.1 * velocity.x_mps;
            place_m[1] += 0.1 * velocity.y_mps;
        }
        least_m = least_m.min(distance_m(now_m, place_m) - 0.12 - EXTENT.radius);
    }
    least_m
}

proptest! {
    #[test]
    fn who_walks_by_does_not_touch_who_has_room_to_step_aside(bearing in -3.1..3.1f64, by in -0.25..0.25f64) {
        let (sin, cos) = libm::sincos(bearing);
        let from_m = [1.2 * cos - by * sin, 1.2 * sin + by * cos];
        let least_m = least_m([from_m, [-0.3 * cos, -0.3 * sin]], &view(Surface::Floor(0.0)), FAR_M);
        prop_assert!(least_m > 0.0, "{least_m}");
    }
}

#[test]
fn nobody_steps_where_nothing_is_known_or_something_stands() {
    for blocked in [
        Surface::Unknown,
        Surface::Obstacle(0.5),
        Surface::Floor(-0.1),
    ] {
        let mut view = view(blocked);
        paint(&mut view, -0.02, 0.02, Surface::Floor(0.0));
        let somebody = walker([0.8, 0.05], [-0.3, 0.0]);
        let at = ([0.0; 2], &view, FAR_M);
        let found = changed(&mut giving_way(), ahead(), at, &[somebody]);
        match found.command.motion {
            Motion::Walk(velocity) => assert!(velocity.x_mps.abs() < 1e-9, "{velocity:?}"),
            motion => assert_eq!(motion, Motion::Stand),
        }
    }
}

#[test]
fn where_it_came_from_it_may_step_back_though_nobody_looked_at_that_ground() {
    let mut view = view(Surface::Floor(0.0));
    paint(&mut view, -2.0, 0.02, Surface::Unknown);
    let mut giving_way = giving_way();
    for x_m in [-0.4, -0.35, -0.3, -0.25, -0.2, -0.15, -0.1, -0.05, 0.0] {
        let _ = changed(&mut giving_way, ahead(), ([x_m, 0.0], &view, FAR_M), &[]);
    }
    let somebody = walker([0.3, -1.0], [0.0, 0.3]);
    let found = changed(
        &mut giving_way,
        ahead(),
        ([0.0; 2], &view, FAR_M),
        &[somebody],
    );
    assert_eq!(found.state, "give_way");
    assert!(matches!(found.command.motion, Motion::Walk(velocity) if velocity.x_mps < 0.0));
}

#[test]
fn at_its_goal_it_stays_and_listed_footsteps_are_taken() {
    let view = view(Surface::Floor(0.0));
    let somebody = [walker([0.8, 0.0], [-0.3, 0.0])];
    let found = changed(
        &mut giving_way(),
        Motion::Stand,
        ([0.0; 2], &view, [0.0; 2]),
        &somebody,
    );
    assert_eq!(found.command.motion, Motion::Stand);
    let listed = Motion::Footsteps(Vec::new());
    let found = changed(
        &mut giving_way(),
        listed.clone(),
        ([0.0; 2], &view, FAR_M),
        &somebody,
    );
    assert_eq!(found.command.motion, listed);
}
