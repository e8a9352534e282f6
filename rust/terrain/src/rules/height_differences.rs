//! Rule: both cells beside a difference in height that is no floor are edges, neighbours by a side or by a corner.

use geometry::two_levels;

use crate::Terrain;

pub(super) fn apply(terrain: &mut Terrain) {
    let (cols, floor) = (terrain.cols, terrain.needs.limits.floor_m as f32);
    for index in 0..terrain.height_m.len() {
        let here = terrain.height_m[index];
        if here.is_nan() {
            continue;
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
            if rise > floor {
                terrain.mark_step(index, rise);
                terrain.mark_step(next, rise);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

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
}
