//! The load-bearing surface under grass: the lowest returns that agree, held against the rays that go by below others.

use geometry::{Cell, Grid, Lattice};
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, SHARE, Table, at_least, settings};

use crate::cloud::Point3;

settings! {
    /// How the ground is found under vegetation.
    pub struct LoadBearingConfig("classification.load_bearing") {
        /// Standard deviation of the height of a return from the ground.
        noise: f64 = 0.01, "m", POSITIVE;
        /// Returns lie on one surface within this many times the noise.
        band: f64 = 2.0, "1", POSITIVE;
        /// Share of the returns that may lie below the ground: errors of measurement.
        below: f64 = 0.02, "1", SHARE;
        /// Fewest returns within the band for a cell to say anything.
        returns: usize = 3, "1", at_least(1.0);
        /// Cells around a cell that its ground must go on with.
        reach: usize = 2, "1", at_least(1.0);
        /// A cell's ground stands out of the plane through its neighbours' by no more than this; higher ones are stems, or a tuft that
        /// no ray went through.
        apart: f64 = 0.03, "m", NOT_NEGATIVE;
        /// Rounds in which cells are held against their neighbours.
        rounds: usize = 3, "1", at_least(0.0);
    }
}

/// A ray of a range sensor and where it ended, in a frame with z up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorRay {
    /// Where the sensor was, m.
    pub from: Point3,
    /// What it hit, m.
    pub to: Point3,
}

/// What a cell of the ground is known by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Height of the surface that bears a foot, m.
    pub height_m: f64,
    /// Its standard deviation by the returns that agree on it, m.
    pub sigma_m: f64,
    /// Mean height of all returns, m: what a map of points would take for the ground.
    pub raw_m: f64,
    /// Share of the rays at the cell that ended above its ground: how dense the vegetation is.
    pub cover: f64,
}

/// All that is known of a cell's column.
#[derive(Debug, Clone, Default)]
struct CellReturns {
    returns_m: Vec<f64>,
    /// The lowest height at which a ray went through and on: the ground is below it.
    passed_m: Option<f64>,
}

/// Finds what bears a foot under grass: handbook, section 36.3.5 (ray reasoning after Lacaze, Murphy and DelGiorno 2002, and Hebert
/// and Vandapel 2003).
///
/// Claim: stems return at all heights, the ground at one; and no ground lies where a ray went on.
#[derive(Debug, Clone)]
pub struct LoadBearing {
    config: LoadBearingConfig,
    lattice: Lattice,
    columns: Grid<CellReturns>,
}

impl LoadBearing {
    /// For the cells of a lattice.
    pub fn new(
        config: LoadBearingConfig,
        lattice: Lattice,
        [cols, rows]: [usize; 2],
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let columns = Grid::filled(cols, rows, CellReturns::default());
        Ok(Self {
            config,
            lattice,
            columns,
        })
    }

    /// Takes in rays.
    pub fn insert(&mut self, rays: &[SensorRay]) {
        for ray in rays {
            let end = self.lattice.cell_at(ray.to[0], ray.to[1]);
            if let Some(column) = self.columns.get_mut(end) {
                column.returns_m.push(ray.to[2]);
            }
            self.pass(ray, end);
        }
    }

    /// Notes where a ray leaves the columns before its end.
    fn pass(&mut self, ray: &SensorRay, end: Cell) {
        let along = [0, 1, 2].map(|axis| ray.to[axis] - ray.from[axis]);
        let cells = along[0].abs().max(along[1].abs()) / self.lattice.cell_m;
        // Twice a cell: no column is left out that the ray crosses in its middle.
        let steps = (cells * 2.0) as usize;
        for step in (0..steps).rev() {
            let share = step as f64 / steps as f64;
            let [x, y, z] = [0, 1, 2].map(|axis| ray.from[axis] + share * along[axis]);
            let cell = self.lattice.cell_at(x, y);
            if cell == end {
                continue;
            }
            // Rays come down towards their ends: what lies behind is higher, and outside stays outside.
            let Some(column) = self.columns.get_mut(cell) else {
                break;
            };
            column.passed_m = Some(column.passed_m.map_or(z, |lowest_m| lowest_m.min(z)));
        }
    }

    /// The ground of each cell, `None` where nothing agrees.
    pub fn surface(&self) -> Grid<Option<Support>> {
        let (cols, rows) = (self.columns.cols(), self.columns.rows());
        let mut surface = Grid::filled(cols, rows, None);
        for (support, column) in surface.values_mut().iter_mut().zip(self.columns.values()) {
            *support = self.lowest(column, f64::INFINITY);
        }
        for _ in 0..self.config.rounds {
            let before = surface.clone();
            for index in 0..cols * rows {
                let cell = Cell::new((index % cols) as i32, (index / cols) as i32);
                let Some(expected_m) = self.of_neighbours(&before, cell) else {
                    continue;
                };
                let highest_m = expected_m + self.config.apart;
                let column = &self.columns.values()[index];
                let Some(support) = &mut surface.values_mut()[index] else {
                    continue;
                };
                if support.height_m > highest_m {
                    // Nothing that agrees lies low enough: the ground goes on as around it.
                    let kept = *support;
                    *support = self.lowest(column, highest_m).unwrap_or(Support {
                        height_m: expected_m,
                        sigma_m: self.config.apart,
                        ..kept
                    });
                }
            }
        }
        surface
    }

    /// The lowest returns that agree and lie below a height and below every ray that went on.
    fn lowest(&self, column: &CellReturns, highest_m: f64) -> Option<Support> {
        let config = &self.config;
        let mut all_m = column.returns_m.clone();
        all_m.sort_by(f64::total_cmp);
        let count = all_m.len();
        let band_m = config.band * config.noise;
        let passed_m = column.passed_m.unwrap_or(f64::INFINITY) + band_m;
        let skipped = (config.below * count as f64) as usize;
        let mut first = skipped;
        while first + config.returns <= count {
            let low_m = all_m[first];
            if low_m > highest_m.min(passed_m) {
                return None;
            }
            let agreeing = (all_m[first..].iter())
                .take_while(|height_m| **height_m <= low_m + 2.0 * band_m)
                .count();
            if agreeing >= config.returns {
                let height_m = all_m[first..first + agreeing].iter().sum::<f64>() / agreeing as f64;
                let above = count - first - agreeing;
                return Some(Support {
                    height_m,
                    sigma_m: config.noise / (agreeing as f64).sqrt(),
                    raw_m: all_m.iter().sum::<f64>() / count as f64,
                    cover: above as f64 / count as f64,
                });
            }
            first += 1;
        }
        None
    }

    /// The height that the plane through the cells around a cell has at it: their median, slope and all, since they lie around it in pairs.
    fn of_neighbours(&self, surface: &Grid<Option<Support>>, cell: Cell) -> Option<f64> {
        let reach = self.config.reach as i32;
        let height_m = |col: i32, row: i32| -> Option<f64> {
            let at = surface.get(Cell::new(cell.col + col, cell.row + row));
            at.copied().flatten().map(|support| support.height_m)
        };
        let mut middles_m = Vec::new();
        for row in 0..=reach {
            for col in -reach..=reach {
                if (row, col) > (0, 0)
                    && let (Some(one_m), Some(other_m)) = (height_m(col, row), height_m(-col, -row))
                {
                    middles_m.push(f64::midpoint(one_m, other_m));
                }
            }
        }
        middles_m.sort_by(f64::total_cmp);
        middles_m.get(middles_m.len() / 2).copied()
    }
}

#[cfg(test)]
mod tests;
