//! Reads OctoMap's `.bt` and `.ot` files.

use std::path::Path;

use super::header::{self, Format, TreeKind};
use super::key::{DEPTH, Key, child_corner};
use super::nodes::BRICK_DEPTH;
use super::{Octree, OctreeConfig, OctreeError};

/// Bytes: a building of 1 cm voxels has a tenth.
const LARGEST_FILE: u64 = 500_000_000;

/// Bytes that a tree may take: nodes of a hostile file take forty times what they take in it.
const LARGEST_TREE: usize = 1_000_000_000;

/// Goes through the nodes of a file and builds the tree. Room is taken only for what has been read.
struct Reader<'a> {
    name: &'a str,
    bytes: &'a [u8],
    at: usize,
    kind: TreeKind,
    /// Nodes that were read.
    nodes: usize,
    tree: Octree,
}

impl Octree {
    /// Reads a file of either format; the parameters but the resolution are OctoMap's.
    pub fn read(path: &Path) -> Result<Self, OctreeError> {
        let name = path.display().to_string();
        let access = |reason: String| OctreeError::Access {
            path: name.clone(),
            reason,
        };
        let found = std::fs::metadata(path).map_err(|error| access(error.to_string()))?;
        // A pipe would be waited for without end, a device read without end.
        if !found.is_file() {
            return Err(access("it is no file".to_owned()));
        }
        if found.len() > LARGEST_FILE {
            return Err(access(format!(
                "larger than {LARGEST_FILE} bytes, which is the limit"
            )));
        }
        let bytes = std::fs::read(path).map_err(|error| access(error.to_string()))?;
        Self::from_bytes(&name, &bytes)
    }

    /// Reads a tree from a file's content; `name` is for errors.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, OctreeError> {
        let header = header::parse(name, bytes)?;
        let config = OctreeConfig {
            resolution: header.resolution_m,
            ..OctreeConfig::default()
        };
        let bad = |at: usize, reason: String| OctreeError::Format {
            path: name.to_owned(),
            at,
            reason,
        };
        let tree = Self::new(config).map_err(|error| bad(0, error.to_string()))?;
        let mut reader = Reader {
            name,
            bytes,
            at: header.end,
            kind: header.kind,
            nodes: 0,
            tree,
        };
        if header.nodes > 0 {
            match header.format {
                Format::Binary => {
                    reader.nodes = 1;
                    reader.binary([0; 3], 0)?;
                }
                Format::Full => reader.full([0; 3], 0)?,
            }
        }
        let Reader {
            at, nodes, tree, ..
        } = reader;
        if at != bytes.len() {
            return Err(bad(
                at,
                format!("{} bytes follow the last node", bytes.len() - at),
            ));
        }
        if nodes != header.nodes {
            let reason = format!(
                "the file holds {nodes} nodes, its header says {}",
                header.nodes
            );
            return Err(bad(at, reason));
        }
        Ok(tree)
    }
}

impl Reader<'_> {
    fn bad(&self, reason: impl Into<String>) -> OctreeError {
        OctreeError::Format {
            path: self.name.to_owned(),
            at: self.at,
            reason: reason.into(),
        }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], OctreeError> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let taken = rest.first_chunk().copied();
        let taken = taken.ok_or_else(|| self.bad("the file ends within the tree"))?;
        self.at += N;
        Ok(taken)
    }

    /// The children of an inner node: two bits each, then those of the inner ones among them.
    fn binary(&mut self, corner: Key, depth: u32) -> Result<(), OctreeError> {
        self.check_depth(depth)?;
        let codes = u16::from_le_bytes(self.take()?);
        if codes == 0 {
            self.at -= 2;
            return Err(self.bad("an inner node has no children"));
        }
        let code = |child: usize| codes >> (2 * child) & 3;
        for child in 0..8 {
            self.nodes += usize::from(code(child) != 0);
            let value = match code(child) {
                1 => self.tree.beam.lowest,
                2 => self.tree.beam.highest,
                _ => continue,
            };
            self.set(child_corner(corner, depth, child), depth + 1, value);
        }
        for child in (0..8).filter(|&child| code(child) == 3) {
            self.binary(child_corner(corner, depth, child), depth + 1)?;
        }
        self.finish(corner, depth);
        Ok(())
    }

    /// A node: its log-odds, one bit for each child, and the children.
    fn full(&mut self, corner: Key, depth: u32) -> Result<(), OctreeError> {
        let value = f32::from_le_bytes(self.take()?);
        if !value.is_finite() {
            self.at -= 4;
            return Err(self.bad(format!("log-odds must be finite, got {value}")));
        }
        if self.kind == TreeKind::Colour {
            let _colour: [u8; 3] = self.take()?;
        }
        let [children] = self.take()?;
        self.nodes += 1;
        if children == 0 {
            self.set(corner, depth, value);
            return Ok(());
        }
        self.check_depth(depth)?;
        for child in (0..8).filter(|child| children >> child & 1 == 1) {
            self.full(child_corner(corner, depth, child), depth + 1)?;
        }
        self.finish(corner, depth);
        Ok(())
    }

    /// Refuses children of single voxels, and trees for which memory has no room.
    fn check_depth(&self, depth: u32) -> Result<(), OctreeError> {
        if self.tree.bytes() > LARGEST_TREE {
            return Err(self.bad(format!(
                "the tree takes more than {LARGEST_TREE} bytes, which is the limit"
            )));
        }
        if depth < DEPTH {
            return Ok(());
        }
        Err(self.bad(format!("the tree is deeper than {DEPTH} levels")))
    }

    fn set(&mut self, corner: Key, depth: u32, value: f32) {
        let Octree { nodes, beam, .. } = &mut self.tree;
        nodes.set_leaf(corner, depth, value, beam);
    }

    /// After the children of a node: they may all be the same.
    fn finish(&mut self, corner: Key, depth: u32) {
        if depth <= BRICK_DEPTH {
            self.tree.nodes.prune(corner);
        }
    }
}
