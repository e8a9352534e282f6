//! Grey-scale openings of a raster by discs (Serra 1982): what is narrower than the disc and higher than its surroundings goes.

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
    let mut spans = Spans::new(cols, radius);
    for (row, values) in heights_m.values().chunks_exact(cols).enumerate() {
        spans.read(values);
        for away in 0..=radius {
            let width = (radius * radius - away * away).isqrt();
            let [one, other] = spans.lowest(width);
            let mut lower = |row: usize| {
                let to = &mut lowest.values_mut()[row * cols..(row + 1) * cols];
                for ((least, one), other) in to.iter_mut().zip(one).zip(other) {
                    *least = lesser(*least, lesser(*one, *other));
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

/// Without the rules for NaN of `f64::min`, of which there is none: one instruction for several values.
const fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The lowest of 1, 2, 4, 8 and so on values side by side, of a row with room on both sides: two of them cover any width.
#[derive(Debug)]
struct Spans {
    cols: usize,
    radius: usize,
    tables: Vec<Vec<f64>>,
}

impl Spans {
    fn new(cols: usize, radius: usize) -> Self {
        let room = cols + 2 * radius;
        let tables = (2 * radius + 1).ilog2() + 1;
        Self {
            cols,
            radius,
            tables: (0..tables).map(|_| vec![f64::INFINITY; room]).collect(),
        }
    }

    /// Of the values of a row.
    fn read(&mut self, values: &[f64]) {
        self.tables[0][self.radius..self.radius + self.cols].copy_from_slice(values);
        for level in 1..self.tables.len() {
            let (below, above) = self.tables.split_at_mut(level);
            let before = &below[level - 1];
            let pairs = before.iter().zip(&before[1 << (level - 1)..]);
            for (least, (one, other)) in above[0].iter_mut().zip(pairs) {
                *least = lesser(*one, *other);
            }
        }
    }

    /// Two spans for each value of the row, that together reach from `width` before it to `width` behind it.
    fn lowest(&self, width: usize) -> [&[f64]; 2] {
        let level = (2 * width + 1).ilog2();
        let table = &self.tables[level as usize];
        let first = self.radius - width;
        let last = self.radius + width + 1 - (1 << level);
        [first, last].map(|from| &table[from..from + self.cols])
    }
}
