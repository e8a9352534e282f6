//! A short slope where a step is looked for: what lies between two levels may be spread over more than a riser is.
//!
//! Both are fitted to the same disparities, the upright face and slopes of several lengths, each with its own place and levels, and what
//! is told is by how much the best slope explains the picture better. What the matching window makes of an upright face is in both.

mod faces;
#[cfg(test)]
mod tests;

use geometry::Robot;
use nalgebra::{Matrix3, Vector3};
use segmentation::Planes;
use sensing::Scan;

use super::excerpt::stretch_in_view;
use super::lot::PIXELS;
use super::onto_step;
use super::sight::{CameraSight, StepModel};
use crate::{BevelTuning, Edge, EdgeModelTuning};
use faces::{Faces, RiseForm};

/// What a frame says of a change of height.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FittedBevel {
    /// The middle of the slope that explains it best.
    pub(crate) middle: Edge<Robot>,
    /// How far that slope takes from level to level, m.
    pub(crate) run_m: f64,
    /// By how much it explains the picture better than an upright face does, or two with a tread between, in squared noise; negative where it
    /// does so worse.
    pub(crate) better: f64,
}

/// Fits slopes where an edge is. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct BevelModel {
    pixels: Vec<[f64; 3]>,
    misses: Vec<f64>,
}

impl BevelModel {
    /// What a frame says of the change of height at `guess` from one level to another (robot frame, m), of which nothing else changes within
    /// `room_m` before and behind; `None` where it says nothing.
    pub(crate) fn fit(
        &mut self,
        (scan, planes): (&Scan, &Planes),
        guess: &Edge<Robot>,
        heights_m: [f64; 2],
        room_m: [f64; 2],
        tuning: &EdgeModelTuning,
    ) -> Option<FittedBevel> {
        let (rules, camera) = (&tuning.bevels, &scan.camera);
        let rise_m = (heights_m[1] - heights_m[0]).abs();
        if rise_m < rules.least_rise {
            return None;
        }
        let sight = CameraSight::new(camera, &planes.robot_from_camera, tuning.camera_clear);
        let highest_m = heights_m[0].max(heights_m[1]);
        let stretch = stretch_in_view(camera, planes, guess, highest_m, &tuning.excerpt).ok()?;
        let start = StepModel {
            anchor_m: stretch.middle_m,
            place_m: 0.0,
            heading_rad: guess.heading_rad(),
            near_height_m: heights_m[0],
            far_height_m: heights_m[1],
        };
        let room_m = room_m.map(|room_m| room_m.min(rules.around));
        let thinned = self.choose(scan, &sight, &start, (stretch.half_m, room_m), tuning)?;
        let (upright, _) = self.settle(&sight, &start, RiseForm::Riser, rules)?;
        let widest_m = 2.0 * room_m[0].min(room_m[1]) - rules.level_beside;
        let runs_m = || {
            let runs_m = (0..rules.runs).map(|at| rules.shortest + rules.run_step * at as f64);
            runs_m.take_while(move |&run_m| run_m <= widest_m)
        };
        let slopes_m = runs_m().filter(|run_m| rise_m <= rules.steepest * run_m);
        let (step, run_m) = self.best(&sight, &start, (slopes_m, RiseForm::Slope), rules)?;
        let slope = RiseForm::Slope(run_m);
        let noise_px = self.noise_px(&sight, &step, slope, rules)?;
        let most = rules.outlier * noise_px;
        let bevel = self.cost(&sight, &step, slope, most)?;
        let mut riser = self.cost(&sight, &upright, RiseForm::Riser, most)?;
        if bevel < riser
            && rise_m >= 2.0 * rules.step
            && let Some((step, deep_m)) =
                self.best(&sight, &start, (runs_m(), RiseForm::Tread), rules)
            && let Some(flight) = self.cost(&sight, &step, RiseForm::Tread(deep_m), most)
        {
            riser = riser.min(flight);
        }
        let alike = (PIXELS as f64 / thinned as f64).max(1.0);
        Some(FittedBevel {
            middle: onto_step(guess, &stretch, &step),
            run_m,
            better: (riser - bevel) / (noise_px.powi(2) * alike),
        })
    }

    /// Takes the pixels around the edge; every so many of them, which it returns.
    fn choose(
        &mut self,
        scan: &Scan,
        sight: &CameraSight,
        step: &StepModel,
        (half_m, room_m): (f64, [f64; 2]),
        tuning: &EdgeModelTuning,
    ) -> Option<usize> {
        let rules = &tuning.bevels;
        let faces = Faces::new(sight, step, RiseForm::Riser)?;
        let (across, along) = (sight.along(&step.normal()), sight.along(&step.along()));
        let camera = sight.position_m.xy();
        let ahead_m = -step.beyond_m(&camera);
        let aside_m = step.along().dot(&(camera - step.anchor_m));
        self.pixels.clear();
        let width = scan.camera.width;
        for (at, &seen_px) in scan.disparity_px.iter().enumerate() {
            let (col, row) = ((at % width) as f64, (at / width) as f64);
            let (near, far) = (faces.near.at(col, row), faces.far.at(col, row));
            if seen_px.is_nan()
                || seen_px <= 0.0
                || near.min(far) < f64::from(tuning.excerpt.least_disparity)
            {
                continue;
            }
            let from_m = across.at(col, row) / near - ahead_m;
            let to_m = across.at(col, row) / far - ahead_m;
            let beside_m = aside_m + along.at(col, row) / near;
            if from_m > -room_m[0] && to_m < room_m[1] && beside_m.abs() < half_m {
                self.pixels.push([col, row, f64::from(seen_px)]);
            }
        }
        if self.pixels.len() < rules.fewest {
            return None;
        }
        let thinned = self.pixels.len().div_ceil(rules.samples);
        let mut at = 0;
        self.pixels.retain(|_| {
            at += 1;
            (at - 1) % thinned == 0
        });
        Some(thinned)
    }

