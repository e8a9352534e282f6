//! Exact frames of level surfaces of any outline: what a perfect segmenter would make of perfect disparities.

use geometry::{Camera, Map, Outline, Plane, Point, Pose, Robot};
use nalgebra::{Point2, Point3, Vector3};
use segmentation::{PlaneRegion, Planes};
use sensing::Scan;

use testkit::synthetic::CAMERA;

/// A solid from below to a level top.
#[derive(Debug, Clone)]
pub(super) struct Prism {
    pub(super) outline: Outline,
    pub(super) top_m: f64,
}

impl Prism {
    pub(super) fn new(corners: &[[f64; 2]], top_m: f64) -> Self {
        let corners: Vec<_> = corners.iter().map(|&[x, y]| Point2::new(x, y)).collect();
        Self {
            outline: Outline::hull(&corners).unwrap(),
            top_m,
        }
    }

    /// Depth at which a ray meets it, and whether from above.
    fn meet(&self, eye: &Vector3<f64>, ray: &Vector3<f64>) -> Option<(f64, bool)> {
        let [enters, leaves] = self.outline.cuts(&eye.xy().into(), &ray.xy())?;
        let flat = ray.xy().norm_squared();
        let [from, to] =
            [enters, leaves].map(|cut| (cut.at.coords - eye.xy()).dot(&ray.xy()) / flat);
        let onto = (self.top_m - eye.z) / ray.z;
        if to < 0.0 {
            None
        } else if from > 0.0 && from > onto {
            Some((from, false))
        } else {
            (onto > 0.0 && onto <= to).then_some((onto, true))
        }
    }
}

/// What the camera sees of the prisms, all in the map; the last prism may be the ground.
pub(super) fn frame(
    prisms: &[Prism],
    map_from_robot: &Pose<Map, Robot>,
    robot_from_camera: &Pose<Robot, Camera>,
) -> (Scan, Planes) {
    let (mut scan, mut planes) = (Scan::new(CAMERA), Planes::new(CAMERA.width * CAMERA.height));
    scan.robot_from_camera = *robot_from_camera;
    planes.robot_from_camera = *robot_from_camera;
    planes.reliable = true;
    let camera = (*map_from_robot * *robot_from_camera).inner;
    let robot_from_map = map_from_robot.inverse();
    let mut hits = vec![Vec::new(); prisms.len()];
    for at in 0..planes.labels.len() {
        let ray = camera.rotation * Vector3::from(CAMERA.ray(at % CAMERA.width, at / CAMERA.width));
        let eye = camera.translation.vector;
        let met = prisms
            .iter()
            .enumerate()
            .filter_map(|(i, prism)| Some((prism.meet(&eye, &ray)?, i)));
        let Some(((depth_m, above), prism)) = met.min_by(|((a, _), _), ((b, _), _)| a.total_cmp(b))
        else {
            continue;
        };
        let point = (robot_from_map * Point::<Map>::wrap((eye + ray * depth_m).into())).inner;
        scan.disparity_px[at] = CAMERA.disparity_px(depth_m) as f32;
        planes.points_in_robot_m[at] = [point.x as f32, point.y as f32, point.z as f32];
        if above {
            hits[prism].push(point);
            planes.labels[at] = prism as u16 + 1;
            planes.floor_height_m[at] = point.z as f32;
        }
    }
    for (prism, points) in prisms.iter().zip(&hits) {
        let height_m = prism.top_m - map_from_robot.origin().inner.z;
        let flat: Vec<_> = points.iter().map(Point3::xy).collect();
        let count = points.len().max(1) as f64;
        let sum = flat.iter().fold([0.0; 2], |[x, y], p| [x + p.x, y + p.y]);
        let enough = points.len() >= 40;
        planes.regions.push(PlaneRegion {
            support: points.len(),
            mean: Point::new(sum[0] / count, sum[1] / count, height_m),
            plane: Plane {
                normal: Vector3::z_axis(),
                distance_m: height_m,
            },
            boundary: Outline::hull(&flat).ok().filter(|_| enough),
            floor_height_m: enough.then_some(height_m),
            roughness: None,
        });
    }
    (scan, planes)
}
