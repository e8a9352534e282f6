//! What the local map has somewhere: what several frames saw, and what one frame saw that is large.
//!
//! A small thing that one frame saw may be noise; who steps in the way is not.

use geometry::CellArea;
use volume::octree::{LayerColumns, Octree, ViewLayers};

/// Probability of a voxel that is as likely occupied as not: nothing is known against it.
const EVEN: f64 = 0.5;

/// For each cell the layers in which something stands, one bit each.
#[derive(Debug, Clone, Default)]
pub(super) struct LocalColumns {
    sure: LayerColumns,
    likely: LayerColumns,
    /// Cells along x.
    cols: usize,
}

impl LocalColumns {
    /// How far a cell's neighbours reach that have a say in what it holds: the eight around it.
    pub(super) const REACH: i32 = 1;

    /// Reads the cells of an area anew: sure is what is as likely as `p_occ`.
    pub(super) fn read(
        &mut self,
        (tree, p_occ): (&Octree, f64),
        layers: &ViewLayers,
        area: CellArea,
    ) {
        self.cols = layers.size()[0];
        self.sure.read((tree, p_occ), layers, area);
        self.likely.read((tree, EVEN), layers, area);
    }

    /// What stands in the cell that is stored at an index. What is only likely counts where there are so many voxels of it in the
    /// cell and those around.
    pub(super) fn at(&self, index: usize, large: u32) -> u64 {
        let sure = self.sure.at(index);
        let likely = self.likely.at(index);
        if likely == sure || self.around(index) < large {
            sure
        } else {
            likely
        }
    }

    /// Likely voxels in a cell and the eight around it.
    fn around(&self, index: usize) -> u32 {
        let (col, row) = (index % self.cols, index / self.cols);
        (row.saturating_sub(1)..=row + 1)
            .flat_map(|row| {
                let last = (col + 1).min(self.cols - 1);
                (col.saturating_sub(1)..=last).map(move |col| row * self.cols + col)
            })
            .map(|index| self.likely.at(index).count_ones())
            .sum()
    }
}
