//! The two maps of Maier, Hornung and Bennewitz 2012 (002, sections III.A, B and D): a static one that was told, and a local one of
//! what was seen. What is occupied in either, within the robot's vertical extent, is projected to the floor.
//!
//! The paper's floor is where nothing is projected, and its normals keep the floor's points out of the local map. A robot on stairs
//! needs to know how high its floor is: floors, and which points are theirs, are those of [`Fog`]; where it saw none, the
//! static map tells.

mod beams;
mod config;
mod empty_sight;
mod known_surfaces;
mod local_columns;
mod tuning;

use crate::part::WorldModelPart;
use geometry::{Cell, CellArea, Grid, Lattice, Map, Pose, Robot};
use known_map::{AroundLimits, KnownMap, MapAround};
use segmentation::Planes;
use settings::ConfigError;
use settings::{Part, TableDescription, read};

use crate::{FloorView, Fog, FogConfig, Insertion, MapError, Surface, Voxel, WorldModel};
use beams::BeamGround;
pub use config::TwoMapsConfig;
use empty_sight::EmptySight;
use geometry::runs;
use local_columns::LocalColumns;
pub use tuning::{BeamsTuning, EmptySightTuning, KnownSurfacesTuning, TwoMapsTuning};
use volume::Ray;
use volume::octree::{Cast, Octree, Sighting, ViewLayers, probability};
use volume::{Clearing, Update};

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: "octree",
    about: "a static map that is told and a local one of what is seen, octrees",
    source: Some("Maier, Hornung and Bennewitz 2012 (002)"),
    tables: &[
        TableDescription::of::<TwoMapsConfig>(),
        TableDescription::of::<FogConfig>(),
    ],
    make: |needs| {
        let (config, fog): (_, FogConfig) =
            (read(needs.tables, "octree")?, read(needs.tables, "fog")?);
        let fog = fog.for_robot(needs.headroom_m);
        Ok(Box::new(TwoMaps::new(config, &fog, needs.known_map)?))
    },
};

/// Keeps the static and the local map, the floors, and the view made of them.
#[derive(Debug, Clone)]
pub struct TwoMaps {
    config: TwoMapsConfig,
    /// As it was when nothing had been seen.
    fresh: Fog,
    floors: Fog,
    /// The local map.
    pub local: Octree,
    known: Option<MapAround>,
    /// Height of the level on which the robot stands, m: where it stood when the maps were last projected anew.
    level_m: f64,
    layers: ViewLayers,
    seen: LocalColumns,
    view: FloorView,
    rays: Vec<Ray>,
}

impl TwoMaps {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "octree";

    /// A map of which nothing was seen: around the static map where there is one, else around the map's origin. `floors`: of the
    /// floor grid, with the cells of the view; its `clearing` is always `projected`.
    pub fn new(
        config: TwoMapsConfig,
        floors: &FogConfig,
        static_map: Option<&KnownMap>,
    ) -> Result<Self, ConfigError> {
        config.check_with(floors)?;
        let extent = static_map.and_then(KnownMap::extent_m);
        let window = extent.and_then(|(middle_m, reach_m)| {
            let reach = (reach_m / floors.cell).ceil();
            let cells = floors.cells as f64 + 2.0 * reach;
            let fits =
                2.0 * reach <= config.tuning.whole_map && cells <= FogConfig::MOST_CELLS as f64;
            fits.then_some((middle_m, reach))
        });
        let floors = FogConfig {
            // As much room beyond the static map as there is around the robot without one.
            cells: floors.cells + window.map_or(0, |(_, reach)| 2 * reach as usize),
            // The voxels of this one only tell which floors are still there.
            clearing: Clearing::Projected,
            ..floors.clone()
        };
        let floors = match window {
            Some((middle_m, reach)) => Fog::around(floors, middle_m, reach)?,
            None => Fog::new(floors)?,
        };
        let lattice = floors.view().lattice;
        let cells = floors.config.cells;
        let known = |map: &KnownMap| map.around(&config.octree(), "navigation.octree.resolution");
        let size = [cells; 2];
        let layers = ViewLayers::above(-config.below_m(), (lattice, size), config.resolution);
        Ok(Self {
            local: Octree::new(config.octree())?,
            known: static_map.map(known).transpose()?,
            level_m: f64::NAN,
            seen: LocalColumns::default(),
            view: floors.view().clone(),
            rays: Vec::new(),
            fresh: floors.clone(),
            layers,
            floors,
            config,
        })
    }

