//! A map of what range sensors of anyone's saw, whose poses are known: no body, no localizer, no planner.

use geometry::{Camera, Map, Pose, Robot};
use mapping::{WorldModel, WorldModelNeeds};
use segmentation::{Planes, Segmenter, SegmenterNeeds};
use sensing::{Frame, PinholeCamera, RangeSensor, Scan, ScanConfig};
use settings::{Tables, read};
use stairs::{Recognizer, Staircase};

use crate::{PilotError, SEGMENTERS, WORLD_MODELS};

/// What finds surfaces in the pictures of a camera.
struct SurfaceSight {
    camera: PinholeCamera,
    /// For each pixel that the segmenter sees the one of the picture.
    pixels: Vec<Option<u32>>,
    segmenter: Box<dyn Segmenter>,
    scan: Scan,
    frame: Frame,
    /// What it saw in the last picture.
    planes: Planes,
    recognizer: Option<Recognizer>,
}

impl SurfaceSight {
    /// Finds the surfaces of a picture.
    fn look(
        &mut self,
        depths_m: &[f32],
        robot_from_camera: Pose<Robot, Camera>,
    ) -> Result<(), PilotError> {
        for (slot, pixel) in self.frame.depth_m.iter_mut().zip(&self.pixels) {
            let depth_m = pixel.and_then(|pixel| depths_m.get(pixel as usize));
            *slot = depth_m.copied().unwrap_or(f32::NAN);
        }
        self.scan.read(&self.frame, robot_from_camera)?;
        self.segmenter.segment(&self.scan, &mut self.planes)?;
        // The pose is known: the ground need neither be found nor followed.
        self.planes.reliable = true;
        Ok(())
    }
}

/// What finds the surfaces.
pub enum ChosenSegmenter<'a> {
    /// One of the list, by its name.
    Named(&'a str),
    /// One that is in no list.
    Own(Box<dyn Segmenter>),
}

/// How surfaces are found in pictures.
pub struct SightNeeds<'a> {
    /// The segmenter.
    pub segmenter: ChosenSegmenter<'a>,
    /// Pixels a side of the picture that are one to the segmenter.
    pub pool: usize,
    /// Depths are taken to be as precise as eyes so far apart see them, m.
    pub baseline_m: f64,
    /// Whether stairs are looked for.
    pub stairs: bool,
}

/// Keeps a map of frames as the pilot's world model of that name does. The poses of the frames are trusted.
pub struct RangeMap {
    /// The map.
    pub model: Box<dyn WorldModel>,
    tables: Tables,
    sight: Option<SurfaceSight>,
}

impl RangeMap {
    /// A map of which nothing is known, by a world model of the list. `headroom_m`: the robot's height, where there is a robot.
    pub fn new(name: &str, tables: Tables, headroom_m: Option<f64>) -> Result<Self, PilotError> {
        let needs = WorldModelNeeds {
            tables: &tables,
            known_map: None,
            headroom_m,
        };
        let model = WORLD_MODELS.find(name)?(&needs)?;
        Ok(Self::of(model, tables))
    }

    /// A map that a world model keeps which is in no list.
    pub fn of(model: Box<dyn WorldModel>, tables: Tables) -> Self {
        Self {
            model,
            tables,
            sight: None,
        }
    }

    /// Gives the pictures a camera.
    pub fn set_camera(
        &mut self,
        camera: PinholeCamera,
        needs: SightNeeds<'_>,
    ) -> Result<(), PilotError> {
        let config: ScanConfig = read(&self.tables, "scan")?;
        let scan = Scan::pooled(camera.centred(needs.baseline_m), needs.pool, config);
        let made = SegmenterNeeds {
            tables: &self.tables,
            camera: scan.camera,
        };
        let recognizer = (needs.stairs)
            .then(|| -> Result<_, PilotError> {
                Ok(Recognizer::new(read(&self.tables, "stairs")?, scan.camera)?)
            })
            .transpose()?;
        let [width, height] = camera.size_px;
        let segmenter = match needs.segmenter {
            ChosenSegmenter::Named(name) => SEGMENTERS.find(name)?(&made)?,
            ChosenSegmenter::Own(segmenter) => segmenter,
        };
        self.sight = Some(SurfaceSight {
            camera,
            pixels: camera.centred_pixels(),
            segmenter,
            planes: Planes::new(scan.disparity_px.len()),
            recognizer,
            scan,
            frame: Frame {
                exposure_ns: 0,
                arrival_ns: 0,
                width,
                height,
                depth_m: vec![f32::NAN; width * height],
            },
        });
        Ok(())
    }

    /// The camera of the pictures.
    pub fn camera(&self) -> Option<&PinholeCamera> {
        self.sight.as_ref().map(|sight| &sight.camera)
    }

    /// What was found in the last picture; `None` before it, and of a map that has no use for surfaces.
    pub fn planes(&self) -> Option<&Planes> {
        self.sight.as_ref().map(|sight| &sight.planes)
    }

    /// The stairs that are seen or remembered, where they are looked for.
    pub fn staircase(&self) -> Option<&Staircase> {
        let recognizer = self.sight.as_ref()?.recognizer.as_ref();
        recognizer.map(|recognizer| &recognizer.staircase)
    }

