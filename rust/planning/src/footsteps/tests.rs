//! Footsteps over floors, stairs and what stands in the way.

use std::f64::consts::{FRAC_PI_2, TAU};

use geometry::{Goal, Grid, Lattice, PlanarPose, SplitMix64};
use mapping::HeightMap;
use robot::Side;
use terrain::footholds::SoleSize;

use super::limits::StepReach;
use super::*;

/// As of the robot `qrio`.
pub(super) const LIMITS: StepLimits = StepLimits {
    sole: SoleSize {
        length_m: 0.105,
        width_m: 0.075,
    },
    stance_width_m: 0.085,
    foot_gap_m: 0.008,
    max_forward_m: 0.07,
    max_backward_m: 0.05,
    max_sideways_m: 0.1,
    max_turn_rad: 0.3,
    careful_forward_m: 0.135,
    walked_both: 1.5,
    careful_sideways_m: 0.05,
    careful_sideways_down_m: 0.015,
    careful_rise_m: 0.055,
    careful_lift_m: 0.11,
    clearance_m: [0.02, 0.02],
    walked_s: 0.5,
    careful_air_s: 0.8,
    careful_ground_s: 0.4,
    careful_speed_mps: 0.195,
    careful_lift_mps: 0.08,
    body_radius_m: 0.14,
    body_from_m: 0.15,
};

/// A map from -0.6 m to 3 m forward and 1.2 m to both sides.
pub(super) fn map(height_m: impl Fn(f64, f64) -> f64) -> HeightMap {
    let lattice = Lattice {
        origin_m: [-0.6, -1.2],
        cell_m: 0.01,
    };
    let mut heights_m = Grid::filled(360, 240, 0.0);
    for cell in heights_m.area().cells() {
        let [x_m, y_m] = lattice.center_of(cell);
        *heights_m.get_mut(cell).unwrap() = height_m(x_m, y_m) as f32;
    }
    HeightMap::new(lattice, heights_m, 0.0)
}

pub(super) fn goal(x_m: f64, y_m: f64) -> Goal {
    Goal {
        x_m,
        y_m,
        radius_m: 0.08,
        height_m: None,
    }
}

pub(super) fn layer() -> FootstepLayer {
    FootstepLayer::new(FootstepsConfig::default(), LIMITS).unwrap()
}

fn plan(map: &HeightMap, start: PlanarPose, to: Goal) -> Result<FootstepPlan, NoFootsteps> {
    let mut layer = layer();
    let feet = layer.feet_around(&start);
    let found = layer.plan(map, feet, &to);
    if let Ok(plan) = &found {
        assert_steps_are_possible(map, feet, &to, plan);
    }
    found
}

/// That each step is within reach of the other foot, rises no more than the legs do, and ends on a height of the map; that the feet take
/// turns; and that they end side by side at the goal.
fn assert_steps_are_possible(
    map: &HeightMap,
    feet: [PlanarPose; 2],
    to: &Goal,
    plan: &FootstepPlan,
) {
    let height_m = |pose: &PlanarPose| {
        f64::from(
            map.height_m(map.lattice.cell_at(pose.x_m, pose.y_m))
                .unwrap(),
        )
    };
    let mut feet = feet.map(|pose| (pose, height_m(&pose)));
    let mut before: Option<Side> = None;
    let mut cost_s = 0.0;
    for step in &plan.steps {
        assert_ne!(before, Some(step.side));
        before = Some(step.side);
        let (standing, standing_m) = feet[step.side.other().index()];
        let reach = LIMITS.reach(&standing.relative(&step.pose), step.side);
        assert!(reach.is_some(), "{step:?}");
        let there_m = f64::from(step.foothold.height_m);
        assert!(
            (there_m - standing_m).abs() < LIMITS.careful_rise_m,
            "{step:?}"
        );
        assert!((there_m - height_m(&step.pose)).abs() < 0.0061, "{step:?}");
        if step.manner == StepManner::Walked {
            let (moving, _) = feet[step.side.index()];
            assert!(
                LIMITS.walks_so_far(moving.distance_m(&step.pose)),
                "{step:?}"
            );
            assert!(step.foothold.bearing_share > 0.94, "{step:?}");
        }
        feet[step.side.index()] = (step.pose, there_m);
        cost_s += step.cost.total_s();
    }
    assert!((cost_s - plan.cost_s).abs() < 1e-9);
    assert!(plan.cost_s <= plan.first.0);
    let [(left, _), (right, _)] = feet;
    let middle_m = [0.5 * (left.x_m + right.x_m), 0.5 * (left.y_m + right.y_m)];
    assert!(geometry::distance_m(middle_m, [to.x_m, to.y_m]) < to.radius_m + 0.01);
    assert!((left.distance_m(&right) - LIMITS.stance_width_m).abs() < 0.01);
}

