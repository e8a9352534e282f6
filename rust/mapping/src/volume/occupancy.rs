//! The voxel occupancy grid: equations (1), (3), (4), (6) and (10) of 000.

use geometry::{Cell, CellArea, Lattice};

use super::columns::for_each_column;
use super::ray::Part;
use super::{ProbabilityTable, VoxelWalk};
use crate::surface::Update;

/// Number of voxels along each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Along x.
    pub cols: usize,
    /// Along y.
    pub rows: usize,
    /// Along z, at most 64.
    pub layers: usize,
}

/// Where the voxels lie in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// The cells seen from above.
    pub lattice: Lattice,
    /// Lower bound of layer 0, m.
    pub bottom_m: f64,
    /// Height of a layer, m.
    pub layer_m: f64,
}

impl Placement {
    /// A point of the map frame in voxels.
    fn in_voxels(&self, point_m: [f64; 3]) -> [f64; 3] {
        let Lattice { origin_m, cell_m } = self.lattice;
        [
            (point_m[0] - origin_m[0]) / cell_m,
            (point_m[1] - origin_m[1]) / cell_m,
            (point_m[2] - self.bottom_m) / self.layer_m,
        ]
    }
}

/// One line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Its end in the map frame, m.
    pub end_m: [f64; 3],
    /// Whether something was seen at its end; false: it was only seen to be free up to there.
    pub hit: bool,
}

/// Probabilities of occupancy over the robot's surroundings.
///
/// The layers of a cell lie side by side in storage: a line of sight that looks down stays within a cache line for long,
/// and the highest occupied layer is one instruction on the cell's mask.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyGrid {
    size: Size,
    placement: Placement,
    table: ProbabilityTable,
    codes: Vec<u8>,
    /// One bit a layer: whether its probability exceeds `p_occ`.
    occupied: Vec<u64>,
    /// One bit a layer: hit, or passed, by a ray of the frame that is being inserted. Zero between frames.
    hits: Vec<u64>,
    passed: Vec<u64>,
}

impl OccupancyGrid {
    /// A grid of which nothing is known: 0.5 everywhere, equation (4).
    pub fn new(size: Size, placement: Placement, table: ProbabilityTable) -> Self {
        let cells = size.cols * size.rows;
        Self {
            codes: vec![table.unknown(); cells * size.layers],
            occupied: vec![0; cells],
            hits: vec![0; cells],
            passed: vec![0; cells],
            size,
            placement,
            table,
        }
    }

    /// Where the voxels lie.
    pub const fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Equation (1): probability that the place is occupied; 0.5 outside the grid, equation (4).
    pub fn probability(&self, point_m: [f64; 3]) -> f64 {
        self.voxel_at(point_m).map_or(0.5, |(cell, layer)| {
            self.table
                .decode(self.codes[cell * self.size.layers + layer])
        })
    }

    /// Inequality (7): whether the probability at a place exceeds `p_occ`.
    pub fn is_occupied(&self, point_m: [f64; 3]) -> bool {
        self.voxel_at(point_m)
            .is_some_and(|(cell, layer)| self.occupied[cell] >> layer & 1 == 1)
    }

    /// Equation (10): height of the centre of the highest occupied voxel of a cell, m; `None` is *invalid*.
    pub fn obstacle_height_m(&self, cell: Cell) -> Option<f64> {
        let mask = self.occupied[self.cell_index(cell)?];
        mask.checked_ilog2()
            .map(|layer| self.center_m(layer as usize))
    }

    /// The other way round: height of the centre of the lowest occupied voxel of a cell whose centre lies above a height, m.
    pub fn lowest_above_m(&self, cell: Cell, height_m: f64) -> Option<f64> {
        let mask = self.occupied[self.cell_index(cell)?];
        bits(mask)
            .map(|layer| self.center_m(layer))
            .find(|&center_m| center_m > height_m)
    }

    /// Height of the centre of a layer, m.
    fn center_m(&self, layer: usize) -> f64 {
        self.placement.bottom_m + (layer as f64 + 0.5) * self.placement.layer_m
    }

    /// Takes in the rays of one frame, all from `eye_m`, and says which cells they touched (the affected area).
    pub fn insert(
        &mut self,
        eye_m: [f64; 3],
        rays: impl Iterator<Item = Ray>,
        update: Update,
    ) -> CellArea {
        let eye = self.placement.in_voxels(eye_m);
        let size = [self.size.cols, self.size.rows, self.size.layers].map(|n| n as i32);
        let mut area = CellArea::EMPTY;
        for ray in rays {
            let end = self.placement.in_voxels(ray.end_m);
            let Some(part) = Part::inside(eye, end, size) else {
                continue;
            };
            area.include(Cell::new(part.first[0], part.first[1]));
            area.include(Cell::new(part.last[0], part.last[1]));
            let hit = ray.hit && part.ends_inside;
            match update {
                Update::PerFrame => self.mark(&part, hit),
                Update::PerPoint => {
                    if let Some(walk) = VoxelWalk::new(eye, end, size) {
                        self.apply_ray(walk, hit);
                    }
                }
            }
        }
        if update == Update::PerFrame {
            self.apply_marks(area);
        }
        area
    }

