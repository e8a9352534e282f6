//! The nearest blocked cell of every cell, exactly: the distance transform in two passes (Meijster, Roerdink and Hesselink 2000), which
//! remembers what it was nearest to.

/// No blocked cell anywhere.
pub(super) const NONE: u32 = u32::MAX;

/// Of every cell, row by row, the nearest blocked one and the square of the distance of their centres.
#[derive(Debug, Clone)]
pub(super) struct NearestBlocked {
    /// Index of the nearest blocked cell, [`NONE`] where nothing is blocked.
    pub blocked: Vec<u32>,
    /// Squared distance to it, cells².
    pub squared: Vec<u32>,
}

impl NearestBlocked {
    /// Of a grid with so many columns, row by row.
    pub(super) fn of(blocked: &[bool], cols: usize) -> Self {
        let row_of = nearest_in_column(blocked, cols);
        let mut found = Self {
            blocked: vec![NONE; blocked.len()],
            squared: vec![u32::MAX; blocked.len()],
        };
        let mut envelope = Vec::with_capacity(cols);
        for (row, rows_of) in row_of.chunks_exact(cols).enumerate() {
            lower_envelope(row, rows_of, &mut envelope);
            let mut at = 0;
            for col in 0..cols {
                while at + 1 < envelope.len() && envelope[at + 1].from <= col as i64 {
                    at += 1;
                }
                let Some(piece) = envelope.get(at) else { break };
                let across = col.abs_diff(piece.col) as u32;
                found.squared[row * cols + col] = across * across + piece.height;
                found.blocked[row * cols + col] =
                    rows_of[piece.col] * cols as u32 + piece.col as u32;
            }
        }
        found
    }
}

/// A parabola of the lower envelope of a row, and the column from which on it is the lowest.
struct Parabola {
    col: usize,
    height: u32,
    from: i64,
}

/// Row of the nearest blocked cell of the same column.
fn nearest_in_column(blocked: &[bool], cols: usize) -> Vec<u32> {
    let mut rows = vec![NONE; blocked.len()];
    for at in 0..blocked.len() {
        if blocked[at] {
            rows[at] = (at / cols) as u32;
        } else if at >= cols {
            rows[at] = rows[at - cols];
        }
    }
    for at in (0..blocked.len().saturating_sub(cols)).rev() {
        let (row, below) = ((at / cols) as u32, rows[at + cols]);
        if below != NONE && (rows[at] == NONE || below.abs_diff(row) < row.abs_diff(rows[at])) {
            rows[at] = below;
        }
    }
    rows
}

fn lower_envelope(row: usize, rows_of: &[u32], envelope: &mut Vec<Parabola>) {
    envelope.clear();
    for (col, &nearest) in rows_of.iter().enumerate() {
        if nearest == NONE {
            continue;
        }
        let down = nearest.abs_diff(row as u32);
        let height = down * down;
        let mut from = 0;
        while let Some(last) = envelope.last() {
            from = first_below(last, col, height);
            if from > last.from {
                break;
            }
            let _ = envelope.pop();
            from = 0;
        }
        envelope.push(Parabola { col, height, from });
    }
}

/// First column where the parabola over `col` is lower than the one before it.
fn first_below(before: &Parabola, col: usize, height: u32) -> i64 {
    let (old, new) = (before.col as i64, col as i64);
    let rise = new * new - old * old + i64::from(height) - i64::from(before.height);
    rise.div_euclid(2 * (new - old)) + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn nothing_blocked_is_nearer((cols, blocked) in (1_usize..14).prop_flat_map(|cols| {
            (Just(cols), prop::collection::vec(prop::bool::weighted(0.2), cols * 9))
        })) {
            let found = NearestBlocked::of(&blocked, cols);
            let squared = |a: usize, b: usize| {
                (a % cols).abs_diff(b % cols).pow(2) + (a / cols).abs_diff(b / cols).pow(2)
            };
            for at in 0..blocked.len() {
                let least = (0..blocked.len()).filter(|&b| blocked[b]).map(|b| squared(at, b)).min();
                match least {
                    None => prop_assert_eq!(found.blocked[at], NONE),
                    Some(least) => {
                        prop_assert_eq!(found.squared[at] as usize, least);
                        prop_assert!(blocked[found.blocked[at] as usize]);
                        prop_assert_eq!(squared(at, found.blocked[at] as usize), least);
                    }
                }
            }
        }
    }
}
