//! What walking would cost if no slope were too steep.

use crate::Terrain;
use crate::cells::around;

impl Terrain {
    /// What a length would cost in each cell if no slope were too steep to be walked on; none where none is.
    pub fn weights_over_slopes(&self) -> Option<Vec<f32>> {
        let mut steep = self.slopes.too_steep().peekable();
        let _any = steep.peek()?;
        let mut weights = self.weights.clone();
        // Feet keep off the edges that steep cells are.
        let reach = (self.needs.feet_m / self.lattice.cell_m).ceil() as usize + 1;
        for index in steep {
            for cell in around(index, reach, [self.cols, self.rows]) {
                if !self.blocked[cell] && weights[cell].is_infinite() {
                    weights[cell] = 1.0;
                }
            }
        }
        Some(weights)
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;
    use proptest::prelude::*;

    use crate::testing::Floor;

    /// A floor that rises so much per metre in this direction, everywhere, as the map has it, with errors of its heights.
    fn plane(rise_per_m: f64, heading_rad: f64, off_m: &[f64]) -> Floor {
        let mut floor = Floor::new();
        let (sin, cos) = libm::sincos(heading_rad);
        let cells: Vec<geometry::Cell> = floor.view.cells.area().cells().collect();
        for (at, cell) in cells.into_iter().enumerate() {
            let [x, y] = floor.view.lattice.center_of(cell);
            let height_m = rise_per_m * (cos * x + sin * y) + off_m[at % off_m.len()];
            *floor.view.cells.get_mut(cell).unwrap() = Surface::Floor(height_m as f32);
            let gradient = [cos, sin].map(|share| (share * rise_per_m) as f32);
            *floor.view.gradients.get_mut(cell).unwrap() = gradient;
        }
        floor
    }

    proptest! {
        #[test]
        fn a_plane_of_any_tilt_up_to_10_degrees_is_floor(
            degrees in 2.0..10.0f64, heading_rad in -3.2..3.2f64,
            off_m in prop::collection::vec(-0.004..0.004f64, 7),
        ) {
            let rise_per_m = libm::tan(degrees.to_radians());
            let terrain = plane(rise_per_m, heading_rad, &off_m).after("steep_slopes");
            prop_assert!(!terrain.any_edge);
            prop_assert!(terrain.weights_over_slopes().is_none());
        }

        #[test]
        fn a_plane_of_more_than_12_degrees_is_none(degrees in 12.0..20.0f64, heading_rad in -3.2..3.2f64) {
            let rise_per_m = libm::tan(degrees.to_radians());
            let terrain = plane(rise_per_m, heading_rad, &[0.0]).after("edge_costs");
            prop_assert!(terrain.edge.iter().all(|&edge| edge));
            prop_assert!(terrain.weights_over_slopes().is_some());
        }

        #[test]
        fn a_step_of_15_mm_or_more_beside_level_floor_is_an_edge(rise_m in 0.015..0.05f64, at_m in -0.5..0.5f64) {
            let mut floor = Floor::new();
            floor.paint([at_m, -2.0], [2.0, 2.0], Surface::Floor(rise_m as f32));
            let terrain = floor.after("steep_slopes");
            prop_assert!(terrain.edge.iter().any(|&edge| edge));
        }
    }
}