    /// Moves the window by whole voxels: what was at (c + cols, r + rows, l + layers) is now at (c, r, l).
    pub fn shift(&mut self, cols: i32, rows: i32, layers: i32) {
        let unknown = self.table.unknown();
        let (width, height) = (self.size.cols as i32, self.size.rows as i32);
        let depth = self.size.layers;
        if cols != 0 || rows != 0 {
            // Walk in the direction in which a source is read before it is overwritten.
            let row_at = |i: i32| if rows >= 0 { i } else { height - 1 - i };
            let col_at = |i: i32| if cols >= 0 { i } else { width - 1 - i };
            for (row, col) in (0..height).flat_map(|r| (0..width).map(move |c| (r, c))) {
                let cell = Cell::new(col_at(col), row_at(row));
                let source = Cell::new(cell.col + cols, cell.row + rows);
                let Some(to) = self.cell_index(cell) else {
                    continue;
                };
                if let Some(from) = self.cell_index(source) {
                    self.codes
                        .copy_within(from * depth..(from + 1) * depth, to * depth);
                    self.occupied[to] = self.occupied[from];
                } else {
                    self.codes[to * depth..(to + 1) * depth].fill(unknown);
                    self.occupied[to] = 0;
                }
            }
            let cell_m = self.placement.lattice.cell_m;
            self.placement.lattice.origin_m[0] += f64::from(cols) * cell_m;
            self.placement.lattice.origin_m[1] += f64::from(rows) * cell_m;
        }
        if layers != 0 {
            self.shift_layers(layers);
        }
    }

    /// Sets where the voxels lie, after [`Self::shift`] moved their content: exact, not summed up.
    pub fn place(&mut self, lattice: Lattice, bottom_m: f64) {
        self.placement.lattice = lattice;
        self.placement.bottom_m = bottom_m;
    }

    fn shift_layers(&mut self, layers: i32) {
        let (depth, unknown) = (self.size.layers, self.table.unknown());
        let kept = depth.saturating_sub(layers.unsigned_abs() as usize);
        let all = u64::MAX >> (64 - depth);
        for (column, mask) in self.codes.chunks_exact_mut(depth).zip(&mut self.occupied) {
            if layers > 0 {
                column.copy_within(depth - kept.., 0);
                column[kept..].fill(unknown);
                *mask = mask.checked_shr(layers.unsigned_abs()).unwrap_or(0);
            } else {
                column.copy_within(..kept, depth - kept);
                column[..depth - kept].fill(unknown);
                *mask = mask.checked_shl(layers.unsigned_abs()).unwrap_or(0) & all;
            }
        }
        self.placement.bottom_m += f64::from(layers) * self.placement.layer_m;
    }

    /// Per frame: remembers what the ray passed and hit.
    fn mark(&mut self, part: &Part, hit: bool) {
        let (cols, passed) = (self.size.cols, &mut self.passed);
        let Part {
            from,
            to,
            first,
            last,
            ..
        } = *part;
        for_each_column(from, to, first, last, cols, |cell, layers| {
            passed[cell] |= layers;
        });
        if hit {
            let cell = last[1] as usize * cols + last[0] as usize;
            self.hits[cell] |= 1 << last[2];
        }
    }

    /// Per frame: each voxel once, a hit wins over rays that passed. A ray's own end is hit, or, when nothing was seen
    /// there, passed.
    fn apply_marks(&mut self, area: CellArea) {
        for cell in area.cells() {
            let Some(index) = self.cell_index(cell) else {
                continue;
            };
            let hits = std::mem::take(&mut self.hits[index]);
            let passed = std::mem::take(&mut self.passed[index]) & !hits;
            let column = &mut self.codes[index * self.size.layers..][..self.size.layers];
            let mut mask = self.occupied[index];
            for layer in bits(hits) {
                column[layer] = self.table.after_hit(column[layer]);
                mask |= u64::from(self.table.is_occupied(column[layer])) << layer;
            }
            for layer in bits(passed) {
                column[layer] = self.table.after_miss(column[layer]);
                mask &= !(u64::from(!self.table.is_occupied(column[layer])) << layer);
            }
            self.occupied[index] = mask;
        }
    }

    /// Per point, as the paper writes: every voxel of every ray, at once.
    fn apply_ray(&mut self, walk: VoxelWalk, hit: bool) {
        let last = walk.last;
        for voxel in walk {
            let [x, y, z] = voxel.map(|v| v as usize);
            let cell = y * self.size.cols + x;
            let code = &mut self.codes[cell * self.size.layers + z];
            *code = if hit && voxel == last {
                self.table.after_hit(*code)
            } else {
                self.table.after_miss(*code)
            };
            let bit = 1_u64 << z;
            let set = u64::from(self.table.is_occupied(*code)) << z;
            self.occupied[cell] = self.occupied[cell] & !bit | set;
        }
    }

    fn cell_index(&self, cell: Cell) -> Option<usize> {
        let (col, row) = (
            usize::try_from(cell.col).ok()?,
            usize::try_from(cell.row).ok()?,
        );
        (col < self.size.cols && row < self.size.rows).then(|| row * self.size.cols + col)
    }

    fn voxel_at(&self, point_m: [f64; 3]) -> Option<(usize, usize)> {
        let [x, y, z] = self.placement.in_voxels(point_m);
        let cell = self.cell_index(Cell::new(x.floor() as i32, y.floor() as i32))?;
        (z >= 0.0 && z < self.size.layers as f64).then_some((cell, z as usize))
    }
}

/// Positions of the set bits.
fn bits(mut mask: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (mask != 0).then(|| mask.trailing_zeros() as usize)?;
        mask &= mask - 1;
        Some(bit)
    })
}
