//! A camera without distortion and with square pixels.

use crate::error::SceneError;

/// Size and focal length of a camera: pixel centres are at integers, the axis goes through the picture's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pinhole {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Focal length in pixels.
    pub focal_px: f64,
}

impl Pinhole {
    /// Refuses a camera that cannot be built.
    pub fn new(width: usize, height: usize, focal_px: f64) -> Result<Self, SceneError> {
        if width == 0 || height == 0 || !focal_px.is_finite() || focal_px <= 0.0 {
            return Err(SceneError::Camera);
        }
        Ok(Self {
            width,
            height,
            focal_px,
        })
    }

    /// Number of pixels.
    pub const fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// The column that the axis goes through.
    pub(crate) const fn middle_column(&self) -> f64 {
        (self.width - 1) as f64 / 2.0
    }

    /// The row that the axis goes through.
    pub(crate) const fn middle_row(&self) -> f64 {
        (self.height - 1) as f64 / 2.0
    }

    /// What the rays of each column have to the right for a metre ahead.
    pub(crate) fn across(&self) -> Vec<f64> {
        let middle = self.middle_column();
        let columns = 0..self.width;
        columns
            .map(|column| (column as f64 - middle) / self.focal_px)
            .collect()
    }

    /// What the rays of each row have downwards for a metre ahead.
    pub(crate) fn down(&self) -> Vec<f64> {
        let middle = self.middle_row();
        let rows = 0..self.height;
        rows.map(|row| (row as f64 - middle) / self.focal_px)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_goes_through_the_pictures_middle() {
        let pinhole = Pinhole::new(88, 72, 100.0).unwrap();
        assert_eq!(pinhole.across()[43], -0.005);
        assert_eq!(pinhole.across()[44], 0.005);
        assert_eq!(pinhole.down()[71], 0.355);
    }

    #[test]
    fn a_camera_without_pixels_or_without_a_focal_length_is_refused() {
        for (width, height, focal_px) in [(0, 72, 1.0), (88, 0, 1.0), (88, 72, 0.0)] {
            assert_eq!(
                Pinhole::new(width, height, focal_px),
                Err(SceneError::Camera)
            );
        }
        assert!(Pinhole::new(1, 1, f64::NAN).is_err());
    }
}
