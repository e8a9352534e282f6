//! A depth camera without a robot is localized: somebody carries it, and odometry says how it moved from picture to picture.
//!
//! Nothing feels which way is down: the attitude goes on from the start, and the beams correct it with the place. Where no start is told
//! the picture's own floor says it.

use std::sync::Arc;

use geometry::{Camera, Map, Pose};
use known_map::{KnownMap, StandingRoom};
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use segmentation::Planes;
use sensing::PinholeCamera;
use settings::{ConfigError, Table};

use super::belief::Belief;
use super::config::MonteCarloConfig;
use super::ground::floor_below;
use super::motion::BodyReading;
use super::particle::TorsoPose;
use super::random::{Purpose, Stream};
use super::static_map::StaticMap;
use super::{MonteCarloLocalizer, PlaceSearch};

/// Where a camera is believed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraEstimate {
    /// The optical frame in the map.
    pub map_from_camera: Pose<Map, Camera>,
    /// Standard deviation of its place along the least certain level direction, m.
    pub spread_m: f64,
    /// Standard deviation of its heading, rad.
    pub spread_rad: f64,
    /// Whether it is not to be acted on.
    pub lost: bool,
}

/// Follows a depth camera through a known map, or finds where it is.
#[derive(Debug, Clone)]
pub struct CameraLocalizer {
    localizer: MonteCarloLocalizer,
    camera: PinholeCamera,
    planes: Planes,
    /// The axes that a body has, in the camera: forward, left, up.
    body_from_camera: UnitQuaternion<f64>,
    /// The camera in the map, with a body's axes, by the last picture that was used; where no start was told and none was used yet, none.
    believed: Option<Isometry3<f64>>,
    /// How it moved since.
    since: Isometry3<f64>,
    /// The camera by odometry alone.
    odometry_from_body: Isometry3<f64>,
    /// Its height above the floor that it saw last, m.
    height_m: f64,
    pictures: u64,
    is_told: bool,
}

impl CameraLocalizer {
    /// Follows a camera from a pose that is told, or finds it anywhere on the map.
    pub fn new(
        map: &KnownMap,
        camera: PinholeCamera,
        map_from_camera: Option<Pose<Map, Camera>>,
        config: MonteCarloConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let room = StandingRoom {
            radius_m: 0.0,
            height_m: config.tuning.camera.room,
        };
        let map = Arc::new(StaticMap::new(map, room, &config)?);
        if map_from_camera.is_none() && map.places.is_empty() {
            return Err(ConfigError {
                key: "start".to_owned(),
                allowed: "told in a map without a floor to stand on".to_owned(),
                found: "none".to_owned(),
            });
        }
        let body_from_camera =
            Rotation3::from_matrix_unchecked(Matrix3::new(0., 0., 1., -1., 0., 0., 0., -1., 0.));
        let body_from_camera = UnitQuaternion::from_rotation_matrix(&body_from_camera);
        let believed = map_from_camera.map(|pose| pose.inner * body_from_camera.inverse());
        Ok(Self {
            localizer: MonteCarloLocalizer::new(map, None, config)?,
            planes: Planes::new(camera.size_px[0] * camera.size_px[1]),
            camera,
            body_from_camera,
            believed,
            since: Isometry3::identity(),
            odometry_from_body: believed.unwrap_or_else(Isometry3::identity),
            height_m: 0.0,
            pictures: 0,
            is_told: map_from_camera.is_some(),
        })
    }

    /// Takes in a picture, depths in m row by row, NaN where nothing was seen, and how the camera moved since the last one. None as long
    /// as nothing tells where it may be: no start was told, and no picture showed a floor yet.
    pub fn update(
        &mut self,
        depths_m: impl Iterator<Item = f32>,
        previous_from_current: &Isometry3<f64>,
    ) -> Option<CameraEstimate> {
        let turn = self.body_from_camera;
        let moved = turn * previous_from_current * turn.inverse();
        self.pictures += 1;
        self.since *= moved;
        self.odometry_from_body *= moved;
        self.read(depths_m);
        if self.believed.is_none() {
            self.begin()?;
        }
        let before = self.believed?;
        let predicted = before * self.since;
        let reading = self.reading(&predicted);
        if self.localizer.take(reading, &self.planes) {
            let found = self.belief().map(|belief| belief.torso);
            let torso = found.unwrap_or_else(|| TorsoPose::of(&predicted));
            // Angles add up only near where the guesses are: so the next step begins there.
            if let Some(last) = &mut self.localizer.last {
                last.odometry_from_torso = torso;
            }
            self.believed = Some(torso.isometry());
            self.since = Isometry3::identity();
        }
        let pose = self.believed? * self.since;
        let belief = self.belief();
        Some(CameraEstimate {
            map_from_camera: Pose::wrap(pose * turn),
            spread_m: belief.map_or(f64::INFINITY, Belief::spread_m),
            spread_rad: belief.map_or(f64::INFINITY, |belief| {
                belief.covariance.m44.max(0.0).sqrt()
            }),
            lost: self.localizer.is_lost(),
        })
    }