/// Steps forward from `first_m` on, as high and deep as this.
pub(super) fn flight(x_m: f64, first_m: f64, (rise_m, tread_m, count): (f64, f64, i32)) -> f64 {
    let steps = ((x_m - first_m) / tread_m).floor() as i32 + 1;
    rise_m * f64::from(steps.clamp(0, count))
}

#[test]
fn over_a_floor_it_walks_nearly_as_fast_as_legs_go() {
    let floor = map(|_, _| 0.0);
    let found = plan(&floor, PlanarPose::default(), goal(2.0, 0.3)).unwrap();
    let careful = |step: &&PlannedFootstep| step.manner == StepManner::Careful;
    assert_eq!(found.steps.iter().find(careful), None);
    let least_s = (2.02 - 0.08) / LIMITS.speed_mps();
    assert!(
        found.cost_s < 1.25 * least_s,
        "{} against {least_s}",
        found.cost_s
    );
}

#[test]
fn stairs_are_climbed_up_and_down_at_any_heading_foot_over_foot() {
    let up = |rise_m: f64, tread_m: f64| map(move |x_m, _| flight(x_m, 0.5, (rise_m, tread_m, 4)));
    for (rise_m, tread_m) in [(0.04, 0.2), (0.03, 0.12), (0.05, 0.11)] {
        for yaw_rad in [0.0, 0.35, -0.8] {
            let stairs = up(rise_m, tread_m);
            let found = plan(&stairs, PlanarPose::new(0.0, 0.0, yaw_rad), goal(1.7, 0.0)).unwrap();
            let careful = found
                .steps
                .iter()
                .filter(|step| step.manner == StepManner::Careful);
            assert!(
                (4..20).contains(&careful.count()),
                "{rise_m} {tread_m} {yaw_rad}"
            );
            let down = plan(
                &stairs,
                PlanarPose::new(1.7, 0.0, FRAC_PI_2 + yaw_rad),
                goal(0.0, 0.0),
            );
            assert!(down.is_ok(), "down {rise_m} {tread_m} {yaw_rad}: {down:?}");
        }
    }
}

#[test]
fn a_step_that_is_too_high_is_walked_round_or_refused_with_the_figure() {
    let wall = |from_m: f64| {
        map(move |x_m, y_m| {
            if (0.8..0.9).contains(&x_m) && y_m > from_m {
                0.07
            } else {
                0.0
            }
        })
    };
    let around = plan(&wall(-0.5), PlanarPose::default(), goal(1.6, 0.0)).unwrap();
    assert!(around.steps.iter().any(|step| step.pose.y_m < -0.45));
    let none = plan(&wall(-2.0), PlanarPose::default(), goal(1.6, 0.0));
    assert_eq!(none, Err(NoFootsteps::NoWay { rise_m: 0.055 }));
}

#[test]
fn who_walks_steps_far_or_to_the_side_and_who_steps_down_far_keeps_the_feet_together() {
    let reach = |x_m: f64, wider_m: f64| {
        let step = PlanarPose::new(x_m, LIMITS.stance_width_m + wider_m, 0.0);
        (
            LIMITS.reach(&step, Side::Left),
            LIMITS.reaches_down(&step, Side::Left, 0.05),
        )
    };
    let wide_m = LIMITS.careful_sideways_m.min(LIMITS.max_sideways_m);
    let ahead_m = LIMITS.max_forward_m;
    assert!(matches!(reach(ahead_m, 0.0).0, Some(StepReach::Walking)));
    assert!(matches!(reach(0.0, wide_m).0, Some(StepReach::Walking)));
    let both = reach(0.8 * ahead_m, 0.8 * wide_m).0;
    assert!(!matches!(
        both,
        Some(StepReach::Walking | StepReach::WalkingOnly)
    ));
    assert!(reach(0.9 * LIMITS.careful_forward_m, 0.0).1);
    assert!(
        !reach(
            0.9 * LIMITS.careful_forward_m,
            0.5 * LIMITS.careful_sideways_m
        )
        .1
    );
}

