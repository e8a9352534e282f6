//! What makes one segmenter differ from the others: how it finds surfaces in a picture.

use super::view::{Linear, View};

/// Most regions that are told apart in one frame; smaller ones are left out.
pub(crate) const MAX_REGIONS: usize = 63;

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
pub(super) const fn fineness(pixels: usize) -> usize {
    let finer = (pixels / ENOUGH).isqrt();
    if finer > 1 { finer } else { 1 }
}

/// A region of one surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Region {
    /// Disparity over `g`, 1/m; 0 of a surface that is not horizontal.
    pub q: f32,
    /// Pixels.
    pub support: usize,
    /// Pixels that the erosion leaves.
    pub core: usize,
    /// The disparities of its plane, px, from finders that find planes in any direction.
    pub plane: Option<Linear>,
    /// Whether that plane is a slope to walk on.
    pub is_slope: bool,
}

/// How often a picture was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// For the first time, under a view that is a guess.
    First,
    /// Again, under a better view.
    Again,
}

/// Finds surfaces.
pub trait Finder: Send + Sync {
    /// Whether it finds planes in any direction, not horizontal ones only.
    const ANY_DIRECTION: bool;

    /// Fills `regions` with what `picture` shows under `view`, and `labels` with their pixels (0: none, i + 1: region i).
    /// Before another look both still hold what the last one left.
    fn find(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        look: Look,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    );
}

/// Pixels whose labels are compared together.
const CHUNK: usize = 16;

/// Tells how many pixels have which label, some at a time: most lie among their like.
pub(crate) fn count_labels(labels: &[u16], mut add: impl FnMut(usize, usize)) {
    let (chunks, rest) = labels.as_chunks::<CHUNK>();
    for chunk in chunks {
        let first = chunk[0];
        if chunk
            .iter()
            .fold(0, |differs, label| differs | (label ^ first))
            == 0
        {
            add(usize::from(first), CHUNK);
        } else {
            for &label in chunk {
                add(usize::from(label), 1);
            }
        }
    }
    for &label in rest {
        add(usize::from(label), 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_robots_image_is_as_fine_as_it_is_and_larger_ones_are_finer() {
        let sizes = [[30, 20], [88, 72], [160, 120], [320, 240], [640, 480]];
        assert_eq!(sizes.map(|[w, h]| fineness(w * h)), [1, 1, 1, 3, 6]);
    }

    proptest! {
        #[test]
        fn every_pixel_is_counted_once(runs in prop::collection::vec((0..4u16, 1..40usize), 0..12)) {
            let labels: Vec<u16> =
                runs.iter().flat_map(|&(label, count)| std::iter::repeat_n(label, count)).collect();
            let mut counts = [0; 4];
            count_labels(&labels, |label, pixels| counts[label] += pixels);
            for (label, &count) in counts.iter().enumerate() {
                let of_label = labels.iter().filter(|&&other| usize::from(other) == label);
                prop_assert_eq!(count, of_label.count());
            }
        }
    }
}
