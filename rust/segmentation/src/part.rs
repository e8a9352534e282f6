//! What a segmenter is made of. Those that come with the crate stand in `finders/mod.rs`, a line each.

use sensing::Intrinsics;
use settings::{MakeError, Part, Tables};

use crate::Segmenter;

/// What a segmenter can be made of.
#[derive(Debug, Clone, Copy)]
pub struct SegmenterNeeds<'a> {
    /// The tables of `[navigation]`.
    pub tables: &'a Tables,
    /// The camera of the scans.
    pub camera: Intrinsics,
}

/// A segmenter that has a name.
pub type SegmenterPart = Part<fn(&SegmenterNeeds<'_>) -> Result<Box<dyn Segmenter>, MakeError>>;
