//! Planes in a scan: several ways to find them, the ground plane, labelled points.
#![doc = include_str!("../README.md")]

#[cfg(test)]
mod arbitrary;
mod camera_pose;
#[cfg(test)]
mod comparison;
pub mod finders;
mod ground_plane;
mod part;
mod picture;
mod planes;
mod regions;
#[cfg(test)]
mod tiny_pictures;

pub use finders::PARTS;
pub use ground_plane::config::GroundConfig;
pub use part::{SegmenterNeeds, SegmenterPart};
pub use planes::{KnownFloor, PlaneRegion, Planes, SegmentError, Segmenter};
