//! Where the map's cells lie: it grows, moves, and takes in others.

use geometry::{Cell, Grid};

use super::map::{OccupancyError, OccupancyMap};
use super::odds::log_odds;
use super::said::Said;

impl OccupancyMap {
    /// Joins what a map of other scans knows: as if its scans had been taken in here (004, Fig. 36.2), but for where either reached a limit.
    pub fn join(&mut self, other: &Self) -> Result<(), OccupancyError> {
        let cells = |axis: usize| {
            (other.lattice.origin_m[axis] - self.lattice.origin_m[axis]) / self.config.cell
        };
        let offset = [cells(0), cells(1)];
        let aligned = offset.iter().all(|at| (at - at.round()).abs() < ALIGNED);
        if other.config.cell != self.config.cell || !aligned {
            return Err(OccupancyError::OtherLattice);
        }
        let corner = [other.cells.cols(), other.cells.rows()];
        let high = [0, 1].map(|axis| {
            other.lattice.origin_m[axis] + (corner[axis] as f64 - 0.5) * self.config.cell
        });
        let low = other
            .lattice
            .origin_m
            .map(|at_m| at_m + self.config.cell / 2.0);
        if !corner.contains(&0) {
            self.cover_box(low, high)?;
        }
        let theirs = log_odds(other.config.prior);
        for cell in other.cells.area().cells() {
            let Some(&belief) = other.cells.get(cell).filter(|belief| belief.looks > 0) else {
                continue;
            };
            let [x_m, y_m] = other.lattice.center_of(cell);
            if let Some(index) = self.cells.index(self.lattice.cell_at(x_m, y_m)) {
                self.add(index, f64::from(belief.log_odds) - theirs, belief.looks);
            }
        }
        Ok(())
    }

    /// Moves the cells that are kept: what was at cell (c + cols, r + rows) is then at (c, r), and what comes in is unknown.
    pub fn shift(&mut self, cols: i32, rows: i32) {
        let unknown = self.unknown();
        self.cells.shift(cols, rows, &unknown);
        self.lattice.origin_m[0] += f64::from(cols) * self.config.cell;
        self.lattice.origin_m[1] += f64::from(rows) * self.config.cell;
    }

    pub(super) fn cover_box(
        &mut self,
        low_m: [f64; 2],
        high_m: [f64; 2],
    ) -> Result<(), OccupancyError> {
        let (mut area, had) = (self.cells.area(), self.cells.area());
        for at_m in [low_m, high_m] {
            area.include(self.lattice.cell_at(at_m[0], at_m[1]));
        }
        if area == had || !self.grows {
            return Ok(());
        }
        // By half of its size at least, so that growing takes little of the time.
        let more = |count: usize| (count / 2) as i32;
        let (cols, rows) = (more(self.cells.cols()), more(self.cells.rows()));
        let roomy =
            |end: i64, had: i64, by: i32| if end == had { end } else { end + i64::from(by) };
        let min = [
            -roomy(-i64::from(area.min.col), -i64::from(had.min.col), cols),
            -roomy(-i64::from(area.min.row), -i64::from(had.min.row), rows),
        ];
        let max = [
            roomy(i64::from(area.max.col), i64::from(had.max.col), cols),
            roomy(i64::from(area.max.row), i64::from(had.max.row), rows),
        ];
        let [new_cols, new_rows] = [0, 1].map(|axis| (max[axis] - min[axis] + 1) as usize);
        if new_cols.saturating_mul(new_rows) > self.config.most_cells {
            return Err(OccupancyError::TooLarge {
                cols: new_cols,
                rows: new_rows,
            });
        }
        let mut cells = Grid::filled(new_cols, new_rows, self.unknown());
        for cell in had.cells() {
            let moved = Cell::new(
                (i64::from(cell.col) - min[0]) as i32,
                (i64::from(cell.row) - min[1]) as i32,
            );
            if let (Some(slot), Some(belief)) = (cells.get_mut(moved), self.cells.get(cell)) {
                *slot = *belief;
            }
        }
        let cell_m = self.config.cell;
        let origin_m = self.lattice.origin_m;
        self.lattice.origin_m = [0, 1].map(|axis| origin_m[axis] + min[axis] as f64 * cell_m);
        self.said = vec![Said::Nothing; new_cols * new_rows];
        self.cells = cells;
        Ok(())
    }
}

/// Cells of two maps that lie this near to each other, in cells, lie on one lattice: sums of decimal fractions.
const ALIGNED: f64 = 1e-6;
