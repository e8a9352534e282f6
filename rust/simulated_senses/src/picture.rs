//! What the rays of one frame met: the nearest of all bodies wins.

use crate::error::{SceneError, of_length};
use crate::eye::{LocalEye, Triple};
use crate::pinhole::Pinhole;
use crate::view::PixelArea;

/// No body.
pub(crate) const NOTHING: i32 = -1;

/// For each pixel, row by row, the nearest body and how near it is.
#[derive(Debug, Clone)]
pub struct TruePicture {
    width: usize,
    across: Vec<f64>,
    down: Vec<f64>,
    nearness: Vec<f64>,
    body: Vec<i32>,
}

impl TruePicture {
    /// An empty picture of a camera's.
    pub fn new(pinhole: &Pinhole) -> Self {
        Self {
            width: pinhole.width,
            across: pinhole.across(),
            down: pinhole.down(),
            nearness: vec![0.0; pinhole.pixels()],
            body: vec![NOTHING; pinhole.pixels()],
        }
    }

    /// One over the depth along the axis, 1/m; 0 where a ray met nothing.
    pub fn nearness(&self) -> &[f64] {
        &self.nearness
    }

    /// The body that was met, -1 for none.
    pub fn body(&self) -> &[i32] {
        &self.body
    }

    /// Forgets what was met.
    pub(crate) fn clear(&mut self) {
        self.nearness.fill(0.0);
        self.body.fill(NOTHING);
    }

    /// Writes the depth, m, NaN where nothing was met; what is nearer than `nearest_m` is there.
    pub fn write_depth(&self, nearest_m: f64, depth_m: &mut [f64]) {
        for (depth, near) in depth_m.iter_mut().zip(&self.nearness) {
            let there = 1.0 / near;
            let there = if there < nearest_m { nearest_m } else { there };
            *depth = if *near > 0.0 { there } else { f64::NAN };
        }
    }

    /// Takes depths, m, from elsewhere: NaN or a body of -1 is nothing.
    pub fn read(&mut self, depth_m: &[f64], body: &[i32]) -> Result<(), SceneError> {
        self.clear();
        self.merge(depth_m, body)
    }

    /// Lets bodies that were cast elsewhere cover what is farther than they: depths, m, and which body.
    pub fn merge(&mut self, depth_m: &[f64], body: &[i32]) -> Result<(), SceneError> {
        of_length("depth", depth_m.len(), self.body.len())?;
        of_length("geom", body.len(), self.body.len())?;
        let seen = self.nearness.iter_mut().zip(&mut self.body);
        for ((near, here), (depth, other)) in seen.zip(depth_m.iter().zip(body)) {
            let nearness = 1.0 / depth;
            if *other != NOTHING && nearness > *near {
                *near = nearness;
                *here = *other;
            }
        }
        Ok(())
    }

    /// Draws a body: `met` is told a pixel's ray in the body's frame and what is nearest so far, and says how near the body is there;
    /// what is no more than 0, or no number, is not met.
    #[inline]
    pub(crate) fn paint(
        &mut self,
        area: &PixelArea,
        eye: &LocalEye,
        body: i32,
        met: impl Fn(Triple, f64) -> f64,
    ) {
        let across = &self.across[area.columns.clone()];
        for row in area.rows.clone() {
            let y = self.down[row];
            let [base_x, base_y, base_z] = [0, 1, 2].map(|i| eye.ahead[i] + y * eye.down[i]);
            let begin = row * self.width;
            let pixels = begin + area.columns.start..begin + area.columns.end;
            let nearness = &mut self.nearness[pixels.clone()];
            let bodies = &mut self.body[pixels];
            for ((near, here), x) in nearness.iter_mut().zip(bodies).zip(across) {
                let ray = [
                    base_x + x * eye.across[0],
                    base_y + x * eye.across[1],
                    base_z + x * eye.across[2],
                ];
                let nearness = met(ray, *near);
                let covers = nearness > *near;
                *near = if covers { nearness } else { *near };
                *here = if covers { body } else { *here };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_body_covers_the_farther_one_whatever_the_order() {
        let pinhole = Pinhole::new(2, 1, 1.0).unwrap();
        let mut picture = TruePicture::new(&pinhole);
        picture.read(&[2.0, f64::NAN], &[4, 4]).unwrap();
        picture.merge(&[3.0, 1.0], &[5, 5]).unwrap();
        assert_eq!(picture.body(), [4, 5]);
        picture.merge(&[1.0, 0.5], &[6, -1]).unwrap();
        assert_eq!(picture.body(), [6, 5]);
        let mut depth = [0.0; 2];
        picture.write_depth(1e-6, &mut depth);
        assert_eq!(depth, [1.0, 1.0]);
    }

    #[test]
    fn nothing_met_is_no_number_and_what_touches_the_lens_is_as_near_as_can_be() {
        let pinhole = Pinhole::new(2, 1, 1.0).unwrap();
        let mut picture = TruePicture::new(&pinhole);
        picture.read(&[f64::NAN, 0.0], &[-1, 0]).unwrap();
        let mut depth = [0.0; 2];
        picture.write_depth(1e-6, &mut depth);
        assert!(depth[0].is_nan());
        assert_eq!(depth[1], 1e-6);
        assert!(picture.read(&[1.0], &[0]).is_err());
    }
}
