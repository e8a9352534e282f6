//! Field D* against the grid's ways, and against a search over all places where it may cross.

use std::collections::HashMap;

use super::*;
use crate::search::Search;
use crate::search::testing::World;
use geometry::SplitMix64;

fn asked(world: &World) -> Asked<'_> {
    Asked {
        weights: &world.weights,
        cols: world.cols,
        start: world.start,
        ends: &world.ends,
    }
}

fn on_grid(world: &World) -> Option<f64> {
    let ending = |cell: usize| world.ending(cell);
    let remaining = |cell: usize| world.remaining(cell);
    let route = Search::default().run(&world.weights, world.cols, world.start, ending, remaining);
    Some(route?.cost)
}

/// The start of these tests may be entered: a line out of a blocked one costs something else than a step.
fn open_start(world: &mut World) {
    if world.weights[world.start].is_infinite() {
        world.weights[world.start] = 1.0;
    }
}

/// Checks a way: each corner on a line between middles, the cost what its lines cost.
fn check(found: &Route, world: &World) {
    let mut cost = 0.0;
    for pair in found.corners.windows(2) {
        assert!(pair[1].iter().any(|at| at.fract() == 0.0));
        let line = Line::between(pair[0], pair[1], &world.weights, world.cols).unwrap();
        cost += line.cost;
    }
    let [col, row] = found.corners.last().unwrap().map(|at| at as usize);
    cost += world.ending(row * world.cols + col).unwrap();
    assert!((cost - found.cost).abs() < 1e-6);
    for pair in found.cells.windows(2) {
        let [a, b] = [pair[0] as usize, pair[1] as usize];
        let apart = (a % world.cols)
            .abs_diff(b % world.cols)
            .max((a / world.cols).abs_diff(b / world.cols));
        assert_eq!(apart, 1);
    }
}

#[test]
fn a_way_costs_no_more_than_the_grids() {
    let mut random = SplitMix64::new(1);
    let (mut shorter, mut sum, mut count) = (0, 0.0, 0.0);
    for _ in 0..400 {
        let mut world = World::random(30, 25, &mut random);
        open_start(&mut world);
        let found = FieldDStar::new(8).run(asked(&world), 1.0);
        let grid = on_grid(&world);
        assert_eq!(found.is_some(), grid.is_some());
        if let (Some(found), Some(grid)) = (found, grid) {
            check(&found, &world);
            assert!(found.cost <= grid + 1e-6, "{} {grid}", found.cost);
            shorter += usize::from(found.cost < grid - 1e-6);
            sum += found.cost / grid.max(1e-9);
            count += 1.0;
        }
    }
    assert!(
        shorter > 200 && sum < 0.95 * count,
        "{shorter} of {count}, {sum}"
    );
}

#[test]
fn over_open_ground_it_goes_nearly_straight() {
    let world = World {
        weights: vec![1.0; 60 * 60],
        cols: 60,
        start: 0,
        ends: vec![(60 * 20 + 55, 0.0)],
    };
    let mut search = FieldDStar::new(8);
    let found = search.run(asked(&world), 1.0).unwrap();
    assert!(search.expanded() < 60 * 60);
    let straight = geometry::hypot(55.0, 20.0);
    assert!(found.cost < 1.01 * straight, "{} {straight}", found.cost);
    assert!(on_grid(&world).unwrap() > 1.07 * straight);
}

/// The cheapest way over all places where lines may be crossed, by comparing all with all.
fn brute_force(world: &World, pieces: usize) -> Option<f64> {
    let key = |at: [f64; 2]| at.map(|at| (at * pieces as f64).round() as i64);
    let (cols, rows) = (world.cols as f64, (world.weights.len() / world.cols) as f64);
    let start = [
        (world.start % world.cols) as f64,
        (world.start / world.cols) as f64,
    ];
    let mut costs = HashMap::from([(key(start), (0.0, start))]);
    let mut changed = vec![start];
    while let Some(here) = changed.pop() {
        let cost: f64 = costs[&key(here)].0;
        candidates(here, pieces, |to| {
            if to[0] < 0.0 || to[1] < 0.0 || to[0] > cols - 1.0 || to[1] > rows - 1.0 {
                return;
            }
            let Some(line) = Line::between(here, to, &world.weights, world.cols) else {
                return;
            };
            let through = cost + line.cost;
            let known = costs.get(&key(to)).map_or(f64::INFINITY, |known| known.0);
            if through < known - 1e-12 {
                let _ = costs.insert(key(to), (through, to));
                changed.push(to);
            }
        });
    }
    let ends = world.ends.iter().filter_map(|&(end, cost)| {
        let end = [
            (end as usize % world.cols) as f64,
            (end as usize / world.cols) as f64,
        ];
        Some(costs.get(&key(end))?.0 + cost)
    });
    ends.reduce(f64::min)
}

#[test]
fn on_small_grids_it_is_near_to_the_best_of_all_ways() {
    let mut random = SplitMix64::new(2);
    let (mut most, mut sum, mut count) = (1.0_f64, 0.0, 0.0);
    for _ in 0..60 {
        let mut world = World::random(6, 5, &mut random);
        open_start(&mut world);
        let found = FieldDStar::new(4)
            .run(asked(&world), 1.0)
            .map(|found| found.cost);
        let best = brute_force(&world, 4);
        assert_eq!(found.is_some(), best.is_some());
        if let (Some(found), Some(best)) = (found, best.filter(|&best| best > 1e-6)) {
            assert!(found >= best - 1e-6);
            most = most.max(found / best);
            sum += found / best;
            count += 1.0;
        }
    }
    assert!(most < 1.1 && sum / count < 1.02, "{most}");
}

#[test]
fn repaired_it_costs_what_it_does_when_begun_anew() {
    let mut random = SplitMix64::new(3);
    for _ in 0..5 {
        let mut world = World::random(30, 25, &mut random);
        let mut search = FieldDStar::new(8);
        for _ in 0..100 {
            open_start(&mut world);
            let repaired = search.run(asked(&world), 1.0);
            let anew = FieldDStar::new(8).run(asked(&world), 1.0);
            assert_eq!(repaired.is_some(), anew.is_some());
            if let (Some(repaired), Some(anew)) = (&repaired, &anew) {
                assert!(
                    (repaired.cost - anew.cost).abs() < 1e-4 * anew.cost,
                    "{} {}",
                    repaired.cost,
                    anew.cost
                );
            }
            let _ = world.change(&mut random);
            world.walk(repaired.as_ref(), &mut random);
        }
    }
}
