//! The picture that surfaces are looked for in, and how fine it is.

/// What a finder sees, row by row.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// Columns.
    pub width: usize,
    /// Disparities, px; NaN where nothing was seen.
    pub disparity_px: &'a [f32],
    /// `g` of each pixel, m px.
    pub g: &'a [f32],
    /// Local noise, px.
    pub sigma_px: &'a [f32],
}

/// Pixels of the robot's camera: what is looked at there is as much as is needed.
const ENOUGH: usize = 88 * 72;

/// How many times finer an image of so many pixels is than that of the robot's camera, each way. Where pixels are looked at that
/// tell of whole surfaces, so many columns or rows may be left out: matching windows overlap, so that they tell nearly the same.
pub(crate) const fn fineness(pixels: usize) -> usize {
    let finer = (pixels / ENOUGH).isqrt();
    if finer > 1 { finer } else { 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_robots_image_is_as_fine_as_it_is_and_larger_ones_are_finer() {
        let sizes = [[30, 20], [88, 72], [160, 120], [320, 240], [640, 480]];
        assert_eq!(sizes.map(|[w, h]| fineness(w * h)), [1, 1, 1, 3, 6]);
    }
}
