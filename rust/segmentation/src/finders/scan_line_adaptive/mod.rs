//! Scan-line grouping of planes in any direction whose thresholds follow the noise: the segmenter `scan_line_adaptive`.
//!
//! After Jiang and Bunke (1994), reference 10 of 000, with what 000 says of its own variation: it adapts to the noise where
//! it is. Scan lines some columns wide are cut into pieces of one plane each, by an optimal partition instead of recursive
//! splits; pieces side by side are joined, those first that agree best. Both ask the same: are two planes, each with a noise
//! of its own, likelier by more than their price than one? So a threshold is no number of pixels but follows from how the
//! surface scatters. Disparity takes the place of range: planes are planes in both.

mod borders;
mod config;
mod merging;
mod patch;
mod pieces;

use crate::part::SegmenterPart;
use sensing::Intrinsics;
use settings::{Part, TableDescription};

use crate::finders::free_planes::planes::FreePlanes;
use crate::ground_plane::{Configured, GroundConfig, Grounded};
use crate::picture::{Picture, View};
use crate::regions::{Finder, Look, Region};
use borders::{NoisyPlane, settle_borders};
pub use config::ScanLineAdaptiveConfig;
use merging::Merging;
use patch::{NoiseRange, Rules};
use pieces::{Cutter, Piece};

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "scan_line_adaptive",
    about: "scan-line grouping of planes in any direction, each with a noise of its own",
    source: Some("000, section III, after Jiang and Bunke 1994"),
    tables: &[TableDescription::of::<ScanLineAdaptiveConfig>()],
    make: ScanLineAdaptive::make,
};

/// The scan-line segmenter of planes in any direction.
pub type ScanLineAdaptive = Grounded<NoisyLines>;

/// Finds planes by scan lines with a noise of their own. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct NoisyLines {
    config: ScanLineAdaptiveConfig,
    noise: NoiseRange,
    /// Smallest region, pixels.
    min_region: f64,
    cutter: Cutter,
    merging: Merging,
    pieces: Vec<Piece>,
    /// The patches that are planes, the largest first.
    roots: Vec<usize>,
    noisy_planes: Vec<NoisyPlane>,
    queue: Vec<usize>,
    planes: FreePlanes,
}

impl Configured for NoisyLines {
    type Config = ScanLineAdaptiveConfig;

    fn new(config: &ScanLineAdaptiveConfig, ground: &GroundConfig, _: &Intrinsics) -> Self {
        Self {
            config: config.clone(),
            noise: NoiseRange {
                least_px: ground.noise_floor,
                most_px: ground.noise_floor * ground.noise_ceiling,
            },
            min_region: ground.min_region as f64,
            planes: FreePlanes::new(config.tuning.free_planes.clone()),
            ..Self::default()
        }
    }
}

impl NoisyLines {
    /// Lists the patches that are large enough.
    fn find_planes(&mut self) {
        let merging = &self.merging;
        let whole =
            |&at: &usize| merging.root(at) == at && merging.patch(at).count() >= self.min_region;
        self.roots.clear();
        self.roots.extend((0..self.pieces.len()).filter(whole));
        let size = |at: usize| merging.patch(at).count();
        self.roots
            .sort_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
        self.planes.clear();
        self.noisy_planes.clear();
        let mut kept = 0;
        for &root in &self.roots {
            if self.planes.is_full() {
                break;
            }
            let patch = merging.patch(root);
            let plane = NoisyPlane::new(&patch.plane(), patch.scatter_px(self.noise));
            self.noisy_planes.push(plane);
            let _label = self.planes.add(plane.plane);
            kept += 1;
        }
        self.roots.truncate(kept);
    }

    fn paint(&self, width: usize, labels: &mut [u16]) {
        labels.fill(0);
        for (at, piece) in self.pieces.iter().enumerate() {
            let root = self.merging.root(at);
            let Some(index) = self.roots.iter().position(|&other| other == root) else {
                continue;
            };
            let left = piece.strip * self.config.strip;
            let right = (left + self.config.strip).min(width);
            for row in piece.rows.clone() {
                labels[row * width + left..row * width + right].fill(index as u16 + 1);
            }
        }
    }
}

impl Finder for NoisyLines {
    const ANY_DIRECTION: bool = true;

    fn find(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        look: Look,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        if look == Look::First {
            let rules = Rules {
                config: &self.config,
                noise: self.noise,
                min_region: self.min_region,
            };
            self.cutter.cut(picture, rules, &mut self.pieces);
            self.merging.merge(&self.pieces, rules);
            self.find_planes();
            self.paint(picture.width, labels);
            let (planes, queue) = (&self.noisy_planes, &mut self.queue);
            settle_borders(picture, planes, &self.config, labels, queue);
        }
        self.planes.show(view, look, labels, regions);
    }
}
