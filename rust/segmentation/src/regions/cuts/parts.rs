//! What is known of a picture's regions part by part: sums for fits of a piece of a region.

use std::ops::Range;

use nalgebra::Vector2;

use super::tuning::CutTuning;
use crate::picture::{SeenPicture, to_f32};
use crate::regions::fit::{RegionFit, terms};
use crate::regions::region::Region;

/// Where a pixel of a surface lies, from below the camera, m.
fn place_m(q: f32, [g, x, y]: [f32; 3]) -> Vector2<f64> {
    Vector2::new(x, y).map(|value| f64::from(value / (q * g)))
}

/// Pixels of one region that lie together.
#[derive(Debug, Clone, Copy)]
pub(super) struct RegionPart {
    pub(super) region: usize,
    /// Where they are on the region's surface, from below the camera, m.
    pub(super) place_m: Vector2<f64>,
    pub(super) sums: PartSums,
}

/// Sums over pixels.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PartSums {
    pub(super) pixels: f64,
    /// Sums of `g` times each of the terms of a fit.
    pub(super) by_g: [f64; 4],
}

impl PartSums {
    pub(super) fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        for (sum, more) in self.by_g.iter_mut().zip(other.by_g) {
            *sum += more;
        }
    }
}

/// The parts of all regions. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct RegionParts {
    all: Vec<RegionPart>,
    totals: Vec<RegionFit>,
}

impl RegionParts {
    /// The parts of one region.
    pub(super) fn of(&self, region: usize) -> impl Iterator<Item = &RegionPart> {
        self.all.iter().filter(move |part| part.region == region)
    }

    /// All of them together.
    pub(super) fn total(&self, region: usize) -> &RegionFit {
        &self.totals[region]
    }

    /// Sums up the regions' pixels, one every few, by blocks of so many columns and rows, of which one in so many each way is looked
    /// at.
    pub(super) fn collect(
        &mut self,
        seen: SeenPicture<'_>,
        regions: &[Region],
        labels: &[u16],
        [block, apart]: [usize; 2],
        tuning: &CutTuning,
    ) {
        self.all.clear();
        self.totals.clear();
        let shared_by = (tuning.alike / (tuning.stride * apart * apart) as f64).max(1.0);
        let fits = regions
            .iter()
            .map(|region| RegionFit::at(region.q, shared_by));
        self.totals.extend(fits);
        let width = seen.picture.width;
        let height = labels.len() / width;
        for top in (0..height).step_by(block) {
            for left in (0..width).step_by(block) {
                let rows = top..(top + block).min(height);
                let cols = left..(left + block).min(width);
                self.add_block(seen, regions, labels, [cols, rows], (apart, tuning));
            }
        }
    }

    /// Adds what in a block belongs to the region of its first pixel.
    fn add_block(
        &mut self,
        seen: SeenPicture<'_>,
        regions: &[Region],
        labels: &[u16],
        [cols, rows]: [Range<usize>; 2],
        (apart, tuning): (usize, &CutTuning),
    ) {
        let (stride, outlier) = (tuning.stride, tuning.outlier);
        let picture = seen.picture;
        let mut part: Option<RegionPart> = None;
        // Which one of the pixels of a row is looked at first: row by row the next one.
        let mut phase = (cols.start + rows.start) / apart % stride;
        for row in rows.step_by(apart) {
            let (x, y) = (seen.view.x.along(row), seen.view.y.along(row));
            let line = row * picture.width + cols.start..row * picture.width + cols.end;
            let [disparity_px, g, sigma_px] = [picture.disparity_px, picture.g, picture.sigma_px]
                .map(|image| &image[line.clone()]);
            let labels = &labels[line];
            for i in (phase * apart..labels.len()).step_by(stride * apart) {
                let Some(region) = usize::from(labels[i]).checked_sub(1) else {
                    continue;
                };
                if part.is_some_and(|part| part.region != region) {
                    continue;
                }
                let (q, precision) = (regions[region].q, 1.0 / sigma_px[i]);
                let miss = (disparity_px[i] - q * g[i]) * precision;
                // Not close also where nothing was seen.
                let close = miss.abs() < outlier;
                if q == 0.0 || !close {
                    continue;
                }
                let col = to_f32(cols.start + i);
                let gxy = [g[i], x.at(col), y.at(col)];
                let part = part.get_or_insert_with(|| RegionPart {
                    region,
                    place_m: place_m(q, gxy),
                    sums: PartSums::default(),
                });
                let values = terms(q, gxy, precision, miss);
                self.totals[region].add(values);
                part.sums.add(&PartSums {
                    pixels: (stride * apart * apart) as f64,
                    by_g: values.map(|value| values[0] * value),
                });
            }
            phase = if phase + 1 == stride { 0 } else { phase + 1 };
        }
        self.all.extend(part);
    }
}
