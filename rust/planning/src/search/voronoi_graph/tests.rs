//! Ways by the diagram against ways over the whole grid.

use geometry::SplitMix64;
use geometry::distance::CellDistances;

use super::*;
use crate::search::Search;
use crate::search::testing::{World, below};

/// Open ground with some blocks, half of it dear.
fn blocks(cols: usize, rows: usize, random: &mut SplitMix64) -> World {
    let mut world = World::random(cols, rows, random);
    for (at, weight) in world.weights.iter_mut().enumerate() {
        *weight = if at % cols > cols / 2 { 2.0 } else { 1.0 };
    }
    for _ in 0..below(14, random) {
        let (left, low) = (below(cols, random), below(rows, random));
        let (wide, high) = (1 + below(cols / 3, random), 1 + below(rows / 3, random));
        for row in low..(low + high).min(rows) {
            for col in left..(left + wide).min(cols) {
                world.weights[row * cols + col] = f32::INFINITY;
            }
        }
    }
    world
}

fn route(weights: &[f32], world: &World) -> Option<Route> {
    let (ending, remaining) = (|cell| world.ending(cell), |cell| world.remaining(cell));
    Search::default().run(weights, world.cols, world.start, ending, remaining)
}

fn laid(search: &mut VoronoiGraphSearch, world: &World) {
    let graph = Graph {
        weights: &world.weights,
        cols: world.cols,
        links: None,
    };
    let ends = world.ends.iter().map(|end| end.0 as usize);
    let _ = search.lay(graph, ends.chain([world.start]));
}

#[test]
fn there_is_a_way_by_the_diagram_exactly_where_there_is_one_over_the_grid() {
    let mut random = SplitMix64::new(5);
    let mut search = VoronoiGraphSearch::default();
    let mut found = 0;
    for trial in 0..1000 {
        let world = if trial % 2 == 0 {
            World::random(24, 17, &mut random)
        } else {
            blocks(30, 22, &mut random)
        };
        laid(&mut search, &world);
        let (by_diagram, anywhere) = (
            route(search.weights(), &world),
            route(&world.weights, &world),
        );
        assert_eq!(by_diagram.is_some(), anywhere.is_some(), "trial {trial}");
        if let (Some(by_diagram), Some(anywhere)) = (by_diagram, anywhere) {
            found += 1;
            assert!(search.holds(&by_diagram));
            assert!(by_diagram.cost >= anywhere.cost - 1e-6, "trial {trial}");
        }
    }
    assert!(found > 300, "{found} ways are few");
}

#[test]
fn between_two_walls_the_way_keeps_to_the_middle() {
    let (cols, rows) = (60, 21);
    let mut random = SplitMix64::new(1);
    let mut world = World::random(cols, rows, &mut random);
    for (at, weight) in world.weights.iter_mut().enumerate() {
        let row = at / cols;
        *weight = if row == 0 || row + 1 == rows {
            f32::INFINITY
        } else {
            1.0
        };
    }
    (world.start, world.ends) = (3 * cols + 5, vec![((3 * cols + 54) as u32, 0.0)]);
    let mut search = VoronoiGraphSearch::default();
    laid(&mut search, &world);
    let by_diagram = route(search.weights(), &world).expect("a way");
    let mut distance = CellDistances::default();
    let blocked: Vec<bool> = world
        .weights
        .iter()
        .map(|weight| weight.is_infinite())
        .collect();
    distance.compute(&blocked, cols);
    let along = by_diagram
        .cells
        .iter()
        .filter(|&&cell| (18..42).contains(&(cell as usize % cols)));
    for &cell in along {
        assert!(
            distance.squared(cell as usize) >= 81,
            "a cell beside the middle is the most"
        );
    }
}
