//! World models: what the robot knows of the ground around it.

mod averaging;
mod bevel;
mod changing_places;
mod columns;
mod elevation;
mod felt_place;
mod foreseen_place;
mod height_map;
mod laid_bevels;
mod mesh;
mod model;
mod multi_level;
mod occupancy_2d;
mod overlay;
mod part;
mod points;
mod room;
pub mod surface;
mod two_maps;

pub use averaging::{Averaging, AveragingConfig, AveragingTuning};
pub use bevel::Bevel;
pub use changing_places::ChangingConfig;
pub use columns::Span;
pub use elevation::{
    CellMeasurement, CellSizes, Elevation, ElevationConfig, ElevationTuning, EvenSlopeTuning,
    ExtendedElevationConfig, Gathered, HeightEstimate, RangeCells, SightLines, SurfaceRule,
};
pub use felt_place::FeltPlace;
pub use foreseen_place::ForeseenPlace;
pub use height_map::HeightMap;
pub use mesh::{MeshConfig, MeshMap, MeshTuning};
pub use meshes::TriangleMesh;
pub use model::{FloorView, HeadRoom, Insertion, MapError, Surface, Voxel, WorldModel};
pub use multi_level::{MultiLevel, MultiLevelConfig, MultiLevelTuning, Patch};
pub use occupancy_2d::{DepthSliceConfig, Occupancy2d};
pub use overlay::{FeltConfig, Overlay};
pub use part::{WorldModelNeeds, WorldModelPart};
pub use points::{Moments, Points, PointsConfig, PointsTuning, Sample, Shape, SurfaceSamples};
pub use sensing::RangeNoise;
pub use surface::{Fog, FogConfig, FogTuning, OverheadTuning};
pub use two_maps::{
    BeamsTuning, EmptySightTuning, KnownSurfacesTuning, TwoMaps, TwoMapsConfig, TwoMapsTuning,
};
pub use volume::{Clearing, Update};

/// The world models that come with the crate: a new one is a file or folder beside these, and its lines here.
pub const PARTS: &[WorldModelPart] = &[
    surface::PART,
    averaging::PART,
    two_maps::PART,
    elevation::PART,
    elevation::EXTENDED,
    multi_level::PART,
    points::PART,
    mesh::PART,
    occupancy_2d::PART,
];
