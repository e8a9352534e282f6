//! Ray casting: the first occupied voxel on a line of sight.

use super::super::VoxelWalk;
use super::Octree;
use super::key::{DEPTH, Key, SPAN, centre_m, child_of, in_voxels, key_at, shared_levels};
use super::nodes::{BRICK_DEPTH, NodeLink, Nodes, voxel_in_brick};

/// What a ray comes upon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cast {
    /// An occupied voxel, by its centre, m.
    Occupied([f64; 3]),
    /// A voxel of which nothing is known, by its centre, m; only where the unknown is not looked through.
    Unknown([f64; 3]),
    /// Neither, within the range and within what a tree can hold.
    Nothing,
}

/// How far and through what a ray is cast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// Voxels whose centre is further away end the ray, m; infinity: none does.
    pub max_range_m: f64,
    /// Whether voxels of which nothing is known are passed.
    pub through_unknown: bool,
}

/// Voxel after voxel near each other: only what differs on the way from the root is looked up.
struct Cursor<'a> {
    nodes: &'a Nodes,
    key: Key,
    /// The links on the way to the voxel, down to where it ends.
    links: [NodeLink; BRICK_DEPTH as usize + 1],
    depth: u32,
}

impl<'a> Cursor<'a> {
    fn new(nodes: &'a Nodes) -> Self {
        let links = [nodes.root; BRICK_DEPTH as usize + 1];
        Self {
            nodes,
            key: [0; 3],
            links,
            depth: 0,
        }
    }

    /// Whether a voxel is occupied, where anything is known of it.
    #[inline]
    fn occupied(&mut self, key: Key) -> Option<bool> {
        self.depth = self.depth.min(shared_levels(key, self.key).min(DEPTH));
        self.key = key;
        loop {
            match self.links[self.depth as usize] {
                NodeLink::Unknown => return None,
                NodeLink::Leaf(value) => return Some(value >= 0.0),
                NodeLink::Brick(at) => {
                    let (brick, voxel) = (self.nodes.brick(at), voxel_in_brick(key));
                    let known = brick.known >> voxel & 1 == 1;
                    return known.then_some(brick.occupied >> voxel & 1 == 1);
                }
                NodeLink::Branch(at) => {
                    let child = child_of(key, self.depth);
                    self.depth += 1;
                    self.links[self.depth as usize] = self.nodes.branch(at)[child];
                }
            }
        }
    }
}

impl Octree {
    /// Follows a ray until a voxel is occupied. The voxel that it starts in counts. A direction of no length, or what is no
    /// number, meets nothing.
    pub fn cast_ray(&self, origin_m: [f64; 3], direction: [f64; 3], sighting: Sighting) -> Cast {
        let Sighting {
            max_range_m,
            through_unknown,
        } = sighting;
        let per_m = self.per_m();
        let from = in_voxels(origin_m, per_m);
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        if key_at(from).is_none() || !(length > 0.0 && length.is_finite()) || max_range_m.is_nan() {
            return Cast::Nothing;
        }
        // A voxel's centre may be nearer than where the ray enters it, by half a diagonal.
        let reach = (max_range_m * per_m + 1.0).min(2.0 * f64::from(SPAN));
        let to = std::array::from_fn(|axis| from[axis] + reach * direction[axis] / length);
        let resolution_m = self.config.resolution;
        let mut cursor = Cursor::new(&self.nodes);
        let walk = VoxelWalk::new(from, to, [SPAN; 3]).into_iter().flatten();
        for (passed, voxel) in walk.enumerate() {
            let key = voxel.map(|at| at as u16);
            let centre = centre_m(key, 1, resolution_m);
            let off = |axis: usize| centre[axis] - origin_m[axis];
            let far = off(0) * off(0) + off(1) * off(1) + off(2) * off(2);
            if passed > 0 && far > max_range_m * max_range_m {
                return Cast::Nothing;
            }
            match cursor.occupied(key) {
                Some(true) => return Cast::Occupied(centre),
                None if !through_unknown => return Cast::Unknown(centre),
                _ => {}
            }
        }
        Cast::Nothing
    }
}
