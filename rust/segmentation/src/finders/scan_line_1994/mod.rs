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
use settings::{Part, TableDescription};

use crate::finders::free_planes::planes::FreePlanes;
use crate::ground_plane::{Configured, GroundConfig, Grounded};
use crate::picture::{Picture, View};
use crate::regions::{Finder, Look, Region};
pub use config::ScanLine1994Config;
use growth::PlaneGrowth;
use lines::{Lines, StraightSegment};

/// How it is listed and made.
pub const PART: SegmenterPart = Part {
    name: "scan_line_1994",
    about: "scan-line grouping as published: straight lines, fixed thresholds",
    source: Some("Jiang and Bunke 1994 (000, reference 10)"),
    tables: &[TableDescription::of::<ScanLine1994Config>()],
    make: ScanLine1994::make,
};

/// The scan-line segmenter of 1994.
pub type ScanLine1994 = Grounded<StraightLines>;

/// Finds planes by straight scan lines. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct StraightLines {
    config: ScanLine1994Config,
    segments: Vec<StraightSegment>,
    lines: Lines,
    growth: PlaneGrowth,
    planes: FreePlanes,
}

impl Configured for StraightLines {
    type Config = ScanLine1994Config;

    fn new(config: &ScanLine1994Config, ground: &GroundConfig, _: &Intrinsics) -> Self {
        Self {
            config: config.clone(),
            growth: PlaneGrowth::new(ground.min_region),
            planes: FreePlanes::new(config.tuning.free_planes.clone()),
            ..Self::default()
        }
    }
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
            let (config, planes) = (&self.config, &mut self.planes);
            self.lines.cut(picture, config, &mut self.segments);
            self.growth
                .grow(picture, &self.segments, config, planes, labels);
        }
        self.planes.show(view, look, labels, regions);
    }
}
