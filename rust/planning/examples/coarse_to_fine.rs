//! What planning from coarse to fine saves, and what it costs: two storeys of rooms, joined by stairs, against A* over all cells
//! (H64: within 5 % of the cheapest way in a fifth of the time).
//!
//! `cargo run --release -p planning --example coarse_to_fine` prints time and cost over 100 pairs of places on 2 x 2000 x 2000 cells, half
//! of them on different storeys; `-- json` prints rows of `docs/results`.

#![expect(clippy::print_stdout, reason = "a measurement: it prints")]

use std::time::Instant;

use geometry::SplitMix64;
use planning::search::hierarchical::{HierarchicalConfig, HierarchicalSearch};
use planning::search::links::Links;
use planning::search::{Graph, Search, octile};

/// Side of a storey, cells.
const SIDE: usize = 2000;
/// Between the storeys is a row where nothing leads.
const STOREY: usize = SIDE * (SIDE + 1);
const PAIRS: usize = 100;
const SEEDS: u64 = 3;

struct House {
    weights: Vec<f32>,
    links: Links,
}

fn below(count: usize, random: &mut SplitMix64) -> usize {
    ((random.uniform() * count as f64) as usize).min(count - 1)
}

/// Rooms in a grid with walls and doors between them, some with none to one side; furniture in rooms, a metre costs more beside it; four
/// staircases.
fn house(seed: u64) -> House {
    let mut random = SplitMix64::new(seed);
    let mut weights = vec![1.0_f32; 2 * SIDE * SIDE + SIDE];
    weights[STOREY - SIDE..STOREY].fill(f32::INFINITY);
    let mut fill =
        |storey: usize, [col, row]: [usize; 2], [wide, high]: [usize; 2], weight: f32| {
            for row in row..(row + high).min(SIDE) {
                let first = storey * STOREY + row * SIDE;
                for cell in &mut weights[first + col.min(SIDE)..first + (col + wide).min(SIDE)] {
                    if weight == 1.0 || weight > *cell {
                        *cell = weight;
                    }
                }
            }
        };
    for storey in 0..2 {
        let room = 100 + 20 * below(4, &mut random);
        for at in (room..SIDE).step_by(room) {
            fill(storey, [at, 0], [4, SIDE], f32::INFINITY);
            fill(storey, [0, at], [SIDE, 4], f32::INFINITY);
        }
        for at in 0..SIDE.div_ceil(room) * SIDE.div_ceil(room) {
            let [col, row] = [
                at % SIDE.div_ceil(room) * room,
                at / SIDE.div_ceil(room) * room,
            ];
            for _ in 0..below(4, &mut random) {
                let at = [
                    col + 8 + below(room - 40, &mut random),
                    row + 8 + below(room - 40, &mut random),
                ];
                let size = [6 + below(30, &mut random), 6 + below(30, &mut random)];
                fill(storey, at.map(|at| at - 3), size.map(|size| size + 6), 2.0);
                fill(storey, at, size, f32::INFINITY);
            }
            let door = 10 + below(room - 40, &mut random);
            if below(10, &mut random) < 8 {
                fill(storey, [col + room, row + door], [4, 20], 1.0);
            }
            if below(10, &mut random) < 8 {
                fill(storey, [col + door, row + room], [20, 4], 1.0);
            }
        }
    }
    let mut links = Links::default();
    links.clear(weights.len());
    let mut stairs = 0;
    while stairs < 4 {
        let foot = below(SIDE * SIDE, &mut random);
        let head = STOREY + foot;
        if weights[foot] == 1.0 && weights[head] == 1.0 {
            let _ = links.add(foot, head, 60.0);
            let _ = links.add(head, foot, 60.0);
            stairs += 1;
        }
    }
    House { weights, links }
}

/// What was measured over the pairs of one house.
#[derive(Default)]
struct Measured {
    flat_s: f64,
    coarse_s: f64,
    ways: usize,
    worst: f64,
    sum: f64,
}

fn measure(house: &House, random: &mut SplitMix64) -> (f64, Measured) {
    let House { weights, links } = house;
    let graph = Graph {
        weights,
        cols: SIDE,
        links: Some(links),
    };
    let mut hierarchical = HierarchicalSearch::new(HierarchicalConfig::default());
    let began = Instant::now();
    hierarchical.read(weights, SIDE);
    hierarchical.build();
    let build_s = began.elapsed().as_secs_f64();
    let mut search = Search::default();
    let mut found = Measured::default();
    for pair in 0..PAIRS {
        let mut place = |storey: usize| loop {
            let at = storey * STOREY + below(SIDE * SIDE, random);
            if weights[at].is_finite() {
                return at;
            }
        };
        let (start, goal) = (place(pair % 2), place(usize::from(pair % 4 < 2)));
        let planar = |at: usize| ((at % SIDE) as f64, (at % STOREY / SIDE) as f64);
        let (x, y) = planar(goal);
        let remaining = |at: usize| octile(planar(at).0 - x, planar(at).1 - y);
        let ending = |at: usize| (at == goal).then_some(0.0);
        let began = Instant::now();
        let flat = search.run_linked(graph, |_| true, start, ending, remaining);
        found.flat_s += began.elapsed().as_secs_f64();
        let began = Instant::now();
        let question = (ending, remaining);
        let ends = [(goal as u32, 0.0)];
        let with = (&mut search, Some(links));
        let coarse = hierarchical.run(with, |_| true, start, &ends, question);
        found.coarse_s += began.elapsed().as_secs_f64();
        assert_eq!(flat.is_some(), coarse.is_some(), "pair {pair}");
        if let (Some(flat), Some(coarse)) = (flat, coarse) {
            let more = coarse.cost / flat.cost.max(1.0) - 1.0;
            found.ways += 1;
            found.sum += more;
            found.worst = found.worst.max(more);
        }
    }
    (build_s, found)
}

fn main() {
    let json = std::env::args().any(|word| word == "json");
    for seed in 0..SEEDS {
        let house = house(seed);
        let (build_s, found) = measure(&house, &mut SplitMix64::new(1000 + seed));
        let measured = format!(
            "{:.3} of the time ({:.1} and {:.1} ms a pair), {:.2} % dearer, {:.2} % at most, {} ways; building {build_s:.1} s",
            found.coarse_s / found.flat_s,
            found.coarse_s * 1e3 / PAIRS as f64,
            found.flat_s * 1e3 / PAIRS as f64,
            found.sum * 100.0 / found.ways.max(1) as f64,
            found.worst * 100.0,
            found.ways,
        );
        let what = format!("house {seed}");
        if json {
            println!(
                "{{\"what\": \"{what}\", \"measured\": \"{measured}\", \"wanted\": \"0.2 of the time, within 5 %\"}}"
            );
        } else {
            println!("{what}: {measured}");
        }
    }
}
