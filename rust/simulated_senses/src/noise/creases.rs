//! What matching a window finds where it holds more than one surface.

use crate::noise::window::larger;

/// Values that are looked at together.
const LANES: usize = 4;

/// Finds the disparity that matching a whole window gives where surfaces are apart: a mean shift with a flat kernel over the window's
/// disparities, from the nearest one on (Comaniciu and Meer 2002). Where all lie within the bandwidth this is their mean.
#[derive(Debug, Clone)]
pub(super) struct Crease {
    window: usize,
    bandwidth: f32,
    iterations: u32,
    inside: Vec<f32>,
}

impl Crease {
    pub(super) fn new(window: usize, bandwidth: f32, iterations: u32) -> Self {
        Self {
            window,
            bandwidth,
            iterations,
            // What fills up the last lanes is near to nothing.
            inside: vec![f32::INFINITY; (window * window).next_multiple_of(LANES)],
        }
    }

    /// The mode, and the mean, of the window whose first pixel is `first` in a picture of rows of `width`, px.
    pub(super) fn mode(&mut self, disparity: &[f32], width: usize, first: usize) -> (f32, f32) {
        let mut nearest = f32::NEG_INFINITY;
        let mut sum = 0.0;
        for (row, part) in self
            .inside
            .chunks_mut(self.window)
            .take(self.window)
            .enumerate()
        {
            let begin = first + row * width;
            for (value, there) in part.iter_mut().zip(&disparity[begin..]) {
                *value = *there;
                nearest = larger(nearest, *there);
                sum += there;
            }
        }
        let mut mode = nearest;
        for _ in 0..self.iterations {
            let next = self.mean_around(mode);
            if next == mode {
                break;
            }
            mode = next;
        }
        (mode, sum / (self.window * self.window) as f32)
    }

    fn mean_around(&self, mode: f32) -> f32 {
        let (mut sum, mut count) = ([0.0_f32; LANES], [0.0_f32; LANES]);
        for part in self.inside.as_chunks::<LANES>().0 {
            for lane in 0..LANES {
                let near = (part[lane] - mode).abs() < self.bandwidth;
                sum[lane] += if near { part[lane] } else { 0.0 };
                count[lane] += if near { 1.0 } else { 0.0 };
            }
        }
        sum.iter().sum::<f32>() / count.iter().sum::<f32>()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// What windows of 5 x 5 find across a step of `jump` between columns 14 and 15.
    fn across(jump: f32) -> Vec<f32> {
        let row: Vec<f32> = (0..30)
            .map(|i| if i < 15 { 6.0 } else { 6.0 + jump })
            .collect();
        let picture = row.repeat(5);
        let mut crease = Crease::new(5, 1.0, 4);
        (0..26)
            .map(|first| crease.mode(&picture, 30, first).0)
            .collect()
    }

    #[test]
    fn a_low_step_blends_over_the_window_and_an_object_is_as_wide_as_the_window_makes_it() {
        let low = across(0.6);
        let blended = low.iter().filter(|d| **d > 6.01 && **d < 6.59).count();
        assert_eq!(blended, 4);
        let object = across(4.0);
        assert!(object.iter().all(|d| *d == 6.0 || *d == 10.0));
        assert_eq!(object.iter().filter(|d| **d == 10.0).count(), 15);
    }

    #[test]
    fn within_the_bandwidth_the_mode_is_the_mean() {
        let picture: Vec<f32> = (0..25).map(|i| 5.0 + (i % 5) as f32 * 0.125).collect();
        let (mode, mean) = Crease::new(5, 1.0, 4).mode(&picture, 5, 0);
        assert_eq!((mode, mean), (5.25, 5.25));
    }

    proptest! {
        #[test]
        fn what_is_found_lies_within_the_window(
            picture in prop::collection::vec(0.0..32.0_f32, 25),
        ) {
            let (mode, _) = Crease::new(5, 1.0, 4).mode(&picture, 5, 0);
            let bounds = picture.iter().fold((f32::MAX, f32::MIN), |(low, high), value| {
                (low.min(*value), high.max(*value))
            });
            prop_assert!(mode >= bounds.0 - 1e-4 && mode <= bounds.1 + 1e-4);
        }
    }
}
