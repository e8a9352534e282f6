//! What is measured in the image itself, pixel by pixel, before any surface is known.

pub(crate) mod erosion;
pub(crate) mod labels;
pub(crate) mod median;
pub(crate) mod near;
pub(crate) mod noise;
pub(crate) mod pixels;
pub(crate) mod seen;
pub(crate) mod view;

pub(crate) use erosion::{Erosion, keep_where};
pub(crate) use labels::{MAX_REGIONS, count_labels, label_runs};
pub(crate) use median::{Median, MedianTuning};
pub(crate) use near::NearFeet;
pub(crate) use noise::{NoiseMap, NoiseTuning};
pub(crate) use pixels::{Picture, fineness, neighbours};
pub(crate) use seen::SeenPicture;
pub(crate) use view::{Linear, View, levelling, to_f32};