    /// What the guesses say, or those of a search, however little sure it is.
    fn belief(&self) -> Option<&Belief> {
        let search = self.localizer.search.as_ref().and_then(PlaceSearch::best);
        self.localizer.belief().or(search)
    }

    /// The picture's points, as seen from the camera with a body's axes.
    fn read(&mut self, depths_m: impl Iterator<Item = f32>) {
        let turn = self.body_from_camera;
        let points = self.camera.points(depths_m).map(|point| {
            let at = turn * Vector3::from(point.map(f64::from));
            [at.x as f32, at.y as f32, at.z as f32]
        });
        self.planes.points_in_robot_m.clear();
        self.planes.points_in_robot_m.extend(points);
        self.planes.any_camera = Some(self.camera);
        self.planes.reliable = true;
    }

    /// Which way is down, and how far, by the floor that the picture shows.
    fn begin(&mut self) -> Option<()> {
        let config = &self.localizer.config;
        let mut draws = Stream::new(config.seed, self.pictures, Purpose::Floor, 0);
        let (up, height_m) = floor_below(&self.planes.points_in_robot_m, config, &mut draws)?;
        let level = UnitQuaternion::rotation_between(&up, &Vector3::z())?;
        let mut torso = TorsoPose::of(&Isometry3::from_parts(Translation3::identity(), level));
        torso.yaw_rad = 0.0;
        self.height_m = height_m;
        self.believed = Some(torso.isometry() * self.since.inverse());
        self.odometry_from_body = torso.isometry();
        Some(())
    }

    /// What a body would say of itself that has its feet on the map's floor below the camera. Moves the points into its frame.
    fn reading(&mut self, map_from_torso: &Isometry3<f64>) -> BodyReading {
        let config = &self.localizer.config;
        let at_m = map_from_torso.translation.vector;
        let known = self.is_told || self.localizer.tracking.is_some();
        let reach_m = config.reach[1];
        let below_m = (self.localizer.map.ranges).cast(at_m.into(), [0.0, 0.0, -1.0], reach_m);
        if let Some(below_m) = below_m.filter(|_| known) {
            self.height_m = below_m;
        }
        let torso = TorsoPose::of(map_from_torso);
        let level = UnitQuaternion::from_euler_angles(0.0, 0.0, torso.yaw_rad);
        let feet_m = at_m - Vector3::z() * self.height_m;
        let map_from_robot = Isometry3::from_parts(feet_m.into(), level);
        let robot_from_torso = map_from_robot.inverse() * map_from_torso;
        for point in &mut self.planes.points_in_robot_m {
            let at = robot_from_torso * Point3::from(point.map(f64::from));
            *point = [at.x as f32, at.y as f32, at.z as f32];
        }
        let robot_from_camera = robot_from_torso * self.body_from_camera;
        self.planes.robot_from_camera = Pose::wrap(robot_from_camera);
        if self.is_told && self.localizer.map_from_robot_at_start.is_none() {
            self.localizer.map_from_robot_at_start = Some(Pose::<Map, _>::wrap(map_from_robot));
        }
        BodyReading {
            time_ns: (self.pictures as f64 * config.tuning.camera.period * 1e9) as u64,
            odometry_from_robot: self.odometry_from_body,
            odometry_from_camera: self.odometry_from_body * self.body_from_camera,
            torso_from_robot: robot_from_torso.inverse(),
            odometry_from_torso: torso,
            torso_height_m: self.height_m,
            is_felt: false,
        }
    }
}
