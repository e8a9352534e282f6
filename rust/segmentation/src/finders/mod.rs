//! The ways to find surfaces in a picture: each makes a segmenter of its own.

pub(crate) mod free_planes;
pub(crate) mod histogram;
pub(crate) mod hough;
pub(crate) mod ransac;
pub(crate) mod scan_line;
pub(crate) mod scan_line_1994;
pub(crate) mod scan_line_adaptive;
