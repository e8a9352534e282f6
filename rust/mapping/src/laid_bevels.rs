//! Short slopes laid into the floor that a model has.

use geometry::{Cell, CellArea, Lattice, Outline};
use nalgebra::Point2;

use crate::{Bevel, FloorView, Surface};

/// Lays a bevel into the floor of a view: each cell rises by as much as the part of the bevel in it does.
pub(crate) fn lay(bevel: &Bevel, view: &mut FloorView) {
    let half = 0.5 * bevel.run_m;
    let corners = [(half, 1.0), (half, -1.0), (-half, 1.0), (-half, -1.0)]
        .map(|(ahead_m, side)| bevel.at_m(ahead_m, side * bevel.half_width_m));
    let Ok(outline) = Outline::hull(&corners) else {
        return;
    };
    let lattice = view.lattice;
    let gradient = bevel.gradient();
    for cell in area_of(lattice, &corners).cells() {
        let Some(share) = share_of(lattice, cell, (bevel, &outline)) else {
            continue;
        };
        let height_m = bevel.height_m(lattice.center_of(cell));
        if let (Some(surface @ Surface::Floor(_)), Some(slot)) =
            (view.cells.get_mut(cell), view.gradients.get_mut(cell))
        {
            *surface = Surface::Floor(height_m as f32);
            *slot = gradient.map(|rise| (share * rise) as f32);
        }
    }
}

/// The cells around places.
fn area_of(lattice: Lattice, corners: &[Point2<f64>]) -> CellArea {
    let least = corners.iter().fold(corners[0], |a, b| a.inf(b));
    let most = corners.iter().fold(corners[0], |a, b| a.sup(b));
    CellArea {
        min: lattice.cell_at(least.x, least.y),
        max: lattice.cell_at(most.x, most.y),
    }
}

/// The share of a cell that lies within a bevel's outline; none where nothing of it does. Only at the outline's sides is it cut out.
fn share_of(lattice: Lattice, cell: Cell, (bevel, outline): (&Bevel, &Outline)) -> Option<f64> {
    let middle_m = lattice.center_of(cell);
    let half = 0.5 * lattice.cell_m;
    let beyond_m = bevel.beyond_sides_m(middle_m);
    // Half of a cell's diagonal: so far a cell reaches in any direction.
    let reach_m = half * std::f64::consts::SQRT_2;
    if beyond_m > reach_m {
        return None;
    }
    if beyond_m < -reach_m {
        return Some(1.0);
    }
    let [x_m, y_m] = middle_m;
    let corners = [(half, half), (-half, half), (-half, -half), (half, -half)]
        .map(|(x, y)| Point2::new(x_m + x, y_m + y));
    let whole = Outline::hull(&corners).ok()?;
    let share = outline.shared_area_m2(&whole) / lattice.cell_m.powi(2);
    (share > 0.0).then_some(share)
}

#[cfg(test)]
mod tests {
    use geometry::Grid;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_way_over_it_rises_by_what_it_rises(
            x_m in -0.3..0.3f64, turn_rad in -0.4..0.4f64, run_m in 0.08..0.25f64, rise_m in -0.03..0.03f64,
        ) {
            let lattice = Lattice { origin_m: [-1.0, -1.0], cell_m: 0.04 };
            let mut view = FloorView::new(lattice, Grid::filled(50, 50, Surface::Floor(0.0)), 9);
            let bevel = Bevel {
                middle_m: [x_m, 0.0],
                heading_rad: turn_rad,
                half_width_m: 0.6,
                run_m,
                heights_m: [0.0, rise_m],
            };
            lay(&bevel, &mut view);
            let steps = 400;
            let (sin, cos) = libm::sincos(turn_rad);
            let step_m = 0.8 / f64::from(steps);
            let rise: f64 = (0..steps).map(|at| {
                let along_m = -0.4 + step_m * (f64::from(at) + 0.5);
                let [x, y] = view.gradient_at(x_m + cos * along_m, sin * along_m);
                (cos * x + sin * y) * step_m
            }).sum();
            prop_assert!((rise - rise_m).abs() < 0.15 * rise_m.abs() + 1e-4, "{rise} {rise_m}");
        }
    }
}
