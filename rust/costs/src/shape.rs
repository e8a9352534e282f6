//! The shape of the ground around each cell, as far as a robot cares.

use classification::{HeightStatistics, SlopeStatistics, SlopeStatisticsConfig};
use geometry::distance::CellDistances;
use geometry::{Cell, Grid};
use settings::ConfigError;

/// The shape of the ground around a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundShape {
    /// Steepness: rise over run.
    pub slope: f64,
    /// Standard deviation of the heights about their plane, m.
    pub roughness_m: f64,
    /// Largest change of height between cells side by side, beside that of the plane, m.
    pub step_m: f64,
    /// To what stands out of the ground, or to the edge of a drop, m.
    pub clearance_m: f64,
    /// Room above the ground, m; infinite where nothing is known above.
    pub head_room_m: f64,
}

impl GroundShape {
    /// Level, smooth ground with room all around.
    pub const LEVEL: Self = Self {
        slope: 0.0,
        roughness_m: 0.0,
        step_m: 0.0,
        clearance_m: f64::INFINITY,
        head_room_m: f64::INFINITY,
    };
}

/// Measures the shape around each cell of a grid of heights (004, section 36.3.4, after Gennery 1999, reference 36.27): slope, roughness and
/// step about the plane of what is near, clearance from what is higher than a step.
#[derive(Debug, Clone)]
pub struct Shapes {
    statistics: SlopeStatistics,
}

impl Shapes {
    /// With the settings of what is near: `reach` and `least_cells`.
    pub fn new(config: SlopeStatisticsConfig) -> Result<Self, ConfigError> {
        let statistics = SlopeStatistics::new(config)?;
        Ok(Self { statistics })
    }

    /// The shape around each cell; `None` where too little is known. Heights and the side of a cell in m; the room above each cell, m, where
    /// the model knows it. Changes of more than `step_m` stand out.
    pub fn measure(
        &self,
        heights_m: &Grid<Option<f64>>,
        head_room_m: Option<&Grid<f64>>,
        cell_m: f64,
        step_m: f64,
    ) -> Grid<Option<GroundShape>> {
        let (cols, rows) = (heights_m.cols(), heights_m.rows());
        let mut distances = CellDistances::default();
        let standing = standing_out(heights_m, step_m);
        let mut away = Vec::new();
        let is_open = !standing.contains(&true);
        distances.compute_roots(&standing, cols, &mut away);
        let statistics = self.statistics.statistics(heights_m, cell_m);
        let mut shapes = Grid::filled(cols, rows, None);
        for (index, shape) in shapes.values_mut().iter_mut().enumerate() {
            let clearance_m = if is_open {
                f64::INFINITY
            } else {
                ((f64::from(away[index]) - 0.5) * cell_m).max(0.0) // to the near side of the cell that stands out
            };
            let head_room_m = head_room_m
                .and_then(|room| room.values().get(index))
                .copied()
                .unwrap_or(f64::INFINITY);
            let of = |one: &HeightStatistics| GroundShape {
                slope: one.slope,
                roughness_m: one.roughness_m,
                step_m: one.step_m,
                clearance_m,
                head_room_m,
            };
            *shape = statistics.values()[index].as_ref().map(of);
        }
        shapes
    }
}

/// Cells that are higher than one beside them by more than a step.
fn standing_out(heights_m: &Grid<Option<f64>>, step_m: f64) -> Vec<bool> {
    let height_m = |cell: Cell| heights_m.get(cell).copied().flatten();
    let beside = |cell: Cell| {
        let around = (-1..=1).flat_map(|row| (-1..=1).map(move |col| (col, row)));
        around.filter_map(move |(col, row)| height_m(Cell::new(cell.col + col, cell.row + row)))
    };
    let stands_out = |cell: Cell| {
        height_m(cell).is_some_and(|own_m| beside(cell).any(|other_m| own_m - other_m > step_m))
    };
    heights_m.area().cells().map(stands_out).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CELL_M: f64 = 0.04;

    fn measured(height_m: impl Fn(f64, f64) -> Option<f64>) -> Grid<Option<GroundShape>> {
        let mut heights = Grid::filled(30, 30, None);
        for cell in heights.area().cells() {
            *heights.get_mut(cell).unwrap() =
                height_m(f64::from(cell.col) * CELL_M, f64::from(cell.row) * CELL_M);
        }
        let shapes = Shapes::new(SlopeStatisticsConfig::default()).unwrap();
        shapes.measure(&heights, None, CELL_M, 0.055)
    }

    proptest! {
        #[test]
        fn a_plane_has_its_slope_and_nothing_else(x in -0.5..0.5f64, y in -0.5..0.5f64, base in -5.0..5.0f64) {
            let shapes = measured(|at_x, at_y| Some(base + x * at_x + y * at_y));
            let shape = shapes.get(Cell::new(15, 15)).unwrap().unwrap();
            prop_assert!((shape.slope - geometry::hypot(x, y)).abs() < 1e-9);
            prop_assert!(shape.roughness_m < 1e-6 && shape.step_m < 1e-6);
        }

        #[test]
        fn clearance_is_the_distance_to_a_wall(wall in 10..20i32) {
            let shapes = measured(|x, _| Some(if x > (f64::from(wall) - 0.5) * CELL_M { 0.5 } else { 0.0 }));
            for col in 0..wall {
                let shape = shapes.get(Cell::new(col, 15)).unwrap().unwrap();
                let truth = (f64::from(wall - col) - 0.5) * CELL_M;
                prop_assert!((shape.clearance_m - truth).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn what_is_not_known_has_no_shape() {
        let shapes = measured(|x, _| (x < 0.4).then_some(0.0));
        assert!(shapes.get(Cell::new(25, 15)).unwrap().is_none());
        assert!(shapes.get(Cell::new(2, 15)).unwrap().unwrap().clearance_m == f64::INFINITY);
    }
}