#[test]
fn where_levels_meet_nobody_knows_just_where_a_foot_goes_over_or_the_robot_looks_first() {
    let blurred = |half_m: f64| {
        let mut step = map(|x_m, _| if x_m < 0.5 { 0.0 } else { 0.03 });
        for cell in step.heights_m().area().cells() {
            let [x_m, _] = step.lattice.center_of(cell);
            if (x_m - 0.5).abs() < half_m {
                step.set_blurred(cell, if x_m < 0.5 { 0.0 } else { 0.03 });
            }
        }
        step
    };
    let ask = |half_m: f64, vain_m: &[[f64; 2]]| {
        let mut layer = layer();
        let question = FootstepQuestion {
            feet: layer.feet_around(&PlanarPose::default()),
            first: None,
            unseen: Unseen::Priced {
                stop_before_m: 0.2,
                faces_rad: 0.8,
            },
            vain_m,
            planned: &[],
        };
        layer.plan_over(&blurred(half_m), &question, &goal(1.2, 0.1))
    };
    let over = ask(0.02, &[]).unwrap();
    assert_eq!(over.exit_m, None);
    let mut onto = (over.steps.iter()).filter(|step| step.foothold.height_m > 0.02);
    // No more than a quarter of a sole hangs over what is blurred.
    assert!(onto.all(|step| step.foothold.bearing_share >= 0.75));
    let [x_m, y_m] = ask(0.1, &[]).unwrap().exit_m.unwrap();
    assert!((x_m - 0.5).abs() < 0.12, "{x_m}");
    // Where it was looked in vain it is looked no more.
    let beside = ask(0.1, &[[x_m, y_m]]).unwrap().exit_m.unwrap();
    assert!(
        geometry::distance_m(beside, [x_m, y_m]) > 0.05,
        "{beside:?}"
    );
}

#[test]
fn the_body_keeps_away_from_what_is_tall() {
    // A gap between two posts: wide enough for the feet, and for the body only in one of the maps.
    let posts = |half_m: f64| {
        map(move |x_m, y_m| {
            if (0.7..0.8).contains(&x_m) && y_m.abs() > half_m {
                0.5
            } else {
                0.0
            }
        })
    };
    assert!(plan(&posts(0.19), PlanarPose::default(), goal(1.5, 0.0)).is_ok());
    let narrow = plan(&posts(0.12), PlanarPose::default(), goal(1.5, 0.0));
    assert!(
        matches!(narrow, Err(NoFootsteps::NoWay { .. })),
        "{narrow:?}"
    );
}

#[test]
fn a_landing_turns_a_flight_by_a_quarter() {
    // Three steps forward, a landing, three steps to the left.
    let stairs = map(|x_m, y_m| {
        if y_m > 0.3 && x_m > 0.9 {
            0.12 + flight(y_m, 0.3, (0.04, 0.2, 3))
        } else if y_m < 0.3 && y_m > -0.3 {
            flight(x_m, 0.5, (0.04, 0.2, 3))
        } else {
            0.0
        }
    });
    let found = plan(&stairs, PlanarPose::default(), goal(1.3, 0.95)).unwrap();
    let top_m = found.steps.last().unwrap().foothold.height_m;
    assert!((top_m - 0.24).abs() < 1e-3);
    assert!(found.steps.len() < 60, "{}", found.steps.len());
}

#[test]
fn started_elsewhere_beside_the_cells_the_way_costs_three_careful_steps_more_at_most() {
    let mut random = SplitMix64::new(7);
    let stairs = map(|x_m, _| flight(x_m, 1.0, (0.04, 0.2, 3)));
    let from = |x_m: f64, y_m: f64| {
        let start = PlanarPose::new(0.3 + x_m, y_m, 0.0);
        plan(&stairs, start, goal(2.0 + x_m, y_m)).unwrap()
    };
    let straight_s = from(0.0, 0.0).cost_s;
    for _ in 0..6 {
        let [x_m, y_m] = random.normals::<2>().map(|normal| 0.01 * normal);
        let apart_s = (from(x_m, y_m).cost_s - straight_s).abs();
        let careful_s = LIMITS.careful_s(LIMITS.careful_forward_m, 0.04);
        assert!(apart_s < 3.0 * careful_s, "{x_m} {y_m}: {apart_s} s");
    }
}

