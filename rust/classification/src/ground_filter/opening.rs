//! Grey-scale openings of a raster by discs (Serra 1982): what is narrower than the disc and higher than its surroundings goes.

use std::collections::VecDeque;

use geometry::Grid;

/// The cells that stand out of the raster: for each radius from 1 to `openings` cells the raster of before is opened, and a cell that
/// loses more than `rise_m` times the radius stands out.
pub(super) fn raised(heights_m: &Grid<f64>, openings: usize, rise_m: f64) -> Vec<bool> {
    let mut raised = vec![false; heights_m.values().len()];
    let mut last = heights_m.clone();
    for radius in 1..=openings {
        let opened = opened(&last, radius);
        let allowed_m = rise_m * radius as f64;
        let lost = last.values().iter().zip(opened.values());
        for (raised, (before_m, after_m)) in raised.iter_mut().zip(lost) {
            *raised |= before_m - after_m > allowed_m;
        }
        last = opened;
    }
    raised
}

/// The opening by a disc of this radius in cells: the lowest within it, and of those the highest.
pub(super) fn opened(heights_m: &Grid<f64>, radius: usize) -> Grid<f64> {
    let mut lowered = lowest_within(heights_m, radius);
    turn(&mut lowered);
    let mut opened = lowest_within(&lowered, radius);
    turn(&mut opened);
    opened
}

fn turn(heights_m: &mut Grid<f64>) {
    for height_m in heights_m.values_mut() {
        *height_m = -*height_m;
    }
}

/// The lowest value within a disc around each cell; what lies outside of the raster does not count.
fn lowest_within(heights_m: &Grid<f64>, radius: usize) -> Grid<f64> {
    let (cols, rows) = (heights_m.cols(), heights_m.rows());
    let mut lowest = Grid::filled(cols, rows, f64::INFINITY);
    let mut line = vec![0.0; cols];
    let mut queue = VecDeque::new();
    for away in 0..=radius.min(rows.saturating_sub(1)) {
        let width = (radius * radius - away * away).isqrt();
        for (row, values) in heights_m.values().chunks_exact(cols).enumerate() {
            lowest_along(values, width, &mut queue, &mut line);
            let mut lower = |row: usize| {
                let to = &mut lowest.values_mut()[row * cols..(row + 1) * cols];
                for (least, value) in to.iter_mut().zip(&line) {
                    *least = least.min(*value);
                }
            };
            if row + away < rows {
                lower(row + away);
            }
            if away > 0 && row >= away {
                lower(row - away);
            }
        }
    }
    lowest
}

/// The lowest of the values up to `width` away on a line, by a queue that holds only what can still be lowest.
fn lowest_along(values: &[f64], width: usize, queue: &mut VecDeque<usize>, lowest: &mut [f64]) {
    queue.clear();
    let mut next = 0;
    for (at, lowest) in lowest.iter_mut().enumerate() {
        while next < values.len() && next <= at + width {
            while queue
                .back()
                .is_some_and(|&back| values[back] >= values[next])
            {
                let _ = queue.pop_back();
            }
            queue.push_back(next);
            next += 1;
        }
        while queue.front().is_some_and(|&front| front + width < at) {
            let _ = queue.pop_front();
        }
        *lowest = queue.front().map_or(f64::INFINITY, |&front| values[front]);
    }
}
