//! Fits over eroded regions: the height of each, and the one tilt that all horizontal regions share.
//!
//! With the camera turned wrong by a small tilt `(a, b)` (the true upward direction is `(a, b, 1)` in the robot's axes as
//! believed), a horizontal surface shows `d = q (g - a X - b Y)`, where `X`, `Y`, `g` are linear in the pixel. One step of
//! Gauss and Newton over all regions, each with its own `q`, gives the tilt.

use nalgebra::{Matrix2, Vector2};

use super::finder::{Picture, Region};
use super::view::View;

/// Every so many columns a pixel is looked at: neighbours tell the same.
const STEP: usize = 2;
/// Matching windows of 5x5 overlap: so many of the pixels looked at tell as much as one independent one.
const SHARED_BY: f64 = 25.0 / STEP as f64;
/// Residuals beyond so many noises are left out.
const OUTLIER: f32 = 3.5;
/// A tilt is there when its squared distance from none, in its own errors, is above this (2 degrees of freedom, 0.1 %).
const SIGNIFICANT: f64 = 13.8;

/// Sums over the pixels of one region; `e` is the residual at the `q` that the sums were made with.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RegionFit {
    // Pixels that took part.
    count: u32,
    q: f64,
    // Sums of the products of any two of: g, the change with the tilt's two components, e. Row up to column, the rest is 0.
    moments: [[f64; 4]; 4],
}

impl RegionFit {
    const fn gg(&self) -> f64 {
        self.moments[0][0]
    }

    const fn ge(&self) -> f64 {
        self.moments[0][3]
    }

    const fn gt(&self) -> Vector2<f64> {
        Vector2::new(self.moments[0][1], self.moments[0][2])
    }

    const fn te(&self) -> Vector2<f64> {
        Vector2::new(self.moments[1][3], self.moments[2][3])
    }

    const fn tt(&self) -> Matrix2<f64> {
        let [_, [_, xx, xy, _], [_, _, yy, _], _] = self.moments;
        Matrix2::new(xx, xy, xy, yy)
    }

    #[inline]
    fn add(&mut self, values: [f64; 4]) {
        self.count += 1;
        for row in 0..4 {
            for col in row..4 {
                self.moments[row][col] += values[row] * values[col];
            }
        }
    }

    /// Adds `count` pixels of a row from a column on, every [`STEP`]-th.
    fn add_run(&mut self, picture: Picture<'_>, view: &View, [col, row]: [usize; 2], count: usize) {
        // Summed up in registers.
        let mut sums = *self;
        let q = sums.q as f32;
        let first = row * picture.width + col;
        let pixels = first..first + (count - 1) * STEP + 1;
        let pictures = picture.disparity_px[pixels.clone()]
            .iter()
            .zip(&picture.g[pixels.clone()])
            .zip(&picture.sigma_px[pixels]);
        for (i, ((&d, &g), &sigma)) in pictures.enumerate().step_by(STEP) {
            let precision = 1.0 / sigma;
            let miss = (d - q * g) * precision;
            // Also false where nothing was seen.
            if miss.abs() < OUTLIER {
                let (x, y) = (view.x.at(col + i, row), view.y.at(col + i, row));
                let values = [g * precision, -q * x * precision, -q * y * precision, miss];
                sums.add(values.map(f64::from));
            }
        }
        *self = sums;
    }

    /// What the region tells of the tilt once its own height is eliminated: information and its product with the tilt.
    fn tilt_equation(&self) -> (Matrix2<f64>, Vector2<f64>) {
        if self.gg() <= 0.0 {
            return (Matrix2::zeros(), Vector2::zeros());
        }
        (
            (self.tt() - self.gt() * self.gt().transpose() / self.gg()) / SHARED_BY,
            (self.te() - self.gt() * (self.ge() / self.gg())) / SHARED_BY,
        )
    }

    /// The region's own tilt, and its squared distance from none in its own errors.
    pub(super) fn own_tilt(&self) -> (Vector2<f64>, f64) {
        let (information, product) = self.tilt_equation();
        // A weak wish for no tilt keeps regions that are a line from giving nonsense.
        let tilt = (information + Matrix2::identity())
            .try_inverse()
            .map_or_else(Vector2::zeros, |inverse| inverse * product);
        (tilt, tilt.dot(&product))
    }

    /// Whether the region may be horizontal when the camera's tilt is known to `limit_rad`.
    pub(super) fn is_level(&self, limit_rad: f64) -> bool {
        let (tilt, certainty) = self.own_tilt();
        certainty < SIGNIFICANT || tilt.norm() < limit_rad
    }

    /// `q` when the camera is tilted by `tilt`.
    pub(super) fn q(&self, tilt: &Vector2<f64>) -> f64 {
        if self.gg() <= 0.0 {
            return self.q;
        }
        self.q + (self.ge() - self.gt().dot(tilt)) / self.gg()
    }

    /// Root mean square residual in noises, at the best `q`.
    pub(super) fn roughness(&self) -> f64 {
        if self.count == 0 || self.gg() <= 0.0 {
            return f64::INFINITY;
        }
        ((self.moments[3][3] - self.ge() * self.ge() / self.gg()).max(0.0) / f64::from(self.count))
            .sqrt()
    }
}

/// Adds up the fit of every region over the pixels that `labels` gives it.
pub(super) fn fit_regions(
    picture: Picture<'_>,
    view: &View,
    regions: &[Region],
    labels: &[u16],
    fits: &mut Vec<RegionFit>,
) {
    fits.clear();
    fits.extend(regions.iter().map(|region| RegionFit {
        q: f64::from(region.q),
        ..RegionFit::default()
    }));
    for (row, line) in labels.chunks_exact(picture.width).enumerate() {
        let mut col = row % STEP;
        while col < line.len() {
            let label = line[col];
            let same = |other: &&u16| **other == label;
            let count = line[col..].iter().step_by(STEP).take_while(same).count();
            if label > 0 {
                fits[usize::from(label) - 1].add_run(picture, view, [col, row], count);
            }
            col += count * STEP;
        }
    }
}

/// The tilt that the level regions share, drawn towards `expected` as far as they leave it open.
pub(super) fn shared_tilt(
    fits: &[RegionFit],
    level_rad: f64,
    expected: &Vector2<f64>,
    expected_sigma_rad: f64,
) -> Vector2<f64> {
    let prior = 1.0 / (expected_sigma_rad * expected_sigma_rad);
    let mut information = Matrix2::identity() * prior;
    let mut product = expected * prior;
    for fit in fits
        .iter()
        .filter(|fit| fit.own_tilt().0.norm() < level_rad)
    {
        let (a, b) = fit.tilt_equation();
        information += a;
        product += b;
    }
    information
        .try_inverse()
        .map_or(*expected, |inverse| inverse * product)
}
