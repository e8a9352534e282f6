//! The generalized Voronoi diagram, its graph, plans on it, and rooms (004, section 36.2.3, Fig. 36.6).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod plans;
mod rooms;

use std::collections::{BTreeMap, VecDeque};

use geometry::{Cell, Grid, SplitMix64};
use plan_view::{VoronoiGraph, VoronoiGraphConfig};
use plans::{CELL_M, House, house, lattice, random_plan};

fn graph_of(free: &Grid<bool>) -> VoronoiGraph {
    VoronoiGraph::new(VoronoiGraphConfig::default(), lattice(), free).unwrap()
}

fn around(cell: Cell) -> impl Iterator<Item = Cell> {
    let beside = move |k: i32| Cell::new(cell.col + k % 3 - 1, cell.row + k / 3 - 1);
    (0..9).filter(|&k| k != 4).map(beside)
}

/// Distances in cells from a cell to all that are blocked or outside, and the directions to them.
fn obstacles(free: &Grid<bool>, cell: Cell) -> Vec<(f64, f64)> {
    let (cols, rows) = (free.cols() as i32, free.rows() as i32);
    let mut found = Vec::new();
    for row in -1..=rows {
        for col in -1..=cols {
            if free.get(Cell::new(col, row)) != Some(&true) {
                let (x, y) = (f64::from(col - cell.col), f64::from(row - cell.row));
                found.push((libm::hypot(x, y), libm::atan2(y, x)));
            }
        }
    }
    found
}

/// Pieces of cells that hang together over sides and corners, or over sides alone.
fn pieces(cells: &dyn Fn(Cell) -> bool, size: i32, corners: bool) -> usize {
    let mut seen = std::collections::BTreeSet::new();
    let mut count = 0;
    for at in 0..(size + 2) * (size + 2) {
        let first = Cell::new(at % (size + 2) - 1, at / (size + 2) - 1);
        if !cells(first) || !seen.insert(first) {
            continue;
        }
        count += 1;
        let mut queue = VecDeque::from([first]);
        while let Some(cell) = queue.pop_front() {
            for next in around(cell) {
                let side = next.col == cell.col || next.row == cell.row;
                let inside = (-1..=size).contains(&next.col) && (-1..=size).contains(&next.row);
                if inside && (side || corners) && cells(next) && seen.insert(next) {
                    queue.push_back(next);
                }
            }
        }
    }
    count
}

#[test]
fn every_cell_of_the_diagram_is_within_one_of_a_point_as_far_from_two_obstacles() {
    for seed in 0..10 {
        let free = random_plan(seed, 40, 8);
        for cell in graph_of(&free).cells() {
            let near = obstacles(&free, cell);
            let nearest = near
                .iter()
                .copied()
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap();
            // The other lies elsewhere: at least a twelfth of a turn away.
            let other = near
                .iter()
                .filter(|there| libm::cos(there.1 - nearest.1) < 0.866);
            let second = other.map(|there| there.0).fold(f64::INFINITY, f64::min);
            // A cell further it is nearer to one by as much as it is farther from the other.
            assert!(
                second - nearest.0 <= 2.0,
                "seed {seed}, {cell:?}: {nearest:?} {second}"
            );
        }
    }
}

#[test]
fn the_diagram_has_the_pieces_and_the_holes_of_the_free_space() {
    for seed in 0..20 {
        let free = random_plan(seed, 40, 10);
        let kept: std::collections::BTreeSet<Cell> = graph_of(&free).cells().collect();
        let is_free = |cell: Cell| free.get(cell) == Some(&true);
        assert_eq!(
            pieces(&|cell| kept.contains(&cell), 40, true),
            pieces(&is_free, 40, true),
            "seed {seed}"
        );
        assert_eq!(
            pieces(&|cell| !kept.contains(&cell), 40, false),
            pieces(&|cell| !is_free(cell), 40, false),
            "seed {seed}"
        );
    }
}

#[test]
fn at_meet_points_three_ways_or_more_begin_and_ways_end_where_they_say() {
    for seed in 0..40 {
        let graph = graph_of(&random_plan(seed, 60, 10));
        let mut begin = BTreeMap::new();
        for way in graph.ways() {
            for place in way.places {
                *begin.entry(place).or_insert(0_usize) += 1;
            }
            for (place, end) in way
                .places
                .iter()
                .zip([way.path_m.first(), way.path_m.last()])
            {
                assert_eq!(Some(&graph.places()[*place].position_m), end);
            }
            for pair in way.path_m.windows(2) {
                let step = libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
                assert!(
                    step < 1.5 * CELL_M,
                    "seed {seed}: a way has a gap of {step} m"
                );
            }
        }
        for (at, place) in graph.places().iter().enumerate() {
            let ways = begin.get(&at).copied().unwrap_or(0);
            let ring = graph.ways().iter().any(|way| way.places == [at, at]);
            assert!(
                ways != 2 || ring,
                "seed {seed}: nothing is decided at {place:?}"
            );
            assert_eq!(place.degree, ways);
        }
    }
}

