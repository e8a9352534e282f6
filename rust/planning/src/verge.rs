//! Where a raised level ends: what was not seen beside it is no ground.

use geometry::Cell;
use mapping::{FloorView, Surface};

use crate::levels::{Levels, Stand};

/// Unseen cells between ground on both sides are ground when they are no more than this: single pixels that the camera
/// missed. A gap into which a foot fits is seen into from where its edge matters.
const GAP_CELLS: usize = 2;

/// What is known of the cells.
pub(crate) struct Seen<'a> {
    pub(crate) view: &'a FloorView,
    pub(crate) blocked: &'a [bool],
    pub(crate) unknown: &'a [bool],
}

/// The ground of the level that the robot stands on. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Verge {
    ground: Vec<bool>,
    gaps: Vec<usize>,
}

impl Verge {
    /// Marks what ends the level on which the robot stands. Around itself, up to `blind_m`, it sees no ground: there it has
    /// its own.
    pub(crate) fn mark(
        &mut self,
        levels: &mut Levels,
        seen: &Seen<'_>,
        stand: &Stand,
        max_step: f64,
        blind_m: f64,
    ) {
        self.find_ground(levels, seen, stand, (max_step, blind_m));
        self.close_gaps(levels, seen, stand);
        let cols = seen.view.cells.cols();
        for (index, &ground) in self.ground.iter().enumerate() {
            if !ground {
                continue;
            }
            let (col, row) = (index % cols, index / cols);
            for r in row.saturating_sub(1)..(row + 2).min(self.ground.len() / cols) {
                for c in col.saturating_sub(1)..(col + 2).min(cols) {
                    let next = r * cols + c;
                    let unseen = levels.height_m[next].is_nan() && !seen.blocked[next];
                    if unseen && !self.ground[next] {
                        levels.edge[next] = true;
                        levels.open[next] = true;
                        levels.any = true;
                    }
                }
            }
        }
    }

    fn find_ground(
        &mut self,
        levels: &mut Levels,
        seen: &Seen<'_>,
        stand: &Stand,
        (max_step, blind_m): (f64, f64),
    ) {
        let on_level =
            |height_m: f32| (f64::from(height_m) - stand.height_m).abs() <= 2.0 * max_step;
        let lattice = &seen.view.lattice;
        let cols = seen.view.cells.cols();
        self.ground.clear();
        for (index, surface) in seen.view.cells.values().iter().enumerate() {
            let height = &mut levels.height_m[index];
            if height.is_nan() && seen.unknown[index] && !levels.edge[index] {
                let cell = Cell::new((index % cols) as i32, (index / cols) as i32);
                let [x, y] = lattice.center_of(cell);
                let (dx, dy) = (x - stand.at_m[0], y - stand.at_m[1]);
                if dx.abs() <= blind_m && dy.abs() <= blind_m && dx.hypot(dy) <= blind_m {
                    *height = stand.ground_m([dx, dy]) as f32;
                }
            }
            // Floor that was seen too rarely to be an edge is ground all the same.
            let rarely = height.is_nan()
                && !seen.unknown[index]
                && matches!(*surface, Surface::Floor(height_m) if on_level(height_m));
            self.ground.push(rarely || on_level(*height));
        }
    }

    fn close_gaps(&mut self, levels: &mut Levels, seen: &Seen<'_>, stand: &Stand) {
        let cols = seen.view.cells.cols();
        let rows = self.ground.len() / cols.max(1);
        self.gaps.clear();
        for index in 0..self.ground.len() {
            if self.ground[index] || !seen.unknown[index] || !levels.height_m[index].is_nan() {
                continue;
            }
            let lines = [(1, index % cols, cols), (cols, index / cols, rows)];
            let closed = lines.into_iter().any(|(stride, at, count)| {
                let before = (1..=GAP_CELLS.min(at)).find(|n| self.ground[index - n * stride]);
                let most = GAP_CELLS.min(count - 1 - at);
                let after = (1..=most).find(|n| self.ground[index + n * stride]);
                before
                    .zip(after)
                    .is_some_and(|(a, b)| a + b <= GAP_CELLS + 1)
            });
            if closed {
                self.gaps.push(index);
            }
        }
        for &index in &self.gaps {
            self.ground[index] = true;
            levels.height_m[index] = stand.height_m as f32;
        }
    }
}
