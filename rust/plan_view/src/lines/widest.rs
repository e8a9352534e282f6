//! The line near another one that holds most points: over all offsets exactly, over slopes by trying them.

use super::line::{PlanarLine, WeightedPoint};

/// The line that holds most weight of points up to `reach_m` off it, near to `line`: its ends turned by up to two such distances, in `slopes`
/// steps, then between the best of them as finely again.
pub(crate) fn widest<'a>(
    line: &PlanarLine,
    points: impl Iterator<Item = &'a WeightedPoint>,
    reach_m: f64,
    slopes: usize,
) -> PlanarLine {
    let [cos, sin, distance_m] = line.normal_form();
    // Along the line from its middle, off it, and weight, of what a turned one may hold.
    let mut near: Vec<[f64; 3]> = points
        .map(|point| {
            let [x_m, y_m] = point.at_m;
            [
                y_m * cos - x_m * sin,
                x_m * cos + y_m * sin - distance_m,
                point.weight,
            ]
        })
        .filter(|[_, off_m, _]| off_m.abs() <= reach_m + 2.0 * reach_m)
        .collect();
    let ends = near.iter().fold(
        [f64::INFINITY, f64::NEG_INFINITY],
        |[low, high], [along, _, _]| [low.min(*along), high.max(*along)],
    );
    let (middle_m, half_m) = (f64::midpoint(ends[0], ends[1]), (ends[1] - ends[0]) / 2.0);
    if near.is_empty() || half_m <= reach_m {
        return *line;
    }
    for [along_m, _, _] in &mut near {
        *along_m -= middle_m;
    }
    let mut best = (0.0, 0.0, 0.0);
    let mut sorted = Vec::with_capacity(near.len());
    let mut turn_most = 2.0 * reach_m / half_m;
    for _ in 0..2 {
        let around = best.1;
        for step in 0..=slopes {
            let slope = around + turn_most * (2.0 * step as f64 / slopes as f64 - 1.0);
            let (weight, offset_m) = fullest(&near, slope, reach_m, &mut sorted);
            if weight > best.0 {
                best = (weight, slope, offset_m);
            }
        }
        turn_most *= 2.0 / slopes as f64;
    }
    let (_, slope, offset_m) = best;
    // The line through the point `offset_m` off the middle with that slope.
    let through = line.point_m(middle_m);
    let through = [through[0] + offset_m * cos, through[1] + offset_m * sin];
    let normal_rad = line.normal_rad - libm::atan(slope);
    let (sin, cos) = libm::sincos(normal_rad);
    PlanarLine {
        normal_rad,
        distance_m: through[0] * cos + through[1] * sin,
    }
}

/// The largest weight in a band of this slope, and how far off its middle lies, m.
fn fullest(near: &[[f64; 3]], slope: f64, reach_m: f64, sorted: &mut Vec<[f64; 2]>) -> (f64, f64) {
    let square = libm::sqrt(1.0 + slope * slope);
    sorted.clear();
    sorted.extend(
        near.iter()
            .map(|[along_m, off_m, weight]| [off_m - slope * along_m, *weight]),
    );
    sorted.sort_unstable_by(|one, other| one[0].total_cmp(&other[0]));
    let width_m = 2.0 * reach_m * square;
    let (mut best, mut held, mut first) = ((0.0, 0.0), 0.0, 0);
    for &[off_m, weight] in sorted.iter() {
        held += weight;
        while off_m - sorted[first][0] > width_m {
            held -= sorted[first][1];
            first += 1;
        }
        if held > best.0 {
            best = (held, f64::midpoint(off_m, sorted[first][0]));
        }
    }
    best
}
