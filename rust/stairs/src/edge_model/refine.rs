//! Gauss and Newton's steps on place, heading and both heights, with large residuals weighed down.

use nalgebra::{Matrix4, Vector4};

use super::excerpt::Excerpt;
use super::window::{WINDOW, Window};

/// Calibrated noise of a disparity, px.
pub(super) const NOISE_PX: f32 = 0.125;
/// Residuals count fully up to this, and not at all beyond that, px.
const HUBER_PX: f32 = 2.0 * NOISE_PX;
const OUTLIER_PX: f32 = 8.0 * NOISE_PX;
/// How well the heights are known before, m.
const HEIGHT_SIGMA_M: f64 = 0.006;

/// The equations of one step, and how large the residuals are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Equations {
    information: Matrix4<f64>,
    product: Vector4<f64>,
    /// Mean size of the residuals, outliers cut off, in the expected noise; 1 when all is as expected.
    pub(super) roughness: f64,
}

impl Equations {
    /// Sums over the chosen pixels of what was seen less what the window shows.
    pub(super) fn sum(excerpt: &Excerpt, window: &Window) -> Self {
        let mut information = [[0.0_f32; 4]; 4];
        let mut product = [0.0_f32; 4];
        let mut size_px = 0.0_f32;
        let [value, rest @ ..] = &window.matched;
        for &at in &excerpt.chosen {
            let at = at as usize;
            let miss = excerpt.observed_px[at] - value[at];
            let size = miss.abs();
            size_px += size.min(OUTLIER_PX);
            if size > OUTLIER_PX {
                continue;
            }
            let weight = if size > HUBER_PX {
                HUBER_PX / size
            } else {
                1.0
            };
            let changes = [rest[0][at], rest[1][at], rest[2][at], rest[3][at]];
            for i in 0..4 {
                let weighted = weight * changes[i];
                product[i] += weighted * miss;
                for j in i..4 {
                    information[i][j] += weighted * changes[j];
                }
            }
        }
        // Windows overlap: all pixels of a window together tell as much as one independent one.
        let thinned = f64::from(excerpt.thinned);
        let share = thinned / (f64::from(NOISE_PX).powi(2) * (WINDOW * WINDOW) as f64);
        let entry = |i: usize, j: usize| f64::from(information[i.min(j)][i.max(j)]) * share;
        Self {
            information: Matrix4::from_fn(entry),
            product: Vector4::from_fn(|i, _| f64::from(product[i]) * share),
            // The mean size of a normal variable is 0.8 of its sigma.
            roughness: f64::from(size_px / NOISE_PX) / (0.798 * excerpt.chosen.len().max(1) as f64),
        }
    }

    /// Adds what is known of the heights: they should change by `heights_m` (near, far).
    pub(super) fn hold_heights(&mut self, heights_m: [f64; 2]) {
        let weight = 1.0 / HEIGHT_SIGMA_M.powi(2);
        for (i, wanted_m) in heights_m.iter().enumerate() {
            self.information[(2 + i, 2 + i)] += weight;
            self.product[2 + i] += weight * wanted_m;
        }
    }

    /// Covariance of place, heading and heights, m and rad.
    pub(super) fn covariance(&self) -> Option<Matrix4<f64>> {
        let covariance = self.information.cholesky()?.inverse();
        covariance
            .iter()
            .all(|v| v.is_finite())
            .then_some(covariance)
    }

    /// The change of place (m), heading (rad), near and far height (m).
    pub(super) fn change(&self) -> Option<Vector4<f64>> {
        let change = self.information.cholesky()?.solve(&self.product);
        change.iter().all(|v| v.is_finite()).then_some(change)
    }
}
