//! Circle and oriented footprint on the same maps: what passes, what it costs, and that nothing is touched.

use geometry::{Cell, Grid, Lattice, Map, Pose, Robot};
use mapping::{FloorView, Surface};
use proptest::prelude::*;
use stairs::{ClimbingConfig, Feet, Staircase};

use super::*;
use crate::path::ends::{PathEnds, run};
use crate::{AStar, AStarConfig, Footprint, Goal, Path, PathEnd, Plan, Planner, Refusal, Sidle};

/// Of the robot: the circle, and what it needs sideways, from front to back and across, m.
const RADIUS_M: f64 = 0.17;
const BOX_M: [f64; 2] = [0.23, 0.38];
const MARGIN_M: f64 = 0.03;
const NEEDED_M: f64 = RADIUS_M + MARGIN_M;
const GOAL: Goal = Goal {
    x_m: 1.2,
    y_m: 0.0,
    radius_m: 0.15,
    height_m: None,
};

fn planner(footprint: Footprint) -> AStar {
    let config = AStarConfig {
        footprint,
        margin: MARGIN_M,
        ..AStarConfig::default()
    };
    let feet = Feet {
        length_m: 0.105,
        pair_width_m: 0.16,
        stance_m: 0.085,
    };
    AStar::new(config, ClimbingConfig::default(), feet, RADIUS_M)
        .unwrap()
        .with_rectangle(BOX_M)
}

/// A window of floor, 3.2 m a side, around the origin.
fn floor(cell_m: f64) -> FloorView {
    let cells = (3.2 / cell_m).round() as usize;
    FloorView::new(
        Lattice {
            origin_m: [-1.6, -1.6],
            cell_m,
        },
        Grid::filled(cells, cells, Surface::Floor(0.0)),
        9,
    )
}

/// Sets all cells whose centre lies in the rectangle, or on its border.
fn stand(view: &mut FloorView, min: [f64; 2], max: [f64; 2]) {
    for cell in view.cells.area().cells() {
        let [x, y] = view.lattice.center_of(cell);
        let [x_in, y_in] =
            [(x, 0), (y, 1)].map(|(m, axis)| m > min[axis] - 1e-9 && m < max[axis] + 1e-9);
        if x_in && y_in {
            *view.cells.get_mut(cell).unwrap() = Surface::Obstacle(0.5);
        }
    }
}

/// A wall across the window from x = 0.4 on with a gap of some width around a place.
fn wall(view: &mut FloorView, thick_m: f64, gap_m: f64, middle_m: f64) {
    let end_m = 0.4 + thick_m;
    stand(view, [0.4, -1.6], [end_m, middle_m - 0.5 * gap_m]);
    stand(view, [0.4, middle_m + 0.5 * gap_m], [end_m, 1.6]);
}

fn plan(planner: &mut AStar, view: &FloorView, start: &Pose<Map, Robot>) -> Plan {
    planner
        .plan(view, &Staircase::default(), start, &GOAL)
        .unwrap()
}

fn at(x_m: f64, yaw_rad: f64) -> Pose<Map, Robot> {
    Pose::from_yaw(x_m, 0.0, 0.0, yaw_rad)
}

/// By brute force over all cells: whether a path comes nearer to any obstacle's centre than the circle, or on a leg sideways the
/// rectangle, allows.
fn touches(view: &FloorView, path: &Path) -> Option<[f64; 2]> {
    let obstacle = |cell: &Cell| matches!(view.cell(*cell), Surface::Obstacle(_));
    let cells: Vec<_> = view.cells.area().cells().filter(obstacle).collect();
    let free = |point: usize, at_m: [f64; 2]| {
        let on_leg = |sidle: &&Sidle| (sidle.from_point..=sidle.to_point).contains(&point);
        let sidle = path.sidles.iter().find(on_leg);
        cells.iter().all(|&cell| {
            let [x, y] = view.lattice.center_of(cell);
            let [dx, dy] = [x - at_m[0], y - at_m[1]];
            // A point of the path lies up to half a diagonal from the cell centre that the circle was looked at in.
            let off_m = 0.5_f64.sqrt() * view.lattice.cell_m;
            sidle.map_or(geometry::hypot(dx, dy) > NEEDED_M - off_m, |sidle| {
                let (sin, cos) = libm::sincos(sidle.heading_rad);
                let ahead_m = (cos * dx + sin * dy).abs();
                let aside_m = (cos * dy - sin * dx).abs();
                let [half_depth_m, half_width_m] = BOX_M.map(|m| 0.5 * m + MARGIN_M);
                // Looked at every half cell.
                aside_m > half_width_m - off_m || ahead_m > half_depth_m - 1e-9
            })
        })
    };
    let mut points = path.points_m.iter().copied().enumerate();
    points
        .find(|&(point, at_m)| !free(point, at_m))
        .map(|(_, at_m)| at_m)
}

