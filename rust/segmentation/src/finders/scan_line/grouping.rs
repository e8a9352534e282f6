//! Region growing: segments of neighbouring strips that show one surface, then pixels, then regions of equal height.

use super::config::ScanLineConfig;
use super::contacts::{RegionContacts, places_of_some};
use super::strips::{LevelSegment, columns_of};
use crate::picture::{MAX_REGIONS, Picture, count_labels};
use crate::regions::Region;

/// Grows regions. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Grouping {
    /// Smallest region, pixels.
    min_region: usize,
    parent: Vec<usize>,
    region_of: Vec<u16>,
    queue: Vec<usize>,
    // Not zero where a pixel's neighbours have other labels.
    differs: Vec<u16>,
    // By the first segment of a group: its pixels, and the sum of its weights.
    groups: Vec<(u32, f32)>,
    contacts: RegionContacts,
}

fn root(parent: &[usize], mut at: usize) -> usize {
    while parent[at] != at {
        at = parent[at];
    }
    at
}

/// Makes two groups one, under the lower of their roots.
fn unite(parent: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parent, a), root(parent, b));
    parent[a.max(b)] = a.min(b);
}

impl Grouping {
    pub(super) fn new(min_region: usize) -> Self {
        Self {
            min_region,
            ..Self::default()
        }
    }

    /// Joins the segments of neighbouring strips that overlap and agree; fills `regions` with the groups that are large
    /// enough and `labels` with their pixels (0: none, i + 1: region i).
    pub(super) fn group(
        &mut self,
        picture: Picture<'_>,
        segments: &[LevelSegment],
        config: &ScanLineConfig,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        self.parent.clear();
        self.parent.extend(0..segments.len());
        let mut left = 0;
        for (at, segment) in segments.iter().enumerate() {
            while segments[left].strip + 1 < segment.strip {
                left += 1;
            }
            let mut other = left;
            while segments[other].strip + 1 == segment.strip {
                if alike(picture, config, &segments[other], segment) {
                    unite(&mut self.parent, other, at);
                }
                other += 1;
            }
        }
        let columns = columns_of(picture, config);
        self.collect(segments, columns, regions);
        labels.fill(0);
        let accept = config.accept as f32;
        for (at, segment) in segments.iter().enumerate() {
            let label = self.region_of[root(&self.parent, at)];
            if label == 0 {
                continue;
            }
            let q = regions[usize::from(label) - 1].q;
            let first = segment.strip * columns;
            let end = (first + columns).min(picture.width);
            for row in segment.first..segment.end {
                let line = row * picture.width + first..row * picture.width + end;
                let pixels = picture.disparity_px[line.clone()]
                    .iter()
                    .zip(&picture.g[line.clone()])
                    .zip(&picture.sigma_px[line.clone()]);
                for (target, ((d, g), sigma)) in labels[line].iter_mut().zip(pixels) {
                    let close = (d - q * g).abs() < accept * sigma;
                    *target = if close { label } else { *target };
                }
            }
        }
    }

    /// Numbers the groups that are large enough, in the order of their first segments.
    fn collect(&mut self, segments: &[LevelSegment], columns: usize, regions: &mut Vec<Region>) {
        regions.clear();
        self.groups.clear();
        self.groups.resize(segments.len(), (0, 0.0));
        self.region_of.clear();
        self.region_of.resize(segments.len(), 0);
        for (at, segment) in segments.iter().enumerate() {
            let group = &mut self.groups[root(&self.parent, at)];
            group.0 += ((segment.end - segment.first) * columns) as u32;
            group.1 += segment.weight;
        }
        for at in 0..segments.len() {
            if self.parent[at] == at
                && self.groups[at].0 as usize >= self.min_region
                && regions.len() < MAX_REGIONS
            {
                regions.push(Region::default());
                self.region_of[at] = regions.len() as u16;
            }
        }
        for (at, segment) in segments.iter().enumerate() {
            let group = root(&self.parent, at);
            let label = usize::from(self.region_of[group]);
            if label > 0 {
                regions[label - 1].q += segment.q * segment.weight / self.groups[group].1;
                regions[label - 1].support += (segment.end - segment.first) * columns;
            }
        }
    }

