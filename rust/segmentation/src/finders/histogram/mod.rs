//! A histogram of heights: the segmenter `histogram`.
//!
//! With the camera levelled, points of one horizontal surface have one height. The peaks of the histogram of heights are
//! surfaces, each with the pixels that are closest to it. Strong on parallel treads; but it knows nothing of what
//! lies beside what, so that surfaces of equal height are one.

mod config;

use crate::part::SegmenterPart;
use sensing::Intrinsics;
use settings::{Part, TableDescription};

use crate::ground_plane::{Configured, GroundConfig, Grounded};
use crate::picture::{MAX_REGIONS, Picture, View};
use crate::regions::{Finder, Look, Region};
pub use config::HistogramConfig;
use config::HistogramTuning;

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "histogram",
    about: "level surfaces by the peaks of a histogram of heights",
    source: None,
    tables: &[TableDescription::of::<HistogramConfig>()],
    make: Histogram::make,
};

/// The segmenter of horizontal surfaces by heights.
pub type Histogram = Grounded<Peaks>;

impl Configured for Peaks {
    type Config = HistogramConfig;

    fn new(config: &HistogramConfig, ground: &GroundConfig, _: &Intrinsics) -> Self {
        let bins = (f64::from(config.tuning.deepest) / config.bin).ceil() as usize;
        Self {
            tuning: config.tuning.clone(),
            bin_m: config.bin as f32,
            apart: (config.apart / config.bin).ceil() as usize,
            accept_px: config.accept as f32,
            min_region: ground.min_region,
            counts: vec![0.0; bins],
            smooth: vec![0.0; bins],
            order: Vec::with_capacity(bins),
            picked: Vec::with_capacity(bins),
        }
    }
}

/// Finds the peaks of the heights. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct Peaks {
    tuning: HistogramTuning,
    bin_m: f32,
    /// Bins.
    apart: usize,
    accept_px: f32,
    min_region: usize,
    counts: Vec<f32>,
    smooth: Vec<f32>,
    /// Bins from the fullest to the emptiest.
    order: Vec<usize>,
    /// Bins that are peaks.
    picked: Vec<usize>,
}

impl Peaks {
    /// Counts the depths below the camera, each shared by the two bins that it lies between, and smooths the counts.
    fn count(&mut self, picture: Picture<'_>) {
        self.counts.fill(0.0);
        for (&d, &g) in picture.disparity_px.iter().zip(picture.g) {
            let at = g / d / self.bin_m;
            // False where nothing was seen and above the horizon.
            if at >= 0.0 && at < (self.counts.len() - 1) as f32 {
                let bin = at as usize;
                let part = at - bin as f32;
                self.counts[bin] += 1.0 - part;
                self.counts[bin + 1] += part;
            }
        }
        let beside = self.tuning.smoothing;
        let own = 1.0 - 2.0 * beside;
        self.smooth.fill(0.0);
        for (smooth, counts) in self.smooth[1..].iter_mut().zip(self.counts.windows(3)) {
            *smooth = beside * counts[0] + own * counts[1] + beside * counts[2];
        }
    }

    /// The fullest bins that are apart from each other, as long as what lies around them is enough for a surface.
    fn pick(&mut self) {
        let (smooth, stands_out) = (&self.smooth, self.tuning.stands_out);
        let reach = self.tuning.valley * self.apart;
        self.order.clear();
        self.order
            .extend((0..smooth.len()).filter(|&bin| smooth[bin] > 0.0));
        self.order.sort_by(|&a, &b| smooth[b].total_cmp(&smooth[a]));
        self.picked.clear();
        for &bin in &self.order {
            let (first, end) = (
                bin.saturating_sub(self.apart),
                (bin + self.apart + 1).min(smooth.len()),
            );
            let highest = smooth[first..end]
                .iter()
                .all(|&beside| beside <= smooth[bin]);
            let is_peak = highest && valley(smooth, bin, reach) * stands_out <= smooth[bin];
            let alone = self
                .picked
                .iter()
                .all(|&peak| peak.abs_diff(bin) > self.apart);
            let enough = self.counts[first..end].iter().sum::<f32>() >= self.min_region as f32;
            if is_peak && alone && enough && self.picked.len() < MAX_REGIONS {
                self.picked.push(bin);
            }
        }
    }

    /// Gives each pixel to the surface that it is closest to.
    fn label(&self, picture: Picture<'_>, regions: &[Region], labels: &mut [u16]) {
        let pixels = picture.disparity_px.iter().zip(picture.g);
        for (label, (&d, &g)) in labels.iter_mut().zip(pixels) {
            *label = 0;
            let mut least = self.accept_px;
            for (number, region) in (1..).zip(regions) {
                let miss = (d - region.q * g).abs();
                // False where nothing was seen.
                if miss < least && g > 0.0 {
                    (least, *label) = (miss, number);
                }
            }
        }
    }

    /// Takes what has too few pixels away, and fits the rest to its pixels.
    fn settle(&self, picture: Picture<'_>, regions: &mut Vec<Region>, labels: &mut [u16]) {
        let mut sums = [(0_usize, 0.0_f32, 0.0_f32); MAX_REGIONS];
        for (at, &label) in labels.iter().enumerate().filter(|(_, label)| **label > 0) {
            let (count, dg, gg) = &mut sums[usize::from(label) - 1];
            let g = picture.g[at];
            *count += 1;
            *dg += picture.disparity_px[at] * g;
            *gg += g * g;
        }
        let mut numbers = [0_u16; MAX_REGIONS + 1];
        regions.clear();
        for (number, &(support, dg, gg)) in numbers[1..].iter_mut().zip(&sums) {
            if support >= self.min_region {
                regions.push(Region {
                    q: dg / gg,
                    support,
                    ..Region::default()
                });
                *number = regions.len() as u16;
            }
        }
        for label in labels {
            *label = numbers[usize::from(*label)];
        }
    }
}

/// The higher one of the lowest counts to both sides of a bin, within so many bins.
fn valley(counts: &[f32], bin: usize, reach: usize) -> f32 {
    let lowest = |side: &[f32]| side.iter().copied().fold(f32::INFINITY, f32::min);
    let (first, end) = (
        bin.saturating_sub(reach),
        (bin + reach + 1).min(counts.len()),
    );
    lowest(&counts[first..=bin]).max(lowest(&counts[bin..end]))
}

impl Finder for Peaks {
    const ANY_DIRECTION: bool = false;

    fn find(
        &mut self,
        picture: Picture<'_>,
        _view: &View,
        _look: Look,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        self.count(picture);
        self.pick();
        regions.clear();
        regions.extend(self.picked.iter().map(|&bin| Region {
            q: 1.0 / (bin as f32 * self.bin_m),
            ..Region::default()
        }));
        self.label(picture, regions, labels);
        self.settle(picture, regions, labels);
    }
}
