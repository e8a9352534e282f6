//! The static map: what is solid in it, and where it says that the robot can stand.

use std::collections::VecDeque;
use std::sync::Arc;

use geometry::CellArea;
use settings::{ConfigError, require};

use super::TwoMapsConfig;
use super::layers::{Columns, Layers};
use geometry::runs;
use volume::octree::{LAYERS, Leaf, Octree, OctreeConfig};

/// So far around the robot something may be the floor that it stands on, m: the map, or its pose, is a little wrong.
const AROUND_M: f64 = 0.2;
/// Voxels into which the solid ones of a map of another size are cut at most.
const MOST_VOXELS: f64 = 2e7;
/// A surface this near to the robot's height is its own level: half a voxel is how it was cut into voxels, the rest is the pose.
const OWN: f64 = 0.75;

/// What was told. Nothing that is seen changes it.
#[derive(Debug, Clone)]
pub(super) struct Prior {
    tree: Arc<Octree>,
    columns: Columns,
    /// For each cell the surfaces on which the robot has headroom, and those that it can get to: the layers below them, one bit each.
    standable: Vec<u64>,
    reached: Vec<u64>,
    /// For each cell the height of the floor, m; none where there is none to get to.
    floors: Vec<Option<f32>>,
    /// For each cell the layers in which something stands out of the floor, one bit each.
    upright: Vec<u64>,
}

impl Prior {
    /// Of a map with voxels of any size.
    pub(super) fn new(tree: Arc<Octree>, config: &OctreeConfig) -> Result<Self, ConfigError> {
        let same = tree.config().resolution == config.resolution;
        Ok(Self {
            tree: if same {
                tree
            } else {
                Arc::new(cut(&tree, config)?)
            },
            columns: Columns::default(),
            standable: Vec::new(),
            reached: Vec::new(),
            floors: Vec::new(),
            upright: Vec::new(),
        })
    }

