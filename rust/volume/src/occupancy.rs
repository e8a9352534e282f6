//! The voxel occupancy grid: equations (1), (3), (4), (6) and (10) of 000.

use geometry::{Cell, CellArea, Lattice, runs};

use super::marks::Marks;
use super::picture::{Picture, PictureSight};
use super::placement::{Placement, Ray, Size};
use super::projected::Looks;
use super::ray::RayPart;
use super::voxels::{Voxels, bits};
use super::{ProbabilityTable, VoxelWalk};
use crate::{Clearing, Update};

/// Probabilities of occupancy over the robot's surroundings.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyGrid {
    size: Size,
    /// Where the voxels lie.
    pub placement: Placement,
    voxels: Voxels,
    marks: Marks,
}

impl OccupancyGrid {
    /// A grid of which nothing is known: 0.5 everywhere, equation (4).
    pub fn new(size: Size, placement: Placement, table: ProbabilityTable) -> Self {
        Self {
            voxels: Voxels::new(size, table),
            marks: Marks::new(size),
            size,
            placement,
        }
    }

    /// Lines of sight that are looked at along columns, and as many along rows, where nobody says another number: of what is likely
    /// to be occupied.
    pub const LOOKS: usize = Looks::USUAL.likely;
    /// Lines of sight that are looked at along columns, and as many along rows, of what is not likely to be occupied.
    pub const LOOKS_AT_OTHERS: usize = Looks::USUAL.others;

    /// Looks at so many lines of sight along columns, and as many along rows, of a voxel past whose middle none goes, before it counts
    /// as not passed ([`Clearing::Projected`]): where it is `likely` to be occupied, and at `others`.
    #[must_use]
    pub const fn with_looks(mut self, likely: usize, others: usize) -> Self {
        self.marks.looks = Looks { likely, others };
        self
    }

    /// Equation (1): probability that the place is occupied; 0.5 outside the grid, equation (4).
    pub fn probability(&self, point_m: [f64; 3]) -> f64 {
        self.voxel_at(point_m)
            .map_or(0.5, |(cell, layer)| self.voxels.probability(cell, layer))
    }

    /// Inequality (7): whether the probability at a place exceeds `p_occ`.
    pub fn is_occupied(&self, [x_m, y_m, z_m]: [f64; 3]) -> bool {
        self.is_occupied_at(self.placement.lattice.cell_at(x_m, y_m), z_m)
    }

    /// Whether the probability at a height of a cell of the grid exceeds `p_occ`.
    pub fn is_occupied_at(&self, cell: Cell, height_m: f64) -> bool {
        self.voxel_of(cell, height_m)
            .is_some_and(|(cell, layer)| self.voxels.occupied(cell) >> layer & 1 == 1)
    }

    /// Whether a layer is occupied in the cell that is stored at an index, row by row.
    #[inline]
    pub fn holds(&self, index: usize, layer: usize) -> bool {
        self.voxels.occupied(index) >> layer & 1 == 1
    }

    /// Equation (10) for the cell that is stored at an index, row by row.
    #[inline]
    pub fn obstacle_height_at(&self, index: usize) -> Option<f64> {
        let layer = self.voxels.occupied(index).checked_ilog2();
        layer.map(|layer| self.center_m(layer as usize))
    }

    /// Height of the centre of the lowest occupied voxel of a cell whose centre lies above a height, m.
    pub fn lowest_above_m(&self, cell: Cell, height_m: f64) -> Option<f64> {
        let mask = self.voxels.occupied(self.cell_index(cell)?);
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
        clearing: Clearing,
    ) -> CellArea {
        let placement = self.placement;
        let eye = placement.in_voxels(eye_m);
        let rays = rays.map(|ray| (placement.in_voxels(ray.end_m), ray.hit));
        match update {
            Update::PerFrame => {
                let area = self.marks.mark(eye, rays, clearing, self.voxels.settled());
                self.apply_marks(area);
                area
            }
            Update::PerPoint => self.apply_rays(eye, rays),
        }
    }

