//! A patch of pixels, its plane of least squares, and how many nats it costs to describe it by that.

use nalgebra::{Vector2, Vector3};

use super::config::ScanLineAdaptiveConfig;

/// What keeps the plane of a patch that is a line finite, pixels^2.
const RIDGE: f64 = 1e-6;

/// The smallest and the largest noise that is believed, px.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NoiseRange {
    pub(super) least_px: f64,
    pub(super) most_px: f64,
}

/// What pieces are cut and joined by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rules<'a> {
    pub(super) config: &'a ScanLineAdaptiveConfig,
    pub(super) noise: NoiseRange,
    /// Smallest region, and the smallest patch that tells whether it lies on the plane of another, pixels.
    pub(super) min_region: f64,
}

/// Sums over pixels: of one, of column, row and disparity, and of the products of any two of these.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct PlanePatch {
    n: f64,
    x: f64,
    y: f64,
    d: f64,
    xx: f64,
    xy: f64,
    yy: f64,
    xd: f64,
    yd: f64,
    dd: f64,
}

impl PlanePatch {
    /// Adds a pixel.
    pub(super) fn add(&mut self, col: usize, row: usize, d: f32) {
        let (x, y, d) = (col as f64, row as f64, f64::from(d));
        *self = self.with(
            &Self {
                n: 1.0,
                x,
                y,
                d,
                xx: x * x,
                xy: x * y,
                yy: y * y,
                xd: x * d,
                yd: y * d,
                dd: d * d,
            },
            1.0,
        );
    }

    /// Both together.
    pub(super) fn and(&self, other: &Self) -> Self {
        self.with(other, 1.0)
    }

    /// What is in this one and not in `part`, which is a part of it.
    pub(super) fn without(&self, part: &Self) -> Self {
        self.with(part, -1.0)
    }

    fn with(&self, o: &Self, times: f64) -> Self {
        Self {
            n: self.n + times * o.n,
            x: self.x + times * o.x,
            y: self.y + times * o.y,
            d: self.d + times * o.d,
            xx: self.xx + times * o.xx,
            xy: self.xy + times * o.xy,
            yy: self.yy + times * o.yy,
            xd: self.xd + times * o.xd,
            yd: self.yd + times * o.yd,
            dd: self.dd + times * o.dd,
        }
    }

    /// Pixels.
    pub(super) const fn count(&self) -> f64 {
        self.n
    }

    /// Change of the plane of least squares per column and per row, and the sum of squares that it leaves, px^2.
    fn fit(&self) -> (Vector2<f64>, f64) {
        let n = self.n.max(f64::MIN_POSITIVE);
        let xx = self.xx - self.x * self.x / n + RIDGE * n;
        let xy = self.xy - self.x * self.y / n;
        let yy = self.yy - self.y * self.y / n + RIDGE * n;
        let xd = self.xd - self.x * self.d / n;
        let yd = self.yd - self.y * self.d / n;
        let dd = self.dd - self.d * self.d / n;
        let scale = 1.0 / (xx * yy - xy * xy);
        let slope = Vector2::new((yy * xd - xy * yd) * scale, (xx * yd - xy * xd) * scale);
        (slope, (dd - slope.x * xd - slope.y * yd).max(0.0))
    }

    /// The plane of least squares: disparity per column, per row, and at column 0, row 0.
    pub(super) fn plane(&self) -> Vector3<f64> {
        let (slope, _) = self.fit();
        let n = self.n.max(f64::MIN_POSITIVE);
        let origin = (self.d - slope.x * self.x - slope.y * self.y) / n;
        Vector3::new(slope.x, slope.y, origin)
    }

    /// The scatter around that plane, px, within what is believed.
    pub(super) fn scatter_px(&self, noise: NoiseRange) -> f64 {
        let (_, squares) = self.fit();
        let scatter_px = (squares / self.n.max(1.0)).sqrt();
        scatter_px.clamp(noise.least_px, noise.most_px)
    }

    /// How much less likely both patches are under one plane than under two, each with its own noise: twice the logarithm.
    pub(super) fn disagreement(&self, other: &Self, noise: NoiseRange) -> f64 {
        let [one, two] = [self, other].map(|patch| {
            let precision = patch.scatter_px(noise).powi(-2);
            Self::default().with(patch, precision)
        });
        one.and(&two).fit().1 - one.fit().1 - two.fit().1
    }

    /// Twice the negative logarithm of the likelihood under that plane with a normal error. Its sigma is the scatter, within what
    /// is believed: the noise follows what is seen.
    pub(super) fn cost(&self, noise: NoiseRange) -> f64 {
        let (_, squares) = self.fit();
        let variance =
            (squares / self.n.max(1.0)).clamp(noise.least_px.powi(2), noise.most_px.powi(2));
        self.n * variance.ln() + squares / variance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use testkit::synthetic::Noise;

    const ANY: NoiseRange = NoiseRange {
        least_px: 1e-3,
        most_px: 10.0,
    };

    fn patch(plane: [f64; 3], sigma_px: f64, seed: u64) -> PlanePatch {
        let (mut noise, mut patch) = (Noise::new(seed), PlanePatch::default());
        for (col, row) in (0..12).flat_map(|col| (3..40).map(move |row| (col, row))) {
            let d = plane[0] * col as f64 + plane[1] * row as f64 + plane[2];
            // Even within as much as gives this sigma.
            let error = noise.within(sigma_px * 3.0_f64.sqrt());
            patch.add(col, row, (d + error) as f32);
        }
        patch
    }

    proptest! {
        #[test]
        fn the_plane_is_found_and_its_scatter_is_the_noise(
            a in -0.5..0.5f64, b in -0.5..0.5f64, c in 2.0..20.0f64, sigma in 0.01..0.3f64, seed in 0..99u64,
        ) {
            let patch = patch([a, b, c], sigma, seed);
            let found = patch.plane();
            prop_assert!((found - Vector3::new(a, b, c)).xy().norm() < 0.1 * sigma);
            prop_assert!((patch.scatter_px(ANY) / sigma - 1.0).abs() < 0.15);
        }

        #[test]
        fn two_patches_cost_no_more_than_both_as_one(
            step in -1.0..1.0f64, first in 0.01..0.3f64, second in 0.01..0.3f64,
        ) {
            let a = patch([0.1, 0.2, 5.0], first, 1);
            let b = patch([0.1, 0.2, 5.0 + step], second, 2);
            let both = a.and(&b);
            prop_assert!(both.cost(ANY) > a.cost(ANY) + b.cost(ANY) - 1e-6);
            prop_assert!((both.without(&b).cost(ANY) - a.cost(ANY)).abs() < 1e-3);
        }
    }
}
