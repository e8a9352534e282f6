//! Scan-line grouping: the segmenter `scan_line`.
//!
//! After Jiang and Bunke (1994) as 003, section III, uses it, in disparity instead of metres: lines of constant
//! `q = d / g` on strips of columns, and regions grown over them and over pixels.

mod config;
mod contacts;
mod grouping;
mod partition;
mod rules;
mod steep;
mod strip_rows;
mod strips;

use crate::part::SegmenterPart;
use sensing::Intrinsics;
use settings::{ConfigError, Table};
use settings::{Part, TableDescription, read};

use crate::ground_plane::config::GroundConfig;
use crate::ground_plane::grounded::Grounded;
use crate::picture::pixels::Picture;
use crate::picture::view::View;
use crate::regions::finder::{Finder, Look};
use crate::regions::region::Region;
pub use config::ScanLineConfig;
use grouping::Grouping;
use rules::{GrowthRules, StripRules};
use strips::{LevelSegment, Strips};

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "scan_line",
    about: "planes by scan-line grouping, thresholds follow the local noise",
    source: Some("003, section III, after Jiang and Bunke 1994"),
    tables: &[TableDescription::of::<ScanLineConfig>()],
    make: |needs| {
        let (config, ground) = (
            read(needs.tables, "scan_line")?,
            read(needs.tables, "ground")?,
        );
        Ok(Box::new(ScanLine::new(&config, ground, needs.camera)?))
    },
};

/// The scan-line segmenter.
pub type ScanLine = Grounded<ScanLines>;

impl ScanLine {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub fn new(
        config: &ScanLineConfig,
        ground: GroundConfig,
        camera: Intrinsics,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        Self::around(ScanLines::new(config, &ground, &camera), ground, camera)
    }
}

/// Finds surfaces by scan lines. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct ScanLines {
    strip_rules: StripRules,
    growth_rules: GrowthRules,
    segments: Vec<LevelSegment>,
    strips: Strips,
    grouping: Grouping,
}

impl ScanLines {
    fn new(config: &ScanLineConfig, ground: &GroundConfig, camera: &Intrinsics) -> Self {
        let scale = (camera.focal_px * camera.baseline_m) as f32;
        Self {
            strip_rules: StripRules::new(config, scale),
            growth_rules: GrowthRules::new(config, ground.min_region),
            segments: Vec::new(),
            strips: Strips::default(),
            grouping: Grouping::default(),
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
        let rules = self.growth_rules;
        self.segments.clear();
        self.strips
            .cut(picture, self.strip_rules, &mut self.segments);
        self.grouping
            .group(picture, &self.segments, rules, regions, labels);
        if look == Look::Again {
            self.grouping.grow(picture, rules, regions, labels);
            self.grouping.merge(picture, rules, regions, labels);
        }
    }
}
