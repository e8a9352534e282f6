//! A smooth field that tells how likely a point of a scan lies at a place: it falls off what was seen there.

use geometry::{Cell, CellArea, Grid, Lattice, PlanarPose};

use crate::beams::pieces;
use crate::config::ScanMatchConfig;

/// Full likelihood in a cell.
const FULL: u16 = u16::MAX;
/// Standard deviations off what is seen beyond which nothing is said.
const REACH: f64 = 2.0;
/// Cells that a field grows by at a time.
const CHUNK: i32 = 32;
/// Uniform cubic B-splines: coefficients of the powers of the place between two cells, for the four around it, times six.
const SPLINE: [[i32; 4]; 4] = [[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]];

/// How likely a point lies in each cell: the mean, over the scans that saw something near, of the Gaussian of its distance from what they saw.
#[derive(Debug, Clone)]
pub struct LikelihoodField {
    lattice: Lattice,
    /// Shares of [`FULL`].
    pub(crate) likely: Grid<u16>,
    scans: Grid<u16>,
    /// Of the scan that is taken in: squared distances, m², of the cells that it reaches; infinite of others.
    squared_m2: Grid<f32>,
    touched: Vec<u32>,
}

/// A value with its slope and its curvature.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Smooth {
    pub(crate) value: f64,
    /// Along x and y, 1/m.
    pub(crate) slope: [f64; 2],
    /// Along xx, xy and yy, 1/m².
    pub(crate) curvature: [f64; 3],
}

impl LikelihoodField {
    /// A field in which nothing was seen, around the origin.
    pub fn new(config: &ScanMatchConfig) -> Self {
        Self {
            lattice: Lattice {
                origin_m: [0.0; 2],
                cell_m: config.cell,
            },
            likely: Grid::filled(0, 0, 0),
            scans: Grid::filled(0, 0, 0),
            squared_m2: Grid::filled(0, 0, f32::INFINITY),
            touched: Vec::new(),
        }
    }

    /// Takes in what a scan saw: ends of beams in the sensor's frame, m, by bearing, from a pose in the field's frame.
    pub(crate) fn insert(
        &mut self,
        config: &ScanMatchConfig,
        ends: &[[f64; 2]],
        pose: &PlanarPose,
    ) {
        let placed: Vec<[f64; 2]> = ends
            .iter()
            .map(|end| pose.apply(end[0], end[1]).into())
            .collect();
        let reach_m = REACH * config.spread;
        self.cover(&placed, reach_m);
        for piece in pieces(&placed, config.join) {
            self.reach_from(piece, reach_m);
        }
        let fall = -0.5 / (config.spread * config.spread);
        for index in core::mem::take(&mut self.touched) {
            let index = index as usize;
            let squared_m2 =
                core::mem::replace(&mut self.squared_m2.values_mut()[index], f32::INFINITY);
            let seen = f64::from(FULL) * libm::exp(fall * f64::from(squared_m2));
            let count = &mut self.scans.values_mut()[index];
            *count = count.saturating_add(1);
            let value = &mut self.likely.values_mut()[index];
            let mean = f64::from(*value) + (seen - f64::from(*value)) / f64::from(*count);
            *value = libm::round(mean) as u16;
        }
    }