#[test]
fn what_is_no_question_and_what_was_not_seen_is_said() {
    let floor = map(|_, _| 0.0);
    let nowhere = plan(&floor, PlanarPose::new(f64::NAN, 0.0, 0.0), goal(1.0, 0.0));
    assert_eq!(nowhere, Err(NoFootsteps::NotFinite));
    let unseen = map(|x_m, _| if x_m > 0.8 { f64::NAN } else { 0.0 });
    assert_eq!(
        plan(&unseen, PlanarPose::default(), goal(1.5, 0.0)),
        Err(NoFootsteps::UnseenGoal)
    );
    let blind = map(|x_m, _| if x_m < 0.5 { f64::NAN } else { 0.0 });
    let found = plan(&blind, PlanarPose::default(), goal(1.5, 0.0));
    assert_eq!(found, Err(NoFootsteps::UnseenStart(Side::Left)));
    let one = HeightMap::new(
        Lattice {
            origin_m: [0.0; 2],
            cell_m: 0.01,
        },
        Grid::filled(1, 1, 0.0),
        0.0,
    );
    let found = plan(&one, PlanarPose::new(0.005, 0.005, 0.0), goal(0.005, 0.005));
    assert!(found.is_err(), "{found:?}");
    let none = HeightMap::new(
        Lattice {
            origin_m: [0.0; 2],
            cell_m: 0.01,
        },
        Grid::filled(0, 0, 0.0),
        0.0,
    );
    assert_eq!(
        plan(&none, PlanarPose::default(), goal(0.5, 0.0)),
        Err(NoFootsteps::UnseenGoal)
    );
    for cell_m in [0.1, 1e-6, 0.0, f64::NAN] {
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m,
        };
        let map = HeightMap::new(lattice, Grid::filled(9, 9, 0.0), 0.0);
        let refused = plan(&map, PlanarPose::new(0.4, 0.4, 0.0), goal(0.5, 0.0)).unwrap_err();
        let said = format!("(half a sole's breadth): got {cell_m} m");
        assert!(refused.to_string().contains(&said), "{refused}");
    }
}

#[test]
fn the_same_question_has_the_same_answer_whatever_was_asked_before() {
    let stairs = map(|x_m, _| flight(x_m, 0.5, (0.04, 0.2, 3)));
    let mut used = layer();
    let mut answer = |x_m: f64, yaw_rad: f64| {
        let feet = used.feet_around(&PlanarPose::new(0.0, 0.0, yaw_rad));
        used.plan(&stairs, feet, &goal(x_m, 0.0))
    };
    let first = answer(1.5, 0.0);
    let _ = answer(1.0, 0.2 * TAU);
    assert_eq!(answer(1.5, 0.0), first);
}

#[test]
fn every_step_that_a_heading_offers_is_within_reach_and_none_is_missing_straight_ahead() {
    let table = step_table::StepTable::new(&FootstepsConfig::default(), &LIMITS, 0.01);
    for heading in 0..24 {
        for side in Side::BOTH {
            let mut table = table.clone();
            let steps = table.steps_mut(heading, side).clone();
            let standing = PlanarPose::new(0.0, 0.0, table.yaw_rad(heading));
            let places = steps.iter().map(|step| {
                let [x_m, y_m] = step.offset.map(|cells| 0.01 * f64::from(cells));
                let there = PlanarPose::new(x_m, y_m, table.yaw_rad(step.heading));
                standing.relative(&there)
            });
            assert!(
                places
                    .clone()
                    .all(|place| LIMITS.reach(&place, side).is_some())
            );
            let straight = places.filter(|place| place.yaw_rad.abs() < 1e-9);
            let farthest_m = straight.map(|place| place.x_m).fold(0.0, f64::max);
            assert!(farthest_m > 0.12, "{heading} {farthest_m}");
            assert!(
                steps
                    .iter()
                    .any(|step| step.heading == heading && step.reach == limits::StepReach::Walking)
            );
        }
    }
}
