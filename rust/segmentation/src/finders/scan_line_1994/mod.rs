//! Scan-line grouping as published: the segmenter `scan_line_1994`.
//!
//! After Jiang and Bunke (1994), reference 10 of 000: scan lines are split into straight pieces of two parameters, and
//! planes grow from three pieces side by side over all pieces whose ends lie on them. Thresholds are fixed. Of a later
//! refinement, which 000 and 003 use, it has nothing. Scan lines run down the columns: across the treads of a staircase.
//! Disparity takes the place of range: planes are planes in both.

mod config;
mod growth;
mod lines;

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
pub use config::ScanLine1994Config;
use growth::{PlaneGrowth, PlaneGrowthRules};
use lines::{LineRules, Lines, StraightSegment};

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "scan_line_1994",
    about: "scan-line grouping as published: straight lines, fixed thresholds",
    source: Some("Jiang and Bunke 1994 (000, reference 10)"),
    tables: &[TableDescription::of::<ScanLine1994Config>()],
    make: |needs| {
        let (config, ground) = (
            read(needs.tables, "scan_line_1994")?,
            read(needs.tables, "ground")?,
        );
        Ok(Box::new(ScanLine1994::new(&config, ground, needs.camera)?))
    },
};

/// The scan-line segmenter of 1994.
pub type ScanLine1994 = Grounded<StraightLines>;

impl ScanLine1994 {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub fn new(
        config: &ScanLine1994Config,
        ground: GroundConfig,
        camera: Intrinsics,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let finder = StraightLines {
            line_rules: LineRules {
                strip: config.strip,
                split_px: config.split as f32,
                min_segment: config.min_segment,
                max_gap: config.tuning.max_gap,
                seen: config.tuning.seen,
            },
            growth_rules: PlaneGrowthRules {
                strip: config.strip,
                accept_px: config.accept as f32,
                min_region: ground.min_region,
                overlap: config.tuning.overlap,
            },
            segments: Vec::new(),
            lines: Lines::default(),
            growth: PlaneGrowth::default(),
            planes: FreePlanes::new(config.tuning.free_planes.clone()),
        };
        Self::around(finder, ground, camera)
    }
}

/// Finds planes by straight scan lines. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct StraightLines {
    line_rules: LineRules,
    growth_rules: PlaneGrowthRules,
    segments: Vec<StraightSegment>,
    lines: Lines,
    growth: PlaneGrowth,
    planes: FreePlanes,
}

impl Finder for StraightLines {
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
            self.lines.cut(picture, self.line_rules, &mut self.segments);
            let (rules, planes) = (self.growth_rules, &mut self.planes);
            self.growth
                .grow(picture, &self.segments, rules, planes, labels);
        }
        self.planes.show(view, labels, regions);
    }
}