    /// The view made of both maps at once: what [`WorldModel::view`] is frame by frame.
    pub fn projected(&self) -> FloorView {
        let mut whole = self.clone();
        whole.seen = LocalColumns::default();
        whole.view = self.unknown(self.layers.lattice);
        let all = whole.layers.all();
        let local = (&whole.local, whole.config.p_occ);
        whole.seen.read(local, &whole.layers, all);
        whole.project(all);
        whole.view
    }

    /// A view of which nothing is known.
    fn unknown(&self, lattice: Lattice) -> FloorView {
        FloorView {
            lattice,
            ..self.fresh.view().clone()
        }
    }

    /// Follows the robot: where its level or the window is another one, all is looked at anew; whether that is so.
    fn follow(&mut self, robot_m: [f64; 3]) -> bool {
        let lattice = self.floors.view().lattice;
        let same_level = (robot_m[2] - self.level_m).abs()
            <= self.config.tuning.same_level * self.config.resolution;
        if same_level && lattice == self.layers.lattice {
            return false;
        }
        self.level_m = robot_m[2];
        let bottom_m = self.level_m - self.config.below_m();
        let place = (lattice, self.layers.size());
        self.layers = ViewLayers::above(bottom_m, place, self.config.resolution);
        self.view = self.unknown(lattice);
        if let Some(known) = &mut self.known {
            let limits = AroundLimits {
                height_m: self.config.height,
                rise_m: self.config.rise,
                delta_m: self.floors.config.delta,
            };
            known.look(&self.layers, robot_m, limits);
        }
        true
    }

