//! The best plane through disparities, in noises, against the best level surface.

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::picture::pixels::Picture;
use crate::picture::view::View;

/// A picture and how it is seen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen<'a> {
    pub(crate) picture: Picture<'a>,
    pub(crate) view: &'a View,
}

impl Seen<'_> {
    /// `X`, `Y`, `g` of a pixel.
    pub(super) fn xyg(&self, at: usize) -> [f32; 3] {
        let (col, row) = (at % self.picture.width, at / self.picture.width);
        let (x, y) = (self.view.x.at(col, row), self.view.y.at(col, row));
        [x, y, self.picture.g[at]]
    }

    /// How far off the plane `d = a X + b Y + q g` a pixel is, in noises; infinite where nothing was seen.
    pub(super) fn miss(&self, at: usize, [a, b, q]: [f32; 3]) -> f32 {
        let [x, y, g] = self.xyg(at);
        let d = self.picture.disparity_px[at];
        let miss = (d - a * x - b * y - q * g) / self.picture.sigma_px[at];
        if miss.is_nan() { f32::INFINITY } else { miss }
    }

    /// How much nearer than a level surface a plane is at a pixel, in noises.
    pub(super) fn apart(&self, at: usize, [a, b, q]: [f32; 3], level_q: f32) -> f32 {
        let [x, y, g] = self.xyg(at);
        (a * x + b * y + (q - level_q) * g) / self.picture.sigma_px[at]
    }

    /// `X`, `Y`, `g` and disparity of a pixel, in noises; none where nothing was seen.
    pub(super) fn terms(&self, at: usize) -> Option<[f64; 4]> {
        let d = self.picture.disparity_px[at];
        let [x, y, g] = self.xyg(at);
        let precision = 1.0 / self.picture.sigma_px[at];
        (!d.is_nan()).then(|| [x, y, g, d].map(|value| f64::from(value * precision)))
    }
}

/// Sums over pixels.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SlopeSums {
    moments: Matrix3<f64>,
    products: Vector3<f64>,
    squares: f64,
}

impl SlopeSums {
    /// Adds a pixel by its [`Seen::terms`].
    pub(super) fn add(&mut self, terms: Option<[f64; 4]>) {
        let Some([x, y, g, d]) = terms else { return };
        let place = Vector3::new(x, y, g);
        self.moments += place * place.transpose();
        self.products += place * d;
        self.squares += d * d;
    }

    /// Adds what others hold.
    pub(super) fn join(&mut self, other: &Self) {
        self.moments += other.moments;
        self.products += other.products;
        self.squares += other.squares;
    }

    /// The plane `(a, b, q)` of least squares.
    pub(super) fn plane(&self) -> Option<Vector3<f64>> {
        let plane = self.moments.try_inverse()? * self.products;
        plane.iter().all(|value| value.is_finite()).then_some(plane)
    }

    /// The best plane of this tilt.
    pub(super) fn tilted(&self, tilt: &Vector2<f64>) -> Option<Vector3<f64>> {
        let direction = Vector3::new(tilt.x, tilt.y, 1.0);
        let q = self.products.dot(&direction) / direction.dot(&(self.moments * direction));
        q.is_finite().then(|| direction * q)
    }

    /// What a plane leaves over, in squared noise of independent pixels; `alike` as in [`independent`].
    pub(super) fn cost(&self, plane: &Vector3<f64>, alike: f64) -> f64 {
        let left = self.squares + plane.dot(&(self.moments * plane - 2.0 * self.products));
        left.max(0.0) / alike
    }

    /// What the best level surface leaves over, in squared noise of independent pixels.
    pub(super) fn level_cost(&self, alike: f64) -> f64 {
        let explained = self.products.z * self.products.z / self.moments[(2, 2)].max(1e-9);
        (self.squares - explained).max(0.0) / alike
    }
}

/// What overlapping windows make of a sum of squares over pixels, in squared noise of independent ones: so many of the pixels are
/// `alike` that they tell as much as one.
pub(super) const fn independent(squares: f64, alike: f64) -> f64 {
    squares / alike
}
