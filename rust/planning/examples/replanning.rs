//! What it takes to have a cheapest way again after a change: a fresh A*, the rule by which a way stands, D* Lite, Delayed D*, Field D*.
//!
//! `cargo run --release -p planning --example replanning` prints a table of ratios to a fresh A* on the same grid, median and 99th
//! percentile, on 400 x 400 cells with 120 boxes; `-- json` prints it as rows of `docs/results`.

#![expect(
    clippy::expect_used,
    clippy::print_stdout,
    clippy::too_many_lines,
    reason = "a measurement: it prints, may end with a panic, and is read from above to below"
)]

use std::hint::black_box;
use std::time::Instant;

use geometry::SplitMix64;
use planning::search::d_star_lite::{Asked, DStarLite};
use planning::search::field_d_star::FieldDStar;
use planning::search::kept::{KeptRoute, WeightChange};
use planning::search::{Route, Search, octile};

const SIDE: usize = 400;
const START: usize = 3 * SIDE + 3;
const GOAL: usize = (SIDE - 4) * SIDE + SIDE - 4;
const GRIDS: usize = 12;
const CHANGES: usize = 10;
/// The side of the box that appears, cells.
const BOX: usize = 10;

fn below(count: usize, random: &mut SplitMix64) -> usize {
    ((random.uniform() * count as f64) as usize).min(count - 1)
}

/// Boxes between the corners.
fn grid(random: &mut SplitMix64) -> Vec<f32> {
    let mut weights = vec![1.0; SIDE * SIDE];
    for _ in 0..120 {
        let [col, row] = [8 + below(350, random), 8 + below(350, random)];
        let [width, height] = [2 + below(30, random), 2 + below(30, random)];
        for row in row..row + height {
            weights[row * SIDE + col..][..width].fill(f32::INFINITY);
        }
    }
    weights
}

/// The grid from corner to corner.
const fn asked(weights: &[f32]) -> Asked<'_> {
    Asked {
        weights,
        cols: SIDE,
        start: START,
        ends: &[(GOAL as u32, 0.0)],
    }
}

fn remaining(cell: usize) -> f64 {
    let off = |at: usize, goal: usize| f64::from(at as i32 - goal as i32);
    octile(off(cell % SIDE, GOAL % SIDE), off(cell / SIDE, GOAL / SIDE))
}

fn fresh(search: &mut Search, weights: &[f32], start: usize) -> Option<Route> {
    let ending = |cell: usize| (cell == GOAL).then_some(0.0);
    search.run(weights, SIDE, start, ending, remaining)
}

/// Least time of a few runs, us: what else the computer does only adds to it.
fn least_us<T>(mut run: impl FnMut() -> T) -> (f64, T) {
    let mut best: Option<(f64, T)> = None;
    for _ in 0..3 {
        let began = Instant::now();
        let result = black_box(run());
        let us = began.elapsed().as_secs_f64() * 1e6;
        if best.as_ref().is_none_or(|best| us < best.0) {
            best = Some((us, result));
        }
    }
    best.expect("there were runs")
}

/// What was measured of one way to replan.
#[derive(Default)]
struct Measured {
    us: Vec<f64>,
    expanded: f64,
}

impl Measured {
    fn add(&mut self, us: f64, expanded: usize) {
        self.us.push(us);
        self.expanded += expanded as f64;
    }

    /// A percentile, us.
    fn at(&self, share: f64) -> f64 {
        let mut us = self.us.clone();
        us.sort_by(f64::total_cmp);
        us[((us.len() - 1) as f64 * share).round() as usize]
    }
}

const WAYS: [&str; 6] = [
    "fresh A*",
    "the rule, A* where the way does not stand",
    "the rule where the way stands",
    "D* Lite",
    "Delayed D*",
    "Field D*, repaired",
];

