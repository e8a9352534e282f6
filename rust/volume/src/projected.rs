//! Misses the other way round: not along every line of sight, but from every voxel in view to a line of sight that goes by.

use geometry::{Cell, CellArea};

use super::columns::run;
use super::frustum::Frustum;
use super::picture::PictureSight;
use super::placement::Size;
use super::reaches::{LEVELS, Level, Reaches};
use super::voxels::{Column, bits};

/// Lines of sight along columns, and as many along rows, that are looked at of a voxel past whose middle none goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Looks {
    /// Of what is likely to be occupied.
    pub(super) likely: usize,
    /// Of what is not, where lines of sight nearby reach as deep.
    pub(super) others: usize,
}

impl Looks {
    /// Where nobody says other numbers.
    pub(super) const USUAL: Self = Self {
        likely: 6,
        others: 2,
    };
}

/// A level of the picture as it is looked up.
struct Lens<'a> {
    level: &'a Level,
    per_tile: f32,
    /// Columns and rows less a little.
    last: [f32; 2],
    /// Up to this depth every line of sight of a neighbourhood goes through a voxel whose middle shows in its tile, m.
    deepest_m: f32,
}

impl<'a> Lens<'a> {
    fn new(level: &'a Level, sight: &PictureSight) -> Self {
        Self {
            level,
            per_tile: 1.0 / level.tile_px,
            last: level.size.map(|n| n as f32 - 0.01),
            deepest_m: sight.one_pixel_m / level.apart_px,
        }
    }

    /// How deep a line of sight reaches that goes by a place, m, and how far it is from it along columns and rows, tiles.
    #[inline]
    fn reach(&self, [depth_m, across, down]: [f32; 3]) -> (f32, [f32; 2]) {
        let per_depth = self.per_tile / depth_m;
        let (u, v) = (across * per_depth, down * per_depth);
        let within = |at: f32, last: f32| {
            let at = if at > 0.0 { at } else { 0.0 };
            (if at < last { at } else { last }) as i32
        };
        let (i, j) = (within(u, self.last[0]), within(v, self.last[1]));
        let at = j as usize * self.level.size[0] + i as usize;
        let reach_m = self.level.depths_m.get(at).copied().unwrap_or(0.0);
        (reach_m, [i as f32 + 0.5 - u, j as f32 + 0.5 - v])
    }
}

/// A place in the picture: its depth, and column and row times depth; and what a step of one layer adds to it.
type Shown = [f32; 3];

/// Finds voxels that lines of sight pass.
pub(super) struct Projector<'a> {
    sight: &'a PictureSight,
    lenses: [Lens<'a>; LEVELS],
    frustum: Frustum,
    size: Size,
    looks: Looks,
}

impl<'a> Projector<'a> {
    /// A projector of lines of sight that reach `farthest_m` deep at most.
    pub(super) fn new(
        sight: &'a PictureSight,
        reaches: &'a Reaches,
        (farthest_m, looks): (f32, Looks),
        size: Size,
    ) -> Self {
        let levels = reaches.levels().each_ref();
        Self {
            lenses: levels.map(|level| Lens::new(level, sight)),
            frustum: Frustum::new(sight, farthest_m, size),
            sight,
            size,
            looks,
        }
    }

    /// Calls `visit(index, layers)` for every cell with layers that are passed and not known, with those layers. What `column(index)`
    /// has as likely is looked at more closely.
    pub(super) fn visit(
        &self,
        column: impl Fn(usize) -> Column,
        mut visit: impl FnMut(usize, u64),
    ) -> CellArea {
        let all = u64::MAX >> (64 - self.size.layers);
        let mut area = CellArea::EMPTY;
        for row in 0..self.size.rows {
            let Some([first, last]) = self.frustum.columns(row) else {
                continue;
            };
            for col in first..=last {
                let index = row * self.size.cols + col;
                let Column { known, likely } = column(index);
                let open = all & !known;
                if open == 0 {
                    continue;
                }
                let passed = self.passed([col, row], open, likely);
                if passed != 0 {
                    area.include(Cell::new(col as i32, row as i32));
                    visit(index, passed);
                }
            }
        }
        area
    }

