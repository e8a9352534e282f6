//! Where a surface that meets a slope ends: what is seen there is off its plane by more than noise.

use std::ops::Range;

use super::tuning::SlopeDoubtTuning;
use crate::picture::SeenPicture;

/// Finds pixels around which a surface is off what is seen. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Doubts {
    tuning: SlopeDoubtTuning,
    /// Pixels that tell as much as one independent one.
    alike: f32,
    /// `(a, b, q)` of each region's plane; none of what is neither level nor a slope.
    pub(super) planes: Vec<Option<[f32; 3]>>,
    /// How far each pixel is off its surface, in noises, and sums of it up and down.
    miss: Vec<f32>,
    sums: Vec<[f32; 2]>,
    /// Pixels of each region, and those of them that are in doubt.
    counts: Vec<[usize; 2]>,
}

impl Doubts {
    /// Buffers that are still empty.
    pub(super) fn new(tuning: SlopeDoubtTuning, alike: f64) -> Self {
        Self {
            tuning,
            alike: alike as f32,
            ..Self::default()
        }
    }

    /// Marks the pixels around which the mean of their region is further off its plane than noise would have it: a part of a slope
    /// that was taken for the level it leads to, or ground that a slope was grown over.
    pub(super) fn find(&mut self, seen: SeenPicture<'_>, labels: &[u16], doubtful: &mut [bool]) {
        let SlopeDoubtTuning { accept, sure, .. } = self.tuning;
        let width = seen.picture.width;
        let planes = &self.planes;
        self.miss.clear();
        self.miss
            .extend(labels.iter().enumerate().map(|(at, &label)| {
                let plane = usize::from(label).checked_sub(1);
                let plane = plane.and_then(|index| planes[index]);
                plane.map_or(0.0, |plane| seen.miss(at, plane).clamp(-accept, accept))
            }));
        let rows = labels.len() / width;
        let mut sums = std::mem::take(&mut self.sums);
        sums.clear();
        sums.extend((0..labels.len()).map(|at| {
            let (col, row) = (at % width, at / width);
            let along = self.reach(row, rows).map(|row| row * width + col);
            sum(labels, at, along, |at| [self.miss[at], 1.0])
        }));
        self.counts.clear();
        self.counts.resize(planes.len(), [0; 2]);
        for (at, doubtful) in doubtful
            .iter_mut()
            .enumerate()
            .filter(|(at, _)| labels[*at] > 0)
        {
            let (col, line) = (at % width, at - at % width);
            let along = self.reach(col, width).map(|col| line + col);
            let [total, count] = sum(labels, at, along, |at| sums[at]);
            // The mean, in its own standard deviations, squared.
            let is_off = total * total > sure * sure * count * self.alike;
            *doubtful |= is_off;
            let [all, off] = &mut self.counts[usize::from(labels[at]) - 1];
            (*all, *off) = (*all + 1, *off + usize::from(is_off));
        }
        self.sums = sums;
    }

    /// The regions of which so much is in doubt that they are parts of several surfaces.
    pub(super) fn mixed(&self) -> impl Iterator<Item = usize> {
        let least = f64::from(self.tuning.mixed);
        let counts = self.counts.iter().enumerate();
        counts.filter_map(move |(index, [all, off])| {
            (*off as f64 > least * *all as f64).then_some(index)
        })
    }

    /// What is averaged along one axis around a place.
    fn reach(&self, at: usize, count: usize) -> Range<usize> {
        at.saturating_sub(self.tuning.around)..(at + self.tuning.around + 1).min(count)
    }
}

/// Sums over those of some pixels that are of the same region as the one at `at`.
fn sum(
    labels: &[u16],
    at: usize,
    along: impl Iterator<Item = usize>,
    of: impl Fn(usize) -> [f32; 2],
) -> [f32; 2] {
    let same = along.filter(|&other| labels[other] == labels[at]);
    same.fold([0.0; 2], |[sum, count], other| {
        let [more, further] = of(other);
        [sum + more, count + further]
    })
}

#[cfg(test)]
mod tests {
    use testkit::synthetic::{CAMERA, camera_pose};

    use super::*;
    use crate::picture::{Picture, View};

    /// Marks of a picture of one level surface, in whose right half it is seen `off` noises nearer than it is.
    fn marks(off: f32) -> Vec<bool> {
        let (width, count) = (CAMERA.width, CAMERA.width * CAMERA.height);
        let rotation = camera_pose(0.0, 0.85).inner.rotation.to_rotation_matrix();
        let view = View::new(&CAMERA, &rotation);
        let (mut g, sigma_px) = (vec![0.0; count], vec![0.5; count]);
        view.fill(width, &mut g);
        let nearer = |at: usize| {
            if at % width < width / 2 {
                0.0
            } else {
                0.5 * off
            }
        };
        let disparity_px: Vec<f32> = (g.iter().enumerate())
            .map(|(at, g)| g + nearer(at))
            .collect();
        let picture = Picture {
            width,
            disparity_px: &disparity_px,
            g: &g,
            sigma_px: &sigma_px,
            finer: 1,
        };
        let mut doubts = Doubts::new(SlopeDoubtTuning::default(), 25.0);
        doubts.planes.push(Some([0.0, 0.0, 1.0]));
        let mut doubtful = vec![false; count];
        let seen = SeenPicture {
            picture,
            view: &view,
        };
        doubts.find(seen, &vec![1; count], &mut doubtful);
        doubtful
    }

    #[test]
    fn what_is_off_by_two_noises_all_around_is_in_doubt_and_what_is_off_by_one_is_not() {
        for off in [2.0, -2.0] {
            let marked = marks(off);
            let line = &marked[CAMERA.width * 30..][..CAMERA.width];
            assert!(line[CAMERA.width * 3 / 4] && !line[CAMERA.width / 4]);
        }
        assert!(!marks(1.0).contains(&true));
    }
}
