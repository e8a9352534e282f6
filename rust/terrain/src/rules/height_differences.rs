//! Rule: both cells beside a difference in height that is no floor are edges, neighbours by a side or by a corner.

use geometry::two_levels;

use crate::Terrain;

/// So many cells of a row are looked at together first.
const TOGETHER: usize = 32;

pub(super) fn apply(terrain: &mut Terrain) {
    let (cols, floor) = (terrain.cols, terrain.needs.limits.floor_m as f32);
    for first in (0..terrain.height_m.len()).step_by(TOGETHER) {
        let end = (first + TOGETHER).min(terrain.height_m.len());
        if differs(&terrain.height_m[first..], end - first, cols, floor) {
            for index in first..end {
                mark(terrain, index, floor);
            }
        }
    }
}

/// Whether some of the first cells may differ from a neighbour by more than floor does: where one ends a row, the next row's first one is taken
/// for its neighbour.
fn differs(heights_m: &[f32], count: usize, cols: usize, floor: f32) -> bool {
    let here = &heights_m[..count];
    // Without a branch, several cells at a time. Not a number: unknown, no difference.
    let beside = |next: usize| {
        let there = heights_m.get(next..).unwrap_or_default();
        let differs = |(here, there): (&f32, &f32)| (there - here).abs() > floor;
        (here.iter().zip(there)).fold(false, |any, pair| any | differs(pair))
    };
    beside(1) | beside(cols) | beside(cols + 1) | beside(cols.saturating_sub(1))
}

/// Marks a cell, and those of its neighbours to the right and above that differ from it.
fn mark(terrain: &mut Terrain, index: usize, floor: f32) {
    let (cols, here) = (terrain.cols, terrain.height_m[index]);
    if here.is_nan() {
        return;
    }
    let col = index % cols;
    let neighbours = [
        (col + 1 < cols, index + 1),
        (true, index + cols),
        (col + 1 < cols, index + cols + 1),
        (col > 0, index + cols - 1),
    ];
    for (inside, next) in neighbours {
        // Not a number: unknown, no difference.
        let there = terrain.height_m.get(next).copied().unwrap_or(f32::NAN);
        if !(inside && two_levels(there, here, floor)) {
            continue;
        }
        let rise = terrain.slopes.step_m(index, next, there - here);
        if rise > floor + terrain.noise_m(index, next) && !terrain.may_be_strips(index, next, rise)
        {
            terrain.mark_step(index, rise);
            terrain.mark_step(next, rise);
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;
    use proptest::prelude::*;

    use crate::Rules;
    use crate::testing::{Floor, cell};

    proptest! {
        #[test]
        fn noise_of_heights_is_no_step_and_a_step_that_is_higher_than_their_noise_is_one(
            sigma_m in 0.0..0.02f32, off in prop::collection::vec(-1.4..1.4f32, 7), higher_m in 0.001..0.1f32,
        ) {
            let mut floor = Floor::new();
            floor.doubt([-2.0, -2.0], [2.0, 2.0], sigma_m);
            let cells: Vec<geometry::Cell> = floor.view.cells.area().cells().collect();
            for (at, &cell) in cells.iter().enumerate() {
                let height = Surface::Floor(sigma_m * off[at % off.len()]);
                *floor.view.cells.get_mut(cell).unwrap() = height;
            }
            prop_assert!(!floor.after("height_differences").any_edge);
            // Two standard deviations of the difference, and what is floor.
            let step_m = 0.01 + 2.0 * 2.0_f32.sqrt() * sigma_m + higher_m;
            floor.paint([-2.0, -2.0], [0.5, 2.0], Surface::Floor(0.0));
            floor.paint([0.5, -2.0], [2.0, 2.0], Surface::Floor(step_m));
            let terrain = floor.after("height_differences");
            prop_assert!(terrain.edge[cell(&terrain, 0.475, 0.025)]);
            prop_assert!(!terrain.edge[cell(&terrain, 0.225, 0.025)]);
        }
    }

    #[test]
    fn a_step_has_an_edge_on_both_sides_that_is_open_where_it_may_be_climbed_and_a_slope_has_none()
    {
        let mut floor = Floor::new();
        floor.paint([0.5, -2.0], [2.0, 2.0], Surface::Floor(0.04));
        floor.paint([-2.0, -2.0], [-0.5, 2.0], Surface::Floor(-0.2));
        floor.paint([-2.0, 1.0], [2.0, 2.0], Surface::Floor(0.008));
        let terrain = floor.after("height_differences");
        let at = |x_m: f64, y_m: f64| cell(&terrain, x_m, y_m);
        for x_m in [0.475, 0.525] {
            assert!(terrain.edge[at(x_m, 0.025)] && terrain.open[at(x_m, 0.025)]);
        }
        for x_m in [-0.475, -0.525] {
            assert!(terrain.edge[at(x_m, 0.025)] && !terrain.open[at(x_m, 0.025)]);
        }
        assert!(!terrain.edge[at(0.225, 1.025)], "8 mm are floor");
    }

    /// Whether there is an edge anywhere where a slope of one metre that begins 1 m from the robot, who has been `nearer_m` nearer, has a
    /// strip that is off by `off_m`.
    fn has_edge(off_m: f64, nearer_m: f64, unseen: bool) -> bool {
        let (mut rules, mut terrain) = (Rules::default(), crate::testing::terrain());
        let mut floor = Floor::new();
        floor.ramp([1.0, -2.0], [2.0, 2.0], [0.0, 0.09]);
        floor.tilt([1.4, -2.0], [1.5, 2.0], 0.0);
        floor.paint(
            [1.4, -2.0],
            [1.5, 2.0],
            Surface::Floor((0.04 + off_m) as f32),
        );
        if unseen {
            floor.paint([1.35, -2.0], [1.4, 2.0], Surface::Unknown);
        }
        floor.stand.at_m = [nearer_m, 0.0];
        floor.read(&mut rules, &mut terrain, "shadows");
        terrain.any_edge
    }

    #[test]
    fn on_a_slope_a_low_step_is_believed_once_it_was_near_and_a_drop_from_afar() {
        for unseen in [false, true] {
            assert!(!has_edge(0.035, 0.0, unseen));
            assert!(has_edge(0.035, 0.9, unseen));
            assert!(has_edge(-0.1, 0.0, unseen), "a drop");
            assert!(!has_edge(0.01, 0.9, unseen));
        }
    }
}
