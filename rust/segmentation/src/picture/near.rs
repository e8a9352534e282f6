//! What is seen near the robot's feet.

use nalgebra::Vector3;

use crate::picture::view::{View, to_f32};

/// Squares that differ by less than this share of themselves may be told apart by rounding alone.
const ROUNDING: f64 = 1e-12;

/// Tells which pixels show what is up to a distance from the robot over the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NearFeet<'a> {
    view: &'a View,
    camera_m: &'a Vector3<f64>,
    reach_m: f64,
    surely: f64,
    possibly: f64,
}

impl<'a> NearFeet<'a> {
    /// Up to `reach_m`, seen from `camera_m` (robot frame).
    pub(crate) fn new(view: &'a View, camera_m: &'a Vector3<f64>, reach_m: f64) -> Self {
        let square = reach_m * reach_m;
        Self {
            view,
            camera_m,
            reach_m,
            surely: square * (1.0 - ROUNDING),
            possibly: square * (1.0 + ROUNDING),
        }
    }

    /// Keeps what shows such a place of a row and leaves out the rest; how many pixels are kept.
    pub(crate) fn keep(&self, row: usize, disparity_px: &[f32], kept_px: &mut [f32]) -> usize {
        let (x, y) = (self.view.x.along(row), self.view.y.along(row));
        let (mut surely, mut possibly) = (0_u32, 0_u32);
        // No branch, so that many are looked at at once.
        for ((col, &d), kept) in (0_i32..).zip(disparity_px).zip(kept_px.iter_mut()) {
            let square = self.square(x.at(col as f32), y.at(col as f32), d);
            let near = square < self.surely;
            surely += u32::from(near);
            possibly += u32::from(square < self.possibly);
            *kept = if near { d } else { f32::NAN };
        }
        if possibly == surely {
            return surely as usize;
        }
        let mut count = 0;
        let near = self.along(row, disparity_px);
        for ((near, &d), kept) in near.zip(disparity_px).zip(kept_px) {
            count += usize::from(near);
            *kept = if near { d } else { f32::NAN };
        }
        count
    }

    /// Square of the distance from the robot, m2, of what a pixel shows.
    fn square(&self, x: f32, y: f32, d: f32) -> f64 {
        let x_m = self.camera_m.x + f64::from(x / d);
        let y_m = self.camera_m.y + f64::from(y / d);
        x_m * x_m + y_m * y_m
    }

    /// Whether each pixel of a row shows such a place; what was not seen does not.
    pub(crate) fn along(&self, row: usize, disparity_px: &[f32]) -> impl Iterator<Item = bool> {
        let (x, y) = (self.view.x.along(row), self.view.y.along(row));
        disparity_px.iter().enumerate().map(move |(col, &d)| {
            let col = to_f32(col);
            let x_m = self.camera_m.x + f64::from(x.at(col) / d);
            let y_m = self.camera_m.y + f64::from(y.at(col) / d);
            let square = x_m * x_m + y_m * y_m;
            // The exact distance takes long, and is asked for where it matters.
            square < self.surely
                || square < self.possibly && geometry::hypot(x_m, y_m) < self.reach_m
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use testkit::synthetic::{CAMERA, camera_pose};

    proptest! {
        #[test]
        fn near_is_what_the_distance_says(
            row in 0..CAMERA.height, d in 0.5..20.0_f32, off in prop_oneof![Just(0.0), -1e-15..1e-15, -0.2..0.2_f64],
        ) {
            let pose = camera_pose(0.1, 0.8).inner;
            let view = View::new(&CAMERA, &pose.rotation.to_rotation_matrix());
            let camera_m = pose.translation.vector;
            let distance_m = |col: usize| {
                let x_m = camera_m.x + f64::from(view.x.at(col, row) / d);
                let y_m = camera_m.y + f64::from(view.y.at(col, row) / d);
                geometry::hypot(x_m, y_m)
            };
            // As far as one of the pixels, or nearly so.
            let reach_m = (distance_m(CAMERA.width / 2) + off).max(0.0);
            let near = NearFeet::new(&view, &camera_m, reach_m);
            let line = [d; CAMERA.width];
            for (col, found) in near.along(row, &line).enumerate() {
                prop_assert_eq!(found, distance_m(col) < reach_m);
            }
            let mut kept_px = [0.0; CAMERA.width];
            let count = near.keep(row, &line, &mut kept_px);
            let kept: Vec<bool> = kept_px.iter().map(|kept| *kept == d).collect();
            prop_assert_eq!(&kept, &near.along(row, &line).collect::<Vec<_>>());
            prop_assert_eq!(count, kept.iter().filter(|kept| **kept).count());
        }
    }

    #[test]
    fn what_was_not_seen_is_not_near() {
        let pose = camera_pose(0.0, 0.8).inner;
        let view = View::new(&CAMERA, &pose.rotation.to_rotation_matrix());
        let near = NearFeet::new(&view, &pose.translation.vector, 100.0);
        assert!(near.along(0, &[f32::NAN; 3]).all(|near| !near));
    }
}
