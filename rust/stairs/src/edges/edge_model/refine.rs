//! Gauss and Newton's steps on place, heading and both heights, with large residuals weighed down.

use nalgebra::{Matrix4, Vector4};

use super::excerpt::Excerpt;
use super::lot::PIXELS;
use super::sight::{CameraSight, PixelLinear, StepFaces, StepModel};
use super::window::Matcher;

use crate::EdgeModelTuning;

/// Mean size of a normal variable, in its sigma.
const MEAN_SIZE: f64 = 0.798;

/// The equations of one step, and how large the residuals are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Equations {
    information: Matrix4<f64>,
    product: Vector4<f64>,
    /// Mean size of the residuals, outliers cut off, in the expected noise; 1 when all is as expected.
    pub(super) roughness: f64,
}

/// What a step shows, and what its neighbours in place and heading do.
struct Model {
    faces: StepFaces,
    matcher: Matcher,
    /// A little farther, a little nearer; turned a little left, a little right.
    around: [Matcher; 4],
    /// How much farther and nearer, m, and how far turned, rad.
    trial: (f64, f64),
}

impl Model {
    fn new(sight: &CameraSight, step: &StepModel, tuning: &EdgeModelTuning) -> Option<Self> {
        let trial = (tuning.refine.trial_place, tuning.refine.trial_heading);
        let window = &tuning.window;
        let moved = |place_m: f64, turn_rad: f64| {
            let moved = StepModel {
                place_m: step.place_m + place_m,
                heading_rad: step.heading_rad + turn_rad,
                ..*step
            };
            moved.faces(sight).map(|faces| Matcher::new(&faces, window))
        };
        let faces = step.faces(sight)?;
        Some(Self {
            matcher: Matcher::new(&faces, window),
            faces,
            around: [
                moved(trial.0, 0.0)?,
                moved(-trial.0, 0.0)?,
                moved(0.0, trial.1)?,
                moved(0.0, -trial.1)?,
            ],
            trial,
        })
    }

    /// Disparity at a pixel, px, and its change with place, heading, near and far height.
    fn show(&self, col: f64, row: f64) -> (f32, [f32; 4]) {
        let (c, r) = (col as f32, row as f32);
        let seen = self.matcher.look(c, r);
        let [near, far, riser] = seen.by_face;
        let faces = &self.faces;
        let part = |share: f32, change: &PixelLinear| {
            if share == 0.0 {
                0.0
            } else {
                share * change.at(col, row) as f32
            }
        };
        let (mut by_place, mut by_heading) = (
            part(riser, &faces.riser_by_place),
            part(riser, &faces.riser_by_heading),
        );
        if seen.jumps && !faces.rising {
            // The window takes one side or the other: what changes shows in finite steps only.
            let there = self.around.each_ref().map(|other| other.value_px(c, r));
            by_place = (there[0] - there[1]) / (2.0 * self.trial.0 as f32);
            by_heading = (there[2] - there[3]) / (2.0 * self.trial.1 as f32);
        }
        let changes = [
            by_place,
            by_heading,
            part(near, &faces.near_by_height),
            part(far, &faces.far_by_height),
        ];
        (seen.value_px, changes)
    }
}

impl Equations {
    /// Sums over the chosen pixels of what was seen less what the step shows; `None` when the camera is on no side of
    /// the edge from which it could be seen.
    pub(super) fn sum(
        excerpt: &Excerpt,
        sight: &CameraSight,
        step: &StepModel,
        tuning: &EdgeModelTuning,
    ) -> Option<Self> {
        let noise_px = tuning.refine.noise;
        let huber_px = tuning.refine.huber * noise_px;
        let outlier_px = tuning.refine.outlier * noise_px;
        let model = Model::new(sight, step, tuning)?;
        let mut information = [[0.0_f32; 4]; 4];
        let mut product = [0.0_f32; 4];
        let mut size_px = 0.0_f32;
        for pixel in &excerpt.chosen {
            let (value_px, changes) = model.show(pixel.col, pixel.row);
            let miss = pixel.observed_px - value_px;
            let size = miss.abs();
            size_px += size.min(outlier_px);
            if size > outlier_px {
                continue;
            }
            let weight = if size > huber_px {
                huber_px / size
            } else {
                1.0
            };
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
        let share = thinned / (f64::from(noise_px).powi(2) * PIXELS as f64);
        let entry = |i: usize, j: usize| f64::from(information[i.min(j)][i.max(j)]) * share;
        Some(Self {
            information: Matrix4::from_fn(entry),
            product: Vector4::from_fn(|i, _| f64::from(product[i]) * share),
            roughness: f64::from(size_px / noise_px)
                / (MEAN_SIZE * excerpt.chosen.len().max(1) as f64),
        })
    }

    /// Adds what is known of the heights: they should change by `heights_m` (near, far), which are known to `sigma_m`.
    pub(super) fn hold_heights(&mut self, heights_m: [f64; 2], sigma_m: f64) {
        let weight = 1.0 / sigma_m.powi(2);
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
