//! All samples: blocks of a sparse grid, into which points go one by one.

use super::block::SampleBlock;
use super::cells::{EDGE, cell_in_block};
use super::moments::Moments;
use super::sample::Sample;
use crate::columns::Span;
use volume::{GridKey, SparseGrid};

/// SurfaceSamples of the surfaces that were seen, in any direction and of any extent, as many as the surfaces need (004, section 36.3.2).
#[derive(Debug, Clone)]
pub struct SurfaceSamples {
    blocks: SparseGrid<SampleBlock>,
    cell_m: f64,
    /// Points further from a sample than so many standard deviations of both are no part of it.
    gate: f32,
    flat_m: f32,
    /// The block of the last point: the next one is mostly in it, too.
    last: Option<(GridKey, usize)>,
}

impl SurfaceSamples {
    /// No samples. Cells have this side, m; `gate` and `flat_m` as of the settings `gate` and `flat`.
    pub fn new(cell_m: f64, gate: f64, flat_m: f64) -> Self {
        Self {
            blocks: SparseGrid::new(),
            cell_m,
            gate: gate as f32,
            flat_m: flat_m as f32,
            last: None,
        }
    }

    /// SurfaceSamples that are kept.
    pub fn count(&self) -> usize {
        self.blocks
            .iter()
            .map(|(_, block)| block.samples.len())
            .sum()
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> usize {
        let each = self
            .blocks
            .iter()
            .map(|(_, block)| block.samples.capacity());
        self.blocks.bytes() + each.sum::<usize>() * size_of::<Sample>()
    }

    /// Blocks that are kept.
    pub const fn blocks(&self) -> usize {
        self.blocks.len()
    }

    const fn side_m(&self) -> f64 {
        self.cell_m * EDGE as f64
    }

    /// Takes in a point of the map frame, m, of which a coordinate is as sure as a variance, m², says, and whether it was seen from above.
    pub fn add(&mut self, at_m: [f64; 3], variance_m2: f32, from_above: bool) {
        let in_cells = at_m.map(|at| (at / self.cell_m).floor());
        if in_cells.iter().any(|at| at.is_nan() || at.abs() > 1e9) {
            return;
        }
        let cells = in_cells.map(|at| at as i32);
        let edge = EDGE as i32;
        let key = cells.map(|at| at.div_euclid(edge));
        let place = cells.map(|at| at.rem_euclid(edge) as usize);
        let side_m = self.side_m();
        let local = |key: GridKey| {
            [0, 1, 2].map(|axis| (at_m[axis] - f64::from(key[axis]) * side_m) as f32)
        };
        let own = match self.last {
            Some((last, at)) if last == key => Some(at),
            _ => self.blocks.position(key),
        };
        let own_m = local(key);
        let mut best: Option<(usize, GridKey, [usize; 3], usize, f32)> = None;
        let mut ask = |position: Option<usize>, key: GridKey, place: [usize; 3], at_m| {
            let Some(position) = position else { return };
            let (_, block) = self.blocks.at(position);
            let near = block.nearest(at_m, variance_m2, cell_in_block(place), from_above);
            if let Some((sample, off)) = near.filter(|near| near.1 <= self.gate)
                && best.is_none_or(|best| off < best.4)
            {
                best = Some((position, key, place, sample, off));
            }
        };
        ask(own, key, place, own_m);
        // A sample of the block above or below may reach here.
        let reach_m = self.gate * variance_m2.sqrt();
        for (beside, near, layer) in [
            (-1, own_m[2] < reach_m, EDGE - 1),
            (1, side_m as f32 - own_m[2] < reach_m, 0),
        ] {
            if near {
                let other = [key[0], key[1], key[2] + beside];
                let place = [place[0], place[1], layer];
                ask(self.blocks.position(other), other, place, local(other));
            }
        }
        let (position, key, place, sample) = if let Some((position, key, place, sample, _)) = best {
            (position, key, place, Some(sample))
        } else {
            let fresh = self.blocks.position_or_insert(key, SampleBlock::default);
            (fresh, key, place, None)
        };
        let point = Moments::of(local(key), variance_m2);
        let (_, block) = self.blocks.at_mut(position);
        block.fuse(&point, (cell_in_block(place), from_above), sample);
        self.last = Some((key, position));
    }

    /// Takes in that a frame is over: what lies on one surface becomes one sample.
    pub fn end_frame(&mut self) {
        for position in 0..self.blocks.len() {
            self.blocks.at_mut(position).1.end_frame(self.flat_m);
        }
    }

    /// Takes back samples that frames saw through, so many in a row. `through` says so of a place of the map frame, m, as sure as a variance, m², says.
    pub fn look_through(&mut self, patience: u8, through: impl Fn([f64; 3], f32) -> bool) {
        let (side_m, cell_m) = (self.side_m(), self.cell_m as f32);
        self.last = None;
        self.blocks.retain(|key, block| {
            if !block.touched {
                block.look_through(cell_m, patience, |at_m, variance_m2| {
                    let place =
                        [0, 1, 2].map(|axis| f64::from(key[axis]) * side_m + f64::from(at_m[axis]));
                    through(place, variance_m2)
                });
            }
            !block.samples.is_empty()
        });
    }

    /// Forgets what is further than `reach_m` from a place, along x or y.
    pub fn forget_beyond(&mut self, [x_m, y_m, _]: [f64; 3], reach_m: f64) {
        let side_m = self.side_m();
        let near = |key: i32, at_m: f64| (f64::from(key) * side_m - at_m).abs() <= reach_m;
        self.last = None;
        self.blocks
            .retain(|key, _| near(key[0], x_m) && near(key[1], y_m));
    }

    /// The moments of all samples whose means lie in a box of the map frame, m, about its lowest corner.
    pub fn moments_in(&self, low_m: [f64; 3], high_m: [f64; 3]) -> Moments {
        let side_m = self.side_m();
        let key = |at_m: f64| (at_m / side_m).floor().clamp(-1e9, 1e9) as i32;
        let [first, last] = [low_m, high_m].map(|corner| corner.map(key));
        let mut all = Moments::NONE;
        for x in first[0]..=last[0] {
            for y in first[1]..=last[1] {
                for z in first[2]..=last[2] {
                    let corner = [x, y, z];
                    for sample in self
                        .blocks
                        .get(corner)
                        .into_iter()
                        .flat_map(|one| &one.samples)
                    {
                        let by =
                            [0, 1, 2].map(|axis| f64::from(corner[axis]) * side_m - low_m[axis]);
                        let moved = sample.moments.moved(by.map(|by_m| by_m as f32));
                        let inside = (0..3).all(|axis| {
                            let at = f64::from(moved.mean_m[axis]);
                            at >= 0.0 && at < high_m[axis] - low_m[axis]
                        });
                        if inside {
                            all = all.with(&moved);
                        }
                    }
                }
            }
        }
        all
    }

    /// Hands what each sample of at least so many points is in each of its columns to `take`, with the column's cell, counted from the map's origin.
    pub fn spans(&self, least_points: u32, upright: f32, mut take: impl FnMut([i32; 2], Span)) {
        let (side_m, cell_m) = (self.side_m(), self.cell_m as f32);
        for (key, block) in self.blocks.iter() {
            let bottom_m = (f64::from(key[2]) * side_m) as f32;
            for sample in &block.samples {
                if sample.moments.count < least_points {
                    continue;
                }
                for row in 0..EDGE {
                    for col in 0..EDGE {
                        if let Some(span) = sample.span([col, row], (bottom_m, cell_m), upright) {
                            let column = [
                                key[0] * EDGE as i32 + col as i32,
                                key[1] * EDGE as i32 + row as i32,
                            ];
                            take(column, span);
                        }
                    }
                }
            }
        }
    }
}