/// Boxes that appear and go again, on the way or off it.
fn measure(on_way: bool) -> [Measured; 6] {
    let mut random = SplitMix64::new(7);
    let mut found: [Measured; 6] = Default::default();
    let (mut search, mut scratch) = (Search::default(), KeptRoute::default());
    for _ in 0..GRIDS {
        let mut weights = grid(&mut random);
        let Some(route) = fresh(&mut search, &weights, START) else {
            continue;
        };
        let mut kept = KeptRoute::default();
        kept.keep(&route, &weights, SIDE);
        let mut lite = [DStarLite::new(false), DStarLite::new(true)];
        for lite in &mut lite {
            let _ = lite.run(asked(&weights), 1.0);
        }
        let mut field = FieldDStar::new(8);
        let _ = field.run(asked(&weights), 1.0);
        for _ in 0..CHANGES {
            let middle = route.cells
                [below(route.cells.len() / 2, &mut random) + route.cells.len() / 4]
                as usize;
            let corner = if on_way {
                (middle / SIDE - BOX / 2) * SIDE + middle % SIDE - BOX / 2
            } else {
                (8 + below(370, &mut random)) * SIDE + 8 + below(370, &mut random)
            };
            let cells = (0..BOX * BOX).map(|at| corner + at / BOX * SIDE + at % BOX);
            let changes: Vec<WeightChange> = cells
                .map(|cell| WeightChange {
                    cell,
                    before: weights[cell],
                    after: f32::INFINITY,
                })
                .filter(|change| change.before < change.after)
                .collect();
            let hit = changes
                .iter()
                .any(|change| route.cells.contains(&(change.cell as u32)));
            if hit != on_way || changes.iter().any(|change| change.cell == GOAL) {
                continue;
            }
            // There and back: what was blocked opens again.
            let back = changes.iter().map(|change| WeightChange {
                before: change.after,
                after: change.before,
                ..*change
            });
            let back: Vec<_> = back.collect();
            for (changes, opens) in [(&changes, false), (&back, true)] {
                for change in changes {
                    weights[change.cell] = change.after;
                }
                let (us, again) = least_us(|| fresh(&mut search, &weights, START));
                let cost = again.as_ref().map(|route| route.cost);
                found[0].add(us, search.expanded);
                if opens && on_way {
                    // The kept way is that around the box, as the default planner would have it by now.
                    let mut blocked = weights.clone();
                    for change in changes {
                        blocked[change.cell] = change.before;
                    }
                    if let Some(around) = fresh(&mut search, &blocked, START) {
                        kept.keep(&around, &blocked, SIDE);
                    }
                }
                let (us, stands) =
                    least_us(|| kept.stands(START, changes.iter().copied(), remaining));
                if let Some(stands) = &stands {
                    assert!((stands.cost - cost.expect("a way")).abs() < 1e-6);
                    found[2].add(us, 0);
                    found[1].add(us, 0);
                } else {
                    let (us, _) = least_us(|| {
                        let stands = kept.stands(START, changes.iter().copied(), remaining);
                        assert!(stands.is_none());
                        let again = fresh(&mut search, &weights, START);
                        if let Some(again) = &again {
                            scratch.keep(again, &weights, SIDE);
                        }
                        again
                    });
                    found[1].add(us, search.expanded);
                    if let Some(again) = &again {
                        kept.keep(again, &weights, SIDE);
                    }
                }
                for (lite, found) in lite.iter_mut().zip(&mut found[3..5]) {
                    let began = Instant::now();
                    for change in changes {
                        lite.set_weight(change.cell, change.after);
                    }
                    let own = lite.route().map(|route| route.cost);
                    found.add(began.elapsed().as_secs_f64() * 1e6, lite.expanded);
                    assert_eq!(own.is_some(), cost.is_some());
                    assert!(
                        own.zip(cost)
                            .is_none_or(|(own, cost)| (own - cost).abs() < 1e-6)
                    );
                }
                let began = Instant::now();
                let own = field.run(asked(&weights), 1.0);
                found[5].add(began.elapsed().as_secs_f64() * 1e6, field.expanded());
                assert!(
                    own.zip(cost)
                        .is_none_or(|(own, cost)| own.cost <= cost + 1e-6)
                );
            }
        }
    }
    found
}

fn main() {
    let json = std::env::args().any(|word| word == "json");
    let mut rows = vec![];
    for on_way in [false, true] {
        let found = measure(on_way);
        let place = if on_way { "on the way" } else { "off the way" };
        for (name, measured) in WAYS.iter().zip(&found) {
            if measured.us.is_empty() {
                continue;
            }
            let [median, p99] = [0.5, 0.99].map(|share| measured.at(share));
            let ratios = [median / found[0].at(0.5), p99 / found[0].at(0.99)];
            let expanded = measured.expanded / found[0].expanded;
            let count = measured.us.len();
            let measured = if *name == WAYS[0] {
                format!("{median:.0} / {p99:.0} us, {count} changes")
            } else {
                format!(
                    "{:.3} / {:.3} of a fresh A* ({median:.1} / {p99:.1} us), {expanded:.3} of its expansions, {count} changes",
                    ratios[0], ratios[1]
                )
            };
            rows.push((format!("{place}: {name}"), measured));
        }
    }
    for (what, measured) in rows {
        if json {
            println!("{{\"what\": \"{what}\", \"measured\": \"{measured}\"}}");
        } else {
            println!("{what}: {measured}");
        }
    }
}
