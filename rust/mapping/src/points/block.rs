//! A block of the sparse grid: the samples of 4 x 4 x 4 cells, fewer where the surface is flat.

use super::cells::EDGE;
use super::moments::Moments;
use super::sample::Sample;

/// The cells of the column that a cell is in.
const fn column_of(cell: usize) -> u64 {
    ((1 << EDGE) - 1) << (cell / EDGE * EDGE)
}

/// The samples of a block.
#[derive(Debug, Clone, Default)]
pub(super) struct SampleBlock {
    pub(super) samples: Vec<Sample>,
    /// Something came since the last frame's end.
    pub(super) touched: bool,
}

impl SampleBlock {
    /// The sample that a point, m from the block's corner, belongs to, if one is near: the position of the nearest and how near, in standard
    /// deviations. `cell` is the point's own, or the one of its column that is next to it.
    pub(super) fn nearest(
        &self,
        at_m: [f32; 3],
        variance_m2: f32,
        cell: usize,
        from_above: bool,
    ) -> Option<(usize, f32)> {
        let column = column_of(cell);
        let near = |sample: &Sample| {
            sample.from_above == from_above && (sample.is_surface() || sample.cells & column != 0)
        };
        let all = self.samples.iter().enumerate();
        all.filter(|(_, sample)| near(sample))
            .map(|(at, sample)| (at, sample.deviations(at_m, variance_m2)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Takes in a point of a cell, in the sample at a position or in a new one.
    pub(super) fn fuse(
        &mut self,
        point: &Moments,
        (cell, from_above): (usize, bool),
        sample: Option<usize>,
    ) {
        self.touched = true;
        match sample {
            Some(at) => self.samples[at].fuse(point, 1 << cell),
            None => self.samples.push(Sample::of(*point, 1 << cell, from_above)),
        }
    }

    /// Takes in that a frame is over: samples that lie on one surface become one.
    pub(super) fn end_frame(&mut self, flat_m: f32) {
        if !self.touched {
            return;
        }
        self.touched = false;
        self.samples.iter_mut().for_each(Sample::end_frame);
        if flat_m > 0.0 {
            self.relay();
            self.join(flat_m);
        }
    }

    /// Surfaces turn with what was fused in them.
    fn relay(&mut self) {
        for sample in self.samples.iter_mut().filter(|one| one.is_surface()) {
            *sample = sample.laid(sample.moments.shape());
        }
    }

    /// Makes one of all samples that are surely on one surface, or of a surface and those that are surely on it.
    fn join(&mut self, flat_m: f32) {
        let sure = |sample: &Sample| sample.moments.weight * flat_m * flat_m >= 1.0;
        let on = |surface: &Sample, one: &Sample| {
            let [nx, ny, nz] = surface.normal;
            let [x, y, z] =
                [0, 1, 2].map(|axis| one.moments.mean_m[axis] - surface.moments.mean_m[axis]);
            (nx * x + ny * y + nz * z).abs() <= flat_m
        };
        let Some(first) = self.samples.iter().position(Sample::is_surface) else {
            let sides = |one: &Sample| one.from_above == self.samples[0].from_above;
            let joinable = |one: &Sample| sure(one) && sides(one);
            if self.samples.len() < EDGE || !self.samples.iter().all(joinable) {
                return;
            }
            let Some(all) = self
                .samples
                .iter()
                .copied()
                .reduce(|all, one| all.joined(&one))
            else {
                return;
            };
            let shape = all.moments.shape();
            let all = all.laid(shape);
            // In a row they are on many surfaces.
            let wide = shape.sigmas_m[1] > shape.sigmas_m[2] + flat_m;
            if wide && self.samples.iter().all(|one| on(&all, one)) {
                self.samples = vec![all];
            }
            return;
        };
        let mut surface = self.samples[first];
        self.samples.retain(|one| {
            let joins = !one.is_surface()
                && one.from_above == surface.from_above
                && sure(one)
                && on(&surface, one);
            if joins {
                surface = surface.joined(one);
            }
            !joins
        });
        if let Some(at) = self.samples.iter().position(Sample::is_surface) {
            self.samples[at] = surface;
        }
    }

    /// Takes back what a frame saw through: surfaces fall apart into cells first. `through` says so of a cell's sample, m from the corner, of which
    /// a coordinate is as sure as a variance, m², says.
    pub(super) fn look_through(
        &mut self,
        cell_m: f32,
        patience: u8,
        through: impl Fn([f32; 3], f32) -> bool,
    ) {
        let mut fallen = Vec::new();
        self.samples.retain_mut(|sample| {
            let mut cells = (0..u64::BITS as usize).filter(|cell| sample.cells >> cell & 1 == 1);
            let variance_m2 = 1.0 / sample.moments.weight;
            let seen_through = if sample.is_surface() {
                cells.any(|cell| through(sample.at_cell(cell, cell_m), variance_m2))
            } else {
                through(sample.moments.mean_m, variance_m2)
            };
            let gone = seen_through && sample.pass(patience);
            if gone && sample.is_surface() {
                fallen.extend(sample.split(cell_m));
            }
            !gone
        });
        self.samples.extend(fallen);
    }
}