    /// Where it lies: the middle of what is occupied and how far it reaches to each side, m; none where nothing is.
    pub(super) fn extent_m(tree: &Octree) -> Option<([f64; 2], f64)> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for leaf in tree.leaves().filter(Leaf::is_occupied) {
            let centre = tree.centre_m(&leaf);
            let half_m = 0.5 * f64::from(leaf.edge()) * tree.config().resolution;
            for axis in 0..2 {
                low[axis] = low[axis].min(centre[axis] - half_m);
                high[axis] = high[axis].max(centre[axis] + half_m);
            }
        }
        let reach_m = (0..2).map(|axis| 0.5 * (high[axis] - low[axis]));
        let reach_m = reach_m.fold(0.0, f64::max);
        let middle = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
        (reach_m > 0.0).then_some((middle, reach_m))
    }

    /// Looks at it from where the robot stands; what rises by less than `delta_m` is floor.
    pub(super) fn look(
        &mut self,
        layers: &Layers,
        robot_m: [f64; 3],
        (config, delta_m): (&TwoMapsConfig, f64),
    ) {
        self.columns.read((&self.tree, 0.5), layers, layers.all());
        let [cols, rows] = layers.size();
        let headroom = (config.height / config.resolution).ceil() as u32;
        let columns = (0..cols * rows).map(|index| self.columns.at(index));
        self.standable.clear();
        self.standable
            .extend(columns.map(|solid| standable(solid, headroom)));
        self.reach(layers, robot_m, config);
        self.floors.clear();
        let floor = |&reached: &u64| floor_m(reached, layers, robot_m[2]).map(|m| m as f32);
        self.floors.extend(self.reached.iter().map(floor));
        self.upright.clear();
        let upright = self.floors.iter().enumerate().map(|(index, floor)| {
            let floor_m = floor.map_or(robot_m[2], f64::from);
            self.columns.at(index) & layers.between(floor_m + delta_m, f64::INFINITY)
        });
        self.upright.extend(upright);
    }

    /// Whether something stands out of the floor within a distance of a place, m, along each axis.
    pub(super) fn stands_near(&self, at_m: [f64; 3], off_m: f64, layers: &Layers) -> bool {
        let corner = |off_m: f64| {
            let [x_m, y_m, _] = at_m;
            layers.lattice().cell_at(x_m + off_m, y_m + off_m)
        };
        let around = CellArea {
            min: corner(-off_m),
            max: corner(off_m),
        };
        // A layer counts by its middle above, by its lower border below.
        let half_m = 0.5 * layers.side_m();
        let heights = layers.between(at_m[2] - off_m - half_m, at_m[2] + off_m);
        (runs(around.within(layers.all()), layers.size()).flatten())
            .any(|index| self.upright[index] & heights != 0)
    }

    /// Finds the surfaces to get to from where the robot stands, by steps from cell to cell.
    fn reach(&mut self, layers: &Layers, [x_m, y_m, z_m]: [f64; 3], config: &TwoMapsConfig) {
        let [cols, rows] = layers.size();
        // Rounding must not decide about a whole number of voxels.
        let most = ((config.rise / config.resolution + 1e-6) as u32).min(LAYERS as u32 - 1);
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
        let side_m = config.resolution;
        let own = layers.between(z_m - 1.5 * side_m, z_m + 0.5 * side_m);
        let corner = |off_m: f64| layers.lattice().cell_at(x_m + off_m, y_m + off_m);
        let around = CellArea {
            min: corner(-AROUND_M),
            max: corner(AROUND_M),
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
    pub(super) fn solid(&self, index: usize) -> u64 {
        self.columns.at(index)
    }

    /// Height of the floor of a cell, m, where there is one that the robot can get to.
    #[inline]
    pub(super) fn floor_at(&self, index: usize) -> Option<f32> {
        self.floors.get(index).copied().flatten()
    }
}

/// The same map in voxels of another size: what holds a part of something solid is solid.
fn cut(tree: &Octree, config: &OctreeConfig) -> Result<Octree, ConfigError> {
    let mut other = Octree::new(config.clone())?;
    let solid = || tree.leaves().filter(Leaf::is_occupied);
    let side_m = |leaf: &Leaf| f64::from(leaf.edge()) * tree.config().resolution;
    let parts = |leaf: &Leaf| (side_m(leaf) / config.resolution - 1e-6).ceil();
    let voxels: f64 = solid().map(|leaf| parts(&leaf).powi(3)).sum();
    let allowed = format!("so coarse that the static map has at most {MOST_VOXELS} solid voxels");
    let usable = voxels <= MOST_VOXELS;
    require(usable, "navigation.octree.resolution", &allowed, voxels)?;
    for leaf in solid() {
        let (side_m, parts) = (side_m(&leaf), parts(&leaf));
        let centre_m = tree.centre_m(&leaf);
        let places = |axis: usize| {
            let place = move |part: i32| (f64::from(part) + 0.5) / parts - 0.5;
            (0..parts as i32).map(move |part| centre_m[axis] + place(part) * side_m)
        };
        for (x_m, y_m) in places(0).flat_map(|x_m| places(1).map(move |y_m| (x_m, y_m))) {
            for key in places(2)
                .filter_map(|z_m| other.key_at([x_m, y_m, z_m]))
                .collect::<Vec<_>>()
            {
                other.update_voxel(key, true);
            }
        }
    }
    Ok(other)
}

/// The layers of a column with so many free ones above them.
fn standable(solid: u64, headroom: u32) -> u64 {
    let last = headroom.min(LAYERS as u32 - 1);
    solid & !(1..=last).fold(0, |under, up| under | solid >> up)
}

/// Of the surfaces of a cell the one nearest to the robot's height, m. One within the width of a voxel is the robot's own level:
/// where exactly it lies, the robot knows better than the voxels.
fn floor_m(surfaces: u64, layers: &Layers, robot_z_m: f64) -> Option<f64> {
    let heights = (0..LAYERS).filter(|layer| surfaces >> layer & 1 == 1);
    let off_m = |height_m: &f64| (height_m - robot_z_m).abs();
    let nearest_m = heights
        .map(|layer| layers.border_m(layer + 1))
        .min_by(|a, b| off_m(a).total_cmp(&off_m(b)))?;
    let own = off_m(&nearest_m) <= layers.side_m() * OWN;
    Some(if own { robot_z_m } else { nearest_m })
}
