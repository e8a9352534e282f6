//! Walking where there are levels: never across an edge, onto what may be a drop, or into what stands on a stair.

use crate::course::{self, Course, goal, goal_at, plan, planner, refused, way, way_from};
use geometry::Cell;
use mapping::Surface;
use planning::search::links::Links;
use planning::search::{Graph, Search};
use planning::{Path, Refusal};
use proptest::prelude::*;

/// The pieces of a path that are walked.
fn walked(path: &Path) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let pieces = path.points_m.windows(2).enumerate();
    pieces.filter_map(|(i, pair)| {
        let climbed = |climb: &planning::Climb| (climb.from_point..climb.to_point).contains(&i);
        (!path.climbs.iter().any(climbed)).then_some([pair[0], pair[1]])
    })
}

/// Height of the floor at a point.
fn level(course: &Course, [x, y]: [f64; 2]) -> Option<f32> {
    match course.view.at(x, y) {
        Surface::Floor(height) => Some(height),
        _ => None,
    }
}

/// Lower corner, size, height and whether a stair of it is known.
type Block = (f64, f64, f64, f64, bool);

/// Whether two blocks, each with a cell around it, share ground.
fn overlap(a: &Block, b: &Block) -> bool {
    let apart = |a_low: f64, a_size: f64, b_low: f64, b_size: f64| {
        a_low > b_low + b_size + 0.04 || b_low > a_low + a_size + 0.04
    };
    !apart(a.0, a.2, b.0, b.2) && !apart(a.1, a.2, b.1, b.2)
}

/// Blocks of floor of random heights, with stairs of their own where `seen`. A block lies over those before it: what a
/// later one covers is not seen as a stair, since a stair says for certain which floor is there.
fn blocks(boxes: &[Block]) -> Course {
    let mut course = Course::floor();
    for (i, block) in boxes.iter().enumerate() {
        let &(x, y, size, height_m, seen) = block;
        let seen = seen && !boxes[i + 1..].iter().any(|later| overlap(block, later));
        let nearest = |low: f64| 0.0_f64.clamp(low, low + size);
        // Nothing lies on a stair that is seen: the view and the stairs tell the same.
        let covers = |stair: &stairs::Stair<geometry::Map>| {
            let (low, high) = (stair.front.right.inner, stair.back.left.inner);
            x < high.x && x + size > low.x && y < high.y && y + size > low.y
        };
        let covered = course.stairs.stairs.iter().any(covers);
        if covered || geometry::hypot(nearest(x), nearest(y)) < 0.3 {
            continue;
        }
        let height = Surface::Floor(height_m as f32);
        course.paint([x, y], [x + size, y + size], height);
        if seen {
            let mut stair = course::stair(x, size, height_m, size);
            course::shift(&mut stair, 0.0, 0.0);
            let aside = geometry::Pose::from_yaw(0.0, y + 0.5 * size, 0.0, 0.0);
            course.stairs.stairs.push(stair.transformed(&aside));
        }
    }
    course
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(80))]
    #[test]
    fn no_leg_that_is_walked_joins_levels(
        boxes in prop::collection::vec((-1.8..1.6f64, -1.8..1.6f64, 0.3..0.9f64, -0.06..0.06f64, any::<bool>()), 0..9),
        to in (-1.7..1.7f64, -1.7..1.7f64),
    ) {
        let course = blocks(&boxes);
        let Ok(path) = plan(&mut planner(), &course, [0.0; 3], 0.0, &goal(to.0, to.1)).way else { return Ok(()) };
        for pair in walked(&path) {
            for piece in 0..4 {
                let at = |t: f64| [pair[0][0] + t * (pair[1][0] - pair[0][0]), pair[0][1] + t * (pair[1][1] - pair[0][1])];
                let (here, next) = (at(0.25 * f64::from(piece)), at(0.25 * f64::from(piece + 1)));
                if let (Some(a), Some(b)) = (level(&course, here), level(&course, next)) {
                    // Beside a climb the cell of the edge may have either height: the stair itself says where it is.
                    let at_edge = path.climbs.iter().flat_map(|climb| &climb.steps)
                        .any(|step| step.stair.front.beyond_m(here).abs() < 0.04 || step.stair.front.beyond_m(next).abs() < 0.04);
                    prop_assert!((a - b).abs() <= 0.01 || at_edge, "{here:?} {a} {next:?} {b}");
                }
            }
        }
        for climb in &path.climbs {
            for step in &climb.steps {
                prop_assert!(step.rise_m.abs() > 0.01 && step.rise_m.abs() <= 0.0525);
            }
        }
    }

    #[test]
    fn the_cost_with_links_equals_dijkstras(
        weights in prop::collection::vec(prop_oneof![3 => 1.0..4.0f32, 1 => Just(f32::INFINITY)], 300),
        links in prop::collection::vec((0..300_usize, 0..303_usize, 1.0..2.0f64), 0..12),
        start in 0..300_usize, end in 0..300_usize,
    ) {
        const COLS: usize = 20;
        let octile = |a: usize, b: usize| planning::search::octile(
            (a % COLS) as f64 - (b % COLS) as f64, (a / COLS) as f64 - (b / COLS) as f64);
        let mut all = Links::default();
        all.clear(weights.len());
        for &(from, to, factor) in &links {
            let least = if to < 300 { octile(from, to) } else { octile(from, end) };
            let _ = all.add(from, to, factor * least + 0.1);
        }
        let graph = Graph { weights: &weights, cols: COLS, links: Some(&all) };
        let ending = |node: usize| (node == end || node >= 300).then_some(0.0);
        let remaining = |node: usize| if node < 300 { octile(node, end) } else { 0.0 };
        let mut search = Search::default();
        let found = search.run_linked(graph, |_| true, start, ending, remaining);
        let reference = search.run_linked(graph, |_| true, start, ending, |_| 0.0);
        prop_assert_eq!(found.is_some(), reference.is_some());
        if let (Some(found), Some(reference)) = (found, reference) {
            prop_assert!((found.cost - reference.cost).abs() < 1e-9);
        }
    }
}

