//! Planes in a scan: scan-line grouping, region growing, the ground plane, labelled points.

mod grounded;
mod planes;
mod scan_line;
#[cfg(test)]
mod synthetic;

pub use grounded::GroundConfig;
pub use planes::{KnownFloor, NothingKnown, PlaneRegion, Planes, SegmentError, Segmenter};
pub use scan_line::{ScanLine, ScanLineConfig};
