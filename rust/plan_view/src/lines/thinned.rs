//! Many points as fewer with weights: what lies in one small cell is one point in their middle.

use std::collections::BTreeMap;

use geometry::Lattice;

use super::line::WeightedPoint;

/// The middles of the points of each cell with sides of so many m, with their number. Smaller than the noise, it changes no line.
pub(crate) fn thinned(points_m: &[[f64; 2]], side_m: f64) -> Vec<WeightedPoint> {
    let lattice = Lattice {
        origin_m: [0.0; 2],
        cell_m: side_m,
    };
    let mut cells: BTreeMap<_, ([f64; 2], f64)> = BTreeMap::new();
    for &[x_m, y_m] in points_m {
        let (sum, count) = cells.entry(lattice.cell_at(x_m, y_m)).or_default();
        sum[0] += x_m;
        sum[1] += y_m;
        *count += 1.0;
    }
    let middle = |(sum, weight): ([f64; 2], f64)| WeightedPoint {
        at_m: sum.map(|sum_m| sum_m / weight),
        weight,
    };
    cells.into_values().map(middle).collect()
}
