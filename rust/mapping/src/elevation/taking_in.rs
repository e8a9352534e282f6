//! How a frame changes what is known.

use geometry::{CellArea, runs};

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
        let eye_m = self.frame.eye_m;
        self.lines.begin(eye_m);
        for point in &self.frame.points {
            self.lines.add(self.frame.at_m(point));
        }
        self.lines.finish();
        let (size, lattice) = (self.view.size(), self.window.lattice());
        let mut cleared = CellArea::EMPTY;
        for (index, cell) in self.cells.values_mut().iter_mut().enumerate() {
            if self.gathered.holds(index) {
                continue;
            }
            let at = cell_of(index, size);
            let centre_m = lattice.center_of(at);
            let Some(bound_m) = self.lines.bound_m(centre_m) else {
                continue;
            };
            let lowest = &mut self.bounds_m.values_mut()[index];
            *lowest = lowest.min(bound_m as f32);
            if cell.known().is_some() {
                let range_m = geometry::hypot(centre_m[0] - eye_m[0], centre_m[1] - eye_m[1]);
                if cell.pass(bound_m as f32, noise.variance_m2(range_m as f32), revision) {
                    cleared.include(at);
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