#[test]
fn a_drop_off_beside_a_staircase_is_never_walked_over() {
    // The goal lies beside the landing, below it: the way leads back down the stairs.
    let course = Course::staircase(4, 0.03, 0.33);
    let path = way_from(&course, [1.5, 0.0, 0.12], 0.0, &goal(1.5, 0.6));
    let steps: usize = path.climbs.iter().map(|climb| climb.steps.len()).sum();
    assert_eq!(steps, 4);
}

#[test]
fn on_a_platform_unseen_ground_is_no_ground() {
    let mut course = Course::staircase(4, 0.03, 0.33);
    course.forget([1.69, -2.0], [2.0, 2.0]);
    course.forget([1.36, 0.165], [2.0, 2.0]);
    course.forget([1.36, -2.0], [2.0, -0.165]);
    let path = way_from(&course, [1.5, 0.0, 0.12], 0.0, &goal(1.9, 0.5));
    let first = path.climbs.first().map(|climb| climb.from_point).unwrap();
    for [x, y] in &path.points_m[..first] {
        assert!(y.abs() < 0.1 && *x < 1.62, "{x} {y}");
    }
}

#[test]
fn on_a_platform_what_was_seen_too_rarely_is_no_ground_and_a_missed_pixel_is() {
    let mut course = Course::floor();
    course.paint([-0.4, -0.4], [1.2, 0.4], Surface::Floor(0.1));
    let view = &mut course.view;
    // A column across the way that the camera missed.
    let missed = view.lattice.cell_at(0.5, 0.0).col;
    // Beyond the left side it once saw floor a little lower.
    for cell in view.cells.area().cells() {
        let [x, y] = view.lattice.center_of(cell);
        if cell.col == missed {
            *view.cells.get_mut(cell).unwrap() = Surface::Unknown;
        } else if y > 0.4 {
            *view.cells.get_mut(cell).unwrap() = Surface::Floor(0.07);
            *view.sightings.get_mut(cell).unwrap() = u16::from(x > -1.0);
        }
    }
    let start = [0.0, 0.0, 0.1];
    let path = way_from(&course, start, 0.0, &goal(0.9, 0.0));
    assert!(path.points_m.iter().all(|point| point[1].abs() < 0.1));
    let over = plan(&mut planner(), &course, start, 0.0, &goal(0.0, 1.2));
    if let Ok(path) = over.way {
        assert!(path.points_m.iter().all(|point| point[1] < 0.4));
    }
}

#[test]
fn a_box_whose_top_is_flat_is_kept_clear_of_by_the_body() {
    let mut course = Course::floor();
    course.paint([0.6, -0.2], [0.9, 0.12], Surface::Floor(0.25));
    let path = way(&course, 0.0, &goal(1.5, 0.0));
    for [x, y] in path.points_m {
        let away_m = geometry::hypot(x - x.clamp(0.6, 0.9), y - y.clamp(-0.2, 0.12));
        assert!(away_m > 0.14, "{x} {y}");
    }
}

