//! What is occupied in a part of space, seen from above: for each cell one bit a layer.

use super::Octree;
use super::brick::{EDGE, index};
use super::config::log_odds;
use super::key::{Key, child_corner, edge};
use super::nodes::NodeLink;

/// Layers that a column holds.
pub const LAYERS: i32 = u64::BITS as i32;

/// Where columns lie: cells of `per_cell` voxels along each side, of which the lowest voxel of the first is `low`.
#[derive(Debug, Clone, Copy)]
pub struct ColumnFootprint {
    /// Counted from the lowest voxel that a tree can hold.
    pub low: [i32; 3],
    /// Cells along x and y.
    pub cells: [usize; 2],
    /// Voxels along a side of a cell.
    pub per_cell: usize,
}

impl ColumnFootprint {
    /// Columns, rows and layers, in voxels.
    fn size(&self) -> [i32; 3] {
        let [cols, rows] = self.cells.map(|cells| (cells * self.per_cell) as i32);
        [cols, rows, LAYERS]
    }
}

/// Marks occupied voxels of a tree; calls `mark(col, row, layers)` for columns of voxels.
struct Visit<'a, F> {
    tree: &'a Octree,
    /// From these log-odds on something counts as occupied; not negative.
    least: f32,
    low: [i32; 3],
    size: [i32; 3],
    mark: F,
}

impl Octree {
    /// Calls `mark(col, row, layers)` with the cell of every column of voxels in which something is at least as likely as `p_occ`,
    /// which is 0.5 or more; a cell of several columns is marked by each.
    pub fn occupied_columns(
        &self,
        footprint: &ColumnFootprint,
        p_occ: f64,
        mut mark: impl FnMut(usize, usize, u64),
    ) {
        let per_cell = footprint.per_cell;
        let mut visit = Visit {
            tree: self,
            least: log_odds(p_occ),
            low: footprint.low,
            size: footprint.size(),
            mark: |col: i32, row: i32, layers: u64| {
                mark(col as usize / per_cell, row as usize / per_cell, layers);
            },
        };
        visit.link(self.nodes.root, [0; 3], 0);
    }
}

impl<F: FnMut(i32, i32, u64)> Visit<'_, F> {
    fn link(&mut self, link: NodeLink, corner: Key, depth: u32) {
        let edge = edge(depth) as i32;
        let place: [i32; 3] = std::array::from_fn(|axis| i32::from(corner[axis]) - self.low[axis]);
        if (0..3).any(|axis| place[axis] >= self.size[axis] || place[axis] + edge <= 0) {
            return;
        }
        match link {
            NodeLink::Unknown => {}
            NodeLink::Leaf(value) => {
                if value >= self.least {
                    self.cube(place, edge);
                }
            }
            NodeLink::Branch(at) => {
                let tree = self.tree;
                for (child, &link) in tree.nodes.branch(at).iter().enumerate() {
                    self.link(link, child_corner(corner, depth, child), depth + 1);
                }
            }
            NodeLink::Brick(at) => {
                let occupied = self.tree.nodes.brick(at).at_least(self.least);
                self.brick(occupied, place);
            }
        }
    }

    fn cube(&mut self, place: [i32; 3], edge: i32) {
        let inside = |axis: usize| place[axis].max(0)..(place[axis] + edge).min(self.size[axis]);
        let layers = inside(2);
        let mask = (u64::MAX >> (LAYERS - (layers.end - layers.start))) << layers.start;
        for row in inside(1) {
            for col in inside(0) {
                (self.mark)(col, row, mask);
            }
        }
    }

    fn brick(&mut self, occupied: u64, [x, y, z]: [i32; 3]) {
        if occupied == 0 {
            return;
        }
        for at in 0..EDGE * EDGE {
            let (col, row) = (x + (at % EDGE) as i32, y + (at / EDGE) as i32);
            let layers = occupied >> index(at % EDGE, at / EDGE, 0) & 0xf;
            let layers = if z < 0 { layers >> -z } else { layers << z };
            let inside = (0..self.size[0]).contains(&col) && (0..self.size[1]).contains(&row);
            if layers != 0 && inside {
                (self.mark)(col, row, layers);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::super::super::Ray;
    use super::super::OctreeConfig;
    use super::*;
    use crate::Update;

    fn point() -> impl Strategy<Value = [f64; 3]> {
        (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y, z)| [x, y, z])
    }

    proptest! {
        #[test]
        fn columns_hold_the_occupied_voxels_of_their_cells(
            ends in proptest::collection::vec(point(), 1..40),
            low in prop::array::uniform3(-30..10_i32),
            per_cell in 1..4_usize,
            p_occ in prop::sample::select(vec![0.5, 0.7, 0.8]),
        ) {
            let mut tree = Octree::new(OctreeConfig { resolution: 0.05, ..OctreeConfig::default() }).unwrap();
            let rays: Vec<_> = ends.iter().map(|&end_m| Ray { end_m, hit: true }).collect();
            let _beyond = tree.insert([0.0; 3], &rays, Update::PerFrame).unwrap();
            // Part of it is seen twice.
            let _beyond = tree.insert([0.0; 3], &rays[..rays.len() / 2], Update::PerFrame).unwrap();
            let low = low.map(|at| at + 32768);
            let footprint = ColumnFootprint { low, cells: [9, 7], per_cell };
            let mut found = BTreeSet::new();
            tree.occupied_columns(&footprint, p_occ, |col, row, layers| {
                let layers = (0..64_usize).filter(|layer| layers >> layer & 1 == 1);
                found.extend(layers.map(|layer| (col, row, layer)));
            });
            let mut expected = BTreeSet::new();
            for x in 0..9 * per_cell { for y in 0..7 * per_cell { for z in 0..64 {
                let place = [x, y, z];
                let key: Key = std::array::from_fn(|axis| (place[axis] as i32 + low[axis]) as u16);
                if tree.log_odds(key).is_some_and(|value| value >= log_odds(p_occ)) {
                    let _ = expected.insert((x / per_cell, y / per_cell, z));
                }
            }}}
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn a_large_leaf_is_marked_as_far_as_it_lies_inside() {
        let config = OctreeConfig::default();
        let mut tree = Octree::new(config).unwrap();
        let beam = tree.beam;
        tree.nodes.set_leaf([32768; 3], 12, beam.highest, &beam);
        let footprint = ColumnFootprint {
            low: [32764, 32766, 32760],
            cells: [8, 8],
            per_cell: 2,
        };
        let mut cells = BTreeSet::new();
        tree.occupied_columns(&footprint, 0.5, |col, row, layers| {
            assert_eq!(layers, 0xffff << 8);
            let _ = cells.insert((col, row));
        });
        assert_eq!(cells.len(), 6 * 7);
        assert_eq!(cells.first(), Some(&(2, 1)));
    }
}
