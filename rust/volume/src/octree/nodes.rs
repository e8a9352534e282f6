//! The tree itself: what is uniform is one leaf, what is not known is absent, and the lowest levels are bricks.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::brick::{Brick, EDGE, cube, index};
use super::config::Beam;
use super::key::{Key, child_of};

/// Depth of the nodes that are bricks.
pub(super) const BRICK_DEPTH: u32 = 14;

/// What is below a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum NodeLink {
    /// Nothing is known.
    #[default]
    Unknown,
    /// A leaf: its log-odds hold everywhere in it.
    Leaf(f32),
    /// Eight children.
    Branch(u32),
    /// Voxels.
    Brick(u32),
}

/// Where a link is stored: a child of a branch, or the root.
#[derive(Debug, Clone, Copy)]
struct Slot {
    branch: Option<u32>,
    child: usize,
}

/// Always pruned: no branch has eight equal leaves, no brick is uniform or unknown. A clone shares branches and bricks with what it was made
/// from, each until one of both writes into it.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes {
    pub(super) root: NodeLink,
    branches: Vec<Arc<[NodeLink; 8]>>,
    bricks: Vec<Arc<Brick>>,
    free_branches: Vec<u32>,
    free_bricks: Vec<u32>,
}

impl Nodes {
    #[inline]
    pub(super) fn branch(&self, at: u32) -> &[NodeLink; 8] {
        &self.branches[at as usize]
    }

    #[inline]
    pub(super) fn brick(&self, at: u32) -> &Brick {
        &self.bricks[at as usize]
    }

    #[inline]
    pub(super) fn brick_mut(&mut self, at: u32) -> &mut Brick {
        Arc::make_mut(&mut self.bricks[at as usize])
    }

    /// What is known of a voxel.
    pub(super) fn value(&self, key: Key) -> Option<f32> {
        let mut link = self.root;
        for depth in 0..=BRICK_DEPTH {
            match link {
                NodeLink::Unknown => return None,
                NodeLink::Leaf(value) => return Some(value),
                NodeLink::Branch(at) => link = self.branch(at)[child_of(key, depth)],
                NodeLink::Brick(at) => return self.brick(at).value(voxel_in_brick(key)),
            }
        }
        None
    }

    /// Bytes that the tree takes.
    pub(super) fn bytes(&self) -> usize {
        let branches = self.branches.len() - self.free_branches.len();
        let bricks = self.bricks.len() - self.free_bricks.len();
        branches * size_of::<[NodeLink; 8]>() + bricks * size_of::<Brick>()
    }

    /// Adds where its branches and bricks lie to `places`; bytes of those that were not in it yet, and of the lists that find them.
    pub(super) fn own_bytes(&self, places: &mut BTreeSet<usize>) -> usize {
        // Beside what is shared stand two counts of those that share it.
        const COUNTS: usize = 2 * size_of::<usize>();
        let lists = (self.branches.capacity() + self.bricks.capacity()) * size_of::<usize>()
            + (self.free_branches.capacity() + self.free_bricks.capacity()) * size_of::<u32>();
        let mut own = |place: usize, bytes: usize| {
            if places.insert(place) {
                bytes + COUNTS
            } else {
                0
            }
        };
        let branches = self.branches.iter();
        let branches: usize = branches
            .map(|one| own(Arc::as_ptr(one).addr(), size_of::<[NodeLink; 8]>()))
            .sum();
        let bricks = self.bricks.iter();
        let bricks: usize = bricks
            .map(|one| own(Arc::as_ptr(one).addr(), size_of::<Brick>()))
            .sum();
        lists + branches + bricks
    }

    /// The brick of a voxel, made of what is known there. It has to be [`Self::prune`]d when its voxels have been changed.
    pub(super) fn expand(&mut self, key: Key, beam: &Beam) -> u32 {
        let slot = self.descend(key, BRICK_DEPTH);
        let known = match self.link(slot) {
            NodeLink::Brick(at) => return at,
            NodeLink::Leaf(value) => Some(value),
            NodeLink::Unknown | NodeLink::Branch(_) => None,
        };
        let mut brick = Brick::unknown();
        if let Some(value) = known {
            brick.fill(u64::MAX, value, beam);
        }
        let at = store(&mut self.bricks, &mut self.free_bricks, brick);
        self.set(slot, NodeLink::Brick(at));
        at
    }

