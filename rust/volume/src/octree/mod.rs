//! An octree of occupancy after OctoMap (Hornung et al. 2013), as 002 uses it: log-odds that are clamped, the unknown is absent,
//! equal children are one leaf. Its lowest two levels are bricks of 64 voxels, which a frame is brought into as a whole.

mod brick;
mod cast;
mod columns;
mod config;
mod error;
mod header;
mod insertion;
mod key;
mod layers;
mod leaves;
mod nodes;
mod reading;
mod window;
mod writing;

use settings::{ConfigError, Table};

pub use cast::{Cast, Sighting};
pub use columns::{ColumnFootprint, LAYERS};
pub use config::{OctreeConfig, probability};
pub use error::OctreeError;
pub use header::Format;
pub use key::Key;
pub use layers::{LayerColumns, ViewLayers};
pub use leaves::{Leaf, Leaves};

use config::Beam;
use insertion::Workspace;
use nodes::Nodes;

/// What is known of the space around the origin of the map frame: 2^16 voxels along each axis. Clones share what neither has written
/// into since, so that a hundred particles may have a map each.
#[derive(Debug, Clone)]
pub struct Octree {
    /// The parameters.
    pub config: OctreeConfig,
    beam: Beam,
    nodes: Nodes,
    workspace: Workspace,
}

/// Equal where they know the same, however they came to it.
impl PartialEq for Octree {
    fn eq(&self, other: &Self) -> bool {
        self.config == other.config && self.leaves().eq(other.leaves())
    }
}

impl Octree {
    /// A tree of which nothing is known.
    pub fn new(config: OctreeConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            beam: Beam::new(&config),
            config,
            nodes: Nodes::default(),
            workspace: Workspace::default(),
        })
    }

    /// The voxel that holds a point of the map frame; none beyond what a tree can hold.
    pub fn key_at(&self, point_m: [f64; 3]) -> Option<Key> {
        key::key_at(key::in_voxels(point_m, self.per_m()))
    }

    /// What is known of a voxel; equation (1) as log-odds, occupied from 0 on.
    pub fn log_odds(&self, key: Key) -> Option<f32> {
        self.nodes.value(key)
    }

    /// What is known of a point of the map frame.
    pub fn log_odds_at(&self, point_m: [f64; 3]) -> Option<f32> {
        self.log_odds(self.key_at(point_m)?)
    }

    /// Whether a point of the map frame is rather occupied than not, where anything is known of it.
    pub fn is_occupied_at(&self, point_m: [f64; 3]) -> Option<bool> {
        self.log_odds_at(point_m).map(|value| value >= 0.0)
    }

    /// Makes the voxels that hold these points of the map frame, m, as surely occupied as beams can: a map that is told, not seen.
    /// Points beyond what a tree can hold are left out, and counted in what is returned; it is an error where all are. What is no
    /// number is left out, too.
    pub fn occupy(&mut self, points_m: &[[f64; 3]]) -> Result<usize, OctreeError> {
        let (mut held, mut beyond) = (0_usize, None);
        let mut count = 0;
        for (index, &point) in points_m.iter().enumerate() {
            if let Some(key) = self.key_at(point) {
                self.nodes
                    .set_leaf(key, key::DEPTH, self.beam.highest, &self.beam);
                self.nodes.prune(key);
                held += 1;
            } else if point.iter().all(|at| at.is_finite()) {
                count += 1;
                beyond = beyond.or(Some(index));
            }
        }
        match beyond {
            Some(index) if held == 0 => Err(self.beyond(index, points_m[index])),
            _ => Ok(count),
        }
    }

    /// What a point is refused with that lies where no voxel is.
    fn beyond(&self, index: usize, point_m: [f64; 3]) -> OctreeError {
        let side_m = self.config.resolution;
        let half_m = 0.5 * f64::from(key::SPAN) * side_m;
        let [x, y, z] = point_m;
        OctreeError::Reach {
            index,
            place: format!("({x}, {y}, {z})"),
            side_m: side_m.to_string(),
            low: (-half_m).to_string(),
            high: half_m.to_string(),
        }
    }

    /// All leaves.
    pub fn leaves(&self) -> Leaves<'_> {
        Leaves::of(&self.nodes)
    }

    /// The centre of a leaf in the map frame, m.
    pub fn centre_m(&self, leaf: &Leaf) -> [f64; 3] {
        key::centre_m(leaf.corner, leaf.edge(), self.config.resolution)
    }

    /// Nodes, inner ones and leaves, as OctoMap counts them in a pruned tree.
    pub fn node_count(&self) -> usize {
        self.nodes.count()
    }

    /// Bytes that the tree takes, without what is kept for insertion.
    pub fn bytes(&self) -> usize {
        self.nodes.bytes()
    }

    /// Bytes that several trees take together, without what is kept for insertion: what clones share counts once (Fairfield et al. 2007;
    /// 004, ref. 36.19).
    pub fn bytes_together<'a>(trees: impl IntoIterator<Item = &'a Self>) -> usize {
        let mut places = std::collections::BTreeSet::new();
        let each = trees
            .into_iter()
            .map(|tree| tree.nodes.own_bytes(&mut places));
        each.sum()
    }

    /// Voxels a metre.
    fn per_m(&self) -> f64 {
        1.0 / self.config.resolution
    }
}
