//! The camera's height by floor that is known from before: what takes the ground's place where that is out of view.

use nalgebra::Vector3;
use settings::{POSITIVE, SHARE, settings, within};

use crate::picture::View;
use crate::planes::KnownFloor;
use crate::regions::{Finder, FrameSurfaces, Region};

settings! {
    /// How the camera's height is told by floor that is known from before.
    pub struct KnownFloorTuning("navigation.ground.tuning.known_floor") {
        /// Every so many columns and rows a pixel is looked up: neighbours lie in the same cells of a map. Of finer images as many
        /// pixels as of coarse ones.
        stride: usize = 2, "1", within(1.0, 100.0);
        /// Fewest pixels of a region of which the floor's height must be known.
        min_looked_up: usize = 12, "1", POSITIVE;
        /// Surfaces further away than this are not compared: a tilt of half a degree is 6 mm there.
        near: f64 = 0.7, "m", POSITIVE;
        /// Heights of one surface differ by less than this between the cells of a map.
        one_surface: f32 = 0.004, "m", POSITIVE;
        /// Share of the pixels that were looked up, of a region and of all regions, above which those that agree with the middle one
        /// are believed. At the border of a surface a cell of the map may hold the neighbour's height; of most of a surface it does not.
        agreeing: f64 = 0.5, "1", SHARE;
        /// Share of a ground's pixels that must be near for it to tell the camera's height better than known floor does.
        near_share: f64 = 0.25, "1", SHARE;
    }
}

/// How one region lies against the floor that is known at its place.
#[derive(Debug, Clone, Copy)]
struct Vote {
    region: usize,
    /// Pixels that were looked up, and those that agree with the middle one.
    looked_up: usize,
    agree: usize,
    /// Middle of known height less seen height, m, and its mean over those that agree.
    middle_m: f32,
    mean_m: f64,
}

impl Vote {
    /// Whether more than this share of the pixels agree.
    fn is_clear(&self, agreeing: f64) -> bool {
        self.agree as f64 > agreeing * self.looked_up as f64
    }
}

/// Compares the regions of a frame with the known floor. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct KnownLevels {
    tuning: KnownFloorTuning,
    // Of so many pixels one is looked up.
    looked_up_of: usize,
    votes: Vec<Vote>,
    /// What slopes tell of it, where no level surface does.
    slopes: Vec<Vote>,
    misses_m: Vec<Vec<f32>>,
    /// Pixels of each region that are near, and all of them.
    near: Vec<(usize, usize)>,
}

impl KnownLevels {
    /// Nothing compared yet.
    pub(crate) fn new(tuning: KnownFloorTuning) -> Self {
        Self {
            tuning,
            ..Self::default()
        }
    }

    /// Looks up the known heights where the level regions and the slopes of `surfaces` lie, seen from `camera_m` (robot frame).
    pub(crate) fn compare(
        &mut self,
        surfaces: &FrameSurfaces<impl Finder>,
        view: &View,
        camera_m: &Vector3<f64>,
        known: &KnownFloor<'_>,
    ) {
        let (stride, near_m) = (self.tuning.stride * surfaces.finer(), self.tuning.near);
        self.looked_up_of = stride * stride;
        self.votes.clear();
        let count = surfaces.regions.len();
        self.misses_m
            .resize_with(self.misses_m.len().max(count), Vec::new);
        self.misses_m.iter_mut().for_each(Vec::clear);
        self.near.clear();
        self.near.resize(count, (0, 0));
        for (row, col, label) in surfaces.inner_pixels(stride) {
            let region = usize::from(label) - 1;
            let falls = f64::from(view.g.at(col, row));
            let depth = match &surfaces.regions[region] {
                Region {
                    plane: Some(plane),
                    is_slope: true,
                    ..
                } => 1.0 / f64::from(plane.at(col, row)),
                level => 1.0 / (f64::from(level.q) * falls),
            };
            let below_m = depth * falls;
            let x_m = camera_m.x + f64::from(view.x.at(col, row)) * depth;
            let y_m = camera_m.y + f64::from(view.y.at(col, row)) * depth;
            self.near[region].1 += 1;
            if x_m * x_m + y_m * y_m > near_m * near_m {
                continue;
            }
            self.near[region].0 += 1;
            if let Some(height_m) = known(x_m, y_m) {
                self.misses_m[region].push((height_m - (camera_m.z - below_m)) as f32);
            }
        }
        for region in (0..count).filter(|&region| surfaces.is_level(region)) {
            let vote = vote(region, &mut self.misses_m[region], &self.tuning);
            self.votes.extend(vote);
        }
        let slopes = (0..count).filter(|&region| surfaces.regions[region].is_slope);
        self.slopes.clear();
        self.slopes.extend(
            slopes.filter_map(|region| vote(region, &mut self.misses_m[region], &self.tuning)),
        );
    }

