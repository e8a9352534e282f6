//! The known map itself: the octree that was told, and what is made of it, each once.

use std::sync::{Arc, OnceLock};

use settings::{ConfigError, Table, require};
use volume::octree::{Leaf, Octree, OctreeConfig};
use volume::{DistanceField, InnerSurfaceRule, InnerSurfaces, RangeField, SolidError, SolidVoxels};

use crate::{
    Floors, KnownMapConfig, MapAround, MapSurfaces, Prior, Standing, StandingRoom,
    standing::standing,
};

/// Columns of a map's floors up to which memory has room: five bytes each.
const MOST_COLUMNS: usize = 1 << 26;

/// The map that a robot is told. Nothing that is seen changes it. What several components read is made when the first of them asks.
#[derive(Debug)]
pub struct KnownMap {
    /// The octree that was told.
    pub tree: Arc<Octree>,
    solid: OnceLock<Result<Arc<SolidVoxels>, ConfigError>>,
    /// Nothing where surfaces are the voxels' faces.
    surfaces: OnceLock<Option<Arc<InnerSurfaces>>>,
    ranges: OnceLock<Arc<RangeField>>,
    distances: OnceLock<Result<Arc<DistanceField>, ConfigError>>,
    config: KnownMapConfig,
}

impl KnownMap {
    /// The map that an octree holds: its occupied voxels are solid, all else is free.
    pub fn new(tree: Arc<Octree>, config: KnownMapConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            tree,
            solid: OnceLock::new(),
            surfaces: OnceLock::new(),
            ranges: OnceLock::new(),
            distances: OnceLock::new(),
            config,
        })
    }

    /// The map of boxes, each from its lowest to its highest corner, m: the blocks of a course. A voxel is solid where its centre
    /// lies in a box.
    pub fn of_boxes(boxes: &[[[f64; 3]; 2]], resolution_m: f64) -> Result<Self, ConfigError> {
        let solid = SolidVoxels::of_boxes(boxes, resolution_m).map_err(refusal)?;
        let mut tree = Octree::new(OctreeConfig {
            resolution: resolution_m,
            ..OctreeConfig::default()
        })?;
        let [cols, rows, layers] = solid.size();
        for (y, z) in (0..layers).flat_map(|z| (0..rows).map(move |y| (y, z))) {
            let in_row = (0..cols).map(|x| [x, y, z]);
            let filled = in_row.filter(|voxel| solid.is_solid(voxel.map(|at| at as i64)));
            let centre_m = |voxel| (solid.corner_m(voxel)).map(|low_m| low_m + 0.5 * resolution_m);
            let _beyond = tree
                .occupy(&filled.map(centre_m).collect::<Vec<_>>())
                .map_err(|error| ConfigError {
                    key: "static_map".to_owned(),
                    allowed: "within what a tree can hold".to_owned(),
                    found: error.to_string(),
                })?;
        }
        let config = KnownMapConfig {
            resolution: resolution_m,
            ..KnownMapConfig::default()
        };
        Ok(Self {
            solid: Ok(Arc::new(solid)).into(),
            ..Self::new(Arc::new(tree), config)?
        })
    }

    /// Where the map lies: the middle of what is occupied and how far it reaches to each side, m; none where nothing is.
    pub fn extent_m(&self) -> Option<([f64; 2], f64)> {
        let tree = &self.tree;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for leaf in tree.leaves().filter(Leaf::is_occupied) {
            let centre = tree.centre_m(&leaf);
            let half_m = 0.5 * f64::from(leaf.edge()) * tree.config.resolution;
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

    /// The occupied voxels as a dense grid.
    pub fn solid(&self) -> Result<&Arc<SolidVoxels>, ConfigError> {
        let made = || SolidVoxels::occupied(&self.tree).map(Arc::new);
        let solid = self.solid.get_or_init(|| made().map_err(refusal));
        solid.as_ref().map_err(Clone::clone)
    }

    /// Whether ranges made this map, so that its surfaces lie in the voxels.
    fn is_measured(&self) -> bool {
        match self.config.surfaces {
            MapSurfaces::Auto => self.tree.leaves().any(|leaf| !leaf.is_occupied()),
            MapSurfaces::Faces => false,
            MapSurfaces::Inside => true,
        }
    }

    /// Where in the voxels the surfaces lie; none where that is their faces.
    fn surfaces(&self) -> Result<Option<&Arc<InnerSurfaces>>, ConfigError> {
        let solid = self.solid()?;
        let tuning = &self.config.tuning.surface;
        let rule = InnerSurfaceRule {
            reach: tuning.reach,
            flatness: tuning.flatness,
            glancing: tuning.glancing,
            before: tuning.before,
        };
        let made = || (self.is_measured()).then(|| Arc::new(InnerSurfaces::new(solid, rule)));
        Ok(self.surfaces.get_or_init(made).as_ref())
    }

    /// How far rays get.
    pub fn ranges(&self) -> Result<&Arc<RangeField>, ConfigError> {
        let (solid, surfaces) = (self.solid()?, self.surfaces()?);
        Ok((self.ranges).get_or_init(|| {
            Arc::new(match surfaces {
                Some(surfaces) => RangeField::measured(solid, surfaces),
                None => RangeField::new(solid),
            })
        }))
    }

    /// How near surfaces are.
    pub fn distances(&self) -> Result<&Arc<DistanceField>, ConfigError> {
        let (solid, surfaces) = (self.solid()?, self.surfaces()?);
        let made = || match surfaces {
            Some(surfaces) => DistanceField::measured(solid, surfaces),
            None => DistanceField::new(solid),
        };
        let distances = (self.distances).get_or_init(|| made().map(Arc::new).map_err(refusal));
        distances.as_ref().map_err(Clone::clone)
    }

    /// Where a body has room to stand, in the order of the voxels' layers, rows and columns.
    pub fn standing(&self, room: StandingRoom) -> Result<Vec<Standing>, ConfigError> {
        let voxels = (self.solid()?.as_ref(), self.surfaces()?.map(Arc::as_ref));
        Ok(standing(voxels, room, &self.config.tuning.standing))
    }

    /// The voxels whose tops are floors, of not more columns than there is room for.
    fn floor_voxels(&self) -> Result<(&SolidVoxels, Option<&InnerSurfaces>), ConfigError> {
        let solid = self.solid()?;
        let [cols, rows, _] = solid.size();
        let usable = cols * rows <= MOST_COLUMNS;
        let allowed = format!("so coarse that the map spans at most {MOST_COLUMNS} columns");
        let key = "navigation.static_map.resolution";
        require(usable, key, &allowed, (cols * rows) as f64)?;
        Ok((solid, self.surfaces()?.map(Arc::as_ref)))
    }

    /// The floors on which a body has room to stand, and the ways over them.
    pub fn floors(&self, room: StandingRoom) -> Result<Floors, ConfigError> {
        Ok(Floors::new(self.floor_voxels()?, room, &self.config.tuning))
    }

    /// What is to be expected where nothing was seen yet, by a robot of a height, m.
    pub fn prior(&self, height_m: f64) -> Result<Prior, ConfigError> {
        let tuning = &self.config.tuning;
        let floors = Floors::new(self.floor_voxels()?, Prior::room(height_m), tuning);
        Ok(Prior::new(self.solid()?, floors, height_m, tuning))
    }

    /// The map in voxels of a size of one's own, to be looked at from where the robot stands. Voxels so small that there are too many
    /// are refused by the key of their size.
    pub fn around(&self, voxels: &OctreeConfig, key: &str) -> Result<MapAround, ConfigError> {
        MapAround::new(&self.tree, voxels, key, &self.config.tuning)
    }
}

/// A map that makes no dense grid, as the setting that is to blame.
fn refusal(error: SolidError) -> ConfigError {
    let (key, allowed, found) = match error {
        SolidError::Resolution { found } => ("resolution", "finite and > 0", found.to_string()),
        SolidError::Empty => (
            "",
            "solid somewhere, at finite places",
            "nothing".to_owned(),
        ),
        SolidError::TooLarge { found } => {
            let most = SolidVoxels::MOST;
            let allowed = format!("so coarse that the map spans at most {most} voxels");
            return refused("resolution", &allowed, found.to_string());
        }
        SolidError::TooFull { found } => {
            let most = SolidVoxels::MOST_SOLID;
            let allowed = format!("so coarse that the map has at most {most} solid voxels");
            return refused("resolution", &allowed, found.to_string());
        }
        SolidError::TooLargeForDistances { found } => {
            let most = SolidVoxels::MOST_WITH_DISTANCES;
            let allowed = format!(
                "so coarse that the map spans at most {most} voxels where distances are asked for (likelihood_field)"
            );
            return refused("resolution", &allowed, found.to_string());
        }
    };
    refused(key, allowed, found)
}

fn refused(key: &str, allowed: &str, found: String) -> ConfigError {
    let dot = if key.is_empty() { "" } else { "." };
    ConfigError {
        key: format!("navigation.static_map{dot}{key}"),
        allowed: allowed.to_owned(),
        found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOXES: [[[f64; 3]; 2]; 2] = [
        [[0.0, 0.0, -0.04], [2.0, 1.0, 0.0]],
        [[1.96, 0.0, 0.0], [2.0, 1.0, 1.6]],
    ];

    fn known(tree: Arc<Octree>) -> KnownMap {
        KnownMap::new(tree, KnownMapConfig::default()).unwrap()
    }

    #[test]
    fn a_tree_and_its_boxes_are_one_map() {
        let boxes = KnownMap::of_boxes(&BOXES, 0.04).unwrap();
        let tree = known(Arc::clone(&boxes.tree));
        assert_eq!(tree.solid(), boxes.solid());
        assert_eq!(tree.extent_m(), boxes.extent_m());
        let ([x_m, y_m], reach_m) = tree.extent_m().unwrap();
        assert!((x_m - 1.0).abs() < 1e-9 && (y_m - 0.5).abs() < 1e-9);
        assert!((reach_m - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_made_of_a_map_is_made_once() {
        let map = KnownMap::of_boxes(&BOXES, 0.04).unwrap();
        assert!(Arc::ptr_eq(map.solid().unwrap(), map.solid().unwrap()));
        assert!(Arc::ptr_eq(map.ranges().unwrap(), map.ranges().unwrap()));
        let distances = || map.distances().unwrap();
        assert!(Arc::ptr_eq(distances(), distances()));
    }

    #[test]
    fn a_map_that_makes_no_grid_is_refused_by_the_setting_to_blame() {
        let said = |error: ConfigError| error.to_string();
        let empty = Octree::new(OctreeConfig::default()).unwrap();
        assert_eq!(
            said(known(Arc::new(empty)).solid().unwrap_err()),
            "navigation.static_map must be solid somewhere, at finite places, got nothing"
        );
        let far = [[[0.0; 3], [1.0; 3]], [[999.0; 3], [1000.0; 3]]];
        assert_eq!(
            said(KnownMap::of_boxes(&far, 0.5).unwrap_err()),
            "navigation.static_map.resolution must be so coarse that the map spans at most 1000000000 voxels, got 8000000000"
        );
        assert_eq!(
            said(KnownMap::of_boxes(&far, 0.0).unwrap_err()),
            "navigation.static_map.resolution must be finite and > 0, got 0"
        );
    }
}
