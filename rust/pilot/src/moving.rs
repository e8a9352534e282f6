//! What moves in a frame: kept out of the map, and foreseen.

use behaviour::Mover;
use dynamic_scenes::{MovingConfig, MovingThings, MovingTrack, PictureShape, RangeView};
use geometry::{Camera, Map, Point, Pose, Robot, distance_m};
use mapping::ForeseenPlace;
use proprioception::BodyState;
use robot::Body;
use segmentation::Planes;
use settings::ConfigError;

/// How high the camera is above the robot's ground, m.
pub(crate) fn eye_m(body: &Body, state: &BodyState) -> f64 {
    let robot_from_camera = state.robot_from_torso * body.torso_from_camera(&state.links);
    robot_from_camera.origin().inner.z
}

/// Looks for what moves in each frame that is trusted.
pub(crate) struct Moving {
    config: MovingConfig,
    /// None where nothing is followed.
    things: Option<MovingThings>,
}

/// Whether a thing is faster than this, m/s.
fn is_fast(track: &MovingTrack, fast_mps: f64) -> bool {
    let [x, y] = track.velocity_mps();
    geometry::hypot(x, y) > fast_mps
}

impl Moving {
    pub(crate) fn new(config: MovingConfig) -> Result<Self, ConfigError> {
        let things = MovingThings::new(config.clone())?;
        Ok(Self {
            things: config.follow.then_some(things),
            config,
        })
    }

    /// What is followed.
    pub(crate) fn tracks(&self) -> &[MovingTrack] {
        self.things.as_ref().map_or(&[], MovingThings::tracks)
    }

    pub(crate) fn forget(&mut self) {
        if let Some(things) = &mut self.things {
            things.forget();
        }
    }

    /// Takes in a frame: what surely moves is then as if it had not been seen. Where that will be, all of it.
    pub(crate) fn see(
        &mut self,
        planes: &mut Planes,
        map_from_robot: &Pose<Map, Robot>,
    ) -> Vec<ForeseenPlace> {
        let Some(things) = self.things.as_mut().filter(|_| planes.reliable) else {
            return Vec::new();
        };
        let Some(pinhole) = planes.pinhole() else {
            return Vec::new();
        };
        let [cols, rows] = pinhole.size_px;
        if cols * rows != planes.points_in_robot_m.len() {
            return Vec::new();
        }
        // One pixel of each block.
        let side = cols.div_ceil(self.config.columns).max(1);
        let size = [cols / side, rows / side];
        let middle = side / 2;
        let at = |index: usize| {
            let (row, col) = (
                index / size[0] * side + middle,
                index % size[0] * side + middle,
            );
            planes.points_in_robot_m[row * cols + col]
        };
        let camera_from_robot = planes.robot_from_camera.inverse();
        let map_from_camera: Pose<Map, Camera> = *map_from_robot * planes.robot_from_camera;
        let (mut depths_m, mut points) = (Vec::new(), Vec::new());
        for index in 0..size[0] * size[1] {
            let [x, y, z] = at(index).map(f64::from);
            let point = Point::<Robot>::new(x, y, z);
            depths_m.push((camera_from_robot * point).inner.z as f32);
            let placed = (*map_from_robot * point).inner;
            points.push(([placed.x, placed.y, placed.z], z));
        }
        let share = side as f64;
        let shape = PictureShape {
            size_px: size,
            focal_px: pinhole.focal_px.map(|px| px / share),
            centre_px: pinhole.centre_px.map(|px| (px - middle as f64) / share),
        };
        let time_s = planes.exposure_ns as f64 * 1e-9;
        let view = RangeView::of_picture(time_s, &map_from_camera, shape, depths_m);
        let of = things.see(view, points);
        for (index, id) in of.into_iter().enumerate() {
            if id.is_none_or(|id| !things.surely_moves(id)) {
                continue;
            }
            let (row, col) = (index / size[0] * side, index % size[0] * side);
            for row in row..row + side {
                for pixel in row * cols + col..row * cols + col + side {
                    planes.points_in_robot_m[pixel] = [f32::NAN; 3];
                    planes.floor_height_m[pixel] = f32::NAN;
                }
            }
        }
        self.foreseen(map_from_robot)
    }

    /// What moves, or may, and where it will be from now on.
    pub(crate) fn movers(&self, now_ns: u64) -> Vec<Mover> {
        let config = &self.config;
        let steps = (config.wait / config.step).ceil() as u32;
        let now_s = now_ns as f64 * 1e-9;
        let mover = |track: &MovingTrack| {
            let late_s = (now_s - track.time_s()).max(0.0);
            let place_m = |step| {
                let ahead_s = late_s + f64::from(step) * config.step;
                track.predicted(ahead_s).at_m
            };
            Mover {
                places_m: (0..=steps).map(place_m).collect(),
                step_s: config.step,
                radius_m: track.radius_m,
                room_m: config.room,
                is_sure: track.moves,
            }
        };
        let tracks = self.tracks().iter();
        tracks
            .filter(|track| !track.moves || is_fast(track, config.fast))
            .map(mover)
            .collect()
    }

    /// Where what surely moves is and will be, but for what is where the robot stands.
    fn foreseen(&self, map_from_robot: &Pose<Map, Robot>) -> Vec<ForeseenPlace> {
        let config = &self.config;
        let robot = map_from_robot.origin().inner;
        let steps = (config.ahead / config.step).ceil() as u32;
        let places = self
            .tracks()
            .iter()
            .filter(|track| track.moves)
            .flat_map(|track| {
                (0..=steps).map(move |step| {
                    let ahead_s = (f64::from(step) * config.step).min(config.ahead);
                    ForeseenPlace {
                        at_m: track.predicted(ahead_s).at_m,
                        radius_m: track.radius_m + config.room,
                        top_m: robot.z + 1.0,
                    }
                })
            });
        places
            .filter(|place| {
                distance_m(place.at_m, [robot.x, robot.y]) > config.own + place.radius_m
            })
            .collect()
    }
}