    /// Gives all voxels of a node the same value; the node holds no branch or brick yet, or is a part of a brick.
    pub(super) fn set_leaf(&mut self, corner: Key, depth: u32, value: f32, beam: &Beam) {
        if depth <= BRICK_DEPTH {
            let slot = self.descend(corner, depth);
            self.set(slot, NodeLink::Leaf(value));
        } else {
            let at = self.expand(corner, beam);
            let place = corner.map(|at| usize::from(at) % EDGE);
            let edge = EDGE >> (depth - BRICK_DEPTH);
            self.brick_mut(at).fill(cube(place, edge), value, beam);
        }
    }

    /// Makes one leaf of every node above a brick, and of the brick, that has become uniform.
    pub(super) fn prune(&mut self, key: Key) {
        let mut path = [Slot {
            branch: None,
            child: 0,
        }; BRICK_DEPTH as usize + 1];
        let mut depth = 0;
        while let NodeLink::Branch(branch) = self.link(path[depth]) {
            let child = child_of(key, depth as u32);
            depth += 1;
            path[depth] = Slot {
                branch: Some(branch),
                child,
            };
        }
        for slot in path[..=depth].iter().rev() {
            let Some(value) = self.uniform(self.link(*slot)) else {
                return;
            };
            match self.link(*slot) {
                NodeLink::Brick(at) => self.free_bricks.push(at),
                NodeLink::Branch(at) => self.free_branches.push(at),
                NodeLink::Leaf(_) | NodeLink::Unknown => {}
            }
            self.set(*slot, NodeLink::Leaf(value));
        }
    }

    /// The value of all voxels below a link whose children are pruned, if it is the same.
    fn uniform(&self, link: NodeLink) -> Option<f32> {
        match link {
            NodeLink::Unknown => None,
            NodeLink::Leaf(value) => Some(value),
            NodeLink::Brick(at) => self.brick(at).common(u64::MAX),
            NodeLink::Branch(at) => {
                let children = self.branch(at);
                let NodeLink::Leaf(first) = children[0] else {
                    return None;
                };
                let same = |link: &NodeLink| matches!(link, NodeLink::Leaf(value) if value.to_bits() == first.to_bits());
                children.iter().all(same).then_some(first)
            }
        }
    }

    /// Where the node of a depth above a voxel is stored. Leaves on the way get children of the same value.
    fn descend(&mut self, key: Key, depth: u32) -> Slot {
        let mut slot = Slot {
            branch: None,
            child: 0,
        };
        for level in 0..depth {
            let branch = match self.link(slot) {
                NodeLink::Branch(branch) => branch,
                other => {
                    let branch = store(&mut self.branches, &mut self.free_branches, [other; 8]);
                    self.set(slot, NodeLink::Branch(branch));
                    branch
                }
            };
            slot = Slot {
                branch: Some(branch),
                child: child_of(key, level),
            };
        }
        slot
    }

    #[inline]
    fn link(&self, slot: Slot) -> NodeLink {
        slot.branch
            .map_or(self.root, |at| self.branch(at)[slot.child])
    }

    fn set(&mut self, slot: Slot, link: NodeLink) {
        match slot.branch {
            Some(at) => Arc::make_mut(&mut self.branches[at as usize])[slot.child] = link,
            None => self.root = link,
        }
    }
}

/// Which voxel of its brick a voxel is.
#[inline]
pub(super) fn voxel_in_brick(key: Key) -> usize {
    let [x, y, z] = key.map(|at| usize::from(at) % EDGE);
    index(x, y, z)
}

/// Stores something where something was given back, or behind all.
fn store<T>(all: &mut Vec<Arc<T>>, free: &mut Vec<u32>, item: T) -> u32 {
    let item = Arc::new(item);
    if let Some(at) = free.pop() {
        all[at as usize] = item;
        return at;
    }
    all.push(item);
    all.len() as u32 - 1
}