    /// Takes the frame that the floors took in into the local map; the cells that it touched.
    fn take_in(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<CellArea, MapError> {
        let mut rays = std::mem::take(&mut self.rays);
        rays.clear();
        let frame = &self.floors.frame;
        let ground = BeamGround {
            level_m: self.level_m,
            delta_m: self.floors.config.delta,
            floor_at: |index| self.floor_at(index),
        };
        let tuning = &self.config.tuning;
        let beams = (self.config.resolution, &tuning.beams);
        beams::read(&mut rays, (frame, planes), &ground, beams);
        let eye_m = frame.eye_m;
        if let Some(known) = &self.known {
            let known = (known, &self.layers);
            known_surfaces::leave_out(&mut rays, eye_m, known, &tuning.known_surfaces);
        }
        let seen = rays.len();
        let empty = EmptySight {
            range_m: self.config.unseen_range,
            blind_m: self.config.blind_range,
            floor_m: self.level_m,
            voxel_m: self.config.resolution,
            beside_px: tuning.empty_sight.beside,
        };
        empty_sight::read(&mut rays, planes, map_from_robot, &empty);
        let mut at = 0;
        rays.retain(|ray| {
            at += 1;
            at <= seen || !self.is_hidden(eye_m, ray)
        });
        let lattice = &self.layers.lattice;
        let mut touched = CellArea::of(lattice.cell_at(eye_m[0], eye_m[1]));
        for ray in &rays {
            touched.include(lattice.cell_at(ray.end_m[0], ray.end_m[1]));
        }
        let taken = self.local.insert(eye_m, &rays, Update::PerFrame);
        self.rays = rays;
        let _beyond = taken.map_err(|error| MapError::Failed(error.to_string()))?;
        Ok(touched.within(self.layers.all()))
    }

    /// Whether something is remembered on a line of sight, so near that the camera may be blind to it.
    fn is_hidden(&self, eye_m: [f64; 3], ray: &Ray) -> bool {
        let near = Sighting {
            max_range_m: self.config.blind_range,
            through_unknown: true,
        };
        let along = std::array::from_fn(|axis| ray.end_m[axis] - eye_m[axis]);
        self.local.cast_ray(eye_m, along, near) != Cast::Nothing
    }

    /// Height of the floor of the cell that is stored at an index, m: what was seen, or else what was told.
    fn floor_at(&self, index: usize) -> Option<f32> {
        let told = || self.known.as_ref()?.floor_at(index);
        self.floors.floor_at(index).or_else(told)
    }

    /// Layers of a cell in which either map has something.
    fn solid(&self, index: usize) -> u64 {
        let told = self.known.as_ref().map_or(0, |known| known.solid(index));
        self.seen.at(index, self.config.large) | told
    }

    /// Section III.D for the cell that is stored at an index: what stands out of its floor within the robot's vertical extent is an
    /// obstacle. Where no floor is known, that of the cells beside it counts, or the level that the robot stands on.
    fn surface_at(&self, index: usize) -> Surface {
        let floor = self.floor_at(index);
        let base_m = floor.or_else(|| {
            let cols = self.layers.size()[0];
            let cell = Cell::new((index % cols) as i32, (index / cols) as i32);
            self.floors.floor_beside(cell)
        });
        let base_m = base_m.map_or(self.level_m, f64::from);
        let (delta_m, height_m) = (self.floors.config.delta, self.config.height);
        let extent = self.layers.between(base_m + delta_m, base_m + height_m);
        match (self.solid(index) & extent).checked_ilog2() {
            Some(top) => Surface::Obstacle(self.layers.middle_m(top) as f32),
            None => floor.map_or(Surface::Unknown, Surface::Floor),
        }
    }

    /// Brings the view up to date in an area.
    fn project(&mut self, area: CellArea) {
        for index in runs(area, self.layers.size()).flatten() {
            let surface = self.surface_at(index);
            self.view.cells.values_mut()[index] = surface;
            self.view.head.values_mut()[index] = self.floors.view().head.values()[index];
            let floors = &self.floors.floor;
            self.view.sightings.values_mut()[index] = floors.all_sightings()[index];
            self.view.gradients.values_mut()[index] = match surface {
                Surface::Floor(_) => floors.gradient_at(index),
                Surface::Obstacle(_) | Surface::Unknown => [0.0; 2],
            };
        }
    }
}

impl WorldModel for TwoMaps {
    /// What was told is kept.
    fn forget(&mut self) {
        self.floors = self.fresh.clone();
        if let Ok(nothing) = Octree::new(self.config.octree()) {
            self.local = nothing;
        }
        self.level_m = f64::NAN;
    }

    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        let at = map_from_robot.inner.translation.vector;
        let robot_m = [at.x, at.y, at.z];
        let eye_m = (*map_from_robot * planes.robot_from_camera.origin()).inner;
        let held = |at_m: [f64; 3]| self.local.key_at(at_m).is_some();
        let finite = robot_m.iter().all(|at_m| at_m.is_finite());
        if finite && !(held(robot_m) && held(eye_m.into())) {
            let said = "the robot's pose must be no further away than a map can reach";
            return Err(MapError::Failed(said.into()));
        }
        let insertion = self.floors.insert(planes, map_from_robot)?;
        let moved = self.follow(robot_m);
        let mut changed = if insertion.used {
            self.take_in(planes, map_from_robot)?
        } else {
            CellArea::EMPTY
        };
        if moved {
            changed = self.layers.all();
        }
        let local = (&self.local, self.config.p_occ);
        self.seen.read(local, &self.layers, changed);
        changed = changed.grown(LocalColumns::REACH);
        changed.join(insertion.changed);
        let changed = changed.within(self.layers.all());
        self.project(changed);
        Ok(Insertion {
            changed,
            ..insertion
        })
    }

    fn view(&self) -> &FloorView {
        &self.view
    }

    /// The voxels of the local map.
    fn occupied(&self) -> Vec<Voxel> {
        (self.local.leaves())
            .filter(|leaf| probability(leaf.log_odds) >= self.config.p_occ)
            .map(|leaf| Voxel {
                centre_m: self.local.centre_m(&leaf),
                side_m: f64::from(leaf.edge()) * self.config.resolution,
            })
            .collect()
    }

    fn ceilings(&self) -> Option<Grid<f32>> {
        let [cols, rows] = self.layers.size();
        let mut ceilings = Grid::filled(cols, rows, f32::NAN);
        for (index, slot) in ceilings.values_mut().iter_mut().enumerate() {
            if let Some(floor) = self.floor_at(index) {
                let above_m = f64::from(floor) + self.floors.config.delta;
                let above = self.solid(index) & self.layers.between(above_m, f64::INFINITY);
                if above != 0 {
                    *slot = self.layers.middle_m(above.trailing_zeros()) as f32;
                }
            }
        }
        Some(ceilings)
    }
}
