//! Obstacle or traversable, by slope and spread of the heights around a cell.

use geometry::{Cell, Grid, hypot};
use nalgebra::{Matrix3, Vector3};
use settings::{ConfigError, POSITIVE, Table, at_least, settings};

settings! {
    /// How cells are told apart by the heights around them.
    pub struct SlopeStatisticsConfig("classification.slope_statistics") {
        /// Cells around a cell whose heights count.
        reach: usize = 2, "1", at_least(1.0);
        /// Fewest of them that must be known.
        least_cells: usize = 6, "1", at_least(4.0);
        /// Steeper ground is an obstacle.
        slope: f64 = 0.4, "1", POSITIVE;
        /// A larger change of height between cells side by side, beside that of the slope, is an obstacle.
        step: f64 = 0.05, "m", POSITIVE;
        /// Heights that are spread more about their plane are an obstacle.
        roughness: f64 = 0.03, "m", POSITIVE;
    }
}

/// How the heights around a cell are distributed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightStatistics {
    /// Steepness of the plane through them: rise over run.
    pub slope: f64,
    /// Their standard deviation about the plane, m.
    pub roughness_m: f64,
    /// Largest change of height between two cells side by side, beside that of the plane, m.
    pub step_m: f64,
    /// From the lowest to the highest, m.
    pub range_m: f64,
}

/// Sizes below count as this.
const NEGLIGIBLE: f64 = 1e-3;

/// Tells obstacles by limits on slope, step and roughness: handbook, section 36.3.5 (after Lacroix et al. 2002, reference 36.46).
#[derive(Debug, Clone)]
pub struct SlopeStatistics {
    config: SlopeStatisticsConfig,
}

impl SlopeStatistics {
    /// With settings.
    pub fn new(config: SlopeStatisticsConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// Whether each cell is an obstacle by its statistics; `None` where too little is known. Heights and side of a cell in m.
    pub fn obstacles(&self, heights_m: &Grid<Option<f64>>, cell_m: f64) -> Grid<Option<bool>> {
        let statistics = self.statistics(heights_m, cell_m);
        let mut obstacles = Grid::filled(statistics.cols(), statistics.rows(), None);
        for (obstacle, one) in obstacles.values_mut().iter_mut().zip(statistics.values()) {
            *obstacle = one.map(|one| self.is_obstacle(&one));
        }
        obstacles
    }

    /// Whether heights that are distributed so are an obstacle.
    pub fn is_obstacle(&self, statistics: &HeightStatistics) -> bool {
        self.excess(statistics) > 1.0
    }

    /// The statistic that is largest for its limit, in limits: above 1 it is an obstacle.
    fn excess(&self, statistics: &HeightStatistics) -> f64 {
        let slope = statistics.slope / self.config.slope;
        let step = statistics.step_m / self.config.step;
        slope
            .max(step)
            .max(statistics.roughness_m / self.config.roughness)
    }

    /// Statistics as a list for a trained classifier, in logarithms since each is a size; what the limits say is one of them.
    pub fn features(&self, statistics: &HeightStatistics) -> Vec<f64> {
        let all = [
            self.excess(statistics),
            statistics.slope,
            statistics.roughness_m,
            statistics.step_m,
            statistics.range_m,
        ];
        all.map(|value| libm::log(value.max(NEGLIGIBLE))).to_vec()
    }

    /// The statistics of each cell; `None` where too little is known.
    pub fn statistics(
        &self,
        heights_m: &Grid<Option<f64>>,
        cell_m: f64,
    ) -> Grid<Option<HeightStatistics>> {
        let (cols, rows) = (heights_m.cols(), heights_m.rows());
        let mut statistics = Grid::filled(cols, rows, None);
        for (index, one) in statistics.values_mut().iter_mut().enumerate() {
            let cell = Cell::new((index % cols) as i32, (index / cols) as i32);
            *one = self.around(heights_m, cell, cell_m);
        }
        statistics
    }

    fn around(
        &self,
        heights_m: &Grid<Option<f64>>,
        cell: Cell,
        cell_m: f64,
    ) -> Option<HeightStatistics> {
        let reach = self.config.reach as i32;
        let height_m = |col: i32, row: i32| {
            let inside = col.abs() <= reach && row.abs() <= reach;
            let at = Cell::new(cell.col + col, cell.row + row);
            heights_m.get(at).copied().flatten().filter(|_| inside)
        };
        let offsets = (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |col| (col, row)));
        let known: Vec<_> = offsets
            .filter_map(|(col, row)| height_m(col, row).map(|height_m| (col, row, height_m)))
            .collect();
        if known.len() < self.config.least_cells {
            return None;
        }
        let place = |col: i32, row: i32| {
            Vector3::new(f64::from(col) * cell_m, f64::from(row) * cell_m, 1.0)
        };
        let mut products = Matrix3::zeros();
        let mut moments = Vector3::zeros();
        let base_m = known[0].2; // numbers near 0, however high the ground lies
        for (col, row, height_m) in &known {
            let at = place(*col, *row);
            products += at * at.transpose();
            moments += at * (height_m - base_m);
        }
        let plane = products.cholesky()?.solve(&moments); // none where all lie on one line
        let residual_m = |col, row, height_m: f64| height_m - base_m - plane.dot(&place(col, row));
        let mut squares = 0.0;
        let mut step_m: f64 = 0.0;
        for &(col, row, here_m) in &known {
            let apart_m = residual_m(col, row, here_m);
            squares += apart_m * apart_m;
            for (col, row) in [(col + 1, row), (col, row + 1)] {
                if let Some(beside_m) = height_m(col, row) {
                    step_m = step_m.max((residual_m(col, row, beside_m) - apart_m).abs());
                }
            }
        }
        let heights = || known.iter().map(|(_, _, height_m)| *height_m);
        let highest_m = heights().fold(f64::NEG_INFINITY, f64::max);
        let lowest_m = heights().fold(f64::INFINITY, f64::min);
        Some(HeightStatistics {
            slope: hypot(plane[0], plane[1]),
            roughness_m: (squares / known.len() as f64).sqrt(),
            step_m,
            range_m: highest_m - lowest_m,
        })
    }
}

#[cfg(test)]
pub(crate) mod tests;
