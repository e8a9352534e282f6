//! The camera's height by floor that is known from before: what takes the ground's place where that is out of view.

use nalgebra::Vector3;

use crate::KnownFloor;
use crate::picture::view::View;
use crate::regions::finder::Finder;
use crate::regions::surfaces::Surfaces;

/// Every so many columns and rows a pixel is looked up: neighbours lie in the same cells of a map.
const STRIDE: usize = 2;
/// Fewest pixels of a region of which the floor's height must be known.
const MIN_LOOKED_UP: usize = 12;
/// Surfaces further away than this are not compared, m: a tilt of half a degree is 6 mm there.
const NEAR_M: f64 = 0.7;
/// Heights of one surface differ by less than this between cells of a map, m.
const ONE_SURFACE_M: f32 = 0.004;

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
    /// At the border of a surface a cell of the map may hold the neighbour's height; of most of a surface it does not.
    const fn is_clear(&self) -> bool {
        2 * self.agree > self.looked_up
    }
}

/// Compares the regions of a frame with the known floor. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(crate) struct KnownLevels {
    votes: Vec<Vote>,
    misses_m: Vec<Vec<f32>>,
    /// Pixels of each region that are near, and all of them.
    near: Vec<(usize, usize)>,
}

impl KnownLevels {
    /// Looks up the known heights where the level regions of `surfaces` lie, seen from `camera_m` (robot frame).
    pub(crate) fn compare(
        &mut self,
        surfaces: &Surfaces<impl Finder>,
        view: &View,
        camera_m: &Vector3<f64>,
        known: &dyn KnownFloor,
    ) {
        self.votes.clear();
        let count = surfaces.regions.len();
        self.misses_m
            .resize_with(self.misses_m.len().max(count), Vec::new);
        self.misses_m.iter_mut().for_each(Vec::clear);
        self.near.clear();
        self.near.resize(count, (0, 0));
        for (row, col, label) in surfaces.inner_pixels(STRIDE) {
            let region = usize::from(label) - 1;
            let below_m = 1.0 / f64::from(surfaces.regions[region].q);
            let depth = below_m / f64::from(view.g.at(col, row));
            let x_m = camera_m.x + f64::from(view.x.at(col, row)) * depth;
            let y_m = camera_m.y + f64::from(view.y.at(col, row)) * depth;
            self.near[region].1 += 1;
            if x_m * x_m + y_m * y_m > NEAR_M * NEAR_M {
                continue;
            }
            self.near[region].0 += 1;
            if let Some(height_m) = known.height_m(x_m, y_m) {
                self.misses_m[region].push((height_m - (camera_m.z - below_m)) as f32);
            }
        }
        for region in (0..count).filter(|&region| surfaces.is_level(region)) {
            self.votes.extend(vote(region, &mut self.misses_m[region]));
        }
    }

    /// Whether a good part of a region is near enough to tell the height well.
    pub(crate) fn is_near(&self, region: usize) -> bool {
        let (near, all) = self.near[region];
        4 * near > all
    }

    /// Whether floor at another height than 0 is known where a region lies that is seen at `height_m`.
    pub(crate) fn is_elsewhere(&self, region: usize, height_m: f64, gate_m: f64) -> bool {
        self.votes
            .iter()
            .find(|vote| vote.region == region && vote.is_clear())
            .is_some_and(|vote| (height_m + vote.mean_m).abs() > gate_m)
    }

    /// What brings the regions onto the known floor, m: the mean over those that agree on it, where they lie no further
    /// off than `gate_m`, make up most of what is known in view and hold `least` pixels.
    pub(crate) fn rise_m(&mut self, gate_m: f64, least: usize) -> Option<f64> {
        self.votes.retain(Vote::is_clear);
        self.votes.sort_by(|a, b| a.middle_m.total_cmp(&b.middle_m));
        let all: usize = self.votes.iter().map(|vote| vote.looked_up).sum();
        let mut before = 0;
        let middle_m = self.votes.iter().find_map(|vote| {
            before += vote.looked_up;
            (2 * before >= all).then_some(vote.middle_m)
        })?;
        let (mut agree, mut sum_m) = (0, 0.0);
        for vote in &self.votes {
            if (vote.middle_m - middle_m).abs() < ONE_SURFACE_M {
                agree += vote.agree;
                sum_m += vote.mean_m * vote.agree as f64;
            }
        }
        let rise_m = sum_m / agree.max(1) as f64;
        let enough = agree * STRIDE * STRIDE >= least && 2 * agree > all;
        (enough && rise_m.abs() < gate_m).then_some(rise_m)
    }
}

fn vote(region: usize, misses_m: &mut [f32]) -> Option<Vote> {
    let looked_up = misses_m.len();
    if looked_up < MIN_LOOKED_UP {
        return None;
    }
    let (_, middle_m, _) = misses_m.select_nth_unstable_by(looked_up / 2, f32::total_cmp);
    let middle_m = *middle_m;
    let (mut agree, mut sum_m) = (0, 0.0);
    for &miss_m in misses_m.iter() {
        if (miss_m - middle_m).abs() < ONE_SURFACE_M {
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