/// Whether there is a way over cells that are so far from everything.
fn is_there_a_way(graph: &VoronoiGraph, size: i32, ends: [[f64; 2]; 2], least_m: f64) -> bool {
    let lattice = lattice();
    let wide =
        |cell: Cell| graph.clearance_m(lattice.center_of(cell)) >= least_m.max(CELL_M) - 1e-9;
    let [start, goal] = ends.map(|point| lattice.cell_at(point[0], point[1]));
    let mut seen = vec![false; (size * size) as usize];
    let mut queue = VecDeque::from([start]);
    while let Some(cell) = queue.pop_front() {
        let inside = (0..size).contains(&cell.col) && (0..size).contains(&cell.row);
        if !inside || !wide(cell) || seen[(cell.row * size + cell.col) as usize] {
            continue;
        }
        if cell == goal {
            return true;
        }
        seen[(cell.row * size + cell.col) as usize] = true;
        queue.extend(around(cell));
    }
    false
}

#[test]
fn there_is_a_plan_on_the_diagram_exactly_where_there_is_a_way_with_that_clearance() {
    let mut found = [0, 0];
    let mut numbers = SplitMix64::new(7);
    let graphs = (0..100).map(|seed| graph_of(&random_plan(seed, 48, 9)));
    for (number, graph) in graphs
        .flat_map(|graph| std::iter::repeat_n(graph, 10))
        .enumerate()
    {
        let mut point = || {
            let cell = Cell::new(
                (numbers.uniform() * 48.0) as i32,
                (numbers.uniform() * 48.0) as i32,
            );
            lattice().center_of(cell)
        };
        let ends = [point(), point()];
        let least_m = CELL_M * (1.0 + 5.0 * numbers.uniform());
        let plan = graph.plan(ends[0], ends[1], least_m);
        assert_eq!(
            plan.is_some(),
            is_there_a_way(&graph, 48, ends, least_m),
            "{number}"
        );
        found[usize::from(plan.is_some())] += 1;
        let Some(plan) = plan else { continue };
        assert_eq!([plan.path_m[0], *plan.path_m.last().unwrap()], ends);
        assert!(plan.clearance_m >= least_m - 1e-9);
        for pair in plan.path_m.windows(2) {
            assert!(libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]) < 1.5 * CELL_M);
        }
    }
    assert!(
        found.iter().all(|&count| count > 100),
        "both come: {found:?}"
    );
}

/// Cells that were seen from some places within a range, walls being a cell thicker here and there.
fn seen_from(house: &House, places: &[[usize; 2]], numbers: &mut SplitMix64) -> Grid<bool> {
    let (cols, rows) = (house.free.cols(), house.free.rows());
    let mut seen = Grid::filled(cols, rows, false);
    let is_free = |x: f64, y: f64| house.free.get(Cell::new(x as i32, y as i32)) == Some(&true);
    for place in places {
        for beam in 0..480 {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(beam) / 480.0);
            let (mut x, mut y) = (place[0] as f64 + 0.5, place[1] as f64 + 0.5);
            while is_free(x, y) {
                *seen.get_mut(Cell::new(x as i32, y as i32)).unwrap() = true;
                (x, y) = (x + 0.5 * cos, y + 0.5 * sin);
            }
        }
    }
    let values = seen.values().to_vec();
    for at in cols..cols * (rows - 1) {
        let by_a_wall = [at - 1, at + 1, at - cols, at + cols]
            .iter()
            .any(|&b| !values[b]);
        if values[at] && by_a_wall && numbers.uniform() < 0.02 {
            seen.values_mut()[at] = false;
        }
    }
    seen
}

#[test]
fn two_walks_through_a_house_make_the_same_graph() {
    // With every tenth cell by a wall instead of every fiftieth, a third of them differ by an end or by a place that is two.
    let mut same = 0;
    for seed in 0..10 {
        let house = house(seed);
        let mut numbers = SplitMix64::new(seed + 100);
        let free: Vec<usize> = (0..house.room_of.len())
            .filter(|&at| house.free.values()[at])
            .collect();
        let mut walk = || {
            let places: Vec<[usize; 2]> = (0..60)
                .map(|_| free[(numbers.uniform() * free.len() as f64) as usize])
                .map(|at| [at % house.free.cols(), at / house.free.cols()])
                .collect();
            graph_of(&seen_from(&house, &places, &mut numbers))
        };
        let (one, other) = (walk(), walk());
        same += u32::from(one.is_like(&other));
    }
    assert!(same >= 7, "{same} of 10");
}

#[test]
fn a_map_without_a_free_cell_has_no_places_and_no_plan() {
    let graph = graph_of(&Grid::filled(5, 4, false));
    assert!(graph.places().is_empty() && graph.ways().is_empty());
    assert_eq!(graph.plan([-0.9, 2.1], [-0.9, 2.1], 0.0), None);
    assert_eq!(graph.rooms().count, 0);
    let nothing = graph_of(&Grid::filled(0, 0, false));
    assert!(nothing.places().is_empty());
    let one = graph_of(&Grid::filled(1, 1, true));
    assert_eq!(one.cells().count(), 1);
    assert!(one.plan([-0.98, 2.02], [-0.98, 2.02], 0.0).is_some());
}
