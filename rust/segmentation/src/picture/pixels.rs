//! The picture that surfaces are looked for in, and how fine it is.

/// What a finder sees, row by row.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// Columns.
    pub width: usize,
    /// Disparities, px; NaN where nothing was seen.
    pub disparity_px: &'a [f32],
    /// Fall of each pixel's ray, the `g` of the view, m px.
    pub g: &'a [f32],
    /// Local noise, px.
    pub sigma_px: &'a [f32],
    /// How many times finer the image is than is needed, each way.
    pub finer: usize,
}

/// How many times finer an image of so many pixels is, each way, than one of as many as are `enough`. Where pixels are looked at that
/// tell of whole surfaces, so many columns or rows may be left out: matching windows overlap, so that neighbours tell nearly alike.
pub(crate) const fn fineness(pixels: usize, enough: usize) -> usize {
    let finer = (pixels / enough).isqrt();
    if finer > 1 { finer } else { 1 }
}

/// The four pixels beside one.
pub(crate) fn neighbours(at: usize, width: usize, pixels: usize) -> impl Iterator<Item = usize> {
    let col = at % width;
    [
        (col > 0).then(|| at - 1),
        (col + 1 < width).then_some(at + 1),
        at.checked_sub(width),
        (at + width < pixels).then_some(at + width),
    ]
    .into_iter()
    .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_robots_image_is_as_fine_as_it_is_and_larger_ones_are_finer() {
        let sizes = [[30, 20], [88, 72], [160, 120], [320, 240], [640, 480]];
        assert_eq!(
            sizes.map(|[w, h]| fineness(w * h, 88 * 72)),
            [1, 1, 1, 3, 6]
        );
    }
}