    /// Takes in depths along the axis of the camera that was given, m, row by row, NaN for not seen; `ground_m` is how high the ground
    /// below the camera is. Whether they were used: not without a camera.
    pub fn insert_depths(
        &mut self,
        depths_m: &[f32],
        map_from_camera: &Pose<Map, Camera>,
        ground_m: f64,
    ) -> Result<bool, PilotError> {
        let Some(sight) = &mut self.sight else {
            return Ok(false);
        };
        let forward = map_from_camera.inner.rotation * nalgebra::Vector3::z();
        let (map_from_robot, robot_from_camera) = standing(map_from_camera, forward, ground_m);
        let surfaces = self.model.needs_surfaces();
        if surfaces || sight.recognizer.is_some() {
            sight.look(depths_m, robot_from_camera)?;
        }
        if let Some(recognizer) = &mut sight.recognizer {
            recognizer.leave_slopes(self.model.view());
            let _ = recognizer.update(&sight.scan, &sight.planes, &map_from_robot, 0)?;
        }
        if surfaces {
            return Ok(self.model.insert(&sight.planes, &map_from_robot)?.used);
        }
        let sensor = RangeSensor::Picture(sight.camera);
        let points: Vec<_> = sight.camera.points(depths_m.iter().copied()).collect();
        self.insert_points(&points, sensor, map_from_camera, ground_m)
    }

    /// Takes in points of the sensor's frame, m, all seen from its origin; NaN for not seen. `ground_m` is how high the ground below the
    /// sensor is. Whether they were used.
    pub fn insert_points(
        &mut self,
        points_m: &[[f32; 3]],
        sensor: RangeSensor,
        map_from_sensor: &Pose<Map, Camera>,
        ground_m: f64,
    ) -> Result<bool, PilotError> {
        let forward = match sensor {
            RangeSensor::Picture(_) => nalgebra::Vector3::z(),
            RangeSensor::ScanLines | RangeSensor::Cloud => nalgebra::Vector3::x(),
        };
        let forward = map_from_sensor.inner.rotation * forward;
        let (map_from_robot, robot_from_sensor) = standing(map_from_sensor, forward, ground_m);
        let pose = robot_from_sensor.inner.cast::<f32>();
        let points = points_m.iter();
        let points = points.map(|&point| (pose * nalgebra::Point3::from(point)).coords.into());
        let mut planes = Planes::of_points(points.collect(), robot_from_sensor);
        if let RangeSensor::Picture(camera) = sensor {
            planes.any_camera = Some(camera);
        }
        Ok(self.model.insert(&planes, &map_from_robot)?.used)
    }
}

/// Where a robot would stand that carries the sensor, upright below it and turned as it looks: in the map, and the sensor in its frame.
fn standing(
    map_from_sensor: &Pose<Map, Camera>,
    forward: nalgebra::Vector3<f64>,
    ground_m: f64,
) -> (Pose<Map, Robot>, Pose<Robot, Camera>) {
    let at = map_from_sensor.inner.translation.vector;
    let yaw_rad = libm::atan2(forward.y, forward.x);
    let map_from_robot = Pose::<Map, Robot>::from_yaw(at.x, at.y, ground_m, yaw_rad);
    (map_from_robot, map_from_robot.inverse() * *map_from_sensor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Cell, Pose};
    use mapping::Surface;
    use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

    /// A camera at a height that looks straight down.
    fn down(height_m: f64) -> Pose<Map, Camera> {
        let turned = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        Pose::wrap(Isometry3::from_parts(
            Translation3::new(1.0, 2.0, height_m),
            turned,
        ))
    }

    fn height_below(map: &RangeMap) -> Surface {
        let view = map.model.view();
        let cell: Cell = view.lattice.cell_at(1.0, 2.0);
        view.cell(cell)
    }

    #[test]
    fn a_picture_and_its_points_give_the_same_elevation() {
        let camera = PinholeCamera {
            size_px: [40, 30],
            focal_px: [50.0, 48.0],
            centre_px: [18.0, 16.0],
        };
        let needs = SightNeeds {
            segmenter: ChosenSegmenter::Named("scan_line"),
            pool: 1,
            baseline_m: 0.075,
            stairs: false,
        };
        let depths = vec![1.5_f32; 40 * 30];
        let points: Vec<_> = camera.points(depths.iter().copied()).collect();
        let mut maps =
            [(); 2].map(|()| RangeMap::new("elevation", Tables::default(), None).unwrap());
        maps[0].set_camera(camera, needs).unwrap();
        assert!(maps[0].insert_depths(&depths, &down(1.7), 0.0).unwrap());
        let sensor = RangeSensor::Cloud;
        assert!(
            maps[1]
                .insert_points(&points, sensor, &down(1.7), 0.0)
                .unwrap()
        );
        for map in &maps {
            let Surface::Floor(height_m) = height_below(map) else {
                panic!("no floor");
            };
            assert!((height_m - 0.2).abs() < 1e-5, "{height_m}");
        }
    }

    #[test]
    fn an_unknown_world_model_is_refused_with_those_that_there_are() {
        let made = RangeMap::new("elevatoin", Tables::default(), None)
            .err()
            .unwrap();
        assert!(made.to_string().contains("elevation"), "{made}");
    }
}