    /// Lets the regions take in the neighbouring pixels that lie on their surfaces; a pixel goes to the surface that it
    /// is closest to among its neighbours'.
    pub(super) fn grow(
        &mut self,
        picture: Picture<'_>,
        config: &ScanLineConfig,
        regions: &[Region],
        labels: &mut [u16],
    ) {
        let width = picture.width;
        let pixels = labels.len();
        let accept = config.accept as f32;
        let inner = |at: usize| {
            let col = at % width;
            col > 0 && col + 1 < width && at >= width && at + width < pixels
        };
        self.find_borders(width, labels);
        let mut next = 0;
        while next < self.queue.len() {
            let at = self.queue[next];
            next += 1;
            let label = labels[at];
            let q = regions[usize::from(label) - 1].q;
            for beside in [at - 1, at + 1, at - width, at + width] {
                let d = picture.disparity_px[beside];
                if d.is_nan() || labels[beside] == label {
                    continue;
                }
                let sigma = picture.sigma_px[beside];
                let miss = (d - q * picture.g[beside]).abs();
                let beats = match labels[beside] {
                    0 => miss < accept * sigma,
                    other => {
                        let rival = regions[usize::from(other) - 1].q;
                        miss + sigma < (d - rival * picture.g[beside]).abs()
                    }
                };
                if beats {
                    labels[beside] = label;
                    if inner(beside) {
                        self.queue.push(beside);
                    }
                }
            }
        }
    }

    /// Queues the pixels of regions that have other pixels beside them; not those at the image's border.
    fn find_borders(&mut self, width: usize, labels: &[u16]) {
        self.queue.clear();
        for row in 1..(labels.len() / width).saturating_sub(1) {
            let first = row * width;
            let [above, here, below] =
                [first - width, first, first + width].map(|first| &labels[first..first + width]);
            self.differs.clear();
            let beside = here.windows(3).zip(&above[1..]).zip(&below[1..]);
            self.differs.extend(beside.map(|((line, &above), &below)| {
                let label = line[1];
                let others =
                    (line[0] ^ label) | (line[2] ^ label) | (above ^ label) | (below ^ label);
                if label > 0 { others } else { 0 }
            }));
            let differs = places_of_some(&self.differs);
            self.queue.extend(differs.map(|col| first + col + 1));
        }
    }

    /// Joins regions that touch and have equal heights, drops what is too small, and numbers the rest anew. Supports are
    /// counted in pixels afterwards; `q` is the mean by support.
    pub(super) fn merge(
        &mut self,
        picture: Picture<'_>,
        config: &ScanLineConfig,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    ) {
        let (count, tuning) = (regions.len(), &config.tuning);
        let joins = [config.join, tuning.small_join * config.join].map(|join| join as f32);
        self.contacts
            .count(picture, count, labels, tuning.contact_reach);
        self.parent.clear();
        self.parent.extend(0..count);
        for i in 0..count {
            for j in i + 1..count {
                let (times, limit) = self.contacts.between(i, j);
                if times < tuning.min_contacts {
                    continue;
                }
                // The mean of sigma / g at the border turns the noise into a difference of q.
                let apart = (regions[i].q - regions[j].q).abs();
                let small = regions[i].support.min(regions[j].support) < tuning.small_region;
                let join = joins[usize::from(small)];
                if apart < join * limit / times as f32 {
                    unite(&mut self.parent, i, j);
                }
            }
        }
        self.region_of.clear();
        self.region_of.resize(count, 0);
        for region in regions.iter_mut() {
            region.support = 0;
        }
        count_labels(labels, |label, pixels| {
            if let Some(index) = label.checked_sub(1) {
                regions[index].support += pixels;
            }
        });
        for i in 0..count {
            let to = root(&self.parent, i);
            if to != i {
                let (part, whole) = (regions[i], regions[to]);
                let support = part.support + whole.support;
                if support > 0 {
                    regions[to].q = (part.q * part.support as f32 + whole.q * whole.support as f32)
                        / support as f32;
                    regions[to].support = support;
                }
            }
        }
        let mut kept = 0;
        for i in 0..count {
            if self.parent[i] == i && regions[i].support >= self.min_region {
                regions[kept] = regions[i];
                kept += 1;
                self.region_of[i] = kept as u16;
            }
        }
        for i in 0..count {
            self.region_of[i] = self.region_of[root(&self.parent, i)];
        }
        regions.truncate(kept);
        // Pixels without a region keep their 0.
        self.region_of.insert(0, 0);
        for label in labels {
            *label = self.region_of[usize::from(*label)];
        }
    }
}

/// Whether two segments of neighbouring strips show one surface.
fn alike(
    picture: Picture<'_>,
    config: &ScanLineConfig,
    a: &LevelSegment,
    b: &LevelSegment,
) -> bool {
    let (first, end) = (a.first.max(b.first), a.end.min(b.end));
    let shorter = (a.end - a.first).min(b.end - b.first) as f64;
    if end < first || ((end - first) as f64) < config.tuning.overlap * shorter {
        return false;
    }
    let row = usize::midpoint(first, end);
    let col = (b.strip * columns_of(picture, config)).min(picture.width - 1);
    let g = picture.g[row * picture.width + col];
    (a.q - b.q).abs() * g < config.join as f32 * picture.sigma_px[row * picture.width + col]
}
