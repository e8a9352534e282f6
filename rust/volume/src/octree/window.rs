//! What is known in a part of space, side by side: the bricks, and what is as free as can be.

use super::super::placement::Size;
use super::brick::{EDGE, index};
use super::config::Beam;
use super::key::{Key, child_corner, edge};
use super::nodes::{NodeLink, Nodes};

/// No brick is there.
const NONE: u32 = u32::MAX;

/// A copy of what a frame needs of the tree. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub(super) struct OctreeWindow {
    low: [i32; 3],
    /// Voxels, and bricks, along each axis.
    size: [i32; 3],
    bricks_along: [usize; 3],
    bricks: Vec<u32>,
    /// For each cell one bit a layer: a miss changes nothing.
    pub(super) settled: Vec<u64>,
}

impl OctreeWindow {
    /// Looks at the voxels of a box of so many whole bricks.
    pub(super) fn look(&mut self, nodes: &Nodes, beam: &Beam, low: [i32; 3], size: Size) {
        let Size { cols, rows, layers } = size;
        self.low = low;
        self.size = size.voxels();
        self.bricks_along = [cols / EDGE, rows / EDGE, layers / EDGE];
        self.bricks.clear();
        self.bricks.resize(self.bricks_along.iter().product(), NONE);
        self.settled.clear();
        self.settled.resize(cols * rows, 0);
        self.visit(nodes, beam, nodes.root, [0; 3], 0);
    }

    /// The brick at a place, counted in bricks, if there is one.
    #[inline]
    pub(super) fn brick(&self, place: [usize; 3]) -> Option<u32> {
        let at = self.bricks[self.number(place)];
        (at != NONE).then_some(at)
    }

    fn number(&self, [col, row, layer]: [usize; 3]) -> usize {
        let [cols, _, layers] = self.bricks_along;
        (row * cols + col) * layers + layer
    }

    fn visit(&mut self, nodes: &Nodes, beam: &Beam, link: NodeLink, corner: Key, depth: u32) {
        let edge = edge(depth) as i32;
        let place: [i32; 3] = std::array::from_fn(|axis| i32::from(corner[axis]) - self.low[axis]);
        if (0..3).any(|axis| place[axis] >= self.size[axis] || place[axis] + edge <= 0) {
            return;
        }
        match link {
            NodeLink::Unknown => {}
            NodeLink::Leaf(value) => {
                if value <= beam.lowest {
                    self.settle(place, edge);
                }
            }
            NodeLink::Branch(at) => {
                for (child, &link) in nodes.branch(at).iter().enumerate() {
                    self.visit(
                        nodes,
                        beam,
                        link,
                        child_corner(corner, depth, child),
                        depth + 1,
                    );
                }
            }
            NodeLink::Brick(at) => {
                self.note(at, nodes.brick(at).settled(), place.map(|at| at as usize));
            }
        }
    }

    /// Notes a brick, which lies inside as a whole.
    fn note(&mut self, brick: u32, settled: u64, [x, y, z]: [usize; 3]) {
        let number = self.number([x / EDGE, y / EDGE, z / EDGE]);
        self.bricks[number] = brick;
        for row in 0..EDGE {
            for col in 0..EDGE {
                let cell = (y + row) * self.size[0] as usize + x + col;
                self.settled[cell] |= (settled >> index(col, row, 0) & 0xf) << z;
            }
        }
    }

    /// Notes that a cube, which may reach beyond, is as free as can be.
    fn settle(&mut self, place: [i32; 3], edge: i32) {
        let inside = |axis: usize| {
            let end = (place[axis] + edge).min(self.size[axis]);
            place[axis].max(0) as usize..end as usize
        };
        let layers = inside(2);
        let mask = (u64::MAX >> (64 - layers.len())) << layers.start;
        for row in inside(1) {
            for cell in inside(0) {
                self.settled[row * self.size[0] as usize + cell] |= mask;
            }
        }
    }
}
