//! Range sensors of anyone's: what they see becomes points in the sensor's frame, whichever kind they are.

use crate::Intrinsics;

/// A pinhole camera without distortion; pixel centres at integer coordinates. The frame is optical: x right, y down, z forward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinholeCamera {
    /// Columns and rows, pixels.
    pub size_px: [usize; 2],
    /// Focal length along columns and rows, pixels.
    pub focal_px: [f64; 2],
    /// Column and row of the optical axis, pixels.
    pub centre_px: [f64; 2],
}

/// What is known of how a sensor's points lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RangeSensor {
    /// Depths along the optical axis, row by row.
    Picture(PinholeCamera),
    /// Points of lines that a laser draws, by its angle. All are seen from the frame's origin.
    ScanLines,
    /// Points in no order, all seen from the frame's origin.
    Cloud,
}

impl PinholeCamera {
    /// The points of depths, m along the axis, row by row; NaN where a depth is not positive and finite.
    pub fn points<'a>(
        &'a self,
        depths_m: impl Iterator<Item = f32> + 'a,
    ) -> impl Iterator<Item = [f32; 3]> + 'a {
        let [width, height] = self.size_px;
        let places = (0..height).flat_map(move |row| (0..width).map(move |col| (col, row)));
        let ([fx, fy], [cx, cy]) = (self.focal_px, self.centre_px);
        depths_m.zip(places).map(move |(depth_m, (col, row))| {
            if depth_m > 0.0 && depth_m.is_finite() {
                let depth = f64::from(depth_m);
                let [x, y] = [(col as f64 - cx) / fx, (row as f64 - cy) / fy];
                [(x * depth) as f32, (y * depth) as f32, depth_m]
            } else {
                [f32::NAN; 3]
            }
        })
    }

    /// The camera of square pixels with its axis in the middle that has the same eye, as segmenters need it.
    pub const fn centred(&self, baseline_m: f64) -> Intrinsics {
        Intrinsics {
            width: self.size_px[0],
            height: self.size_px[1],
            focal_px: self.focal_px[0],
            baseline_m,
        }
    }

    /// For each pixel of the [`Self::centred`] camera the number of the pixel here that looks the same way; none beyond the picture. A depth
    /// along the axis is the same in both.
    pub fn centred_pixels(&self) -> Vec<Option<u32>> {
        let camera = self.centred(1.0);
        let [width, height] = self.size_px;
        let there = |at: usize, axis: usize, middle: f64| {
            let along = (at as f64 - middle) / camera.focal_px;
            let found = (self.centre_px[axis] + self.focal_px[axis] * along).round();
            (found >= 0.0 && found < self.size_px[axis] as f64).then_some(found as usize)
        };
        let (cx, cy) = camera.principal_point_px();
        let rows = (0..height).flat_map(|row| (0..width).map(move |col| (col, row)));
        rows.map(|(col, row)| {
            let (col, row) = (there(col, 0, cx)?, there(row, 1, cy)?);
            Some((row * width + col) as u32)
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_centred_camera_sees_the_same_places_to_half_a_pixel(
            focal in prop::array::uniform2(30.0..60.0f64), off in prop::array::uniform2(-4.0..4.0f64), slope in -0.2..0.2f64,
        ) {
            let camera = PinholeCamera {
                size_px: [32, 24],
                focal_px: focal,
                centre_px: [15.5 + off[0], 11.5 + off[1]],
            };
            let depths: Vec<f32> = (0..32 * 24).map(|i| (1.0 + slope * f64::from(i % 32) / 32.0) as f32).collect();
            let points: Vec<_> = camera.points(depths.iter().copied()).collect();
            let centred = camera.centred(0.1);
            let mut seen = 0;
            for (index, from) in camera.centred_pixels().into_iter().enumerate() {
                let Some(from) = from else { continue };
                let point = points[from as usize].map(f64::from);
                let ray = centred.ray(index % 32, index / 32);
                prop_assert!((point[0] / point[2] - ray[0]).abs() <= 0.5 / focal[0] + 1e-6);
                prop_assert!((point[1] / point[2] - ray[1]).abs() <= 0.5 / focal[1] + 1e-6);
                seen += 1;
            }
            prop_assert!(seen > 300);
        }
    }

    #[test]
    fn what_was_not_seen_has_no_point() {
        let camera = PinholeCamera {
            size_px: [4, 1],
            focal_px: [2.0, 3.0],
            centre_px: [1.0, 0.0],
        };
        let depths = [2.0, f32::NAN, 0.0, f32::INFINITY];
        let points: Vec<_> = camera.points(depths.into_iter()).collect();
        assert_eq!(points[0], [-1.0, 0.0, 2.0]);
        assert!(points[1..].iter().flatten().all(|at| at.is_nan()));
    }
}