    /// Says of the cells near a piece of surface how far they are from it.
    fn reach_from(&mut self, [from, to]: [[f64; 2]; 2], reach_m: f64) {
        let low = [0, 1].map(|axis: usize| from[axis].min(to[axis]) - reach_m);
        let high = [0, 1].map(|axis: usize| from[axis].max(to[axis]) + reach_m);
        let area = CellArea {
            min: self.lattice.cell_at(low[0], low[1]),
            max: self.lattice.cell_at(high[0], high[1]),
        };
        let along = [to[0] - from[0], to[1] - from[1]];
        let length2 = along[0] * along[0] + along[1] * along[1];
        for cell in area.within(self.likely.area()).cells() {
            let [x, y] = self.lattice.center_of(cell);
            let off = [x - from[0], y - from[1]];
            let share = if length2 > 0.0 {
                ((off[0] * along[0] + off[1] * along[1]) / length2).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let [right, up] = [off[0] - share * along[0], off[1] - share * along[1]];
            let squared = right * right + up * up;
            if squared > reach_m * reach_m {
                continue;
            }
            if let Some(index) = self.squared_m2.index(cell) {
                let nearest = &mut self.squared_m2.values_mut()[index];
                if nearest.is_infinite() {
                    self.touched.push(index as u32);
                }
                *nearest = nearest.min(squared as f32);
            }
        }
    }

    /// Grows so that places and what is near them have cells.
    fn cover(&mut self, placed: &[[f64; 2]], reach_m: f64) {
        let mut area = CellArea::EMPTY;
        for [x, y] in placed {
            area.include(self.lattice.cell_at(x - reach_m, y - reach_m));
            area.include(self.lattice.cell_at(x + reach_m, y + reach_m));
        }
        let had = self.likely.area();
        if area.is_empty() || had.within(area) == area {
            return;
        }
        area.join(had);
        let down = |value: i32| value.div_euclid(CHUNK) * CHUNK;
        let (low, high) = (
            Cell::new(down(area.min.col), down(area.min.row)),
            Cell::new(down(area.max.col) + CHUNK, down(area.max.row) + CHUNK),
        );
        let size = [high.col - low.col, high.row - low.row].map(|side| side as usize);
        self.likely = moved(&self.likely, low, size, 0);
        self.scans = moved(&self.scans, low, size, 0);
        self.squared_m2 = Grid::filled(size[0], size[1], f32::INFINITY);
        let [x, y] = self.lattice.origin_m;
        self.lattice.origin_m = [
            x + f64::from(low.col) * self.lattice.cell_m,
            y + f64::from(low.row) * self.lattice.cell_m,
        ];
    }

    /// Gives back what only taking in scans needs.
    pub(crate) fn close(&mut self) {
        self.squared_m2 = Grid::filled(0, 0, f32::INFINITY);
        self.scans = Grid::filled(0, 0, 0);
        self.touched = Vec::new();
    }

    /// Where its cells lie.
    pub const fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Likelihood in a cell, 0..1; 0 where nothing was seen.
    pub fn likelihood(&self, cell: Cell) -> f64 {
        f64::from(self.share(cell)) / f64::from(FULL)
    }

    pub(crate) fn share(&self, cell: Cell) -> u16 {
        self.likely.get(cell).copied().unwrap_or(0)
    }

    /// The likelihood between the cells: a cubic spline over those around, smooth to the second derivative.
    pub(crate) fn at(&self, x_m: f64, y_m: f64) -> Smooth {
        let cell_m = self.lattice.cell_m;
        let place = [x_m, y_m];
        let middle =
            [0, 1].map(|axis: usize| (place[axis] - self.lattice.origin_m[axis]) / cell_m - 0.5);
        let first = middle.map(f64::floor);
        let by = [0, 1].map(|axis: usize| weights(middle[axis] - first[axis]));
        let [col, row] = first.map(|value| value as i32 - 1);
        let mut sum = Smooth::default();
        for (up, y) in by[1].iter().enumerate() {
            for (right, x) in by[0].iter().enumerate() {
                let share = self.share(Cell::new(col + right as i32, row + up as i32));
                if share == 0 {
                    continue;
                }
                let value = f64::from(share) / f64::from(FULL);
                sum.value += value * x[0] * y[0];
                sum.slope[0] += value * x[1] * y[0];
                sum.slope[1] += value * x[0] * y[1];
                sum.curvature[0] += value * x[2] * y[0];
                sum.curvature[1] += value * x[1] * y[1];
                sum.curvature[2] += value * x[0] * y[2];
            }
        }
        sum.slope = sum.slope.map(|value| value / cell_m);
        sum.curvature = sum.curvature.map(|value| value / (cell_m * cell_m));
        sum
    }
}

/// Weights of the four cells around a place between two, and their first and second derivatives.
fn weights(share: f64) -> [[f64; 3]; 4] {
    let powers = [1.0, share, share * share, share * share * share];
    SPLINE.map(|coefficients| {
        let mut sums = [0.0; 3];
        for (power, coefficient) in coefficients.into_iter().enumerate() {
            let first = coefficient * power as i32;
            sums[0] += f64::from(coefficient) * powers[power];
            if power >= 1 {
                sums[1] += f64::from(first) * powers[power - 1];
            }
            if power >= 2 {
                sums[2] += f64::from(first * (power as i32 - 1)) * powers[power - 2];
            }
        }
        sums.map(|sum| sum / f64::from(6_u8))
    })
}

/// A grid's values in another rectangle of its cells.
fn moved<T: Copy>(grid: &Grid<T>, low: Cell, size: [usize; 2], empty: T) -> Grid<T> {
    let mut larger = Grid::filled(size[0], size[1], empty);
    for cell in grid.area().cells() {
        if let (Some(value), Some(slot)) = (
            grid.get(cell),
            larger.get_mut(Cell::new(cell.col - low.col, cell.row - low.row)),
        ) {
            *slot = *value;
        }
    }
    larger
}
