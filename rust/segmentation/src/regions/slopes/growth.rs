//! Growing a slope: pixels that its plane explains better than the level surfaces do that were found.

use nalgebra::Vector3;

use super::tuning::{SlopeGradients, SlopeGrowthTuning};
use crate::picture::{MAX_REGIONS, SeenPicture};
use crate::regions::region::Region;
use crate::regions::tilted::PlaneSums;

/// What a level region is to a slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StripReach {
    /// A part of it that was taken for level.
    Strip,
    /// What it begins or ends at: the slope is where its plane is nearer to the camera than the level surface, or further away.
    Before { q: f32, nearer: bool },
}

/// Grows planes. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct SlopeGrowth {
    tuning: SlopeGrowthTuning,
    gradients: SlopeGradients,
    /// What was grown.
    pub(super) pixels: Vec<usize>,
    /// Whether a pixel is among them.
    pub(super) members: Vec<bool>,
    /// How far a region reaches, by its label; a pixel without a region is as good as one of a strip.
    pub(super) reaches: Vec<StripReach>,
    column_sums: Vec<f32>,
    better: Vec<f32>,
    own_off: Vec<f32>,
}

impl SlopeGrowth {
    /// Buffers that are still empty.
    pub(super) fn new(tuning: SlopeGrowthTuning, gradients: SlopeGradients) -> Self {
        Self {
            tuning,
            gradients,
            ..Self::default()
        }
    }

    /// Grows a plane from a pixel on; none where it is no slope. `is_found`: whether that is the plane of a slope, not of a window.
    pub(super) fn grow(
        &mut self,
        seen: SeenPicture<'_>,
        (start, mut plane): (usize, Vector3<f64>),
        is_found: bool,
        regions: &[Region],
        labels: &[u16],
    ) -> Option<Vector3<f64>> {
        let most_off = self.tuning.most_off;
        self.own_off.clear();
        self.own_off
            .extend(labels.iter().enumerate().map(|(at, &label)| {
                let own = usize::from(label)
                    .checked_sub(1)
                    .map(|index| &regions[index]);
                let q = own.map_or(0.0, |region| region.q);
                off(seen.miss(at, [0.0, 0.0, q]), most_off)
            }));
        self.reaches.clear();
        self.reaches.resize(regions.len() + 1, StripReach::Strip);
        if is_found {
            self.find_reaches(seen, &plane, regions, labels);
        }
        for _ in 0..self.tuning.rounds {
            if !self.gradients.hold(&plane) {
                return None;
            }
            self.flood(seen, start, &plane, labels);
            plane = self.fit_inside(seen)?;
            self.find_reaches(seen, &plane, regions, labels);
        }
        self.gradients.hold(&plane).then_some(plane)
    }

    /// The plane through what was grown, away from its border: there a window saw something else, too.
    fn fit_inside(&self, seen: SeenPicture<'_>) -> Option<Vector3<f64>> {
        let (width, border) = (seen.picture.width, self.tuning.border);
        let mut sums = PlaneSums::default();
        for &at in &self.pixels {
            let col = at % width;
            let is_inside = col >= border
                && col + border < width
                && [
                    at.wrapping_sub(border * width),
                    at + border * width,
                    at.wrapping_sub(border),
                    at + border,
                ]
                .iter()
                .all(|&beside| self.members.get(beside) == Some(&true));
            if is_inside && let Some([x, y, g, d]) = seen.terms(at) {
                sums.add([x, y, g], d);
            }
        }
        sums.plane()
    }

