//! The world as a mesh (004, section 36.3.3): each frame becomes triangles where its surfaces hang together ([`meshes::mesh_of_picture`],
//! [`meshes::mesh_of_cloud`]), and all are fused in a volume of which the surface is read ([`meshes::FusedVolume`]).
//!
//! The robot walks on the triangles that are level enough, of each column on those that it reaches, as with [`crate::MultiLevel`].

mod config;
mod pieces;

use geometry::{Cell, Map, Pose, Robot};
use meshes::{
    FusedVolume, JoiningRule, PictureRanges, SeenFrom, TriangleMesh, mesh_of_cloud,
    mesh_of_picture, simplified,
};
use nalgebra::{Point3, Translation3, Vector3};
use segmentation::Planes;
use settings::{ConfigError, Part, Table, TableDescription, read, require};

use crate::columns::{ColumnView, Span};
use crate::elevation::ElevationConfig;
use crate::elevation::sensed::SensedFrame;
use crate::part::WorldModelPart;
use crate::surface::check_poses;
use crate::{FloorView, Insertion, MapError, Voxel, WorldModel};
pub use config::{MeshConfig, MeshTuning};
use pieces::{PieceRule, Pieces};

/// How it is listed and made.
pub(crate) const PART: WorldModelPart = Part {
    name: MeshMap::NAME,
    about: "surfaces as triangles, fused of all frames: over and under bridges, for files of other tools",
    source: Some(
        "Burgard and Hebert, World Modeling (004, section 36.3.3); Curless and Levoy 1996",
    ),
    tables: &[
        TableDescription::of::<ElevationConfig>(),
        TableDescription::of::<MeshConfig>(),
    ],
    make: |needs| {
        let config: MeshConfig = read(needs.tables, "mesh")?;
        let elevation = read(needs.tables, "elevation")?;
        Ok(Box::new(MeshMap::new(config, elevation, needs.headroom_m)?))
    },
};

/// Keeps the surface and the view made of it.
#[derive(Debug, Clone)]
pub struct MeshMap {
    config: MeshConfig,
    elevation: ElevationConfig,
    /// Room between two things above each other with which both are kept, m.
    headroom_m: f32,
    rule: JoiningRule,
    volume: FusedVolume,
    pieces: Pieces,
    columns: ColumnView,
    frame: SensedFrame,
}

impl MeshMap {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "mesh";

    /// A map of which nothing is known, around the map's origin. `robot_height_m` is the room that counts where the configuration has none.
    pub fn new(
        config: MeshConfig,
        elevation: ElevationConfig,
        robot_height_m: Option<f64>,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        elevation.check()?;
        let headroom = config.headroom.or(robot_height_m);
        let key = "navigation.mesh.headroom";
        let wanted = "given where there is no robot";
        require(headroom.is_some(), key, wanted, "nothing")?;
        let headroom_m = headroom.map_or(f32::INFINITY, |room_m| room_m as f32);
        let noise = elevation.noise();
        Ok(Self {
            headroom_m,
            rule: JoiningRule::new(&config.joining, noise),
            volume: FusedVolume::new(config.fusion.clone(), &config.joining, noise)?,
            pieces: Pieces::default(),
            columns: ColumnView::new(&elevation, headroom_m, config.tuning.joined),
            frame: SensedFrame::default(),
            config,
            elevation,
        })
    }

    /// The whole surface, in the map frame.
    pub fn mesh(&self) -> TriangleMesh {
        self.volume.mesh()
    }

    /// The things in a cell of the view, the lowest first; none where nothing was seen, and outside.
    pub fn things(&self, cell: Cell) -> &[Span] {
        self.columns.things(cell)
    }

