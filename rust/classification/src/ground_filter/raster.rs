//! A cloud as a raster: its spacing, the lowest point of each cell, slopes, heights between cells.

use geometry::{Grid, Lattice, hypot};

use crate::cloud::{CloudError, Point3};

/// Most rounds until the covered area is found at the scale of the spacing itself. Each halves the spacing or is one of the last.
const ROUNDS: usize = 64;
/// Side of the cells that tell where the cloud is, in spacings: two in a hundred are empty by chance.
const COVER: f64 = 2.0;

/// Lowest and highest x and y, m.
fn extent(points: &[Point3]) -> ([f64; 2], [f64; 2]) {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for point in points {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    (low, high)
}

/// Mean distance between neighbours seen from above, m: the root of the area that a point has. 1 m where all lie on one spot.
pub(super) fn spacing_m(points: &[Point3]) -> f64 {
    let (low, high) = extent(points);
    let [across_m, along_m] = [high[0] - low[0], high[1] - low[1]];
    let count = points.len() as f64;
    let longest_m = across_m.max(along_m);
    if longest_m <= 0.0 {
        return 1.0;
    }
    // A cloud on a line has no area: its points lie side by side.
    let mut spacing_m = (across_m * along_m / count).sqrt().max(longest_m / count);
    for _ in 0..ROUNDS {
        let side_m = COVER * spacing_m;
        let mut cells: Vec<[i64; 2]> = (points.iter())
            .map(|point| [0, 1].map(|axis| ((point[axis] - low[axis]) / side_m) as i64))
            .collect();
        cells.sort_unstable();
        cells.dedup();
        let finer_m = side_m * (cells.len() as f64 / count).sqrt();
        let settled = finer_m > spacing_m - spacing_m / 10.0;
        spacing_m = finer_m.min(spacing_m);
        if settled {
            break;
        }
    }
    spacing_m
}

/// The lowest height of each cell, NaN where no point lies.
pub(super) fn lowest(
    points: &[Point3],
    cell_m: f64,
    most: usize,
) -> Result<(Lattice, Grid<f64>), CloudError> {
    let (low, high) = extent(points);
    let sizes = [0, 1].map(|axis| (high[axis] - low[axis]) / cell_m);
    if (sizes[0] + 1.0) * (sizes[1] + 1.0) > most as f64 {
        return Err(CloudError::TooWide {
            across_m: high[0] - low[0],
            along_m: high[1] - low[1],
            cell_m,
            most,
        });
    }
    let lattice = Lattice {
        origin_m: low,
        cell_m,
    };
    let [cols, rows] = sizes.map(|size| size as usize + 1);
    let mut heights_m = Grid::filled(cols, rows, f64::NAN);
    for point in points {
        if let Some(height_m) = heights_m.get_mut(lattice.cell_at(point[0], point[1])) {
            *height_m = height_m.min(point[2]); // the smaller number, where one is NaN
        }
    }
    Ok((lattice, heights_m))
}

/// Steepness at each cell: the length of the gradient by central differences, one-sided at the border.
pub(super) fn slopes(heights_m: &Grid<f64>, cell_m: f64) -> Grid<f64> {
    let (cols, rows) = (heights_m.cols(), heights_m.rows());
    let values = heights_m.values();
    let mut slopes = Grid::filled(cols, rows, 0.0);
    for row in 0..rows {
        for col in 0..cols {
            let (left, right) = (col.saturating_sub(1), (col + 1).min(cols - 1));
            let (below, above) = (row.saturating_sub(1), (row + 1).min(rows - 1));
            let run_m = |steps: usize| (steps.max(1)) as f64 * cell_m;
            let x = (values[row * cols + right] - values[row * cols + left]) / run_m(right - left);
            let y =
                (values[above * cols + col] - values[below * cols + col]) / run_m(above - below);
            slopes.values_mut()[row * cols + col] = hypot(x, y);
        }
    }
    slopes
}

/// The value at a place between the middles of cells, linear along both axes, as at the border beyond it.
pub(super) fn between(grid: &Grid<f64>, lattice: &Lattice, point: &Point3) -> f64 {
    let at = [(0, grid.cols()), (1, grid.rows())].map(|(axis, count)| {
        let cells = (point[axis] - lattice.origin_m[axis]) / lattice.cell_m - 0.5;
        let cells = cells.clamp(0.0, (count - 1) as f64);
        let first = (cells as usize).min(count.saturating_sub(2));
        (first, (first + 1).min(count - 1), cells - first as f64)
    });
    let [(left, right, x), (below, above, y)] = at;
    let value = |col: usize, row: usize| grid.values()[row * grid.cols() + col];
    let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
    mix(
        mix(value(left, below), value(right, below), x),
        mix(value(left, above), value(right, above), x),
        y,
    )
}
