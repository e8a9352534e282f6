//! A* on grids of 400 x 400 cells from corner to corner, and the `pathfinding` crate's on the same grids.

use criterion::{Criterion, criterion_group, criterion_main};
use pathfinding::directed::astar::astar;
use planning::search::{Search, octile};

const SIDE: usize = 400;
const START: [usize; 2] = [3, 3];
const GOAL: [usize; 2] = [SIDE - 4, SIDE - 4];
/// What a step costs the other crate, which needs whole numbers.
const STRAIGHT: u32 = 10_000;
const DIAGONAL: u32 = 14_142;

/// Which cells are blocked: nothing, boxes, one in five.
fn grids() -> [(&'static str, Vec<bool>); 3] {
    // A linear congruential generator (Knuth's MMIX): the same grids everywhere.
    let mut state = 5_u64;
    let mut below = |count: usize| {
        state =
            (state.wrapping_mul(6_364_136_223_846_793_005)).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % count
    };
    let mut boxes = vec![false; SIDE * SIDE];
    for _ in 0..120 {
        let [col, row] = [below(380), below(380)];
        let [width, height] = [2 + below(38), 2 + below(38)];
        for row in row..SIDE.min(row + height) {
            boxes[row * SIDE + col..row * SIDE + SIDE.min(col + width)].fill(true);
        }
    }
    let clutter = (0..SIDE * SIDE).map(|_| below(5) == 0).collect();
    let mut grids = [
        ("open", vec![false; SIDE * SIDE]),
        ("120 boxes", boxes),
        ("one cell in 5", clutter),
    ];
    for (_, blocked) in &mut grids {
        for [col, row] in [START, GOAL] {
            for row in row - 3..=row + 3 {
                blocked[row * SIDE + col - 3..=row * SIDE + col + 3].fill(false);
            }
        }
    }
    grids
}

fn ours(search: &mut Search, weights: &[f32]) -> Option<f64> {
    let index = |[col, row]: [usize; 2]| row * SIDE + col;
    let goal = index(GOAL);
    let away = |cell: usize| {
        let off = |at: usize, goal: usize| f64::from(at as i32 - goal as i32);
        octile(off(cell % SIDE, GOAL[0]), off(cell / SIDE, GOAL[1]))
    };
    let ending = |cell: usize| (cell == goal).then_some(0.0);
    let route = search.run(weights, SIDE, index(START), ending, away)?;
    Some(route.cost)
}

fn theirs(blocked: &[bool]) -> Option<f64> {
    type At = [i32; 2];
    let free = |[col, row]: At| {
        let inside = [col, row].iter().all(|at| (0..SIDE as i32).contains(at));
        inside && !blocked[row as usize * SIDE + col as usize]
    };
    let steps = |&[col, row]: &At| {
        let mut steps = Vec::with_capacity(8);
        for [right, up] in [[1, 0], [-1, 0], [0, 1], [0, -1]] {
            if free([col + right, row + up]) {
                steps.push(([col + right, row + up], STRAIGHT));
            }
        }
        for [right, up] in [[1, 1], [-1, 1], [1, -1], [-1, -1]] {
            let corners = free([col + right, row]) && free([col, row + up]);
            if corners && free([col + right, row + up]) {
                steps.push(([col + right, row + up], DIAGONAL));
            }
        }
        steps
    };
    let [start, goal] = [START, GOAL].map(|at| at.map(|at| at as i32));
    let away = |&[col, row]: &At| {
        let (across, up) = (col.abs_diff(goal[0]), row.abs_diff(goal[1]));
        STRAIGHT * across.max(up) + (DIAGONAL - STRAIGHT) * across.min(up)
    };
    let (_, cost) = astar(&start, steps, away, |at| *at == goal)?;
    Some(f64::from(cost) / f64::from(STRAIGHT))
}

fn search(criterion: &mut Criterion) {
    for (name, blocked) in grids() {
        let weights: Vec<f32> = (blocked.iter())
            .map(|&blocked| if blocked { f32::INFINITY } else { 1.0 })
            .collect();
        let mut search = Search::default();
        let costs = [ours(&mut search, &weights), theirs(&blocked)];
        // A diagonal step in whole numbers is 1.4e-5 too short.
        assert!(
            matches!(costs, [Some(a), Some(b)] if (a - b).abs() < 2e-5 * a),
            "{costs:?}"
        );
        let mut group = criterion.benchmark_group(format!("400x400, {name}"));
        let _ = group.bench_function("core", |bencher| {
            bencher.iter(|| ours(&mut search, &weights));
        });
        let _ = group.bench_function("pathfinding", |bencher| bencher.iter(|| theirs(&blocked)));
        group.finish();
    }
}

criterion_group!(benches, search);
criterion_main!(benches);
