//! What is measured in the image itself, pixel by pixel, before any surface is known.

pub(crate) mod erosion;
pub(crate) mod labels;
pub(crate) mod median;
pub(crate) mod near;
pub(crate) mod noise;
pub(crate) mod pixels;
pub(crate) mod view;
