//! The guided planner as a whole: a house that is known, seen through a small window, and what stands there unmapped.

use geometry::{Grid, Lattice, Pose};
use mapping::Surface;
use proptest::prelude::*;
use stairs::{ClimbingConfig, Feet};

use super::*;
use crate::AStarConfig;

const CELL_M: f64 = 0.04;
const RADIUS_M: f64 = 0.14;
const HEIGHT_M: f64 = 0.58;
/// Half of the window around the robot, and how far it sees, m.
const WINDOW_M: f64 = 1.6;
const SIGHT_M: f64 = 1.2;

/// A block from its lowest to its highest corner, m.
type Block = [[f64; 3]; 2];

/// A floor of 4.8 m by 4 m.
const FLOOR: Block = [[0.0, 0.0, -0.04], [4.8, 4.0, 0.0]];

fn wall(low_m: [f64; 2], high_m: [f64; 2]) -> Block {
    [[low_m[0], low_m[1], 0.0], [high_m[0], high_m[1], 0.6]]
}

fn planner(radius_m: f64) -> AStar {
    let feet = Feet {
        length_m: 0.105,
        pair_width_m: 0.16,
        stance_m: 0.085,
    };
    let (config, climbing) = (AStarConfig::default(), ClimbingConfig::default());
    AStar::new(config, climbing, feet, radius_m).unwrap()
}

/// Walls around the floor, and what else stands there.
fn house(things: &[Block]) -> Vec<Block> {
    let walls = [
        wall([0.0, 0.0], [4.8, 0.08]),
        wall([0.0, 3.92], [4.8, 4.0]),
        wall([0.0, 0.0], [0.08, 4.0]),
        wall([4.72, 0.0], [4.8, 4.0]),
    ];
    [&walls, things].concat()
}

/// Knows a floor and what stands on it.
fn guided(things: &[Block]) -> Guided {
    let boxes = [&[FLOOR], things].concat();
    let map = KnownMap::of_boxes(&boxes, CELL_M).unwrap();
    Guided::new(planner(RADIUS_M), &map, HEIGHT_M, GuideConfig::default()).unwrap()
}

/// What is seen from a place of things on the floor: obstacles and floor within sight, nothing beyond.
fn seen(things: &[Block], at_m: [f64; 2]) -> FloorView {
    let cells = (2.0 * WINDOW_M / CELL_M) as usize;
    let corner_m = at_m.map(|at_m| ((at_m - WINDOW_M) / CELL_M).round() * CELL_M);
    let lattice = Lattice {
        origin_m: corner_m,
        cell_m: CELL_M,
    };
    let mut view = FloorView::new(lattice, Grid::filled(cells, cells, Surface::Unknown), 9);
    for cell in view.cells.area().cells() {
        let place_m = lattice.center_of(cell);
        if geometry::hypot(place_m[0] - at_m[0], place_m[1] - at_m[1]) < SIGHT_M {
            let stands = things.iter().any(|block| holds(block, place_m));
            let surface = [Surface::Floor(0.0), Surface::Obstacle(0.6)][usize::from(stands)];
            *view.cells.get_mut(cell).unwrap() = surface;
        }
    }
    view
}

fn holds([low_m, high_m]: &Block, at_m: [f64; 2]) -> bool {
    (0..2).all(|axis| at_m[axis] > low_m[axis] && at_m[axis] < high_m[axis])
}

fn goal(x_m: f64, y_m: f64) -> Goal {
    Goal {
        x_m,
        y_m,
        radius_m: 0.15,
        height_m: None,
    }
}

/// The largest distance between neighbouring points, m.
fn largest_jump_m(path: &Path) -> f64 {
    let jumps = path.points_m.windows(2);
    let jumps_m =
        jumps.map(|pair| geometry::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]));
    jumps_m.fold(0.0, f64::max)
}

/// Follows the planner 0.1 m at a time until the goal, at most so often; where the robot was, m.
fn walk(
    planner: &mut Guided,
    things: &[Block],
    from_m: [f64; 2],
    goal: &Goal,
) -> Result<Vec<[f64; 2]>, TestCaseError> {
    let (mut at_m, mut been_m) = (from_m, vec![from_m]);
    for _ in 0..200 {
        let start = Pose::from_yaw(at_m[0], at_m[1], 0.0, 0.0);
        let view = seen(things, at_m);
        let plan = planner.plan(&view, &Staircase::default(), &start, goal);
        let Ok(path) = plan.unwrap().way else {
            continue; // looks at the map again
        };
        prop_assert!(largest_jump_m(&path) <= 2.0_f64.sqrt() * CELL_M + 1e-9);
        prop_assert_eq!(path.unknown.len(), path.points_m.len());
        prop_assert_eq!(path.clearance_m.len(), path.points_m.len());
        let away_m = |point: &&[f64; 2]| geometry::hypot(point[0] - at_m[0], point[1] - at_m[1]);
        let next = path.points_m.iter().find(|point| away_m(point) > 0.1);
        let Some(&next_m) = next else {
            break; // arrived
        };
        at_m = next_m;
        been_m.push(at_m);
    }
    Ok(been_m)
}

