//! Which pixels belong to a plane: those around its pieces, too, and at borders those that it explains best.

use nalgebra::Vector3;

use super::config::ScanLineAdaptiveConfig;
use crate::finders::free_planes::flood::flood;
use crate::picture::{Linear, Picture, neighbours};

/// A plane with its own noise.
#[derive(Debug, Clone, Copy)]
pub(super) struct NoisyPlane {
    pub(super) plane: Linear,
    /// Inverse of its noise, 1/px.
    precision: f32,
    /// Twice the logarithm of its noise.
    vagueness: f32,
}

impl NoisyPlane {
    pub(super) fn new(plane: &Vector3<f64>, sigma_px: f64) -> Self {
        Self {
            plane: Linear::new(plane),
            precision: (1.0 / sigma_px) as f32,
            vagueness: (2.0 * sigma_px.ln()) as f32,
        }
    }

    /// How unlikely a disparity is; none when it is further away than `accept` noises.
    fn misfit(&self, col: usize, row: usize, d: f32, accept: f32) -> Option<f32> {
        let there = self.plane.at(col, row);
        let miss = (d - there) * self.precision;
        // Also false where nothing was seen.
        (there > 0.0 && miss.abs() < accept).then_some(miss * miss + self.vagueness)
    }
}

/// Lets the planes of `labels` take in pixels beside theirs, and give those away that a neighbour explains better.
pub(super) fn settle_borders(
    picture: Picture<'_>,
    planes: &[NoisyPlane],
    config: &ScanLineAdaptiveConfig,
    labels: &mut [u16],
    queue: &mut Vec<usize>,
) {
    let misfit = |label: u16, at: usize| {
        let plane = &planes[usize::from(label.checked_sub(1)?)];
        let (col, row) = (at % picture.width, at / picture.width);
        plane.misfit(col, row, picture.disparity_px[at], config.accept as f32)
    };
    for (at, label) in labels.iter_mut().enumerate() {
        if misfit(*label, at).is_none() {
            *label = 0;
        }
    }
    flood(labels, picture.width, queue, |label, at| {
        misfit(label, at).is_some()
    });
    for _ in 0..config.tuning.border_rounds {
        for at in 0..labels.len() {
            let Some(mut least) = misfit(labels[at], at) else {
                continue;
            };
            for beside in neighbours(at, picture.width, labels.len()) {
                let other = labels[beside];
                if other != labels[at]
                    && let Some(theirs) = misfit(other, at).filter(|theirs| *theirs < least)
                {
                    least = theirs;
                    labels[at] = other;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_takes_what_it_explains_and_gives_away_what_another_explains_better() {
        // A roof whose ridge is at row 20; its pixels are given to the wrong side from row 16 on, and some to none.
        let width = 10;
        let planes = [[0.0, 0.2, 2.0], [0.0, -0.2, 10.0]]
            .map(|plane| NoisyPlane::new(&Vector3::from(plane), 0.05));
        let disparity_px: Vec<f32> = (0..400)
            .map(|at| 2.0 + 0.2 * (at / width).min(40 - at / width) as f32)
            .collect();
        let mut labels: Vec<u16> = (0..400).map(|at| 1 + u16::from(at / width > 15)).collect();
        labels[30..60].fill(0);
        let picture = Picture {
            width,
            disparity_px: &disparity_px,
            g: &disparity_px,
            sigma_px: &disparity_px,
            finer: 1,
        };
        let config = ScanLineAdaptiveConfig::default();
        settle_borders(picture, &planes, &config, &mut labels, &mut Vec::new());
        for (at, label) in labels.iter().enumerate() {
            let row = at / width;
            assert!(row == 20 || *label == 1 + u16::from(row > 20), "{at}");
        }
    }
}
