//! Writes OctoMap's `.bt` and `.ot` files.

use std::path::Path;

use super::header::{self, Format};
use super::leaves::LeafNode;
use super::{Octree, OctreeError};

/// What a node is in a `.bt` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Free = 1,
    Occupied = 2,
    Inner = 3,
}

impl Octree {
    /// Writes a file, of the format that its name ends in: `.bt` or `.ot`.
    pub fn write(&self, path: &Path) -> Result<(), OctreeError> {
        let access = |reason: String| OctreeError::Access {
            path: path.display().to_string(),
            reason,
        };
        let format = match path.extension().and_then(|end| end.to_str()) {
            Some("bt") => Format::Binary,
            Some("ot") => Format::Full,
            _ => return Err(access("an octree's file must end in .bt or .ot".to_owned())),
        };
        std::fs::write(path, self.to_bytes(format)).map_err(|error| access(error.to_string()))
    }

    /// The content of a file. In `.bt` a leaf is free or occupied, and those that are the same then are one.
    pub fn to_bytes(&self, format: Format) -> Vec<u8> {
        let mut data = Vec::new();
        let root = self.nodes.node(self.nodes.root);
        let nodes = match (format, root) {
            (_, None) => 0,
            (Format::Full, Some(root)) => {
                let _highest = self.put_full(root, &mut data);
                self.node_count()
            }
            (Format::Binary, Some(root)) => {
                let (kind, below) = self.put_binary(root, &mut data);
                if kind == Kind::Inner {
                    1 + below
                } else {
                    // The root cannot be a leaf in this format: its children say it.
                    data.extend((0x5555 * kind as u16).to_le_bytes());
                    9
                }
            }
        };
        let mut bytes = header::text(format, nodes, self.config.resolution).into_bytes();
        bytes.append(&mut data);
        bytes
    }

    /// Appends a node and all below it; returns its log-odds, the highest of its children's.
    fn put_full(&self, node: LeafNode<'_>, data: &mut Vec<u8>) -> f32 {
        if let LeafNode::Leaf(value) = node {
            data.extend(value.to_le_bytes());
            data.push(0);
            return value;
        }
        let at = data.len();
        data.extend([0; 5]);
        let (mut highest, mut children) = (f32::NEG_INFINITY, 0);
        for child in 0..8 {
            if let Some(below) = self.nodes.child(node, child) {
                highest = highest.max(self.put_full(below, data));
                children |= 1 << child;
            }
        }
        data[at..at + 4].copy_from_slice(&highest.to_le_bytes());
        data[at + 4] = children;
        highest
    }

    /// Appends an inner node and all inner ones below it; returns what it is in the file, and how many nodes are below it.
    fn put_binary(&self, node: LeafNode<'_>, data: &mut Vec<u8>) -> (Kind, usize) {
        if let LeafNode::Leaf(value) = node {
            return (
                if value >= 0.0 {
                    Kind::Occupied
                } else {
                    Kind::Free
                },
                0,
            );
        }
        let at = data.len();
        data.extend([0; 2]);
        let (mut codes, mut nodes) = (0_u16, 0);
        for child in 0..8 {
            if let Some(below) = self.nodes.child(node, child) {
                let (kind, more) = self.put_binary(below, data);
                codes |= (kind as u16) << (2 * child);
                nodes += 1 + more;
            }
        }
        for kind in [Kind::Free, Kind::Occupied] {
            if codes == 0x5555 * kind as u16 {
                data.truncate(at);
                return (kind, 0);
            }
        }
        data[at..at + 2].copy_from_slice(&codes.to_le_bytes());
        (Kind::Inner, nodes)
    }
}