    /// What of these lengths, m, explains the pixels best between the levels, and with which place and levels.
    fn best(
        &mut self,
        sight: &CameraSight,
        start: &StepModel,
        (lengths_m, form): (impl Iterator<Item = f64>, fn(f64) -> RiseForm),
        rules: &BevelTuning,
    ) -> Option<(StepModel, f64)> {
        let mut best: Option<(StepModel, f64, f64)> = None;
        for length_m in lengths_m {
            if let Some((step, cost)) = self.settle(sight, start, form(length_m), rules)
                && best.is_none_or(|(_, _, least)| cost < least)
            {
                best = Some((step, length_m, cost));
            }
        }
        best.map(|(step, length_m, _)| (step, length_m))
    }

    /// The place and levels with which what is between them explains the pixels best, and how badly it does so.
    fn settle(
        &mut self,
        sight: &CameraSight,
        start: &StepModel,
        form: RiseForm,
        rules: &BevelTuning,
    ) -> Option<(StepModel, f64)> {
        let mut best: Option<(StepModel, f64)> = None;
        for place in -rules.places..=rules.places {
            let step = StepModel {
                place_m: f64::from(place) * rules.place_step,
                ..*start
            };
            if let Some(cost) = self.cost(sight, &step, form, rules.largest)
                && best.is_none_or(|(_, least)| cost < least)
            {
                best = Some((step, cost));
            }
        }
        let (mut step, mut least) = best?;
        for _ in 0..rules.rounds {
            let next = self.improved(sight, start, &step, form, rules);
            let judged =
                next.and_then(|next| Some((next, self.cost(sight, &next, form, rules.largest)?)));
            match judged.filter(|(_, cost)| *cost < least) {
                Some(better) => (step, least) = better,
                None => break,
            }
        }
        Some((step, least))
    }

    /// One step of Gauss and Newton's on place and both levels, which are known before.
    fn improved(
        &mut self,
        sight: &CameraSight,
        start: &StepModel,
        step: &StepModel,
        form: RiseForm,
        rules: &BevelTuning,
    ) -> Option<StepModel> {
        let trial_m = rules.trial;
        let moved = |change: &Vector3<f64>| StepModel {
            place_m: step.place_m + change.x,
            near_height_m: step.near_height_m + change.y,
            far_height_m: step.far_height_m + change.z,
            ..*step
        };
        let here = Faces::new(sight, step, form)?;
        let trial = |change: Vector3<f64>| Faces::new(sight, &moved(&(change * trial_m)), form);
        let around = [
            trial(Vector3::x())?,
            trial(Vector3::y())?,
            trial(Vector3::z())?,
        ];
        let (mut information, mut product) = (Matrix3::zeros(), Vector3::zeros());
        for &[col, row, observed_px] in &self.pixels {
            let seen_px = here.seen_px(col, row);
            let miss_px = observed_px - seen_px;
            if miss_px.abs() > rules.largest {
                continue;
            }
            let by =
                Vector3::from_fn(|axis, _| (around[axis].seen_px(col, row) - seen_px) / trial_m);
            information += by * by.transpose();
            product += by * miss_px;
        }
        let hold = (rules.noise / rules.height_sigma).powi(2) * rules.hold;
        for (axis, off_m) in [
            (1, start.near_height_m - step.near_height_m),
            (2, start.far_height_m - step.far_height_m),
        ] {
            information[(axis, axis)] += hold;
            product[axis] += hold * off_m;
        }
        let change = information.cholesky()?.solve(&product);
        Some(moved(&change.map(|m| m.clamp(-rules.stride, rules.stride))))
    }

    /// Sum of the squared misses, each of no more than so much.
    fn cost(
        &mut self,
        sight: &CameraSight,
        step: &StepModel,
        form: RiseForm,
        most_px: f64,
    ) -> Option<f64> {
        let faces = Faces::new(sight, step, form)?;
        let misses = (self.pixels.iter())
            .map(|&[col, row, observed_px]| (observed_px - faces.seen_px(col, row)).abs());
        Some(misses.map(|miss_px| miss_px.min(most_px).powi(2)).sum())
    }

    /// The noise of the pixels, as a slope leaves it.
    fn noise_px(
        &mut self,
        sight: &CameraSight,
        step: &StepModel,
        form: RiseForm,
        rules: &BevelTuning,
    ) -> Option<f64> {
        let faces = Faces::new(sight, step, form)?;
        self.misses.clear();
        self.misses.extend(
            (self.pixels.iter())
                .map(|&[col, row, observed_px]| (observed_px - faces.seen_px(col, row)).abs()),
        );
        let middle = self.misses.len() / 2;
        let (_, median, _) = self.misses.select_nth_unstable_by(middle, f64::total_cmp);
        Some((*median / rules.median).max(rules.least_noise))
    }
}
