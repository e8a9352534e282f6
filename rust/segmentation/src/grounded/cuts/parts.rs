//! What is known of a picture's regions part by part: sums for fits of a piece of a region.

use nalgebra::Vector2;

use crate::grounded::finder::{Picture, Region};
use crate::grounded::fit::{RegionFit, terms};
use crate::grounded::view::View;

/// Misses beyond so many noises are left out.
const OUTLIER: f32 = 6.0;

/// A picture and the view that it was taken in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen<'a> {
    pub(super) picture: Picture<'a>,
    pub(super) view: &'a View,
}

impl Seen<'_> {
    /// `g`, x and y of a pixel.
    pub(super) fn gxy(&self, col: usize, row: usize) -> [f32; 3] {
        let g = self.picture.g[row * self.picture.width + col];
        [g, self.view.x.at(col, row), self.view.y.at(col, row)]
    }

    /// Where a pixel of a surface lies, from below the camera, m.
    fn place_m(&self, q: f32, col: usize, row: usize) -> Vector2<f64> {
        let [g, x, y] = self.gxy(col, row);
        Vector2::new(x, y).map(|value| f64::from(value / (q * g)))
    }
}

/// Pixels of one region that lie together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub(super) region: usize,
    /// Where they are on the region's surface, from below the camera, m.
    pub(super) place_m: Vector2<f64>,
    pub(super) sums: Sums,
}

/// Sums over pixels.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub(super) pixels: f64,
    /// g times each of the terms of a fit.
    pub(super) by_g: [f64; 4],
}

impl Sums {
    pub(super) fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        for (sum, more) in self.by_g.iter_mut().zip(other.by_g) {
            *sum += more;
        }
    }
}

/// The parts of all regions. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Parts {
    all: Vec<Part>,
    totals: Vec<RegionFit>,
}

impl Parts {
    /// The parts of one region.
    pub(super) fn of(&self, region: usize) -> impl Iterator<Item = &Part> {
        self.all.iter().filter(move |part| part.region == region)
    }

    /// All of them together.
    pub(super) fn total(&self, region: usize) -> &RegionFit {
        &self.totals[region]
    }

    /// Sums up the regions' pixels, every second one, by blocks of so many columns and rows.
    pub(super) fn collect(
        &mut self,
        seen: Seen<'_>,
        regions: &[Region],
        labels: &[u16],
        block: usize,
    ) {
        self.all.clear();
        self.totals.clear();
        let fits = regions.iter().map(|region| RegionFit::at(region.q));
        self.totals.extend(fits);
        let width = seen.picture.width;
        let height = labels.len() / width;
        for top in (0..height).step_by(block) {
            for left in (0..width).step_by(block) {
                let rows = top..(top + block).min(height);
                let pixels = rows.flat_map(|row| {
                    let cols = left..(left + block).min(width);
                    cols.map(move |col| (col, row))
                });
                self.add_block(seen, regions, labels, pixels);
            }
        }
    }

    /// Adds what in a block belongs to the region of its first pixel.
    fn add_block(
        &mut self,
        seen: Seen<'_>,
        regions: &[Region],
        labels: &[u16],
        pixels: impl Iterator<Item = (usize, usize)>,
    ) {
        let picture = seen.picture;
        let mut part: Option<Part> = None;
        for (col, row) in pixels.filter(|(col, row)| (col + row) % 2 == 0) {
            let at = row * picture.width + col;
            let Some(region) = usize::from(labels[at]).checked_sub(1) else {
                continue;
            };
            let q = regions[region].q;
            let (gxy, precision) = (seen.gxy(col, row), 1.0 / picture.sigma_px[at]);
            let miss = (picture.disparity_px[at] - q * gxy[0]) * precision;
            let other = part.is_some_and(|part| part.region != region);
            // Not close also where nothing was seen.
            let close = miss.abs() < OUTLIER;
            if q == 0.0 || other || !close {
                continue;
            }
            let part = part.get_or_insert_with(|| Part {
                region,
                place_m: seen.place_m(q, col, row),
                sums: Sums::default(),
            });
            let values = terms(q, gxy, precision, miss);
            self.totals[region].add(values);
            part.sums.add(&Sums {
                pixels: 2.0,
                by_g: values.map(|value| values[0] * value),
            });
        }
        self.all.extend(part);
    }
}