    /// The layers of a cell among the open ones that a line of sight passes.
    #[inline]
    fn passed(&self, [col, row]: [usize; 2], open: u64, likely: u64) -> u64 {
        let Some((part, middle)) = self.frustum.layers(col, row) else {
            return 0;
        };
        let mask = |[low, high]: [usize; 2]| run(low as i64, high as i64);
        let open = open & mask(part);
        let lowest = self.sight.shown().map(|linear| linear.at(col, row));
        let step = self.sight.shown().map(|linear| linear.step[2]);
        let place =
            |layer: usize| -> Shown { std::array::from_fn(|a| lowest[a] + layer as f32 * step[a]) };
        let mut passed = 0;
        let mut nearby = 0;
        if let Some([low, high]) = middle {
            let deepest_m = place(low)[0].max(place(high)[0]);
            let mut lenses = self.lenses.iter().rev();
            if let Some(lens) = lenses.find(|lens| deepest_m < lens.deepest_m) {
                nearby = open & mask([low, high]);
                passed = layers(nearby, |layer| {
                    let place = place(layer);
                    place[0] <= lens.reach(place).0
                });
            }
        }
        passed |= layers(open & !nearby, |layer| self.goes_by(place(layer)));
        let Looks {
            likely: closely,
            others,
        } = self.looks;
        passed |= layers(open & likely & !passed, |layer| {
            self.is_crossed([col, row, layer], place(layer), closely)
        });
        let left = open & !likely & !passed;
        if others == 0 || left == 0 {
            return passed;
        }
        let around = self.around([place(part[0])[0], place(part[1])[0]]);
        passed
            | layers(left, |layer| {
                let middle = place(layer);
                middle[0] > 0.0
                    && middle[0] - self.sight.half_m <= around.reach(middle).0
                    && self.is_crossed([col, row, layer], middle, others)
            })
    }

    /// The neighbourhoods in which voxels at such depths show as a whole, as far as any are so large.
    #[inline]
    fn around(&self, [one_m, other_m]: [f32; 2]) -> &Lens<'_> {
        let nearest_m = if one_m < other_m { one_m } else { other_m };
        let [across_px, down_px] = self.sight.halves_px;
        let half_px = if across_px > down_px {
            across_px
        } else {
            down_px
        };
        let covers = |lens: &&Lens<'_>| lens.level.covers_px * nearest_m >= half_px;
        let widest = &self.lenses[LEVELS - 1];
        self.lenses.iter().find(covers).unwrap_or(widest)
    }

    /// Whether the line of sight next to the middle of a voxel reaches as deep and goes through the voxel.
    #[inline]
    fn goes_by(&self, middle: Shown) -> bool {
        let (reach_m, apart_px) = self.lenses[0].reach(middle);
        middle[0] > 0.0 && middle[0] <= reach_m && self.sight.within(middle[0], apart_px)
    }

    /// Whether one of some lines of sight spread over a voxel goes into it.
    fn is_crossed(&self, voxel: [usize; 3], [depth_m, across, down]: Shown, looks: usize) -> bool {
        if depth_m <= 0.0 {
            return false;
        }
        let spread = |from_corner: f32, way: usize| {
            let half_px = self.sight.halves_px[way] / depth_m;
            let (middle_px, end) = (from_corner / depth_m, self.sight.size_px[way] as f32);
            let first = (middle_px - half_px).clamp(0.0, end) as usize;
            let last = (middle_px + half_px + 1.0).clamp(0.0, end) as usize;
            let step = (last - first).div_ceil(looks).max(1);
            (first + (step - 1) / 2..last).step_by(step)
        };
        let middle = self.sight.beyond_eye(voxel);
        let nearest_m = (depth_m - self.sight.half_m).max(0.0);
        let Level { size, depths_m, .. } = self.lenses[0].level;
        let (cols, rows) = (spread(across, 0), spread(down, 1));
        rows.into_iter().any(|row| {
            cols.clone().any(|col| {
                let reach_m = depths_m[row * size[0] + col];
                reach_m > nearest_m && self.sight.enters(middle, [col, row], reach_m)
            })
        })
    }
}

/// The layers, of some, for which it holds.
#[inline]
fn layers(among: u64, holds: impl Fn(usize) -> bool) -> u64 {
    let mut found = 0;
    for layer in bits(among) {
        found |= u64::from(holds(layer)) << layer;
    }
    found
}