#[test]
fn the_way_round_a_known_wall_leads_away_from_the_goal_at_first() {
    // The gap, at y = 3.4 to 3.9, lies outside of the window.
    let map = house(&[wall([2.4, 0.0], [2.48, 3.4])]);
    let (start_m, goal) = ([2.0, 0.6], goal(2.9, 0.6));
    let view = seen(&map, start_m);
    let start = Pose::from_yaw(start_m[0], start_m[1], 0.0, 0.0);
    let mut guided = guided(&map);
    let plan = guided.plan(&view, &Staircase::default(), &start, &goal);
    let path = plan.unwrap().way.unwrap();
    let away_m = |[x, y]: [f64; 2]| geometry::hypot(x - goal.x_m, y - goal.y_m);
    let metre = path.points_m[(1.0 / CELL_M) as usize];
    assert!(away_m(metre) > away_m(start_m) + 0.3, "{metre:?}");
    assert!(away_m(*path.points_m.last().unwrap()) < goal.radius_m);
    let crossings_m = |path: &Path| {
        let crosses = |pair: &&[[f64; 2]]| pair[0][0] < 2.44 && pair[1][0] >= 2.44;
        let crossings = path.points_m.windows(2).filter(crosses);
        crossings.map(|pair| pair[0][1]).collect::<Vec<_>>()
    };
    assert!(matches!(crossings_m(&path)[..], [y] if y > 3.4));
    assert!(largest_jump_m(&path) <= 2.0_f64.sqrt() * CELL_M);
    // Whoever knows only the window tries the wall where it was not seen yet.
    let near = planner(RADIUS_M).plan(&view, &Staircase::default(), &start, &goal);
    assert!(matches!(crossings_m(&near.unwrap().way.unwrap())[..], [y] if y < 3.0));
    let been_m = walk(&mut guided, &map, start_m, &goal).unwrap();
    assert!(
        away_m(*been_m.last().unwrap()) < goal.radius_m,
        "{been_m:?}"
    );
}

#[test]
fn what_blocks_the_nearer_of_two_ways_is_seen_and_the_other_one_taken() {
    // Ways round the wall above, from y = 3.0, and below, up to y = 0.6; the robot stands nearer to the upper.
    let map = house(&[wall([2.4, 0.6], [2.48, 3.0])]);
    let goal = goal(3.6, 2.4);
    let (above, below) = (|at: &[f64; 2]| at[1] > 3.0, |at: &[f64; 2]| at[1] < 0.6);
    let been_m = walk(&mut guided(&map), &map, [1.4, 2.4], &goal).unwrap();
    assert!(been_m.iter().any(above) && !been_m.iter().any(below));
    let mut there = map.clone();
    there.push(wall([2.2, 3.0], [2.6, 4.0]));
    let been_m = walk(&mut guided(&map), &there, [1.4, 2.4], &goal).unwrap();
    let [x, y] = *been_m.last().unwrap();
    assert!(been_m.iter().any(below), "{been_m:?}");
    assert!(
        geometry::hypot(x - goal.x_m, y - goal.y_m) < goal.radius_m,
        "{x} {y}"
    );
}

#[test]
fn a_path_is_lengthened_only_from_where_the_planner_was_sent() {
    let mut guided = guided(&[]);
    let (start_m, goal) = ([0.6, 2.0], goal(4.2, 2.0));
    let start = Pose::from_yaw(start_m[0], start_m[1], 0.0, 0.0);
    let plan = guided.plan(&seen(&[], start_m), &Staircase::default(), &start, &goal);
    let whole = plan.unwrap().way.unwrap();
    let sent = guided.sent.unwrap();
    let way = guided.way([start_m[0], start_m[1], 0.0]).unwrap();
    let to_m = |points: usize| {
        let mut path = whole.clone();
        path.points_m.truncate(points);
        path.unknown.truncate(points);
        path.clearance_m.truncate(points);
        guided.lengthen(&mut path, &way, sent, CELL_M);
        path
    };
    let away_m = |[x, y]: [f64; 2]| geometry::hypot(x - sent.0.x_m, y - sent.0.y_m);
    let off = whole.points_m.iter().position(|at_m| away_m(*at_m) < 0.5);
    let on = whole.points_m.iter().position(|at_m| away_m(*at_m) < 0.15);
    let (off, on) = (off.unwrap() + 1, on.unwrap() + 1);
    assert_eq!(to_m(off).points_m.len(), off);
    assert_eq!(to_m(off).cost_m, whole.cost_m);
    assert!(to_m(on).points_m.len() > on + 20);
    assert!(largest_jump_m(&to_m(on)) <= 2.0_f64.sqrt() * CELL_M);
}

#[test]
fn what_is_no_number_is_refused_and_nothing_is_changed() {
    let mut guided = guided(&[]);
    let view = seen(&[], [0.6, 2.0]);
    let start = Pose::from_yaw(0.6, 2.0, 0.0, 0.0);
    let plan = guided.plan(&view, &Staircase::default(), &start, &goal(f64::NAN, 2.0));
    assert_eq!(plan, Err(PlanError::NotFinite("the goal")));
    assert_eq!((guided.goal, guided.sent), (None, None));
}

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(30))]

        #[test]
        fn what_stands_there_unmapped_makes_no_path_jump_or_touch_it(
            things in prop::collection::vec((0.8..4.0f64, 0.4..3.4f64, 0.08..0.3f64, 0.08..0.5f64), 0..7),
        ) {
            let map = house(&[wall([2.4, 1.2], [2.48, 2.8])]);
            let (start_m, goal) = ([0.4, 2.0], goal(4.4, 2.0));
            let mut there = map.clone();
            there.extend(things.iter().map(|&(x, y, dx, dy)| wall([x, y], [x + dx, y + dy])));
            for [x, y] in walk(&mut guided(&map), &there, start_m, &goal)? {
                let lattice = seen(&there, [x, y]).lattice;
                let inside = there.iter().any(|block| holds(block, lattice.center_of(lattice.cell_at(x, y))));
                prop_assert!(!inside, "{} {}", x, y);
            }
        }
    }
}
