//! The errors of depth cameras: from exact nearness to what block matching would have measured. All in one pass over the rows, by
//! sums and products alone, so that the result is the same on every processor.

#[cfg(test)]
mod camera_tests;
mod creases;
mod draws;
mod occlusion;
mod pattern;
mod stereo;
mod stereo_config;
mod structured_light;
mod structured_light_config;
mod wandering;
mod window;

pub use stereo::StereoErrors;
pub use stereo_config::{CreaseTuning, MatchTuning, PatternTuning, StereoConfig, StereoTuning};
pub use structured_light::StructuredLightErrors;
pub use structured_light_config::StructuredLightConfig;

/// Added and taken away again, it leaves the nearest integer of what is below 2^22: single precision holds no more beside it.
const INTEGERS: f32 = (3_u32 << 22) as f32;

/// The nearest integer of a number below [`LARGEST`] in size; of two equally near the even one.
#[inline]
fn nearest(x: f32) -> f32 {
    (x + INTEGERS) - INTEGERS
}

/// The largest number whose nearest integer is found.
const LARGEST: f32 = (1_u32 << 22) as f32;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_integer_is_that_of_the_standard_library() {
        for i in -4000..4000_i16 {
            let x = f32::from(i) / 16.0;
            assert_eq!(nearest(x), x.round_ties_even());
        }
        assert_eq!(nearest(LARGEST - 1.25), LARGEST - 1.0);
    }
}
