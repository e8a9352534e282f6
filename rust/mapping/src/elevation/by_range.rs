//! Cells that grow with the distance from the robot, as a sensor's points on level ground lie further and further apart: 004, Fig. 36.9,
//! after Lacroix et al. 2002.
//!
//! A cell is a range of directions and of slopes of the sight line: as many points of a picture fall into each. Its sides are `cell`
//! one metre away; it is as wide as that times the distance and as deep as that times the distance squared. The map is the robot's: it
//! is sampled anew whenever that moves, which costs precision.

use geometry::Grid;

use super::cells::{HeightCell, Revision};
use super::sensed::SensedFrame;
use super::{CellMeasurement, Gathered, RangeNoise, SurfaceRule};

/// The cells around a robot.
#[derive(Debug, Clone)]
pub struct RangeCells {
    cell_m: f64,
    nearest_m: f64,
    centre_m: [f64; 2],
    /// Columns by direction, rows by distance.
    cells: Grid<HeightCell>,
    gathered: Gathered,
    error_m: f64,
}

impl RangeCells {
    /// Nothing was seen: cells from `nearest_m` on up to `max_range_m` away, with sides of `cell_m` at one metre.
    pub fn new(cell_m: f64, nearest_m: f64, max_range_m: f64) -> Self {
        /// More would not fit into memory.
        const MOST: usize = 4096;
        let cols = (std::f64::consts::TAU / cell_m).ceil() as usize;
        let rows = ((1.0 / nearest_m - 1.0 / max_range_m) / cell_m).ceil() as usize;
        let [cols, rows] = [cols, rows].map(|count| count.clamp(1, MOST));
        Self {
            cell_m,
            nearest_m,
            centre_m: [0.0; 2],
            cells: Grid::filled(cols, rows, HeightCell::UNKNOWN),
            gathered: Gathered::default(),
            error_m: 0.0,
        }
    }

    /// Points of the last frame in each cell that has any: how far away its middle is, m, and how many.
    pub fn points(&self) -> impl Iterator<Item = (f64, u32)> {
        self.gathered.counts().map(|(cell, points)| {
            let [_, row] = [cell % self.cells.cols(), cell / self.cells.cols()];
            (self.range_m(row), points)
        })
    }

    /// Root mean square of what the last sampling changed heights by, m: the cell that was nearest against the plane through those around it.
    pub const fn resampling_error_m(&self) -> f64 {
        self.error_m
    }

    /// Moves the cells to the robot, and takes in a frame.
    pub(super) fn insert(
        &mut self,
        robot_m: [f64; 3],
        frame: &SensedFrame,
        (noise, rule, revision): (RangeNoise, SurfaceRule, Revision),
    ) {
        self.move_to([robot_m[0], robot_m[1]]);
        self.gathered.begin(self.cells.values().len());
        for point in &frame.points {
            let [x_m, y_m, z_m] = frame.at_m(point);
            if let Some(index) = self.index_at([x_m, y_m]) {
                (self.gathered).add(index, z_m as f32, noise.variance_m2(point.range_m));
            }
        }
        let cells = self.cells.values_mut();
        let take = |measured: CellMeasurement| cells[measured.cell].measure(&measured, revision);
        self.gathered.measure(rule, take);
    }

    /// What is known of the cell that a place of the map frame lies in.
    pub(super) fn at(&self, place_m: [f64; 2]) -> Option<HeightCell> {
        self.cells.values()[self.index_at(place_m)?]
            .known()
            .copied()
    }

    /// Samples the cells around another place.
    fn move_to(&mut self, centre_m: [f64; 2]) {
        if centre_m == self.centre_m {
            return;
        }
        let before = Self {
            gathered: Gathered::default(),
            ..self.clone()
        };
        self.centre_m = centre_m;
        let (mut sum, mut count) = (0.0, 0.0);
        for row in 0..self.cells.rows() {
            for col in 0..self.cells.cols() {
                let place_m = self.middle_m([col, row]);
                let found = before.at(place_m);
                if let (Some(found), Some(plane_m)) = (found, before.plane_m(place_m)) {
                    sum += (f64::from(found.estimate.height_m) - plane_m).powi(2);
                    count += 1.0;
                }
                let index = row * self.cells.cols() + col;
                self.cells.values_mut()[index] = found.unwrap_or(HeightCell::UNKNOWN);
            }
        }
        self.error_m = f64::sqrt(sum / f64::max(count, 1.0));
    }