    /// The points of a frame that tell of a surface, in the robot's frame, m; NaN for the others.
    fn points_in_robot_m(&self, planes: &Planes) -> Vec<[f32; 3]> {
        let eye = planes.robot_from_camera.origin().inner.coords.cast::<f32>();
        let most_m = self.elevation.max_range as f32;
        let points = planes.points_in_robot_m.iter().zip(&planes.at_step);
        let near = points.map(|(&at, &at_step)| {
            let is_near = (Vector3::from(at) - eye).norm() <= most_m;
            if is_near && !at_step {
                at
            } else {
                [f32::NAN; 3]
            }
        });
        near.collect()
    }

    /// Takes in a frame that is seen from there, raised by a shift, m.
    fn take_in(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
        shift_m: f64,
    ) -> Result<(), MapError> {
        let raised = Translation3::new(0.0, 0.0, shift_m) * map_from_robot.inner;
        let robot_from_camera = planes.robot_from_camera.inner;
        let eye = robot_from_camera.translation.vector;
        let points = self.points_in_robot_m(planes);
        let camera = planes.pinhole();
        let seen = match camera {
            Some(camera) => {
                mesh_of_picture(&points, camera.size_px[0], &robot_from_camera, &self.rule)
            }
            None => mesh_of_cloud(&points, SeenFrom::Eye(eye.into()), &self.rule)
                .map_err(|error| MapError::Failed(error.to_string()))?,
        };
        let eye_in_map = raised * Point3::from(eye);
        self.volume
            .insert(&seen.mesh.moved(&raised), eye_in_map.coords.into());
        if let Some(camera) = camera.filter(|_| self.elevation.clearing) {
            let eye = eye.cast::<f32>();
            let ranges = planes.points_in_robot_m.iter();
            let ranges: Vec<_> = ranges.map(|&at| (Vector3::from(at) - eye).norm()).collect();
            let camera_from_map = (raised * robot_from_camera).inverse();
            self.volume
                .see_through(&PictureRanges::new(camera, camera_from_map, &ranges));
        }
        let robot_m = map_from_robot.inner.translation.vector.into();
        self.volume.forget_beyond(robot_m, self.config.kept);
        self.gather();
        Ok(())
    }

    fn piece_rule(&self) -> PieceRule {
        PieceRule {
            cell_m: self.elevation.cell,
            upright: libm::cos(self.config.steepest),
            apart_m: (self.config.tuning.apart * self.elevation.rise) as f32,
            least_frames: self.config.tuning.least_frames,
        }
    }

    /// Gathers the triangles of the surface by columns.
    fn gather(&mut self) {
        let rule = self.piece_rule();
        self.pieces.begin();
        let pieces = &mut self.pieces;
        self.volume.pieces(|piece| pieces.add(piece, &rule));
    }

    /// Brings the triangles into the columns of the window.
    fn columns_anew(&mut self) {
        let rule = self.piece_rule();
        let pieces = &mut self.pieces;
        self.columns.fill(|add| pieces.spans(&rule, add));
    }
}

impl WorldModel for MeshMap {
    fn forget(&mut self) {
        let height_m = Some(f64::from(self.headroom_m));
        if let Ok(fresh) = Self::new(self.config.clone(), self.elevation.clone(), height_m) {
            *self = fresh;
        }
    }

    fn insert(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Result<Insertion, MapError> {
        check_poses(planes, map_from_robot)?;
        let (seen, most_m) = ((planes, map_from_robot), self.elevation.max_range);
        let settled = self.columns.settle(&mut self.frame, seen, most_m);
        if settled.used {
            self.take_in(planes, map_from_robot, settled.shift_m.unwrap_or(0.0))?;
        }
        if settled.used || settled.moved {
            self.columns_anew();
        }
        Ok(self.columns.refresh(map_from_robot, settled))
    }

    fn view(&self) -> &FloorView {
        self.columns.view()
    }

    fn needs_surfaces(&self) -> bool {
        false
    }

    /// Cubes of a cell's side over the vertical extent of each thing in the window.
    fn occupied(&self) -> Vec<Voxel> {
        self.columns.occupied()
    }

    /// The surface, simplified.
    fn surface(&self) -> Option<TriangleMesh> {
        Some(simplified(&self.mesh(), &self.config.simplify))
    }
}
