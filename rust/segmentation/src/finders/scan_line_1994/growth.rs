//! Regions grown from three neighbouring segments that lie on one plane.

use nalgebra::Vector3;

use super::{config::ScanLine1994Config, lines::StraightSegment};
use crate::finders::free_planes::planes::FreePlanes;
use crate::picture::{Linear, Picture};
use crate::regions::PlaneSums;

/// Grows regions. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct PlaneGrowth {
    /// Smallest region, pixels.
    min_region: usize,
    /// Label of each segment; 0: none.
    label_of: Vec<u16>,
    /// Where each scan line's segments start.
    starts: Vec<usize>,
    /// Triples of segments and their length together.
    seeds: Vec<(usize, [usize; 3])>,
    members: Vec<usize>,
    queue: Vec<usize>,
}

impl PlaneGrowth {
    pub(super) fn new(min_region: usize) -> Self {
        Self {
            min_region,
            ..Self::default()
        }
    }

    /// Finds the planes and the pixels of each.
    pub(super) fn grow(
        &mut self,
        picture: Picture<'_>,
        segments: &[StraightSegment],
        config: &ScanLine1994Config,
        planes: &mut FreePlanes,
        labels: &mut [u16],
    ) {
        planes.clear();
        labels.fill(0);
        self.label_of.clear();
        self.label_of.resize(segments.len(), 0);
        self.index(segments, picture.width.div_ceil(config.strip));
        self.find_seeds(segments, config.tuning.overlap);
        for at in 0..self.seeds.len() {
            let (_, seed) = self.seeds[at];
            if planes.is_full() || seed.iter().any(|&segment| self.label_of[segment] > 0) {
                continue;
            }
            let Some(plane) = self.grow_one(segments, seed, config) else {
                continue;
            };
            let label = planes.add(Linear::new(&plane));
            for &member in &self.members {
                self.label_of[member] = label;
                paint(
                    picture,
                    &segments[member],
                    &Linear::new(&plane),
                    config,
                    label,
                    labels,
                );
            }
        }
        planes.spread(picture, config.accept as f32, labels, &mut self.queue);
    }

    fn index(&mut self, segments: &[StraightSegment], strips: usize) {
        self.starts.clear();
        let mut at = 0;
        for strip in 0..=strips {
            while at < segments.len() && segments[at].strip < strip {
                at += 1;
            }
            self.starts.push(at);
        }
    }

    /// The segments of a scan line; none beside the picture.
    fn of_strip(&self, strip: Option<usize>) -> std::ops::Range<usize> {
        let bounds = strip.and_then(|s| Some((*self.starts.get(s)?, *self.starts.get(s + 1)?)));
        bounds.map_or(0..0, |(start, end)| start..end)
    }

    /// All triples of segments on three scan lines side by side that overlap, the longest first.
    fn find_seeds(&mut self, segments: &[StraightSegment], overlap: f64) {
        let mut seeds = std::mem::take(&mut self.seeds);
        seeds.clear();
        for (at, middle) in segments.iter().enumerate() {
            for left in self.of_strip(middle.strip.checked_sub(1)) {
                for right in self.of_strip(Some(middle.strip + 1)) {
                    let (a, b) = (&segments[left], &segments[right]);
                    if a.overlaps(middle, overlap) && b.overlaps(middle, overlap) {
                        let length = a.length() + middle.length() + b.length();
                        seeds.push((length, [left, at, right]));
                    }
                }
            }
        }
        seeds.sort_by_key(|&(length, _)| std::cmp::Reverse(length));
        self.seeds = seeds;
    }

