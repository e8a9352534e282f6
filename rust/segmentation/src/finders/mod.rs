//! The ways to find surfaces in a picture: each makes a segmenter of its own.

pub(crate) mod free_planes;
pub mod histogram;
pub mod hough;
pub mod ransac;
pub mod scan_line;
pub mod scan_line_1994;
pub mod scan_line_adaptive;

pub use histogram::{Histogram, HistogramConfig};
pub use hough::{Hough, HoughConfig};
pub use ransac::{Ransac, RansacConfig};
pub use scan_line::{ScanLine, ScanLineConfig};
pub use scan_line_1994::{ScanLine1994, ScanLine1994Config};
pub use scan_line_adaptive::{ScanLineAdaptive, ScanLineAdaptiveConfig};

use crate::part::SegmenterPart;

/// The segmenters that come with the crate: a new one is a folder beside these, and a line here.
pub const PARTS: &[SegmenterPart] = &[
    scan_line::PART,
    scan_line_1994::PART,
    scan_line_adaptive::PART,
    hough::PART,
    ransac::PART,
    histogram::PART,
];