#[test]
fn what_the_circle_refuses_is_passed_sideways_and_what_it_passes_is_passed_as_ever() {
    // M15: 2r - 1 cm and 2r + 4 cm, on cells so fine that they hold such widths.
    let (narrow_m, wide_m) = (2.0 * NEEDED_M - 0.01, 2.0 * NEEDED_M + 0.04);
    let [mut narrow, mut wide] = [floor(0.01), floor(0.01)];
    wall(&mut narrow, 0.05, narrow_m, 0.0);
    wall(&mut wide, 0.05, wide_m, 0.0);
    let start = at(-0.6, 0.0);
    let [mut circle, mut oriented] = [Footprint::Circle, Footprint::Oriented].map(planner);
    let no_way = plan(&mut circle, &narrow, &start).way.unwrap_err();
    assert_eq!(no_way.refusal, Refusal::TooNarrow);
    assert_eq!(
        no_way.sentence,
        "the widest gap is 0.38 m, 0.40 m are needed"
    );
    let path = plan(&mut oriented, &narrow, &start).way.unwrap();
    assert!(matches!(path.sidles[..], [sidle] if libm::cos(sidle.heading_rad).abs() < 1e-9));
    assert_eq!(touches(&narrow, &path), None);
    let [round, turned] = [Footprint::Circle, Footprint::Oriented]
        .map(|footprint| plan(&mut planner(footprint), &wide, &start).way.unwrap());
    assert_eq!(round, turned);
}

#[test]
fn what_is_narrower_than_the_body_is_deep_is_refused_with_its_figures() {
    let mut view = floor(0.01);
    wall(&mut view, 0.05, BOX_M[0] + 2.0 * MARGIN_M - 0.01, 0.005);
    let no_way = plan(&mut planner(Footprint::Oriented), &view, &at(-0.6, 0.0))
        .way
        .unwrap_err();
    assert_eq!(no_way.refusal, Refusal::TooNarrow);
    assert_eq!(
        no_way.sentence,
        "the widest gap is 0.28 m, 0.29 m are needed"
    );
}

#[test]
fn who_is_in_the_passage_already_goes_on_as_it_is_turned() {
    let mut view = floor(0.04);
    wall(&mut view, 0.12, 0.3, 0.02);
    let mut oriented = planner(Footprint::Oriented);
    let whole = plan(&mut oriented, &view, &at(0.0, 0.0)).way.unwrap();
    let [sidle] = whole.sidles[..] else {
        panic!("{:?}", whole.sidles)
    };
    let inside = Pose::from_yaw(0.45, 0.02, 0.0, sidle.heading_rad + 0.05);
    let kept = plan(&mut oriented, &view, &inside);
    assert!(!kept.replanned);
    let fresh = plan(&mut planner(Footprint::Oriented), &view, &inside);
    for path in [kept.way.unwrap(), fresh.way.unwrap()] {
        let [rest] = path.sidles[..] else {
            panic!("{:?}", path.sidles)
        };
        assert_eq!(rest.from_point, 0);
        assert!(wrap_angle(rest.heading_rad - sidle.heading_rad).abs() < 0.1);
        let [x, _] = path.points_m[rest.to_point];
        assert!(x > 0.58, "{x}");
    }
}

#[test]
fn a_passage_that_is_blocked_meanwhile_is_given_up() {
    let mut view = floor(0.04);
    wall(&mut view, 0.05, 0.3, 0.02);
    let mut oriented = planner(Footprint::Oriented);
    assert!(plan(&mut oriented, &view, &at(-0.6, 0.0)).way.is_ok());
    stand(&mut view, [0.4, -0.04], [0.5, 0.1]);
    assert!(plan(&mut oriented, &view, &at(-0.6, 0.0)).way.is_err());
}

/// A gap of any width in a wall of any thickness, and things before and behind it, none so small that it is taken for a speck.
fn house() -> impl Strategy<Value = FloorView> {
    let thing = (-0.3..1.4f64, -1.4..1.4f64, 0.12..0.3f64, 0.12..0.3f64);
    let things = prop::collection::vec(thing, 0..4);
    (0.04..0.4f64, 0.26..0.52f64, -0.6..0.6f64, things).prop_map(|(thick_m, gap_m, y_m, things)| {
        let mut view = floor(0.04);
        wall(&mut view, thick_m, gap_m, y_m);
        for (x, y, dx, dy) in things {
            stand(&mut view, [x, y], [x + dx, y + dy]);
        }
        view
    })
}

/// Cost of the cheapest route over what a planner has just read.
fn cost(planner: &mut AStar, start: [f64; 2]) -> f64 {
    let (terrain, links) = (&planner.terrain, &planner.links);
    let ends = PathEnds::new(
        terrain,
        &planner.outside,
        &GOAL,
        0.0,
        (&planner.config, &planner.climbing.levels),
    );
    let start = terrain.index_at(start).unwrap();
    let route = run(
        &mut planner.search,
        terrain,
        links,
        &ends,
        start,
        Fit::Holds,
    );
    route.map_or(f64::INFINITY, |route| route.cost)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn the_oriented_way_costs_no_more_than_the_circles_and_touches_nothing(view in house(), yaw in -3.1..3.1f64) {
        let [mut circle, mut oriented] = [Footprint::Circle, Footprint::Oriented].map(planner);
        let start = at(-1.0, yaw);
        let round = plan(&mut circle, &view, &start).way;
        let turned = plan(&mut oriented, &view, &start).way;
        let [round_cost, turned_cost] = [&mut circle, &mut oriented].map(|p| cost(p, [-1.0, 0.0]));
        prop_assert!(turned_cost <= round_cost + 1e-9, "{} {}", turned_cost, round_cost);
        prop_assert!(turned.is_ok() || round.is_err());
        if let Ok(path) = turned {
            prop_assert_eq!(touches(&view, &path), None, "{:?}", path);
            // What leads out of the window and back is compared with both, and by its length in the window alone.
            let inside = oriented.followed.as_ref().is_some_and(|followed| followed.end == PathEnd::Goal);
            if inside {
                prop_assert_eq!(path.sidles.is_empty(), turned_cost >= round_cost);
            }
        }
    }
}
