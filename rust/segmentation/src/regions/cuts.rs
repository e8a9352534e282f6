//! Two levels that lie so close that they were taken for one surface: cut apart along a straight line.
//!
//! A step of 15 mm seen from half a metre away is three noises of one pixel, and the camera's tilt takes up most of what it does
//! to a surface that is laid across it. All pixels of a tread together tell it for sure. So every straight line across a region is
//! tried as an edge: how much better do two heights explain the disparities than one, whatever the tilt within what is
//! known of it? Where two do, each pixel goes to the one that it is closer to.

mod parts;
pub(crate) mod tuning;

use std::f64::consts::PI;

use nalgebra::Vector2;

use crate::picture::{MAX_REGIONS, Picture, SeenPicture, View};
use crate::regions::fit::{LevelStep, Lie};
use crate::regions::region::Region;
use parts::{PartSums, RegionPart, RegionParts};
use tuning::CutTuning;

/// Which lines are tried: directions, the angle between them, and the step in which lines are moved.
#[derive(Debug, Clone, Copy)]
struct LineSearch {
    directions: usize,
    turn_rad: f64,
    step_m: f64,
}

/// What is known of the camera's tilt: where it is expected, and how surely, rad.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TiltPrior {
    pub(crate) expected: Vector2<f64>,
    pub(crate) sigma_rad: f64,
}

/// A line across a region.
#[derive(Debug, Clone, Copy)]
struct RegionCut {
    /// Direction across the line, rad; what is less far in it is before the line.
    across_rad: f64,
    /// How what is before the line differs from the rest.
    step: LevelStep,
}

/// Cuts regions. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Cuts {
    tuning: CutTuning,
    parts: RegionParts,
    // Of the region that is being searched: its parts, how far each is in one direction, m, and their sums by places in it.
    own: Vec<RegionPart>,
    along_m: Vec<f64>,
    places: Vec<PartSums>,
    nearer_px: Vec<f32>,
}

