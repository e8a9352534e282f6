//! The tree as it is seen from outside: nodes down to single voxels, and the leaves one after the other.

use super::brick::{Brick, EDGE, cube};
use super::key::{DEPTH, Key, child_corner, edge};
use super::nodes::{BRICK_DEPTH, NodeLink, Nodes};

/// A node of which something is known. Parts of bricks are nodes, too.
#[derive(Debug, Clone, Copy)]
pub(super) enum LeafNode<'a> {
    /// A leaf: its log-odds hold everywhere in it.
    Leaf(f32),
    Branch(&'a [NodeLink; 8]),
    /// A cube of voxels of a brick, not all the same.
    Part {
        brick: &'a Brick,
        place: [usize; 3],
        edge: usize,
    },
}

impl Nodes {
    /// The node behind a link.
    #[inline]
    pub(super) fn node(&self, link: NodeLink) -> Option<LeafNode<'_>> {
        match link {
            NodeLink::Unknown => None,
            NodeLink::Leaf(value) => Some(LeafNode::Leaf(value)),
            NodeLink::Branch(at) => Some(LeafNode::Branch(self.branch(at))),
            NodeLink::Brick(at) => part(self.brick(at), [0; 3], EDGE),
        }
    }

    /// A child of a node.
    #[inline]
    pub(super) fn child<'a>(&'a self, node: LeafNode<'a>, child: usize) -> Option<LeafNode<'a>> {
        match node {
            LeafNode::Leaf(_) => None,
            LeafNode::Branch(children) => self.node(children[child]),
            LeafNode::Part { brick, place, edge } => {
                let half = edge / 2;
                let place = std::array::from_fn(|axis| place[axis] + (child >> axis & 1) * half);
                part(brick, place, half)
            }
        }
    }

    /// Nodes, inner ones and leaves, of a pruned octree whose leaves may be single voxels.
    pub(super) fn count(&self) -> usize {
        self.node(self.root)
            .map_or(0, |root| self.count_below(root))
    }

    fn count_below(&self, node: LeafNode<'_>) -> usize {
        let children = (0..8).filter_map(|child| self.child(node, child));
        1 + children.map(|child| self.count_below(child)).sum::<usize>()
    }
}

/// A cube of voxels of a brick.
#[inline]
fn part(brick: &Brick, place: [usize; 3], edge: usize) -> Option<LeafNode<'_>> {
    let voxels = cube(place, edge);
    if brick.known & voxels == 0 {
        return None;
    }
    let whole = LeafNode::Part { brick, place, edge };
    Some(brick.common(voxels).map_or(whole, LeafNode::Leaf))
}

/// The largest cube of the tree around a place in which the same is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leaf {
    /// Lowest voxel of the leaf.
    pub corner: Key,
    /// Levels below the root: 16 for a single voxel.
    pub depth: u32,
    /// How likely it is occupied: occupied from 0 on.
    pub log_odds: f32,
}

impl Leaf {
    /// Voxels along a side.
    pub const fn edge(&self) -> u32 {
        edge(self.depth)
    }

    /// Whether it is rather occupied than not.
    pub fn is_occupied(&self) -> bool {
        self.log_odds >= 0.0
    }
}

/// Iterates over the leaves, in the order of OctoMap's files.
#[derive(Debug, Clone)]
pub struct Leaves<'a> {
    nodes: &'a Nodes,
    /// What is still to be visited, the next one last.
    stack: Vec<(LeafNode<'a>, Key, u32)>,
}

impl<'a> Leaves<'a> {
    pub(super) fn of(nodes: &'a Nodes) -> Self {
        let root = nodes.node(nodes.root).map(|root| (root, [0; 3], 0));
        Self {
            nodes,
            stack: root.into_iter().collect(),
        }
    }
}

impl Iterator for Leaves<'_> {
    type Item = Leaf;

    fn next(&mut self) -> Option<Leaf> {
        while let Some((node, corner, depth)) = self.stack.pop() {
            if let LeafNode::Leaf(log_odds) = node {
                return Some(Leaf {
                    corner,
                    depth,
                    log_odds,
                });
            }
            for child in (0..8).rev() {
                if let Some(below) = self.nodes.child(node, child) {
                    let corner = child_corner(corner, depth, child);
                    self.stack.push((below, corner, depth + 1));
                }
            }
        }
        None
    }
}

const _: () = assert!(EDGE == 1 << (DEPTH - BRICK_DEPTH));