#[test]
fn a_line_of_cells_that_was_not_seen_before_a_box_is_no_shadow_below_an_edge() {
    let mut course = Course::floor();
    course.paint([0.9, -2.0], [1.3, -0.25], Surface::Floor(0.12));
    course.paint([0.9, 0.14], [1.3, 2.0], Surface::Obstacle(0.3));
    course.forget([1.08, -0.25], [1.12, -0.12]);
    let path = way(&course, 0.0, &goal(1.8, 0.0));
    assert!(path.cost_m < 2.5, "{}", path.cost_m);
}

#[test]
fn what_the_robot_cannot_see_around_its_feet_is_free_to_leave() {
    let mut course = Course::floor();
    course.paint([-2.0, -2.0], [1.0, 2.0], Surface::Floor(0.1));
    course.forget([-0.2, -0.2], [0.2, 0.2]);
    let path = way_from(&course, [0.0, 0.0, 0.1], 0.0, &goal(0.7, 0.0));
    assert!(path.climbs.is_empty());
}

#[test]
fn risers_that_are_taken_for_obstacles_do_not_bar_a_staircase_and_a_box_on_the_landing_does() {
    let mut course = Course::staircase(4, 0.03, 0.33);
    let to = goal_at(1.52, 0.0, 0.12);
    for i in 0..4_i32 {
        for y in -4..4_i32 {
            let cell = course
                .view
                .lattice
                .cell_at(1.0 + 0.12 * f64::from(i), 0.04 * f64::from(y));
            let top = 0.03 * (i as f32 + 1.0) + 0.03;
            if (i + y) % 4 == 0
                && let Some(slot) = course.view.cells.get_mut(Cell::new(cell.col, cell.row))
            {
                *slot = Surface::Obstacle(top);
            }
        }
    }
    assert_eq!(way(&course, 0.0, &to).climbs.len(), 1);
    course.paint([1.44, -0.16], [1.6, 0.16], Surface::Obstacle(0.3));
    assert!(
        plan(&mut planner(), &course, [0.0; 3], 0.0, &to)
            .way
            .is_err()
    );
}

#[test]
fn a_step_at_which_no_stair_is_known_is_looked_at_from_near_and_then_refused() {
    let mut course = Course::floor();
    course.paint([0.8, -2.0], [2.0, 2.0], Surface::Floor(0.03));
    let (to, mut planner) = (goal(1.5, 0.0), planner());
    let (mut at, mut calls) = ([0.0, 0.0], 0);
    let mut nearest = f64::INFINITY;
    let no_way = loop {
        calls += 1;
        assert!(calls < 2000, "it looks for ever");
        match plan(&mut planner, &course, [at[0], at[1], 0.0], 0.0, &to).way {
            Ok(path) => {
                assert!(path.climbs.is_empty());
                at = path.points_m[2.min(path.points_m.len() - 1)];
                nearest = nearest.min(0.8 - at[0]);
            }
            Err(no_way) => break no_way,
        }
    };
    assert!((0.08..0.3).contains(&nearest), "{nearest}");
    assert_eq!(no_way.refusal, Refusal::Blocked);
    assert!(
        no_way.sentence.contains("a step of 30 mm"),
        "{}",
        no_way.sentence
    );
}

#[test]
fn a_drop_and_a_high_step_without_stairs_are_named() {
    let mut course = Course::floor();
    course.paint([0.8, -2.0], [2.0, 2.0], Surface::Floor(-0.2));
    let (refusal, sentence) = refused(&course, 0.0, &goal(1.5, 0.0));
    assert_eq!(
        (refusal, sentence.as_str()),
        (Refusal::Drop, "it goes down 200 mm, 50 mm is the limit")
    );
    course.paint([0.8, -2.0], [2.0, 2.0], Surface::Floor(0.08));
    let (refusal, sentence) = refused(&course, 0.0, &goal(1.5, 0.0));
    assert_eq!(
        (refusal, sentence.as_str()),
        (
            Refusal::StepTooHigh,
            "the step is 80 mm high, 50 mm is the limit"
        )
    );
}

#[test]
fn a_goal_on_a_level_that_was_not_seen_is_searched_for() {
    // Nothing is known but the ground near the robot.
    let mut course = Course::floor();
    course.forget([0.5, -2.0], [2.0, 2.0]);
    let path = way(&course, 0.0, &goal_at(1.5, 0.0, 0.12));
    let end = path.points_m.last().unwrap();
    assert!(end[0] > 0.5, "{end:?}");
}
