//! What a frame that is a picture shows of places above the floor.

use segmentation::Planes;
use volume::Picture;

use super::OverheadTuning;

/// The picture that a frame is.
pub(super) struct InView<'a> {
    pub(super) planes: &'a Planes,
    pub(super) picture: Picture,
    pub(super) eye_m: [f64; 3],
    /// Of the camera in the robot's frame: where it is, and its axis.
    pub(super) robot_eye_m: [f64; 3],
    pub(super) robot_axis: [f64; 3],
}

impl InView<'_> {
    /// How deep the camera saw in a pixel, m; NaN where it saw nothing.
    fn depth_m(&self, pixel: usize) -> f64 {
        let Some(point) = self.planes.points_in_robot_m.get(pixel) else {
            return f64::NAN;
        };
        (0..3)
            .map(|axis| (f64::from(point[axis]) - self.robot_eye_m[axis]) * self.robot_axis[axis])
            .sum()
    }

    /// A column of places above each other, from the eye along the picture's axes at the height of the eye, m.
    pub(super) fn column(&self, [x_m, y_m]: [f64; 2]) -> [f64; 3] {
        let (dx_m, dy_m) = (x_m - self.eye_m[0], y_m - self.eye_m[1]);
        std::array::from_fn(|axis| {
            let axis = &self.picture.axes[axis];
            axis[0] * dx_m + axis[1] * dy_m
        })
    }

    /// Whether a column, up and down to `reach_m` from the eye's height, may have a place in the picture.
    pub(super) fn may_see(&self, column: &[f64; 3], reach_m: f64, config: &OverheadTuning) -> bool {
        let picture = &self.picture;
        let sways_m = |axis: usize| reach_m * picture.axes[axis][2].abs();
        let deepest_m = column[2] + sways_m(2);
        let aside = |to_px: f64| to_px / picture.focal_px[0] * deepest_m;
        let (left_m, right_m) = (
            aside(-picture.centre_px[0]),
            aside(picture.size_px[0] as f64 - 1.0 - picture.centre_px[0]),
        );
        deepest_m >= config.blind_range
            && column[2] - sways_m(2) <= config.empty_range
            && column[0] + sways_m(0) >= left_m
            && column[0] - sways_m(0) <= right_m
    }

    /// Whether the line of sight to the place of a column at a height goes through it, and on.
    pub(super) fn goes_through(
        &self,
        column: &[f64; 3],
        height_m: f64,
        behind_m: f64,
        config: &OverheadTuning,
    ) -> bool {
        let picture = &self.picture;
        let above_m = height_m - self.eye_m[2];
        let along = |axis: usize| column[axis] + above_m * picture.axes[axis][2];
        let depth_m = along(2);
        if depth_m < config.blind_range || depth_m > config.empty_range {
            return false;
        }
        let place =
            |axis: usize| picture.centre_px[axis] + picture.focal_px[axis] * along(axis) / depth_m;
        let [width, height] = picture.size_px;
        let inside = |at: f64, size: usize| {
            let border = config.beside as f64;
            (at >= border && at + border <= size as f64 - 1.0).then(|| at.round() as usize)
        };
        let (Some(col), Some(row)) = (inside(place(0), width), inside(place(1), height)) else {
            return false;
        };
        let deeper_m = depth_m + behind_m;
        let seen_m = self.depth_m(row * width + col);
        if !seen_m.is_nan() {
            return seen_m > deeper_m;
        }
        // A pixel here and there has no depth for no reason; those around it tell.
        let reach = config.beside;
        let rows = row.saturating_sub(reach)..=(row + reach).min(height - 1);
        rows.flat_map(|row| {
            let cols = col.saturating_sub(reach)..=(col + reach).min(width - 1);
            cols.map(move |col| row * width + col)
        })
        .all(|pixel| {
            let seen_m = self.depth_m(pixel);
            seen_m.is_nan() || seen_m > deeper_m
        })
    }
}
