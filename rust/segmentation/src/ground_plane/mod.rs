//! What all segmenters share: a way to find surfaces, put right by the ground (003, section III).
//!
//! In disparity instead of metres: first the floor's normal, then surfaces, by whatever finder, heights fitted away
//! from the regions' borders, and the ground, whose plane corrects the camera's pose.

mod buffers;
pub(crate) mod config;
pub(crate) mod grounded;
mod level;
mod nearness;
mod product;
mod reference;
mod segmenter;

pub(crate) use config::GroundConfig;
pub(crate) use grounded::{Configured, Grounded};
#[cfg(test)]
mod tests;
mod tuning;
mod underfoot;
