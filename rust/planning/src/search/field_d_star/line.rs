//! Straight lines within a square of four cells' middles: what they cost, and where they may lead.

/// Two places on a line are one when they are no further apart than this share of it: a rounding guard.
const SAME: f64 = 1e-9;

/// A straight line within the square between four middles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    /// In cells: its length in each cell times the cell's weight.
    pub(super) cost: f64,
    /// Column and row of the cells that it leads through.
    pub(super) cells: Vec<[usize; 2]>,
}

impl Line {
    /// The line between two places of a square; `None` where it leads through a blocked cell or past a blocked one's corner.
    pub(super) fn between(
        from: [f64; 2],
        to: [f64; 2],
        weights: &[f32],
        cols: usize,
    ) -> Option<Self> {
        let delta = [to[0] - from[0], to[1] - from[1]];
        let length = geometry::hypot(delta[0], delta[1]);
        // Where it passes from one cell to the next, along and across.
        let passes = [0, 1].map(|axis| {
            let border = from[axis].min(to[axis]).floor() + 0.5;
            let share = (border - from[axis]) / delta[axis];
            (share > 0.0 && share < 1.0).then_some(share)
        });
        let mut borders = [0.0, passes[0].unwrap_or(0.0), passes[1].unwrap_or(0.0), 1.0];
        borders.sort_by(f64::total_cmp);
        let at = |share: f64| [0, 1].map(|axis| from[axis] + share * delta[axis]);
        let (mut cost, mut cells) = (0.0, vec![]);
        let weight = |[col, row]: [usize; 2]| weights[row * cols + col];
        for pair in borders.windows(2) {
            if pair[1] - pair[0] <= SAME {
                continue;
            }
            let cell = at(0.5 * (pair[0] + pair[1])).map(|middle| middle.round() as usize);
            let weight = weight(cell);
            if weight.is_infinite() {
                return None;
            }
            cost += (pair[1] - pair[0]) * length * f64::from(weight);
            cells.push(cell);
        }
        if let [Some(a), Some(b)] = passes
            && (a - b).abs() <= SAME
        {
            let [col, row] = at(a).map(|corner| corner.floor() as usize);
            let around = [
                [col, row],
                [col + 1, row],
                [col, row + 1],
                [col + 1, row + 1],
            ];
            if around.into_iter().any(|cell| weight(cell).is_infinite()) {
                return None;
            }
        }
        Some(Self { cost, cells })
    }
}

/// The places on the lines around to which a straight line may lead from here, within a square.
pub(super) fn candidates([col, row]: [f64; 2], pieces: usize, mut visit: impl FnMut([f64; 2])) {
    let squares = |at: f64| {
        let low = at.floor();
        let both = if at == low {
            [low - 1.0, low]
        } else {
            [low, low]
        };
        both.into_iter().take(if at == low { 2 } else { 1 })
    };
    for low_col in squares(col) {
        for low_row in squares(row) {
            for piece in 0..pieces {
                let share = piece as f64 / pieces as f64;
                let [right, up] = [low_col + 1.0, low_row + 1.0];
                visit([low_col + share, low_row]);
                visit([right, low_row + share]);
                visit([right - share, up]);
                visit([low_col, up - share]);
            }
        }
    }
}
