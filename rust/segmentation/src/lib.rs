//! Planes in a scan: several ways to find them, the ground plane, labelled points.

#[cfg(test)]
mod arbitrary;
#[cfg(test)]
mod comparison;
mod free_planes;
mod grounded;
mod histogram;
mod hough;
mod planes;
mod ransac;
mod scan_line;
mod scan_line_1994;
mod scan_line_adaptive;
#[cfg(test)]
mod synthetic;
#[cfg(test)]
mod tiny_pictures;

pub use grounded::GroundConfig;
pub use histogram::{Histogram, HistogramConfig};
pub use hough::{Hough, HoughConfig};
pub use planes::{KnownFloor, NothingKnown, PlaneRegion, Planes, SegmentError, Segmenter};
pub use ransac::{Ransac, RansacConfig};
pub use scan_line::{ScanLine, ScanLineConfig};
pub use scan_line_1994::{ScanLine1994, ScanLine1994Config};
pub use scan_line_adaptive::{ScanLineAdaptive, ScanLineAdaptiveConfig};
