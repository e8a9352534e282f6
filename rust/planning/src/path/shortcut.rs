//! From cells to a path: straight where the straight way costs no more, points close together.

use terrain::Terrain;

/// What a piece costs that may not be walked: more than any way, and less than makes a sum infinite.
const NO_WAY: f64 = f64::MAX / 1e9;

/// Adds the points of the way along `cells` from the last point of `points` to `end_m` (a point of the last cell): straight where that
/// costs no more, by these weights, than so many times what the cells do.
pub(crate) fn walk(
    points: &mut Vec<[f64; 2]>,
    (terrain, weights): (&Terrain, &[f32]),
    straighter: f64,
    (cells, end_m): (&[u32], [f64; 2]),
) {
    let Some(&start_m) = points.last() else {
        return;
    };
    let mut corners: Vec<[f64; 2]> = cells
        .iter()
        .map(|&c| terrain.center_m(c as usize))
        .collect();
    if let Some(first) = corners.first_mut() {
        *first = start_m;
    }
    if let Some(last) = corners.last_mut().filter(|_| cells.len() > 1) {
        *last = end_m;
    } else {
        corners.push(end_m);
    }
    let mut along = vec![0.0; corners.len()];
    for i in 1..corners.len() {
        let step = terrain.straight_cost_over_m(weights, corners[i - 1], corners[i]);
        along[i] = along[i - 1] + step.unwrap_or(NO_WAY);
    }
    let mut from = 0;
    while from + 1 < corners.len() {
        let to = furthest((terrain, weights), straighter, (&corners, &along), from);
        lay(points, corners[to], terrain.lattice.cell_m);
        from = to;
    }
}

/// A corner after `from`, as far as doubling and halving find one, that is reached straight at no higher cost.
fn furthest(
    (terrain, weights): (&Terrain, &[f32]),
    straighter: f64,
    (corners, along): (&[[f64; 2]], &[f64]),
    from: usize,
) -> usize {
    let reaches = |to: usize| {
        terrain
            .straight_cost_over_m(weights, corners[from], corners[to])
            .is_some_and(|straight| straight <= (along[to] - along[from]) * straighter)
    };
    let last = corners.len() - 1;
    let (mut good, mut bad) = (from + 1, last + 1);
    let mut stride = 2;
    while good < last && bad > last {
        let to = (from + stride).min(last);
        if reaches(to) {
            good = to;
        } else {
            bad = to;
        }
        stride *= 2;
    }
    while good + 1 < bad {
        let middle = usize::midpoint(good, bad);
        if reaches(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    good
}

/// Adds points from the last one straight to `to`, no further apart than a cell.
pub(crate) fn lay(points: &mut Vec<[f64; 2]>, to: [f64; 2], cell_m: f64) {
    let Some(&from) = points.last() else {
        return;
    };
    let length = geometry::hypot(to[0] - from[0], to[1] - from[1]);
    let pieces = (length / cell_m).ceil().max(1.0) as usize;
    for piece in 1..=pieces {
        let t = piece as f64 / pieces as f64;
        points.push([
            from[0] + t * (to[0] - from[0]),
            from[1] + t * (to[1] - from[1]),
        ]);
    }
}
