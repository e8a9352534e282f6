//! The known map around the robot, in the cells of a view: what is solid there, and which floors the robot can get to.

use std::collections::VecDeque;
use std::sync::Arc;

use geometry::{CellArea, runs};
use settings::ConfigError;
use volume::octree::{LAYERS, LayerColumns, Octree, OctreeConfig, ViewLayers};

use crate::{AroundTuning, KnownMapTuning, recut::recut};

/// What the robot passes and climbs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AroundLimits {
    /// Room that it needs above a floor, m.
    pub height_m: f64,
    /// InnerSurfaces of the map are joined by steps of at most this, m.
    pub rise_m: f64,
    /// What rises by less than this above a floor is floor, m.
    pub delta_m: f64,
}

/// The known map as it is around the robot. Nothing that is seen changes it.
#[derive(Debug, Clone)]
pub struct MapAround {
    tree: Arc<Octree>,
    columns: LayerColumns,
    /// For each cell the surfaces on which the robot has headroom, and those that it can get to: the layers below them, one bit each.
    standable: Vec<u64>,
    reached: Vec<u64>,
    /// For each cell the height of the floor, m; none where there is none to get to.
    floors: Vec<Option<f32>>,
    /// For each cell the layers in which something stands out of the floor, one bit each.
    upright: Vec<u64>,
    tuning: AroundTuning,
}

impl MapAround {
    /// The map of a tree with voxels of any size, as one with voxels of a certain size, which is refused by its key.
    pub(crate) fn new(
        tree: &Arc<Octree>,
        voxels: &OctreeConfig,
        key: &str,
        tuning: &KnownMapTuning,
    ) -> Result<Self, ConfigError> {
        let same = tree.config.resolution == voxels.resolution;
        Ok(Self {
            tree: if same {
                Arc::clone(tree)
            } else {
                Arc::new(recut(tree, voxels, key, tuning.most_voxels)?)
            },
            columns: LayerColumns::default(),
            standable: Vec::new(),
            reached: Vec::new(),
            floors: Vec::new(),
            upright: Vec::new(),
            tuning: tuning.around.clone(),
        })
    }

    /// Looks at the map from where the robot stands. The layers have the size of the voxels.
    pub fn look(&mut self, layers: &ViewLayers, robot_m: [f64; 3], limits: AroundLimits) {
        self.columns.read((&self.tree, 0.5), layers, layers.all());
        let [cols, rows] = layers.size();
        let headroom = (limits.height_m / layers.resolution_m).ceil() as u32;
        let columns = (0..cols * rows).map(|index| self.columns.at(index));
        self.standable.clear();
        self.standable
            .extend(columns.map(|solid| standable(solid, headroom)));
        self.reach(layers, robot_m, limits.rise_m);
        self.floors.clear();
        let own_m = layers.resolution_m * self.tuning.own_level;
        let floor = |&reached: &u64| floor_m(reached, layers, robot_m[2], own_m).map(|m| m as f32);
        self.floors.extend(self.reached.iter().map(floor));
        self.upright.clear();
        let upright = self.floors.iter().enumerate().map(|(index, floor)| {
            let floor_m = floor.map_or(robot_m[2], f64::from);
            self.columns.at(index) & layers.between(floor_m + limits.delta_m, f64::INFINITY)
        });
        self.upright.extend(upright);
    }

    /// Whether something stands out of the floor within a distance of a place, m, along each axis.
    pub fn stands_near(&self, at_m: [f64; 3], off_m: f64, layers: &ViewLayers) -> bool {
        let corner = |off_m: f64| {
            let [x_m, y_m, _] = at_m;
            layers.lattice.cell_at(x_m + off_m, y_m + off_m)
        };
        let around = CellArea {
            min: corner(-off_m),
            max: corner(off_m),
        };
        // A layer counts by its middle above, by its lower border below.
        let half_m = 0.5 * layers.resolution_m;
        let heights = layers.between(at_m[2] - off_m - half_m, at_m[2] + off_m);
        (runs(around.within(layers.all()), layers.size()).flatten())
            .any(|index| self.upright[index] & heights != 0)
    }

    /// Finds the surfaces to get to from where the robot stands, by steps from cell to cell.
    fn reach(&mut self, layers: &ViewLayers, [x_m, y_m, z_m]: [f64; 3], rise_m: f64) {
        let [cols, rows] = layers.size();
        // Rounding must not decide about a whole number of voxels.
        let most = ((rise_m / layers.resolution_m + 1e-6) as u32).min(LAYERS as u32 - 1);
        let mut open = VecDeque::new();
        self.reached.clear();
        self.reached.resize(cols * rows, 0);
        let mut enter = |open: &mut VecDeque<_>, index: usize, surfaces: u64| {
            let new = surfaces & self.standable[index] & !self.reached[index];
            if new != 0 {
                self.reached[index] |= new;
                open.push_back((index, new));
            }
        };
        let side_m = layers.resolution_m;
        let AroundTuning {
            start,
            start_below,
            start_above,
            ..
        } = self.tuning;
        let own = layers.between(z_m - start_below * side_m, z_m + start_above * side_m);
        let corner = |off_m: f64| layers.lattice.cell_at(x_m + off_m, y_m + off_m);
        let around = CellArea {
            min: corner(-start),
            max: corner(start),
        };
        for index in runs(around, layers.size()).flatten() {
            enter(&mut open, index, own);
        }
        while let Some((index, surfaces)) = open.pop_front() {
            let (col, row) = (index % cols, index / cols);
            let near = (0..=most).fold(0, |near, up| near | surfaces << up | surfaces >> up);
            let beside = [
                (col > 0, index.wrapping_sub(1)),
                (col + 1 < cols, index + 1),
                (row > 0, index.wrapping_sub(cols)),
                (row + 1 < rows, index + cols),
            ];
            for (_, next) in beside.into_iter().filter(|&(inside, _)| inside) {
                enter(&mut open, next, near);
            }
        }
    }

    /// The layers in which something is solid in the cell that is stored at an index.
    #[inline]
    pub fn solid(&self, index: usize) -> u64 {
        self.columns.at(index)
    }

    /// Height of the floor of a cell, m, where there is one that the robot can get to.
    #[inline]
    pub fn floor_at(&self, index: usize) -> Option<f32> {
        self.floors.get(index).copied().flatten()
    }
}

/// The layers of a column with so many free ones above them.
fn standable(solid: u64, headroom: u32) -> u64 {
    let last = headroom.min(LAYERS as u32 - 1);
    solid & !(1..=last).fold(0, |under, up| under | solid >> up)
}

/// Height of the surface of a cell that is nearest to the robot's, m. One within `own_m` is the robot's own level: where exactly
/// it lies, the robot knows better than the voxels.
fn floor_m(surfaces: u64, layers: &ViewLayers, robot_z_m: f64, own_m: f64) -> Option<f64> {
    let heights = (0..LAYERS).filter(|layer| surfaces >> layer & 1 == 1);
    let off_m = |height_m: &f64| (height_m - robot_z_m).abs();
    let nearest_m = heights
        .map(|layer| layers.border_m(layer + 1))
        .min_by(|a, b| off_m(a).total_cmp(&off_m(b)))?;
    let own = off_m(&nearest_m) <= own_m;
    Some(if own { robot_z_m } else { nearest_m })
}
