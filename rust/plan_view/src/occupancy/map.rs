//! The cells of the map, and how scans change them.

use geometry::{Cell, Grid, Lattice};
use settings::{ConfigError, Table};

use super::OccupancyConfig;
use super::odds::{log_odds, probability_of_log_odds};
use super::said::Said;

/// Why a scan could not be taken in. The map is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OccupancyError {
    /// A pose with a component that is no number.
    #[error("the sensor's pose must be finite")]
    PoseNotFinite,
    /// The map would become too large.
    #[error(
        "the map would have {cols} x {rows} cells, more than navigation.occupancy_2d.most_cells"
    )]
    TooLarge {
        /// Columns that it would have.
        cols: usize,
        /// Rows that it would have.
        rows: usize,
    },
    /// Maps with different cells cannot be joined.
    #[error("maps can be joined whose cells are the same and lie on one lattice")]
    OtherLattice,
}

/// What is known of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellBelief {
    /// Logarithm of the odds that it is occupied.
    pub log_odds: f32,
    /// Scans that said something of it, at most 65535; 0 of a cell that is unknown.
    pub looks: u16,
}

/// Which cells are occupied. It grows with what is seen, unless it was made of a size; cells stay where they are.
#[derive(Debug, Clone)]
pub struct OccupancyMap {
    pub(super) config: OccupancyConfig,
    pub(super) grows: bool,
    pub(super) lattice: Lattice,
    pub(super) cells: Grid<CellBelief>,
    /// Of the scan that is taken in: what is said of each cell, and of which.
    pub(super) said: Vec<Said>,
    pub(super) touched: Vec<u32>,
}

impl OccupancyMap {
    /// A map without a cell.
    pub fn new(config: OccupancyConfig) -> Result<Self, ConfigError> {
        config.check()?;
        let lattice = Lattice {
            origin_m: [0.0; 2],
            cell_m: config.cell,
        };
        Ok(Self::around(config, lattice, [0, 0], true))
    }

    /// A map of so many columns and rows, unknown and never larger, with the corner of its first cell at a place in the map frame, m.
    pub fn of_size(
        config: OccupancyConfig,
        origin_m: [f64; 2],
        size: [usize; 2],
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let lattice = Lattice {
            origin_m,
            cell_m: config.cell,
        };
        Ok(Self::around(config, lattice, size, false))
    }

    fn around(
        config: OccupancyConfig,
        lattice: Lattice,
        [cols, rows]: [usize; 2],
        grows: bool,
    ) -> Self {
        let unknown = CellBelief {
            log_odds: log_odds(config.prior) as f32,
            looks: 0,
        };
        Self {
            config,
            grows,
            lattice,
            cells: Grid::filled(cols, rows, unknown),
            said: vec![Said::Nothing; cols * rows],
            touched: Vec::new(),
        }
    }

    /// The settings.
    pub const fn config(&self) -> &OccupancyConfig {
        &self.config
    }

    /// Where the cells lie in the map frame.
    pub const fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// What is known of each cell.
    pub const fn cells(&self) -> &Grid<CellBelief> {
        &self.cells
    }

    /// Probability that the cell at a point of the map frame, m, is occupied; none where nothing was seen. Takes the same time in any map.
    pub fn probability_at(&self, x_m: f64, y_m: f64) -> Option<f64> {
        self.probability(self.lattice.cell_at(x_m, y_m))
    }

    /// Probability that a cell is occupied; none where nothing was seen, and outside.
    pub fn probability(&self, cell: Cell) -> Option<f64> {
        let belief = self.cells.get(cell).filter(|belief| belief.looks > 0)?;
        Some(probability_of_log_odds(f64::from(belief.log_odds)))
    }

    /// Logarithm of the probability that just these cells are occupied, row by row (004, equation 36.1): the sum of the cells' own, which are taken
    /// to be independent. Unknown cells count with the prior.
    pub fn log_probability_of(&self, occupied: &[bool]) -> f64 {
        let each = self.cells.values().iter().zip(occupied);
        each.map(|(belief, &occupied)| {
            let odds = f64::from(belief.log_odds);
            let sign = if occupied { -1.0 } else { 1.0 };
            -libm::log1p(libm::exp(sign * odds))
        })
        .sum()
    }

    /// Takes in what one measurement says of a cell: the probability that it is occupied, given that measurement alone (004, equation 36.4).
    pub fn update(&mut self, cell: Cell, probability: f64) {
        if let Some(index) = self.cells.index(cell) {
            self.tell(index, probability);
        }
    }

    pub(super) fn unknown(&self) -> CellBelief {
        CellBelief {
            log_odds: log_odds(self.config.prior) as f32,
            looks: 0,
        }
    }

    pub(super) fn in_cells(&self, at_m: [f64; 2]) -> [f64; 3] {
        let in_cells = |axis: usize| (at_m[axis] - self.lattice.origin_m[axis]) / self.config.cell;
        [in_cells(0), in_cells(1), 0.5]
    }

    pub(super) fn tell(&mut self, index: usize, probability: f64) {
        self.add(
            index,
            log_odds(probability) - log_odds(self.config.prior),
            1,
        );
    }

    pub(super) fn add(&mut self, index: usize, change: f64, looks: u16) {
        let (least, most) = (log_odds(self.config.least), log_odds(self.config.most));
        let belief = &mut self.cells.values_mut()[index];
        belief.log_odds = (f64::from(belief.log_odds) + change).clamp(least, most) as f32;
        belief.looks = belief.looks.saturating_add(looks);
    }
}
