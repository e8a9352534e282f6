//! Planes in a scan: several ways to find them, the ground plane, labelled points.

#[cfg(test)]
mod arbitrary;
mod camera_pose;
#[cfg(test)]
mod comparison;
mod finders;
mod ground_plane;
mod picture;
mod planes;
mod regions;
#[cfg(test)]
mod synthetic;
#[cfg(test)]
mod tiny_pictures;

pub use finders::histogram::{Histogram, HistogramConfig};
pub use finders::hough::{Hough, HoughConfig};
pub use finders::ransac::{Ransac, RansacConfig};
pub use finders::scan_line::{ScanLine, ScanLineConfig};
pub use finders::scan_line_1994::{ScanLine1994, ScanLine1994Config};
pub use finders::scan_line_adaptive::{ScanLineAdaptive, ScanLineAdaptiveConfig};
pub use ground_plane::config::GroundConfig;
pub use planes::{KnownFloor, NothingKnown, PlaneRegion, Planes, SegmentError, Segmenter};
