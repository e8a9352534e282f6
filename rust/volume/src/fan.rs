//! Rays of a frame that go the same way, side by side as the eye sees them.

use std::ops::Range;

use super::raster::{ROWS, Raster};

/// A ray that rises or falls more than so many voxels on a voxel's way is not taken in, but followed by itself; the marks are the same.
const STEEPEST: f64 = 4.0;
/// Bins for each ray, if all were evenly spread: a voxel's sure part is to hold whole bins. More or fewer only take longer.
const BINS: f32 = 6.0;
/// Most columns, and most bins for a slope of one.
const COLS: usize = 2048;
/// Side of a block of bins, whose rays are listed together.
const BLOCK: usize = 4;
/// End of a list.
const NONE: u32 = u32::MAX;

/// A ray by its slopes: how far it goes sideways and up while it goes one voxel ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FanBeam {
    slopes: [f32; 2],
    /// Slab in which it ends, counted from the eye's.
    reach: u32,
    ray: u32,
}

/// A ray by its bin; or a bin, and the next ray of its block.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Place {
    col: u16,
    row: u16,
    ray: u32,
}

/// Slopes are counted in bins.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Grain {
    /// Lowest slopes, and bins for a slope of one.
    pub(super) lowest: [f64; 2],
    pub(super) per_slope: f64,
    /// Columns (of slopes sideways) and rows (of slopes up).
    pub(super) size: [usize; 2],
}

/// Rays along one axis of the grid, one way. Reused from frame to frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Fan {
    beams: Vec<FanBeam>,
    pub(super) grain: Grain,
    /// By reach, and where the rays of each reach begin.
    places: Vec<Place>,
    starts: Vec<u32>,
    /// Bins of the rays that are shown.
    pub(super) raster: Raster,
    /// The rays that are listed, by block: the first, and by ray its bin and the next.
    heads: Vec<u32>,
    links: Vec<Place>,
}

impl Fan {
    /// Takes in a ray by its slopes, and the slab in which it ends, unless it is too steep.
    #[inline]
    pub(super) fn take(&mut self, slopes: [f64; 2], reach: u32, ray: u32) -> bool {
        let taken = slopes[1].abs() < STEEPEST;
        if taken {
            let slopes = [slopes[0] as f32, slopes[1] as f32];
            self.beams.push(FanBeam { slopes, reach, ray });
        }
        taken
    }

    /// How many rays it holds.
    pub(super) fn len(&self) -> usize {
        self.beams.len()
    }

    /// The rays that reach a slab.
    pub(super) fn reaching(&self, slab: u32) -> impl Iterator<Item = usize> {
        let reach = self.beams.iter().filter(move |beam| beam.reach >= slab);
        reach.map(|beam| beam.ray as usize)
    }

    /// Sorts the rays by reach, up to a slab; none is shown or listed yet. `rays` are there in all.
    pub(super) fn sort(&mut self, farthest: u32, rays: usize) {
        self.grain = Grain::of(&self.beams);
        let Grain {
            lowest, per_slope, ..
        } = self.grain;
        let (lowest, per_slope) = (lowest.map(|slope| slope as f32), per_slope as f32);
        let slab = |beam: &FanBeam| beam.reach.min(farthest) as usize;
        self.starts.clear();
        self.starts.resize(farthest as usize + 2, 0);
        for beam in &self.beams {
            self.starts[slab(beam)] += 1;
        }
        let mut before = 0;
        for start in &mut self.starts {
            before += *start;
            *start = before;
        }
        self.places.resize(self.beams.len(), Place::default());
        for beam in &self.beams {
            let bin = |way: usize| ((beam.slopes[way] - lowest[way]) * per_slope) as u16;
            let start = &mut self.starts[slab(beam)];
            *start -= 1;
            self.places[*start as usize] = Place {
                col: bin(0),
                row: bin(1),
                ray: beam.ray,
            };
        }
        let [cols, rows] = self.grain.size;
        self.raster.resize([cols, rows]);
        self.heads.clear();
        self.heads
            .resize(cols.div_ceil(BLOCK) * rows.div_ceil(BLOCK), NONE);
        self.links.resize(rays, Place::default());
    }

    /// Where the rays that end in a slab are, by reach.
    fn places(&self, slab: u32) -> Range<usize> {
        let [from, to] = [slab, slab + 1].map(|slab| self.starts[slab as usize] as usize);
        from..to
    }

    /// The rays that end in a slab.
    pub(super) fn ending(&self, slab: u32) -> impl Iterator<Item = usize> {
        let places = &self.places[self.places(slab)];
        places.iter().map(|place| place.ray as usize)
    }

    /// Shows the rays that end in a slab in the raster.
    pub(super) fn show(&mut self, slab: u32) {
        for place in &self.places[self.places(slab)] {
            self.raster
                .set(usize::from(place.col), usize::from(place.row));
        }
    }

    /// Lists the rays that end in a slab: they are asked from now on.
    pub(super) fn list(&mut self, slab: u32) {
        let blocks = self.grain.size[1].div_ceil(BLOCK);
        for place in &self.places[self.places(slab)] {
            let (col, row) = (usize::from(place.col), usize::from(place.row));
            let head = &mut self.heads[col / BLOCK * blocks + row / BLOCK];
            self.links[place.ray as usize] = Place {
                ray: *head,
                ..*place
            };
            *head = place.ray;
        }
    }

    /// Whether it holds for a ray that is listed, of those in some columns and rows.
    pub(super) fn any(
        &self,
        cols: &Range<usize>,
        rows: &Range<usize>,
        mut holds: impl FnMut(usize) -> bool,
    ) -> bool {
        let along = self.grain.size[1].div_ceil(BLOCK);
        let blocks = |bins: &Range<usize>| bins.start / BLOCK..bins.end.div_ceil(BLOCK);
        let mut in_block = |head: u32| {
            let mut ray = head;
            while ray != NONE {
                let place = self.links[ray as usize];
                let here = cols.contains(&place.col.into()) && rows.contains(&place.row.into());
                if here && holds(ray as usize) {
                    return true;
                }
                ray = place.ray;
            }
            false
        };
        let rows = blocks(rows);
        blocks(cols).any(|col| {
            let heads = &self.heads[col * along..][rows.clone()];
            heads.iter().any(|&head| in_block(head))
        })
    }

    /// Forgets all rays.
    pub(super) fn clear(&mut self) {
        self.beams.clear();
        self.places.clear();
        self.starts.clear();
        self.raster.clear();
        self.heads.clear();
        self.links.clear();
        self.grain = Grain::default();
    }
}

impl Grain {
    fn of(beams: &[FanBeam]) -> Self {
        let mut low = [f32::INFINITY; 2];
        let mut high = [f32::NEG_INFINITY; 2];
        for FanBeam { slopes, .. } in beams {
            for way in 0..2 {
                low[way] = if slopes[way] < low[way] {
                    slopes[way]
                } else {
                    low[way]
                };
                high[way] = if slopes[way] > high[way] {
                    slopes[way]
                } else {
                    high[way]
                };
            }
        }
        let span: [f32; 2] = std::array::from_fn(|way| high[way] - low[way]);
        let area = (span[0] * span[1]).max(1e-6);
        let most = |limit: usize, way: usize| (limit as f32 - 2.0) / span[way].max(1e-3);
        let even = (BINS * beams.len() as f32 / area).sqrt();
        let per_slope = even.min(most(COLS, 0)).min(most(ROWS, 1)).min(COLS as f32);
        Self {
            lowest: low.map(f64::from),
            per_slope: f64::from(per_slope),
            size: span.map(|span| (span * per_slope) as usize + 1),
        }
    }
}
