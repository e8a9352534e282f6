//! The points of one frame in the map frame, with their ranges.

use geometry::{Map, Pose, Robot};
use nalgebra::Vector3;
use segmentation::Planes;

/// A point and how far from the sensor it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SensedPoint {
    /// Position in the map frame, m.
    pub at_m: [f64; 3],
    /// Distance from the sensor, m.
    pub range_m: f32,
}

/// The points of one frame and where they were seen from. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub(crate) struct SensedFrame {
    /// The sensor in the map frame, m.
    pub eye_m: [f64; 3],
    /// What was seen.
    pub points: Vec<SensedPoint>,
}

impl SensedFrame {
    /// Carries the points up to `max_range_m` away to the map frame. Those at the edge of a step tell of neither surface and are left out.
    pub(crate) fn read(
        &mut self,
        planes: &Planes,
        map_from_robot: &Pose<Map, Robot>,
        max_range_m: f64,
    ) {
        let eye = planes.robot_from_camera.origin().inner.coords;
        let rotation = *map_from_robot.inner.rotation.to_rotation_matrix().matrix();
        let origin = map_from_robot.inner.translation.vector;
        self.eye_m = (rotation * eye + origin).into();
        self.points.clear();
        let most = max_range_m * max_range_m;
        for (point, &at_step) in planes.points_in_robot_m.iter().zip(&planes.at_step) {
            let at = Vector3::from(point.map(f64::from));
            let squared = (at - eye).norm_squared();
            // What is no number is not near, either.
            let near = squared <= most;
            if at_step || !near {
                continue;
            }
            self.points.push(SensedPoint {
                at_m: (rotation * at + origin).into(),
                range_m: (squared as f32).sqrt(),
            });
        }
    }

    /// Whether the frame is of use: its heights may be trusted, or a shift, m, brings it onto those that are known, by which it is moved. The
    /// ground that the robot stands on tells a frame's height best: where that is seen, no shift is asked for.
    pub(crate) fn settle(&mut self, planes: &Planes, shift_m: Option<f64>) -> bool {
        if let Some(shift_m) = shift_m {
            self.raise(shift_m);
        }
        planes.reliable || shift_m.is_some()
    }

    /// Moves the whole frame up.
    fn raise(&mut self, height_m: f64) {
        self.eye_m[2] += height_m;
        for point in &mut self.points {
            point.at_m[2] += height_m;
        }
    }
}