    /// Height at a place, m, between the middles of its cell and the next ones in direction and distance.
    fn plane_m(&self, place_m: [f64; 2]) -> Option<f64> {
        let (turns, steps) = self.coordinates(place_m)?;
        let [col, row] = [turns - 0.5, steps - 0.5].map(f64::floor);
        let (along, out) = (turns - 0.5 - col, steps - 0.5 - row);
        let cols = self.cells.cols() as f64;
        let height = |col: f64, row: f64| {
            let col = col.rem_euclid(cols) as usize;
            let inside = row >= 0.0 && row < self.cells.rows() as f64;
            let index = inside.then_some(row as usize * self.cells.cols() + col)?;
            let known = self.cells.values()[index].known()?;
            Some(f64::from(known.estimate.height_m))
        };
        let near = (1.0 - along) * height(col, row)? + along * height(col + 1.0, row)?;
        let far = (1.0 - along) * height(col, row + 1.0)? + along * height(col + 1.0, row + 1.0)?;
        Some((1.0 - out) * near + out * far)
    }

    /// Where a place lies in columns by direction and rows by distance; none nearer or further than the cells.
    fn coordinates(&self, place_m: [f64; 2]) -> Option<(f64, f64)> {
        let [x, y] = [place_m[0] - self.centre_m[0], place_m[1] - self.centre_m[1]];
        let range_m = geometry::hypot(x, y);
        let steps = (1.0 / self.nearest_m - 1.0 / range_m) / self.cell_m;
        let turn = libm::atan2(y, x) / std::f64::consts::TAU;
        let turns = (turn + 0.5).min(1.0 - f64::EPSILON) * self.cells.cols() as f64;
        (steps >= 0.0 && steps < self.cells.rows() as f64).then_some((turns, steps))
    }

    fn index_at(&self, place_m: [f64; 2]) -> Option<usize> {
        let (turns, steps) = self.coordinates(place_m)?;
        Some(steps as usize * self.cells.cols() + turns as usize)
    }

    /// Distance of the middle of the cells of a row, m.
    fn range_m(&self, row: usize) -> f64 {
        1.0 / (1.0 / self.nearest_m - (row as f64 + 0.5) * self.cell_m)
    }

    fn middle_m(&self, [col, row]: [usize; 2]) -> [f64; 2] {
        let turn = (col as f64 + 0.5) / self.cells.cols() as f64 - 0.5;
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * turn);
        let range_m = self.range_m(row);
        [
            self.centre_m[0] + range_m * cos,
            self.centre_m[1] + range_m * sin,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_middle_of_a_cell_lies_in_it(col in 0..314usize, row in 0..120usize) {
            let cells = RangeCells::new(0.02, 0.2, 4.0);
            prop_assert!(cells.cells.cols() == 315 && cells.cells.rows() >= 120);
            let index = cells.index_at(cells.middle_m([col, row]));
            prop_assert_eq!(index, Some(row * cells.cells.cols() + col));
        }
    }

    #[test]
    fn cells_grow_with_the_distance_as_their_sides_say() {
        let cells = RangeCells::new(0.02, 0.2, 4.0);
        let depth_m = |row: usize| cells.range_m(row + 1) - cells.range_m(row);
        let row = (0..cells.cells.rows())
            .find(|&row| cells.range_m(row) > 1.0)
            .unwrap();
        assert!((depth_m(row) - 0.02).abs() < 0.002);
        let far = (0..cells.cells.rows())
            .find(|&row| cells.range_m(row) > 2.0)
            .unwrap();
        assert!((depth_m(far) / depth_m(row) - 4.0).abs() < 0.4);
    }
}
