//! A picture under a view: what it has of each pixel, and how far that is off a plane.

use crate::{picture::pixels::Picture, picture::view::View};

/// A picture and how it is seen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenPicture<'a> {
    pub(crate) picture: Picture<'a>,
    pub(crate) view: &'a View,
}

impl SeenPicture<'_> {
    /// What the view has of a pixel: `X`, `Y`, `g`.
    pub(crate) fn xyg(&self, at: usize) -> [f32; 3] {
        let (col, row) = (at % self.picture.width, at / self.picture.width);
        let (x, y) = (self.view.x.at(col, row), self.view.y.at(col, row));
        [x, y, self.picture.g[at]]
    }

    /// How far off the plane `d = a X + b Y + q g` a pixel is, in noises; infinite where nothing was seen.
    pub(crate) fn miss(&self, at: usize, [a, b, q]: [f32; 3]) -> f32 {
        let [x, y, g] = self.xyg(at);
        let d = self.picture.disparity_px[at];
        let miss = (d - a * x - b * y - q * g) / self.picture.sigma_px[at];
        if miss.is_nan() { f32::INFINITY } else { miss }
    }

    /// How much nearer than a level surface a plane is at a pixel, in noises.
    pub(crate) fn apart(&self, at: usize, [a, b, q]: [f32; 3], level_q: f32) -> f32 {
        let [x, y, g] = self.xyg(at);
        (a * x + b * y + (q - level_q) * g) / self.picture.sigma_px[at]
    }

    /// What the view has of a pixel and its disparity, in noises: `X`, `Y`, `g`, `d`; none where nothing was seen.
    pub(crate) fn terms(&self, at: usize) -> Option<[f64; 4]> {
        let d = self.picture.disparity_px[at];
        let [x, y, g] = self.xyg(at);
        let precision = 1.0 / self.picture.sigma_px[at];
        (!d.is_nan()).then(|| [x, y, g, d].map(|value| f64::from(value * precision)))
    }
}
