//! Scan-line grouping: the segmenter `scan_line`.
//!
//! After Jiang and Bunke (1994) as 003, section III, uses it, in disparity instead of metres: lines of constant
//! `q = d / g` on strips of columns, and regions grown over them and over pixels.

mod config;
mod contacts;
mod grouping;
mod partition;
mod steep;
mod strip_rows;
mod strips;

use crate::part::SegmenterPart;
use sensing::Intrinsics;
use settings::{Part, TableDescription};

use crate::ground_plane::{Configured, GroundConfig, Grounded};
use crate::picture::{Picture, View};
use crate::regions::{Finder, Look, Region};
pub use config::ScanLineConfig;
use grouping::Grouping;
use strips::{LevelSegment, Strips};

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "scan_line",
    about: "planes by scan-line grouping, thresholds follow the local noise",
    source: Some("003, section III, after Jiang and Bunke 1994"),
    tables: &[TableDescription::of::<ScanLineConfig>()],
    make: ScanLine::make,
};

/// The scan-line segmenter.
pub type ScanLine = Grounded<ScanLines>;

/// Finds surfaces by scan lines. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct ScanLines {
    config: ScanLineConfig,
    /// Pixels times metres: depth times disparity.
    scale: f32,
    segments: Vec<LevelSegment>,
    strips: Strips,
    grouping: Grouping,
}

impl Configured for ScanLines {
    type Config = ScanLineConfig;

    fn new(config: &ScanLineConfig, ground: &GroundConfig, camera: &Intrinsics) -> Self {
        Self {
            config: config.clone(),
            scale: (camera.focal_px * camera.baseline_m) as f32,
            grouping: Grouping::new(ground.min_region),
            ..Self::default()
        }
    }
}

impl Finder for ScanLines {
    const ANY_DIRECTION: bool = false;

    /// At the first look lines are joined; later ones let the regions take in pixels and join, too.
    fn find(
        &mut self,
        picture: Picture<'_>,
        _view: &View,
        look: Look,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        let config = &self.config;
        self.segments.clear();
        self.strips
            .cut(picture, config, self.scale, &mut self.segments);
        self.grouping
            .group(picture, &self.segments, config, regions, labels);
        if look == Look::Again {
            self.grouping.grow(picture, config, regions, labels);
            self.grouping.merge(picture, config, regions, labels);
        }
    }
}
