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
use settings::{ConfigError, Table};
use settings::{Part, TableDescription, read};

use crate::finders::free_planes::planes::FreePlanes;
use crate::ground_plane::config::GroundConfig;
use crate::ground_plane::grounded::Grounded;
use crate::picture::pixels::Picture;
use crate::picture::view::View;
use crate::regions::finder::{Finder, Look};
use crate::regions::region::Region;
use borders::{BorderRules, NoisyPlane, settle_borders};
pub use config::ScanLineAdaptiveConfig;
use merging::{MergeRules, Merging};
use patch::NoiseRange;
use pieces::{CutRules, Cutter, Piece};

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "scan_line_adaptive",
    about: "scan-line grouping of planes in any direction, each with a noise of its own",
    source: Some("000, section III, after Jiang and Bunke 1994"),
    tables: &[TableDescription::of::<ScanLineAdaptiveConfig>()],
    make: |needs| {
        let (config, ground) = (
            read(needs.tables, "scan_line_adaptive")?,
            read(needs.tables, "ground")?,
        );
        Ok(Box::new(ScanLineAdaptive::new(
            &config,
            ground,
            needs.camera,
        )?))
    },
};

/// The scan-line segmenter of planes in any direction.
pub type ScanLineAdaptive = Grounded<NoisyLines>;

impl ScanLineAdaptive {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub fn new(
        config: &ScanLineAdaptiveConfig,
        ground: GroundConfig,
        camera: Intrinsics,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let alike = config.alike;
        let noise = NoiseRange {
            least_px: ground.noise_floor,
            most_px: ground.noise_floor * ground.noise_ceiling,
        };
        let finder = NoisyLines {
            cut_rules: CutRules {
                strip: config.strip,
                price: config.price,
                min_segment: config.min_segment,
                longest: config.tuning.longest,
                seen: config.tuning.seen,
                noise,
                alike,
            },
            merge_rules: MergeRules {
                price: config.price,
                uneven: config.uneven,
                noise,
                alike,
                min_telling: ground.min_region as f64,
            },
            border_rules: BorderRules {
                accept: config.accept as f32,
                rounds: config.tuning.border_rounds,
            },
            min_region: ground.min_region as f64,
            cutter: Cutter::default(),
            merging: Merging::default(),
            pieces: Vec::new(),
            roots: Vec::new(),
            noisy_planes: Vec::new(),
            queue: Vec::new(),
            planes: FreePlanes::new(config.tuning.free_planes.clone()),
        };
        Self::around(finder, ground, camera)
    }
}

/// Finds planes by scan lines with a noise of their own. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct NoisyLines {
    cut_rules: CutRules,
    merge_rules: MergeRules,
    border_rules: BorderRules,
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
        let noise = self.merge_rules.noise;
        let mut kept = 0;
        for &root in &self.roots {
            if self.planes.is_full() {
                break;
            }
            let patch = merging.patch(root);
            let plane = NoisyPlane::new(&patch.plane(), patch.scatter_px(noise));
            self.noisy_planes.push(plane);
            let _label = self.planes.add(plane.linear());
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
            let left = piece.strip * self.cut_rules.strip;
            let right = (left + self.cut_rules.strip).min(width);
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
            self.cutter.cut(picture, self.cut_rules, &mut self.pieces);
            self.merging.merge(&self.pieces, self.merge_rules);
            self.find_planes();
            self.paint(picture.width, labels);
            let (planes, queue) = (&self.noisy_planes, &mut self.queue);
            settle_borders(picture, planes, self.border_rules, labels, queue);
        }
        self.planes.show(view, labels, regions);
    }
}
