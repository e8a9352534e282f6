//! A first look: the best of a grid of places and headings, without what the matching window does.

use super::excerpt::Excerpt;
use super::sight::{CameraSight, StepModel, first_met};

use crate::CoarseTuning;

/// Samples that are worked on at once: as many as a vector of the processor holds. It tells in which order they are summed.
const LANES: usize = 4;

/// Samples of the excerpt, one quantity a list.
#[derive(Debug, Clone, Default)]
pub(super) struct Coarse {
    near_px: Vec<f32>,
    far_px: Vec<f32>,
    x: Vec<f32>,
    y: Vec<f32>,
    observed_px: Vec<f32>,
}

impl Coarse {
    pub(super) fn with_room(tuning: &CoarseTuning) -> Self {
        let list = || Vec::with_capacity(2 * tuning.samples);
        Self {
            near_px: list(),
            far_px: list(),
            x: list(),
            y: list(),
            observed_px: list(),
        }
    }

    /// The step of the grid around `guess` that explains the chosen pixels best; `None` when there are too few.
    pub(super) fn search(
        &mut self,
        excerpt: &Excerpt,
        sight: &CameraSight,
        guess: &StepModel,
        tuning: &CoarseTuning,
    ) -> Option<StepModel> {
        self.sample(excerpt, sight, guess, tuning)?;
        let CoarseTuning {
            places,
            place_step,
            headings,
            heading_step,
            largest,
            ..
        } = *tuning;
        let mut best: Option<(f32, StepModel)> = None;
        for i in -headings..=headings {
            for j in -places..=places {
                let step = StepModel {
                    place_m: guess.place_m + f64::from(j) * place_step,
                    heading_rad: guess.heading_rad + f64::from(i) * heading_step,
                    ..*guess
                };
                let ahead_m = -step.beyond_m(&sight.position_m.xy());
                if ahead_m < sight.clear_m {
                    continue;
                }
                let cost = self.cost(&step, ahead_m, largest);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, step));
                }
            }
        }
        best.map(|(_, step)| step)
    }

    fn sample(
        &mut self,
        excerpt: &Excerpt,
        sight: &CameraSight,
        guess: &StepModel,
        tuning: &CoarseTuning,
    ) -> Option<()> {
        let faces = guess.faces(sight)?;
        for list in [
            &mut self.near_px,
            &mut self.far_px,
            &mut self.x,
            &mut self.y,
            &mut self.observed_px,
        ] {
            list.clear();
        }
        if excerpt.chosen.len() < tuning.fewest {
            return None;
        }
        // An odd stride that shares no factor with usual widths spreads the samples over rows and columns.
        let stride = excerpt.chosen.len().div_ceil(tuning.samples);
        for pixel in excerpt.chosen.iter().step_by(stride) {
            let (col, row) = (pixel.col, pixel.row);
            self.near_px.push(faces.near.at(col, row) as f32);
            self.far_px.push(faces.far.at(col, row) as f32);
            self.x.push(sight.x.at(col, row) as f32);
            self.y.push(sight.y.at(col, row) as f32);
            self.observed_px.push(pixel.observed_px);
        }
        // Whole lanes: a pixel that shows what it should adds nothing.
        let lacking = self.x.len().next_multiple_of(LANES) - self.x.len();
        for list in [
            &mut self.near_px,
            &mut self.far_px,
            &mut self.x,
            &mut self.y,
            &mut self.observed_px,
        ] {
            list.resize(list.len() + lacking, 0.0);
        }
        Some(())
    }

    /// Sum of the squared residuals, each of no more than `largest_px`.
    fn cost(&self, step: &StepModel, ahead_m: f64, largest_px: f32) -> f32 {
        let normal = step.normal() / ahead_m;
        let (nx, ny) = (normal.x as f32, normal.y as f32);
        let is_rising = step.far_height_m > step.near_height_m;
        let mut sums = [0.0_f32; LANES];
        let surfaces = self
            .near_px
            .chunks_exact(LANES)
            .zip(self.far_px.chunks_exact(LANES));
        let rays = self.x.chunks_exact(LANES).zip(self.y.chunks_exact(LANES));
        let observed = self.observed_px.chunks_exact(LANES);
        for (((near, far), (x, y)), observed) in surfaces.zip(rays).zip(observed) {
            for (lane, sum) in sums.iter_mut().enumerate() {
                let riser = nx * x[lane] + ny * y[lane];
                let seen = first_met(is_rising, near[lane], far[lane], riser);
                let miss = (observed[lane] - seen).abs();
                let miss = if miss < largest_px { miss } else { largest_px };
                *sum += miss * miss;
            }
        }
        sums.iter().sum()
    }
}
