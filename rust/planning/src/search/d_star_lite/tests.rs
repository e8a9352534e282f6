//! D* Lite against a fresh A*, after every change.

use super::*;
use crate::search::{Search, testing};
use geometry::SplitMix64;
use testing::{Change, World};

/// What a fresh A* finds in a world, and how many cells it looks at.
fn fresh(world: &World) -> (Option<f64>, usize) {
    let mut search = Search::default();
    let ending = |cell: usize| world.ending(cell);
    let found = search.run(&world.weights, world.cols, world.start, ending, |cell| {
        world.remaining(cell)
    });
    (found.map(|route| route.cost), search.expanded)
}

fn asked(world: &World) -> Asked<'_> {
    Asked {
        weights: &world.weights,
        cols: world.cols,
        start: world.start,
        ends: &world.ends,
    }
}

/// Compares with a fresh A*; returns the way, what was looked at, and what A* looked at.
fn compare(search: &mut DStarLite, world: &World) -> (Option<Route>, [usize; 2]) {
    let route = search.route();
    let (cost, expanded) = fresh(world);
    let own = route.as_ref().map(|route| route.cost);
    match (own, cost) {
        (Some(own), Some(cost)) => assert!((own - cost).abs() < 1e-6, "{own} against {cost}"),
        (own, cost) => assert_eq!(own, cost),
    }
    (route, [search.expanded, expanded])
}

/// A thousand changes of a few cells each, and of the ends now and then, while the start moves along the way.
fn a_thousand_changes(delayed: bool, seed: u64) {
    let mut random = SplitMix64::new(seed);
    let mut world = World::random(40, 30, &mut random);
    let mut search = DStarLite::new(delayed);
    search.begin(asked(&world));
    let (mut route, _) = compare(&mut search, &world);
    for change in 0..1000 {
        for Change { cell, weight } in world.change(&mut random) {
            search.set_weight(cell, weight);
        }
        if change % 50 == 49 {
            world.set_ends(&mut random);
            search.set_ends(&world.ends);
        }
        if change % 3 == 2 {
            world.walk(route.as_ref(), &mut random);
            let before = search.start;
            search.set_start(world.start);
            search.set_weight(before, world.weights[before]);
        }
        (route, _) = compare(&mut search, &world);
    }
}

#[test]
fn after_each_of_a_thousand_changes_the_cost_is_a_fresh_searchs() {
    for seed in 0..8 {
        a_thousand_changes(false, seed);
    }
}

#[test]
fn delayed_it_costs_the_same() {
    for seed in 0..8 {
        a_thousand_changes(true, seed);
    }
}

#[test]
fn a_grid_that_shifts_keeps_what_is_known_of_it() {
    let mut random = SplitMix64::new(3);
    for delayed in [false, true] {
        let mut world = World::random(40, 30, &mut random);
        let mut search = DStarLite::new(delayed);
        search.begin(asked(&world));
        let _ = compare(&mut search, &world);
        for _ in 0..150 {
            let by = [(1, 0), (0, 1), (-1, 0), (0, -1), (2, 1), (-1, -1)];
            let (cols, rows) = by[testing::below(by.len(), &mut random)];
            world.shift(cols, rows, &mut random);
            search.shift(cols, rows);
            let _ = search.take_changes(asked(&world), usize::MAX - 1);
            let _ = compare(&mut search, &world);
        }
    }
}

#[test]
fn more_changes_than_a_share_begin_anew_and_fewer_are_repaired() {
    let mut random = SplitMix64::new(4);
    let mut world = World::random(40, 30, &mut random);
    let mut search = DStarLite::new(false);
    for share in [0.0, 1.0, 0.005] {
        for _ in 0..30 {
            let _ = world.change(&mut random);
            let cost = search.run(asked(&world), share).map(|route| route.cost);
            assert_eq!(cost.is_some(), fresh(&world).0.is_some());
            if let (Some(own), Some(cost)) = (cost, fresh(&world).0) {
                assert!((own - cost).abs() < 1e-6);
            }
        }
    }
}

/// A corner-to-corner way through boxes.
fn boxes(random: &mut SplitMix64) -> World {
    const SIDE: usize = 150;
    let mut world = World {
        weights: vec![1.0; SIDE * SIDE],
        cols: SIDE,
        start: 3 * SIDE + 3,
        ends: vec![((SIDE * (SIDE - 3) - 4) as u32, 0.0)],
    };
    for _ in 0..40 {
        let [col, row] = [0; 2].map(|_| testing::below(SIDE - 20, random));
        world.set_box([col + 5, row + 5], 10, f32::INFINITY);
    }
    world
}

/// Looks at so many cells for boxes that come on the way or off it, in parts of what a fresh A* looks at.
fn share_looked_at(empty: &DStarLite, on_way: bool) -> f64 {
    let mut random = SplitMix64::new(6);
    let (mut repaired, mut anew) = (0, 0);
    for _ in 0..12 {
        let world = boxes(&mut random);
        let mut search = empty.clone();
        search.begin(asked(&world));
        let Some(route) = search.route() else {
            continue;
        };
        for _ in 0..10 {
            let mut changed = world.clone();
            let middle = route.cells[route.cells.len() / 2] as usize;
            let corner = if on_way {
                [middle % world.cols - 5, middle / world.cols - 5]
            } else {
                [0; 2].map(|_| 5 + testing::below(world.cols - 20, &mut random))
            };
            changed.set_box(corner, 10, f32::INFINITY);
            let lies_on =
                (route.cells.iter()).any(|&cell| changed.weights[cell as usize].is_infinite());
            if lies_on != on_way {
                continue;
            }
            let mut search = search.clone();
            let _ = search.take_changes(asked(&changed), usize::MAX - 1);
            let (_, [own, fresh]) = compare(&mut search, &changed);
            repaired += own;
            anew += fresh;
        }
    }
    assert!(anew > 0);
    repaired as f64 / anew as f64
}

#[test]
fn a_change_off_the_way_takes_less_than_a_third_of_a_new_search_and_one_on_it_less_than_all() {
    for delayed in [false, true] {
        let empty = DStarLite::new(delayed);
        let (off, on) = (
            share_looked_at(&empty, false),
            share_looked_at(&empty, true),
        );
        assert!(off < 1.0 / 3.0 && on < 1.0, "{off} off the way, {on} on it");
    }
}