impl Cuts {
    /// Buffers that are still empty.
    pub(crate) fn new(tuning: CutTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// The lines that are tried first.
    fn coarse(&self) -> LineSearch {
        let directions = self.tuning.coarse_directions;
        LineSearch {
            directions,
            turn_rad: PI / directions as f64,
            step_m: self.tuning.coarse_step,
        }
    }

    /// The lines that are tried around the best one.
    const fn fine(&self) -> LineSearch {
        LineSearch {
            directions: self.tuning.fine_directions,
            turn_rad: self.tuning.fine_turn,
            step_m: self.tuning.fine_step,
        }
    }

    /// Cuts the regions that hold two levels; says whether there were any.
    pub(crate) fn cut(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        tilt: TiltPrior,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) -> bool {
        let seen = SeenPicture { picture, view };
        let before = regions.len();
        let block = self.tuning.block * picture.finer;
        self.parts
            .collect(seen, regions, labels, [block, picture.finer], &self.tuning);
        let mut cuts = [None; MAX_REGIONS];
        for (region, cut) in cuts.iter_mut().enumerate().take(before) {
            *cut = self.best(region, &regions[region], tilt, self.coarse(), PI / 2.0);
        }
        if cuts.iter().all(Option::is_none) {
            return false;
        }
        self.parts
            .collect(seen, regions, labels, [1, 1], &self.tuning);
        for (region, cut) in cuts.iter().enumerate() {
            let Some(cut) = cut else { continue };
            let around = cut.across_rad;
            let fine = self.best(region, &regions[region], tilt, self.fine(), around);
            if let Some(cut) = fine.filter(|_| regions.len() < MAX_REGIONS) {
                self.part(seen, region, &cut.step, regions, labels);
            }
        }
        regions.len() > before
    }

    /// The best line across a region among those that are searched around a direction, if it is an edge.
    fn best(
        &mut self,
        index: usize,
        region: &Region,
        tilt: TiltPrior,
        search: LineSearch,
        around_rad: f64,
    ) -> Option<RegionCut> {
        let (certain, least_step_m) = (self.tuning.certain, self.tuning.least_step);
        if (region.support as f64) < 2.0 * self.tuning.least_side || region.q == 0.0 {
            return None;
        }
        let lie = self
            .parts
            .total(index)
            .lie(&tilt.expected, tilt.sigma_rad)?;
        let middle = 0.5 * (search.directions - 1) as f64;
        let directions =
            (0..search.directions).map(|i| around_rad + (i as f64 - middle) * search.turn_rad);
        self.own.clear();
        self.own.extend(self.parts.of(index).copied());
        directions
            .filter_map(|across_rad| self.best_across(&lie, across_rad, search.step_m))
            .max_by(|a, b| a.step.certainty.total_cmp(&b.step.certainty))
            .filter(|cut| {
                let step_m = cut.step.rise.abs() / f64::from(region.q * region.q);
                cut.step.certainty > certain && step_m > least_step_m
            })
    }

    /// The best line of one direction across the region whose parts are `own`.
    fn best_across(&mut self, lie: &Lie, across_rad: f64, step_m: f64) -> Option<RegionCut> {
        let (most_places, least_side) = (self.tuning.most_places, self.tuning.least_side);
        let across = Vector2::new(libm::cos(across_rad), libm::sin(across_rad));
        self.along_m.clear();
        let own = self.own.iter();
        self.along_m
            .extend(own.map(|part| across.dot(&part.place_m)));
        let nearest_m = self.along_m.iter().copied().fold(f64::INFINITY, f64::min);
        self.places.clear();
        for (part, along_m) in self.own.iter().zip(&self.along_m) {
            let place = (along_m - nearest_m) / step_m;
            // Compared before the cast: one to 32 bits is a fraction of one to more.
            let place = if place >= most_places {
                most_places
            } else {
                place
            } as i32 as usize;
            if place >= self.places.len() {
                self.places.resize(place + 1, PartSums::default());
            }
            self.places[place].add(&part.sums);
        }
        let all: f64 = self.places.iter().map(|place| place.pixels).sum();
        let mut before = PartSums::default();
        let mut best: Option<LevelStep> = None;
        for sums in self.places.iter().filter(|sums| sums.pixels > 0.0) {
            before.add(sums);
            if before.pixels < least_side || all - before.pixels < least_side {
                continue;
            }
            let step = lie.step(before.by_g);
            best = match (best, step) {
                (Some(best), Some(step)) if step.certainty <= best.certainty => Some(best),
                (best, None) => best,
                (_, step) => step,
            };
        }
        best.map(|step| RegionCut { across_rad, step })
    }

    /// Makes two regions of one where both are large enough. A pixel goes with what lies around it: on average over a matching window
    /// it is closer to the one height or to the other.
    fn part(
        &mut self,
        seen: SeenPicture<'_>,
        index: usize,
        step: &LevelStep,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        let whole = regions[index];
        let own = index as u16 + 1;
        let [change, a, b] = step.rest.map(|value| value as f32).into();
        let (rise, width) = (step.rise as f32, seen.picture.width);
        let middle = whole.q + change + 0.5 * rise;
        let nearer_px = |(at, &label): (usize, &u16)| {
            let [x, y, g] = seen.xyg(at);
            let between_px = middle * g - whole.q * (a * x + b * y);
            let off_px = (seen.picture.disparity_px[at] - between_px) * rise.signum();
            if label == own { off_px } else { 0.0 }
        };
        self.nearer_px.clear();
        let pixels = labels.iter().enumerate();
        self.nearer_px.extend(pixels.map(nearer_px));
        let moves = |at: usize| labels[at] == own && self.around_px(at, width) > 0.0;
        let moved: Vec<usize> = (0..labels.len()).filter(|&at| moves(at)).collect();
        let left = whole.support.saturating_sub(moved.len());
        if (moved.len().min(left) as f64) < self.tuning.least_side {
            return;
        }
        regions[index].q += change;
        regions[index].support = left;
        regions.push(Region {
            q: whole.q + change + rise,
            support: moved.len(),
            ..whole
        });
        for at in moved {
            labels[at] = regions.len() as u16;
        }
    }

    /// How much nearer to the one height than to the other a pixel and those around it are, px.
    fn around_px(&self, at: usize, width: usize) -> f32 {
        let (col, row) = (at % width, at / width);
        let (height, around) = (self.nearer_px.len() / width, self.tuning.around);
        let cols = col.saturating_sub(around)..(col + around + 1).min(width);
        let rows = row.saturating_sub(around)..(row + around + 1).min(height);
        let lines = rows.map(|row| &self.nearer_px[row * width..][cols.clone()]);
        lines.flatten().sum()
    }
}

#[cfg(test)]
mod tests;