    /// Takes in rays that are a picture's, each with the number of its pixel, row by row; no pixel has two.
    pub fn insert_picture(
        &mut self,
        eye_m: [f64; 3],
        picture: &Picture,
        rays: impl Iterator<Item = (usize, Ray)>,
        update: Update,
        clearing: Clearing,
    ) -> CellArea {
        if update == Update::PerPoint || clearing != Clearing::Projected {
            return self.insert(eye_m, rays.map(|(_, ray)| ray), update, clearing);
        }
        let placement = self.placement;
        let sight = PictureSight::new(picture, eye_m, &placement);
        let area = self.marks.look(&sight, &placement, rays, &self.voxels);
        self.apply_marks(area);
        area
    }

    /// Moves the window by whole voxels: what was at (c + cols, r + rows, l + layers) is now at (c, r, l).
    pub fn shift(&mut self, cols: i32, rows: i32, layers: i32) {
        if cols != 0 || rows != 0 {
            self.voxels.shift(cols, rows);
            let cell_m = self.placement.lattice.cell_m;
            self.placement.lattice.origin_m[0] += f64::from(cols) * cell_m;
            self.placement.lattice.origin_m[1] += f64::from(rows) * cell_m;
        }
        if layers != 0 {
            self.voxels.shift_layers(layers);
            self.placement.bottom_m += f64::from(layers) * self.placement.layer_m;
        }
    }

    /// Sets where the voxels lie, after [`Self::shift`] moved their content: exact, not summed up.
    pub fn place(&mut self, lattice: Lattice, bottom_m: f64) {
        self.placement.lattice = lattice;
        self.placement.bottom_m = bottom_m;
    }

    /// Per frame: each voxel once, a hit wins over rays that passed. A ray's own end is hit, or, when nothing was seen
    /// there, passed.
    fn apply_marks(&mut self, area: CellArea) {
        for index in runs(area, [self.size.cols, self.size.rows]).flatten() {
            let [hits, passed] = self.marks.take(index);
            if hits | passed == 0 {
                continue;
            }
            self.voxels.hit(index, hits);
            self.voxels.miss(index, passed);
        }
    }

    /// Per point, as the paper writes: every ray at once.
    fn apply_rays(
        &mut self,
        eye: [f64; 3],
        rays: impl Iterator<Item = ([f64; 3], bool)>,
    ) -> CellArea {
        let size = self.size.voxels();
        let mut area = CellArea::EMPTY;
        for (end, hit) in rays {
            let Some(part) = RayPart::inside(eye, end, size) else {
                continue;
            };
            part.add_to(&mut area);
            if let Some(walk) = VoxelWalk::new(eye, end, size) {
                self.apply_ray(walk, hit && part.ends_inside);
            }
        }
        area
    }

    /// Per point: every voxel of a ray.
    fn apply_ray(&mut self, walk: VoxelWalk, hit: bool) {
        let last = walk.last;
        for voxel in walk {
            let [x, y, z] = voxel.map(|v| v as usize);
            let cell = y * self.size.cols + x;
            if hit && voxel == last {
                self.voxels.hit(cell, 1 << z);
            } else {
                self.voxels.miss(cell, 1 << z);
            }
        }
    }

    fn cell_index(&self, cell: Cell) -> Option<usize> {
        let (col, row) = (
            usize::try_from(cell.col).ok()?,
            usize::try_from(cell.row).ok()?,
        );
        (col < self.size.cols && row < self.size.rows).then(|| row * self.size.cols + col)
    }

    fn voxel_at(&self, [x_m, y_m, z_m]: [f64; 3]) -> Option<(usize, usize)> {
        self.voxel_of(self.placement.lattice.cell_at(x_m, y_m), z_m)
    }

    fn voxel_of(&self, cell: Cell, height_m: f64) -> Option<(usize, usize)> {
        Some((self.cell_index(cell)?, self.layer_at(height_m)?))
    }

    /// The layer of a height; none above and below the grid.
    pub fn layer_at(&self, height_m: f64) -> Option<usize> {
        let layer = (height_m - self.placement.bottom_m) / self.placement.layer_m;
        let inside = layer >= 0.0 && layer < self.size.layers as f64;
        inside.then_some(layer as usize)
    }
}
