//! Upright surfaces from above: in each cell a normal distribution of the places that were seen.
//!
//! The normal distributions transform of Biber and Strasser (2003), but read off between the cells, so that a wall has no seams.

use geometry::{Cell, Grid, Lattice};
use nalgebra::{Matrix2, Vector2};

use super::tuning::SurfacesTuning;

/// What was seen in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CellPatch {
    count: f64,
    mean_m: Vector2<f64>,
    /// Sum of the squared deviations from the mean, m^2.
    scatter_m2: Matrix2<f64>,
}

const EMPTY: CellPatch = CellPatch {
    count: 0.0,
    mean_m: Vector2::new(0.0, 0.0),
    scatter_m2: Matrix2::new(0.0, 0.0, 0.0, 0.0),
};

/// The surface near a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wall {
    /// A point of it, m.
    pub(super) middle_m: Vector2<f64>,
    /// Across it.
    pub(super) normal: Vector2<f64>,
    /// Variance across it, m^2.
    pub(super) variance_m2: f64,
}

/// The surfaces around a keyframe.
#[derive(Debug, Clone)]
pub(super) struct UprightSurfaces {
    tuning: SurfacesTuning,
    lattice: Lattice,
    patches: Grid<CellPatch>,
}

impl UprightSurfaces {
    /// A window without any surface yet; its middle is the frame's origin.
    pub(super) fn new(cell_m: f64, tuning: &SurfacesTuning) -> Self {
        let cells = tuning.cells;
        let corner_m = -0.5 * cells as f64 * cell_m;
        Self {
            tuning: tuning.clone(),
            lattice: Lattice {
                origin_m: [corner_m, corner_m],
                cell_m,
            },
            patches: Grid::filled(cells, cells, EMPTY),
        }
    }

    /// Something was seen here; outside the window it is forgotten.
    pub(super) fn add(&mut self, place_m: Vector2<f64>) {
        let cell = self.lattice.cell_at(place_m.x, place_m.y);
        if let Some(patch) = self.patches.get_mut(cell) {
            patch.count += 1.0;
            let before = place_m - patch.mean_m;
            patch.mean_m += before / patch.count;
            patch.scatter_m2 += before * (place_m - patch.mean_m).transpose();
        }
    }

    /// The surface near a place: only where it is long and thin, so that its end or a corner is never taken for one.
    pub(super) fn wall_at(&self, place_m: Vector2<f64>) -> Option<Wall> {
        let (cell_m, tuning) = (self.lattice.cell_m, &self.tuning);
        let near = tuning.near;
        let at = self.lattice.cell_at(place_m.x, place_m.y);
        let (mut weight, mut first, mut second) = (0.0, Vector2::zeros(), Matrix2::zeros());
        let mut cells = 0;
        for (col, row) in (-1..=1).flat_map(|row| (-1..=1).map(move |col| (col, row))) {
            let cell = Cell::new(at.col.saturating_add(col), at.row.saturating_add(row));
            let Some(patch) = self.patches.get(cell).filter(|patch| patch.count > 0.0) else {
                continue;
            };
            let off = patch.mean_m - place_m;
            let distance2 = off.norm_squared() / (cell_m * cell_m);
            if distance2 > near * near {
                continue;
            }
            let share = patch.count * libm::exp(-0.5 * distance2);
            weight += share;
            first += off * share;
            second += (patch.scatter_m2 / patch.count + off * off.transpose()) * share;
            cells += 1;
        }
        if weight < tuning.least_weight || cells < tuning.least_cells {
            return None;
        }
        let mean = first / weight;
        let spread = second / weight - mean * mean.transpose();
        let (across_m2, along_m2, normal) = principal(&spread);
        let is_wall = along_m2 > tuning.slender * across_m2
            && along_m2 > (tuning.least_length * cell_m).powi(2);
        is_wall.then_some(Wall {
            middle_m: place_m + mean,
            normal,
            variance_m2: across_m2,
        })
    }
}

/// The smaller and the larger principal variance, and the direction of the smaller one.
fn principal(spread: &Matrix2<f64>) -> (f64, f64, Vector2<f64>) {
    let (xx, yy, xy) = (spread.m11, spread.m22, spread.m12);
    let (mean, half) = (f64::midpoint(xx, yy), 0.5 * (xx - yy));
    let radius = geometry::hypot(half, xy);
    let along_rad = 0.5 * libm::atan2(xy, half);
    let (sin, cos) = libm::sincos(along_rad);
    (
        (mean - radius).max(0.0),
        mean + radius,
        Vector2::new(-sin, cos),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_wall_has_its_normal_wherever_it_stands(angle in -3.0..3.0f64, shift in -0.4..0.4f64, at in -0.4..0.4f64) {
            let along = Vector2::new(libm::cos(angle), libm::sin(angle));
            let normal = Vector2::new(-along.y, along.x);
            let mut surfaces = UprightSurfaces::new(0.05, &SurfacesTuning::default());
            for step in -100..=100 {
                surfaces.add(normal * shift + along * (0.01 * f64::from(step)));
            }
            let wall = surfaces.wall_at(normal * shift + along * at).unwrap();
            prop_assert!(wall.normal.dot(&along).abs() < 0.02);
            prop_assert!((wall.middle_m - normal * shift).dot(&normal).abs() < 1e-6);
        }
    }

    #[test]
    fn a_post_is_no_wall_and_nothing_is_none() {
        let mut surfaces = UprightSurfaces::new(0.05, &SurfacesTuning::default());
        assert_eq!(surfaces.wall_at(Vector2::zeros()), None);
        for step in 0..20 {
            let (sin, cos) = libm::sincos(0.3 * f64::from(step));
            surfaces.add(Vector2::new(cos, sin) * 0.03);
        }
        assert_eq!(surfaces.wall_at(Vector2::zeros()), None);
        assert_eq!(surfaces.wall_at(Vector2::new(f64::NAN, 0.0)), None);
        surfaces.add(Vector2::new(f64::INFINITY, 0.0));
    }
}
