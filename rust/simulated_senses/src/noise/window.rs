//! Sums and extremes over square windows, row by row: along the rows at once, down the columns over the last rows that were kept.

/// The last rows of a picture, as many as a window has.
#[derive(Debug, Clone)]
pub(super) struct LastRows {
    rows: Vec<Vec<f32>>,
}

impl LastRows {
    /// Rows of so many values.
    pub(super) fn new(window: usize, width: usize) -> Self {
        Self {
            rows: vec![vec![0.0; width]; window],
        }
    }

    /// The place of a row of the picture: that of the oldest one kept.
    pub(super) fn place(&mut self, row: usize) -> &mut [f32] {
        let count = self.rows.len();
        &mut self.rows[row % count]
    }

    /// Folds all rows kept, column by column.
    #[inline]
    pub(super) fn fold(&self, into: &mut [f32], with: impl Fn(f32, f32) -> f32) {
        let Some((first, rest)) = self.rows.split_first() else {
            return;
        };
        into.copy_from_slice(first);
        for row in rest {
            for (value, other) in into.iter_mut().zip(row) {
                *value = with(*value, *other);
            }
        }
    }
}

/// Folds `window` neighbours of a row: `into` has `window - 1` values less.
#[inline]
pub(super) fn fold_along(
    row: &[f32],
    window: usize,
    into: &mut [f32],
    with: impl Fn(f32, f32) -> f32,
) {
    let count = into.len();
    into.copy_from_slice(&row[..count]);
    for shift in 1..window {
        for (value, other) in into.iter_mut().zip(&row[shift..]) {
            *value = with(*value, *other);
        }
    }
}

/// The sum.
#[inline]
pub(super) fn add(a: f32, b: f32) -> f32 {
    a + b
}

/// The larger one.
#[inline]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller one.
#[inline]
pub(super) fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_extremes_are_those_of_every_whole_window() {
        let picture: Vec<Vec<f32>> = (0..6)
            .map(|row| {
                (0..7)
                    .map(|column| ((row * 31 + column * 17) % 23) as f32)
                    .collect()
            })
            .collect();
        for with in [add, larger, smaller] {
            let mut last = LastRows::new(3, 5);
            let mut found = [0.0; 5];
            for (row, values) in picture.iter().enumerate() {
                fold_along(values, 3, last.place(row), with);
                if row < 2 {
                    continue;
                }
                last.fold(&mut found, with);
                for (column, value) in found.iter().enumerate() {
                    let window = picture[row - 2..=row]
                        .iter()
                        .flat_map(|r| &r[column..column + 3]);
                    assert_eq!(window.copied().reduce(with), Some(*value));
                }
            }
        }
    }
}
