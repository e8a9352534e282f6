//! Heights for cells without one: from coarser rasters first, then made smooth.

use geometry::Grid;

/// Fills every NaN, where at least one cell has a height: the mean of coarser cells (a pyramid of halves), then `sweeps` of
/// relaxation towards the harmonic surface through the cells around the hole. What has a height keeps it.
pub(super) fn fill(heights_m: &mut Grid<f64>, sweeps: usize) {
    let (cols, rows) = (heights_m.cols(), heights_m.rows());
    let holes: Vec<usize> = (heights_m.values().iter().enumerate())
        .filter_map(|(index, height_m)| height_m.is_nan().then_some(index))
        .collect();
    if holes.is_empty() || holes.len() == heights_m.values().len() {
        return;
    }
    from_coarser(heights_m);
    let values = heights_m.values_mut();
    for _ in 0..sweeps {
        for &index in &holes {
            let (row, col) = (index / cols, index % cols);
            let mut sum_m = 0.0;
            let mut count = 0.0;
            let mut add = |there: bool, beside: usize| {
                if there {
                    sum_m += values[beside];
                    count += 1.0;
                }
            };
            add(col > 0, index.wrapping_sub(1));
            add(col + 1 < cols, index + 1);
            add(row > 0, index.wrapping_sub(cols));
            add(row + 1 < rows, index + cols);
            values[index] = sum_m / count;
        }
    }
}

/// Fills holes with the value of the coarser cell that they lie in.
fn from_coarser(heights_m: &mut Grid<f64>) {
    let (cols, rows) = (heights_m.cols(), heights_m.rows());
    if !heights_m.values().iter().any(|height_m| height_m.is_nan()) {
        return;
    }
    let (half_cols, half_rows) = (cols.div_ceil(2), rows.div_ceil(2));
    let mut sums = vec![(0.0, 0.0); half_cols * half_rows];
    for (index, height_m) in heights_m.values().iter().enumerate() {
        if !height_m.is_nan() {
            let (sum_m, count) = &mut sums[(index / cols / 2) * half_cols + index % cols / 2];
            *sum_m += height_m;
            *count += 1.0;
        }
    }
    let mut coarser = Grid::filled(half_cols, half_rows, f64::NAN);
    for (mean_m, (sum_m, count)) in coarser.values_mut().iter_mut().zip(sums) {
        *mean_m = sum_m / count; // NaN where none has a height
    }
    from_coarser(&mut coarser);
    for (index, height_m) in heights_m.values_mut().iter_mut().enumerate() {
        if height_m.is_nan() {
            *height_m = coarser.values()[(index / cols / 2) * half_cols + index % cols / 2];
        }
    }
}
