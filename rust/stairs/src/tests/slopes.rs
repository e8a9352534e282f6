//! What lies on a slope of the map, or is led to by one, is no stair.

use geometry::{Grid, Lattice};
use mapping::{FloorView, Surface};

use super::exact::{ground, swing};
use super::prisms::{Prism, frame};
use super::*;

/// A floor that slopes between two lines across x.
fn sloped(from_m: f64, to_m: f64) -> FloorView {
    let lattice = Lattice {
        origin_m: [-1.0, -1.0],
        cell_m: 0.04,
    };
    let mut view = FloorView::new(lattice, Grid::filled(60, 50, Surface::Floor(0.0)), 9);
    for cell in view.cells.area().cells() {
        let [x, _] = lattice.center_of(cell);
        if let Some(slot) = view.gradients.get_mut(cell)
            && (from_m..to_m).contains(&x)
        {
            *slot = [0.1, 0.0];
        }
    }
    view
}

/// Heights of the stairs above the ground after a look at a block of 30 mm from 0.5 to 0.75 m, where the map slopes so.
fn heights_m(floor: &FloorView) -> Vec<f64> {
    let block = [[0.5, -0.3], [0.75, -0.3], [0.75, 0.3], [0.5, 0.3]];
    let prisms = [Prism::new(&block, 0.03), ground()];
    let here = Pose::identity();
    let mut recognizer = swing(&prisms, &here);
    recognizer.leave_slopes(floor);
    let (scan, planes) = frame(&prisms, &here, &camera_pose(0.0, 0.7));
    let staircase = recognizer.update(&scan, &planes, &here, 0).unwrap();
    let heights = staircase.stairs.iter().map(crate::Stair::height_m);
    heights.filter(|height_m| *height_m > 0.01).collect()
}

#[test]
fn level_strips_of_a_slope_and_what_it_leads_to_are_no_stairs() {
    assert_eq!(heights_m(&sloped(0.0, 0.0)).len(), 1, "no slope");
    assert_eq!(heights_m(&sloped(-0.5, 0.3)).len(), 1, "elsewhere");
    assert!(heights_m(&sloped(0.48, 0.8)).is_empty(), "on it");
    assert!(heights_m(&sloped(0.2, 0.48)).is_empty(), "leading to it");
}
