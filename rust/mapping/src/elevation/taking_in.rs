//! How a frame changes what is known.

use geometry::{Cell, CellArea, runs};

use super::cells::{HeightCell, Revision};
use super::filling::{FillRule, fill};
use super::{Elevation, RangeNoise, cell_of};

impl Elevation {
    /// The shift that brings the frame onto the heights that are known.
    pub(super) fn shift_m(&mut self) -> Option<f64> {
        let cells = self.cells.values();
        let known_m = |cell: usize, _: f32| Some(cells[cell].known()?.estimate.height_m);
        let gate = (self.config.match_gate, self.config.min_pairs);
        (self.frame).shift_m(known_m, gate, &self.config.tuning.matching)
    }

    /// Takes in the frame that was read; the cells that it changed.
    pub(super) fn take_in(&mut self, robot_m: [f64; 3]) -> CellArea {
        let (rule, revision, noise) = (self.rule(), self.revision(), self.config.noise());
        let (size, area) = (self.view.size(), self.view.cells.area());
        if let Some(known) = &mut self.by_range {
            known.insert(robot_m, &self.frame, (noise, rule, revision));
            let lattice = self.window.lattice();
            for (index, cell) in self.cells.values_mut().iter_mut().enumerate() {
                let found = known.at(lattice.center_of(cell_of(index, size)));
                *cell = found.unwrap_or(HeightCell::UNKNOWN);
            }
            return area;
        }
        self.gathered.begin(size[0] * size[1]);
        for point in &self.frame.points {
            if let Some(cell) = point.cell() {
                let variance_m2 = noise.variance_m2(point.range_m);
                (self.gathered).add(cell, self.frame.height_m(point), variance_m2);
            }
        }
        let mut touched = CellArea::EMPTY;
        let cells = self.cells.values_mut();
        self.gathered.measure(rule, |measured| {
            cells[measured.cell].measure(&measured, revision);
            touched.include(cell_of(measured.cell, size));
        });
        self.pyramid.insert(&self.frame, noise, rule, revision);
        if self.config.clearing {
            touched.join(self.look_below_sight_lines(revision, noise));
        }
        if self.config.fill > 0.0 {
            self.fill_gaps(touched.grown(self.fill_rule().cells).within(area));
        }
        touched
    }

    /// Takes back what sight lines pass below; the cells in which something was.
    fn look_below_sight_lines(&mut self, revision: Revision, noise: RangeNoise) -> CellArea {
        self.lines.begin();
        for point in &self.frame.points {
            self.lines.add(self.frame.eye_to_m(point));
        }
        self.lines.finish();
        let (size, lattice) = (self.view.size(), self.window.lattice());
        let (eye_m, cell_m) = (self.frame.eye_m, lattice.cell_m as f32);
        let [first_x, first_y] = lattice.center_of(Cell::new(0, 0));
        let first_m = [(first_x - eye_m[0]) as f32, (first_y - eye_m[1]) as f32];
        let cells = self.cells.values_mut().chunks_exact_mut(size[0]);
        let bounds = self.bounds_m.values_mut().chunks_exact_mut(size[0]);
        let mut cleared = CellArea::EMPTY;
        for (row, (cells, bounds_m)) in cells.zip(bounds).enumerate() {
            let y_m = first_m[1] + row as f32 * cell_m;
            for (col, (cell, lowest_m)) in cells.iter_mut().zip(bounds_m).enumerate() {
                if self.gathered.holds(row * size[0] + col) {
                    continue;
                }
                let x_m = first_m[0] + col as f32 * cell_m;
                let Some(bound_m) = self.lines.bound_m([x_m, y_m]) else {
                    continue;
                };
                let bound_m = eye_m[2] as f32 + bound_m;
                *lowest_m = lowest_m.min(bound_m);
                if cell.known().is_some() {
                    let range_m = (x_m * x_m + y_m * y_m).sqrt();
                    if cell.pass(bound_m, noise.variance_m2(range_m), revision) {
                        cleared.include(Cell::new(col as i32, row as i32));
                    }
                }
            }
        }
        cleared
    }

    /// What may be filled.
    pub(super) fn fill_rule(&self) -> FillRule {
        FillRule {
            cells: (self.config.fill / self.config.cell + 0.5) as i32,
            gate: self.config.gate as f32,
            slope: (self.config.rise / self.config.cell.max(self.config.fill)) as f32,
        }
    }

    /// Fills the gaps of an area that lie between cells that the frame saw.
    fn fill_gaps(&mut self, area: CellArea) {
        let (rule, eye_m, lattice) = (self.fill_rule(), self.frame.eye_m, self.window.lattice());
        let size = self.view.size();
        for index in runs(area, size).flatten() {
            if self.cells.values()[index].known().is_none() {
                let cell = cell_of(index, size);
                if let Some(found) = fill(&self.cells, &lattice, (cell, eye_m), rule) {
                    self.filled.values_mut()[index] = found;
                }
            }
        }
    }
}