    /// Takes in segments beside the members as long as their ends lie on the plane through all of them; fills `members`.
    fn grow_one(
        &mut self,
        segments: &[StraightSegment],
        seed: [usize; 3],
        config: &ScanLine1994Config,
    ) -> Option<Vector3<f64>> {
        let mut sums = PlaneSums::default();
        for segment in seed {
            sums.join(&segments[segment].sums);
        }
        let mut plane = sums.plane()?;
        let accept_px = f64::from(config.accept as f32);
        if !seed
            .iter()
            .all(|&segment| lies_on(&segments[segment], &plane, accept_px))
        {
            return None;
        }
        self.members.clear();
        self.members.extend(seed);
        self.queue.clear();
        self.queue.extend(seed);
        while let Some(at) = self.queue.pop() {
            let segment = &segments[at];
            for strip in [segment.strip.checked_sub(1), Some(segment.strip + 1)] {
                for beside in self.of_strip(strip) {
                    let other = &segments[beside];
                    let free = self.label_of[beside] == 0 && !self.members.contains(&beside);
                    let joins = free && other.overlaps(segment, config.tuning.overlap);
                    if joins && lies_on(other, &plane, accept_px) {
                        self.members.push(beside);
                        self.queue.push(beside);
                        sums.join(&other.sums);
                        plane = sums.plane().unwrap_or(plane);
                    }
                }
            }
        }
        let rows: usize = self.members.iter().map(|&at| segments[at].length()).sum();
        (rows * config.strip >= self.min_region).then_some(plane)
    }
}

fn lies_on(segment: &StraightSegment, plane: &Vector3<f64>, accept_px: f64) -> bool {
    let rows = [segment.first, segment.end - 1];
    rows.iter().zip(segment.ends_px).all(|(&row, d)| {
        let there = plane.dot(&Vector3::new(segment.col, row as f64, 1.0));
        (d - there).abs() < accept_px
    })
}

/// Labels the pixels of a segment that lie on the plane.
fn paint(
    picture: Picture<'_>,
    segment: &StraightSegment,
    plane: &Linear,
    config: &ScanLine1994Config,
    label: u16,
    labels: &mut [u16],
) {
    let left = segment.strip * config.strip;
    let accept_px = config.accept as f32;
    for row in segment.first..segment.end {
        for col in left..(left + config.strip).min(picture.width) {
            let at = row * picture.width + col;
            if plane.passes(col, row, picture.disparity_px[at], accept_px) {
                labels[at] = label;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::lines::Lines;
    use super::*;
    use crate::picture::view::View;
    use crate::regions::Look;
    use testkit::synthetic::{CAMERA, camera_pose};

    fn grown(d: impl Fn(usize, usize) -> f32) -> (Vec<u16>, FreePlanes) {
        let (width, height) = (CAMERA.width, CAMERA.height);
        let disparity_px: Vec<f32> = (0..width * height)
            .map(|at| d(at % width, at / width))
            .collect();
        let picture = Picture {
            width,
            disparity_px: &disparity_px,
            g: &disparity_px,
            sigma_px: &disparity_px,
            finer: 1,
        };
        let config = ScanLine1994Config {
            strip: 4,
            split: 0.3,
            accept: 0.3,
            ..ScanLine1994Config::default()
        };
        let mut segments = Vec::new();
        Lines::default().cut(picture, &config, &mut segments);
        let (mut planes, mut labels) = (FreePlanes::default(), vec![0; width * height]);
        PlaneGrowth::new(80).grow(picture, &segments, &config, &mut planes, &mut labels);
        (labels, planes)
    }

    #[test]
    fn one_plane_is_one_region_of_all_pixels() {
        let (labels, _) = grown(|col, row| 4.0 + 0.02 * col as f32 + 0.1 * row as f32);
        assert!(labels.iter().all(|&label| label == 1));
    }

    #[test]
    fn two_planes_that_meet_are_two_regions() {
        let (mut labels, mut planes) = grown(|_, row| 4.0 + 0.15 * (row as f32 - 36.0).abs());
        let rotation = camera_pose(0.0, 0.8).inner.rotation.to_rotation_matrix();
        let mut regions = Vec::new();
        planes.show(
            &View::new(&CAMERA, &rotation),
            Look::First,
            &mut labels,
            &mut regions,
        );
        assert_eq!(regions.len(), 2);
        assert_ne!(labels[0], labels[labels.len() - 1]);
        assert!(regions.iter().all(|region| region.support > 2500));
    }
}