    /// Collects what hangs together with a pixel and lies on the plane rather than on the level surfaces that were found.
    fn flood(&mut self, seen: SeenPicture<'_>, start: usize, plane: &Vector3<f64>, labels: &[u16]) {
        let width = seen.picture.width;
        let count = seen.picture.disparity_px.len();
        let abq = [plane.x, plane.y, plane.z].map(|value| value as f32);
        let (most_off, around) = (self.tuning.most_off, self.tuning.around);
        self.better.clear();
        self.better.extend(
            self.own_off
                .iter()
                .enumerate()
                .map(|(at, own)| own - off(seen.miss(at, abq), most_off)),
        );
        self.average(width);
        self.members.clear();
        self.members.resize(count, false);
        self.pixels.clear();
        let (first_col, first_row) = (start % width, start / width);
        let near = |at: usize, first: usize| at.abs_diff(first) <= around;
        // From around the start, where a single pixel may be missing.
        for at in 0..count {
            if near(at % width, first_col) && near(at / width, first_row) {
                self.visit(seen, at, abq, labels);
            }
        }
        let mut next = 0;
        while next < self.pixels.len() {
            let at = self.pixels[next];
            next += 1;
            let col = at % width;
            if col == 0 || col + 1 == width || at < width || at + width >= count {
                continue;
            }
            for beside in [at - 1, at + 1, at - width, at + width] {
                self.visit(seen, beside, abq, labels);
            }
        }
    }

    fn visit(&mut self, seen: SeenPicture<'_>, at: usize, abq: [f32; 3], labels: &[u16]) {
        let miss = seen.miss(at, abq).abs();
        let fits = match self.reaches[usize::from(labels[at])] {
            StripReach::Strip => self.better[at] > -self.tuning.worse,
            StripReach::Before { q, nearer } => {
                self.better[at] > 0.0 && nearer == (seen.apart(at, abq, q) > 0.0)
            }
        };
        if !self.members[at] && fits && miss < self.tuning.accept {
            self.members[at] = true;
            self.pixels.push(at);
        }
    }

    /// Tells the level regions that are strips of the slope from those that it begins or ends at, and those may have taken pixels of it
    /// only behind the line where the two meet.
    fn find_reaches(
        &mut self,
        seen: SeenPicture<'_>,
        plane: &Vector3<f64>,
        regions: &[Region],
        labels: &[u16],
    ) {
        let abq = [plane.x, plane.y, plane.z].map(|value| value as f32);
        let SlopeGrowthTuning {
            most_off,
            worse,
            doubt,
            ..
        } = self.tuning;
        // By label and side: by how much the plane is better there, and in how many pixels.
        let mut sides = [[(0.0, 0.0); 2]; MAX_REGIONS + 1];
        for (at, &label) in labels.iter().enumerate() {
            let Some(index) = usize::from(label).checked_sub(1) else {
                continue;
            };
            let nearer = seen.apart(at, abq, regions[index].q) > 0.0;
            let side = &mut sides[usize::from(label)][usize::from(nearer)];
            side.0 += self.own_off[at] - off(seen.miss(at, abq), most_off);
            side.1 += 1.0;
        }
        for (index, region) in regions.iter().enumerate() {
            let [further, nearer] = sides[index + 1];
            let mean = (further.0 + nearer.0) / f32::max(further.1 + nearer.1, 1.0);
            let of = |side: (f32, f32)| (side.0 - doubt) / (side.1 + 1.0);
            self.reaches[index + 1] = if mean > -worse || region.q == 0.0 {
                StripReach::Strip
            } else {
                StripReach::Before {
                    q: region.q,
                    nearer: of(nearer) > of(further),
                }
            };
        }
    }

    /// Replaces `better` by its mean over the pixels around each.
    fn average(&mut self, width: usize) {
        let (height, around) = (self.better.len() / width, self.tuning.around);
        self.column_sums.clear();
        self.column_sums.resize(self.better.len(), 0.0);
        for (at, sum) in self.column_sums.iter_mut().enumerate() {
            let (col, row) = (at % width, at / width);
            let rows = row.saturating_sub(around)..(row + around + 1).min(height);
            let count = rows.len() as f32;
            *sum = rows.map(|row| self.better[row * width + col]).sum::<f32>() / count;
        }
        for (at, mean) in self.better.iter_mut().enumerate() {
            let (col, row) = (at % width, at / width);
            let cols = col.saturating_sub(around)..(col + around + 1).min(width);
            let count = cols.len() as f32;
            *mean = self.column_sums[row * width..][cols].iter().sum::<f32>() / count;
        }
    }
}

/// Squared distance in noises, at most `most_off`; that where nothing was seen.
fn off(miss: f32, most_off: f32) -> f32 {
    (miss * miss).min(most_off)
}
