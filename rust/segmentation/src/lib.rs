//! Planes in a scan: scan-line grouping, region growing, the ground plane, labelled points.

mod planes;

pub use planes::{PlaneRegion, Planes, SegmentError, Segmenter};