    /// Whether a slope lies within `gate_m` of where it is known to lie, and is tilted as it is known to be.
    pub(crate) fn has_known_slope(&self, gate_m: f64) -> bool {
        self.slopes.iter().any(|vote| {
            vote.is_clear(self.tuning.agreeing) && f64::from(vote.middle_m.abs()) < gate_m
        })
    }

    /// Whether a good part of a region is near enough to tell the height well.
    pub(crate) fn is_near(&self, region: usize) -> bool {
        let (near, all) = self.near[region];
        near as f64 > self.tuning.near_share * all as f64
    }

    /// Whether floor at another height than 0 is known where a region lies that is seen at `height_m`.
    pub(crate) fn is_elsewhere(&self, region: usize, height_m: f64, gate_m: f64) -> bool {
        self.votes
            .iter()
            .find(|vote| vote.region == region && vote.is_clear(self.tuning.agreeing))
            .is_some_and(|vote| (height_m + vote.mean_m).abs() > gate_m)
    }

    /// What brings the regions onto the known floor, m: the mean over those that agree on it, where they lie no further
    /// off than `gate_m`, make up most of what is known in view and hold `least` pixels.
    pub(crate) fn rise_m(&mut self, gate_m: f64, least: usize) -> Option<f64> {
        let KnownFloorTuning {
            agreeing,
            one_surface,
            ..
        } = self.tuning;
        self.votes.retain(|vote| vote.is_clear(agreeing));
        self.votes.sort_by(|a, b| a.middle_m.total_cmp(&b.middle_m));
        let all: usize = self.votes.iter().map(|vote| vote.looked_up).sum();
        let mut before = 0;
        let middle_m = self.votes.iter().find_map(|vote| {
            before += vote.looked_up;
            (2 * before >= all).then_some(vote.middle_m)
        })?;
        let (mut agree, mut sum_m) = (0, 0.0);
        for vote in &self.votes {
            if (vote.middle_m - middle_m).abs() < one_surface {
                agree += vote.agree;
                sum_m += vote.mean_m * vote.agree as f64;
            }
        }
        let rise_m = sum_m / agree.max(1) as f64;
        let enough = agree * self.looked_up_of >= least && agree as f64 > agreeing * all as f64;
        (enough && rise_m.abs() < gate_m).then_some(rise_m)
    }
}

fn vote(region: usize, misses_m: &mut [f32], tuning: &KnownFloorTuning) -> Option<Vote> {
    let looked_up = misses_m.len();
    if looked_up < tuning.min_looked_up {
        return None;
    }
    let (_, middle_m, _) = misses_m.select_nth_unstable_by(looked_up / 2, f32::total_cmp);
    let middle_m = *middle_m;
    let (mut agree, mut sum_m) = (0, 0.0);
    for &miss_m in misses_m.iter() {
        if (miss_m - middle_m).abs() < tuning.one_surface {
            agree += 1;
            sum_m += f64::from(miss_m);
        }
    }
    Some(Vote {
        region,
        looked_up,
        agree,
        middle_m,
        mean_m: sum_m / agree as f64,
    })
}
