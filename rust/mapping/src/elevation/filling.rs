//! Gaps between heights of one surface, filled where the sensor could have seen them: 004, section 36.3.1.

use geometry::{Cell, Grid, Lattice};

use super::cells::HeightCell;
use super::edges::WAYS;

/// A gap that was filled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Filled {
    /// Height in the map frame, m; NaN where nothing was filled.
    pub height_m: f32,
    /// Frames that saw both of the cells that it lies between.
    pub frames: u16,
    /// Variance of the height, m².
    pub variance_m2: f32,
}

impl Filled {
    pub(super) const NOT: Self = Self {
        height_m: f32::NAN,
        frames: 0,
        variance_m2: f32::INFINITY,
    };
}

/// What fills gaps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FillRule {
    /// Cells that are unknown in a row at most.
    pub cells: i32,
    /// Heights further apart than so many standard deviations of both are of two surfaces.
    pub gate: f32,
    /// Slope that one surface may have between them, m a m.
    pub slope: f32,
}

/// What a cell of which nothing was measured is filled with: a height on the line between the nearest cells before and behind it, the
/// closest pair of the same surface. None where there is no such pair, so that an edge stays where it is; none where a height
/// that is known stands in the sight line to it, so that shadows stay unknown.
pub(super) fn fill(
    cells: &Grid<HeightCell>,
    lattice: &Lattice,
    (cell, eye_m): (Cell, [f64; 3]),
    rule: FillRule,
) -> Option<Filled> {
    let known = |way: [i32; 2], sign: i32| {
        (1..=rule.cells).find_map(|steps| {
            let at = Cell::new(
                cell.col + sign * steps * way[0],
                cell.row + sign * steps * way[1],
            );
            let found = cells.get(at)?.known()?;
            Some((steps, *found))
        })
    };
    let pair = |way: &[i32; 2]| {
        let ((before, low), (behind, high)) = (known(*way, -1)?, known(*way, 1)?);
        let steps = before + behind;
        let length = f32::sqrt((way[0] * way[0] + way[1] * way[1]) as f32);
        let run_m = steps as f32 * length * lattice.cell_m as f32;
        let apart_m = (high.estimate.height_m - low.estimate.height_m).abs();
        let noise_m = (low.estimate.variance_m2 + high.estimate.variance_m2).sqrt();
        let one_surface =
            steps - 1 <= rule.cells && apart_m <= rule.gate * noise_m + rule.slope * run_m;
        let share = before as f32 / steps as f32;
        let filled = Filled {
            height_m: low.estimate.height_m
                + share * (high.estimate.height_m - low.estimate.height_m),
            frames: low.frames.min(high.frames),
            variance_m2: (1.0 - share) * (1.0 - share) * low.estimate.variance_m2
                + share * share * high.estimate.variance_m2,
        };
        one_surface.then_some((steps as f32 * length, filled))
    };
    let closest = WAYS
        .iter()
        .filter_map(pair)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let (_, filled) = closest?;
    is_visible(cells, lattice, cell, filled.height_m, eye_m).then_some(filled)
}

/// Whether no height that is known stands in the sight line from the eye to a height in a cell.
fn is_visible(
    cells: &Grid<HeightCell>,
    lattice: &Lattice,
    cell: Cell,
    height_m: f32,
    eye_m: [f64; 3],
) -> bool {
    let [x, y] = lattice.center_of(cell);
    let along = [x - eye_m[0], y - eye_m[1]];
    let range_m = geometry::hypot(along[0], along[1]);
    let steps = (range_m / lattice.cell_m) as i32;
    let rise_m = f64::from(height_m) - eye_m[2];
    (1..steps).all(|step| {
        let share = 1.0 - f64::from(step) / f64::from(steps);
        let at = lattice.cell_at(eye_m[0] + share * along[0], eye_m[1] + share * along[1]);
        let line_m = (eye_m[2] + share * rise_m) as f32;
        let stands = |known: &HeightCell| {
            known.estimate.height_m - 2.0 * known.estimate.variance_m2.sqrt() > line_m
        };
        !cells
            .get(at)
            .and_then(HeightCell::known)
            .is_some_and(stands)
    })
}
