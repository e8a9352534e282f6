//! The floors of the known map, on all its levels, and the way over them to a goal.

mod repair;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use volume::{InnerSurfaces, SolidVoxels};

use crate::{FloorsTuning, KnownMapTuning, StandingRoom, standing::standing};

/// No place.
const NONE: u32 = u32::MAX;

/// Places to stand, by their numbers: a column of the map has one on each of its levels.
#[derive(Debug, Clone)]
pub struct Floors {
    /// Side of a column, m.
    pub side_m: f64,
    corner_m: [f64; 2],
    cols: usize,
    rows: usize,
    /// For each column the first of its places; one more at the end.
    first: Vec<u32>,
    /// For each place its column.
    column: Vec<u32>,
    /// For each place its height, m.
    height_m: Vec<f32>,
    tuning: FloorsTuning,
}

/// Where a way shall lead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Its middle, seen from above, m.
    pub at_m: [f64; 2],
    /// Within this of the middle one is there, m.
    pub radius_m: f64,
    /// Height of its level, m; any level where it is not told.
    pub height_m: Option<f64>,
}

/// How far it is from each place to a target, and which place is next on the way.
#[derive(Debug, Clone, Default)]
pub struct CostField {
    /// Infinite where no way leads there.
    cost_m: Vec<f32>,
    /// [`NONE`] at the target, and where no way leads there.
    next: Vec<u32>,
}

impl CostField {
    /// Cost of the way from a place, m of level way; infinite where none leads to the target.
    pub fn cost_m(&self, place: u32) -> f32 {
        self.cost_m[place as usize]
    }

    /// The place that comes next on the way; none at the target, and where no way leads there.
    pub fn next(&self, place: u32) -> Option<u32> {
        Some(self.next[place as usize]).filter(|next| *next != NONE)
    }
}

impl Floors {
    /// The floors of a map for a body.
    pub(crate) fn new(
        voxels: (&SolidVoxels, Option<&InnerSurfaces>),
        room: StandingRoom,
        tuning: &KnownMapTuning,
    ) -> Self {
        let solid = voxels.0;
        let [cols, rows, _] = solid.size();
        let mut places: Vec<(u32, f32)> = (standing(voxels, room, &tuning.standing).iter())
            .map(|place| {
                let [x, y, _] = place.voxel;
                ((y * cols + x) as u32, place.top_m[2] as f32)
            })
            .collect();
        places.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut first = vec![0; cols * rows + 1];
        for (column, _) in &places {
            first[*column as usize + 1] += 1;
        }
        for column in 0..cols * rows {
            first[column + 1] += first[column];
        }
        let corner = solid.corner_m([0; 3]);
        let (column, height_m) = places.into_iter().unzip();
        Self {
            side_m: solid.resolution_m,
            corner_m: [corner[0], corner[1]],
            cols,
            rows,
            first,
            column,
            height_m,
            tuning: tuning.floors.clone(),
        }
    }

    /// How many places there are; they are numbered from 0 on.
    pub const fn count(&self) -> usize {
        self.height_m.len()
    }

    /// The column that holds a point, seen from above; none outside the map.
    pub(crate) fn column_at(&self, at_m: [f64; 2]) -> Option<usize> {
        let cell = |axis: usize| (at_m[axis] - self.corner_m[axis]) / self.side_m;
        let (x, y) = (cell(0), cell(1));
        let inside = x >= 0.0 && y >= 0.0 && x < self.cols as f64 && y < self.rows as f64;
        inside.then(|| y as usize * self.cols + x as usize)
    }

    /// Column and row.
    pub(crate) const fn cell_of(&self, column: usize) -> [usize; 2] {
        [column % self.cols, column / self.cols]
    }

    /// Heights of the places of a column, m.
    pub(crate) fn heights_m(&self, column: usize) -> impl Iterator<Item = f64> + '_ {
        let places = self.first[column] as usize..self.first[column + 1] as usize;
        self.height_m[places]
            .iter()
            .map(|&height_m| f64::from(height_m))
    }

    /// Where a place is, m.
    pub fn at_m(&self, place: u32) -> [f64; 3] {
        let [x, y] = self.cell_of(self.column[place as usize] as usize);
        [
            self.corner_m[0] + (x as f64 + 0.5) * self.side_m,
            self.corner_m[1] + (y as f64 + 0.5) * self.side_m,
            f64::from(self.height_m[place as usize]),
        ]
    }

    /// Places no further than `near_m` from a point, seen from above.
    fn around(&self, [x_m, y_m]: [f64; 2], near_m: f64) -> impl Iterator<Item = (u32, f64)> + '_ {
        let cell = |at_m: f64, axis: usize| (at_m - self.corner_m[axis]) / self.side_m;
        let span = |at_m: f64, axis: usize, count: usize| {
            let low = cell(at_m - near_m, axis).floor().max(0.0) as usize;
            low..(cell(at_m + near_m, axis).ceil().max(0.0) as usize).min(count)
        };
        let cols = span(x_m, 0, self.cols);
        span(y_m, 1, self.rows)
            .flat_map(move |row| cols.clone().map(move |col| row * self.cols + col))
            .flat_map(|column| self.first[column]..self.first[column + 1])
            .map(move |place| {
                let [x, y, _] = self.at_m(place);
                (place, geometry::hypot(x - x_m, y - y_m))
            })
            .filter(move |&(_, away_m)| away_m <= near_m)
    }

    /// The place that a robot stands on, of those from which `counts` says that they do.
    pub fn under(&self, [x, y, z]: [f64; 3], counts: impl Fn(u32) -> bool) -> Option<u32> {
        let FloorsTuning { near, level, .. } = self.tuning;
        self.around([x, y], near)
            .filter(|&(place, _)| {
                (f64::from(self.height_m[place as usize]) - z).abs() < level && counts(place)
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(place, _)| place)
    }

    /// The places beside one that a step leads to, with what the step costs, m.
    fn steps(&self, place: u32) -> impl Iterator<Item = (u32, f64)> + '_ {
        let FloorsTuning { step, climb, .. } = self.tuning;
        let [col, row] = self.cell_of(self.column[place as usize] as usize);
        let height_m = f64::from(self.height_m[place as usize]);
        let cols = col.saturating_sub(1)..(col + 2).min(self.cols);
        (row.saturating_sub(1)..(row + 2).min(self.rows))
            .flat_map(move |r| cols.clone().map(move |c| [c, r]))
            .filter(move |&beside| beside != [col, row])
            .flat_map(move |[c, r]| {
                let beside = r * self.cols + c;
                let way_m =
                    self.side_m * f64::from((c.abs_diff(col) + r.abs_diff(row)) as u32).sqrt();
                (self.first[beside]..self.first[beside + 1]).filter_map(move |next| {
                    let rise_m = (f64::from(self.height_m[next as usize]) - height_m).abs();
                    (rise_m <= step).then_some((next, way_m + climb * rise_m))
                })
            })
    }

    /// Whether a step up or down leads on from a place.
    pub fn is_at_step(&self, place: u32) -> bool {
        let (height_m, edge) = (self.height_m[place as usize], self.tuning.edge);
        (self.steps(place)).any(|(next, _)| (self.height_m[next as usize] - height_m).abs() > edge)
    }

    /// For each column whether a step is no further away than `near_m`, m.
    pub(crate) fn columns_near_steps(&self, near_m: f64) -> Vec<bool> {
        let mut near = vec![false; self.cols * self.rows];
        for place in (0..self.count() as u32).filter(|place| self.is_at_step(*place)) {
            let [x, y, _] = self.at_m(place);
            for (beside, _) in self.around([x, y], near_m) {
                near[self.column[beside as usize] as usize] = true;
            }
        }
        near
    }

    /// The way from everywhere to a target (Dijkstra), but through places that are `blocked`.
    pub fn aim(&self, target: &Target, blocked: &[bool], field: &mut CostField) {
        field.cost_m.clear();
        field.cost_m.resize(self.count(), f32::INFINITY);
        field.next.clear();
        field.next.resize(self.count(), NONE);
        // Costs as bits: floats that are not negative are ordered like them.
        let mut queue = BinaryHeap::new();
        let reach_m = target.radius_m.max(self.side_m);
        for (place, away_m) in self.around(target.at_m, reach_m) {
            let height_m = f64::from(self.height_m[place as usize]);
            if target
                .height_m
                .is_none_or(|level_m| (level_m - height_m).abs() < self.tuning.level)
            {
                field.cost_m[place as usize] = away_m as f32;
                queue.push(Reverse(((away_m as f32).to_bits(), place)));
            }
        }
        self.spread(queue, blocked, field);
    }

    /// Finds what leads more cheaply over places in a queue, which holds their costs as bits.
    fn spread(
        &self,
        mut queue: BinaryHeap<Reverse<(u32, u32)>>,
        blocked: &[bool],
        field: &mut CostField,
    ) {
        while let Some(Reverse((bits, place))) = queue.pop() {
            let cost_m = f32::from_bits(bits);
            if cost_m > field.cost_m[place as usize] {
                continue;
            }
            for (next, way_m) in self.steps(place) {
                let through_m = cost_m + way_m as f32;
                if through_m < field.cost_m[next as usize] && !blocked[next as usize] {
                    field.cost_m[next as usize] = through_m;
                    field.next[next as usize] = place;
                    queue.push(Reverse((through_m.to_bits(), next)));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn no_step_makes_a_way_cheaper_than_the_field_says(
            blocks in prop::collection::vec((0.0..1.6f64, 0.0..1.6f64, 0.04..0.4f64, 0.04..0.4f64, 1..10_u32), 0..8),
            x in 0.1..1.9f64, y in 0.1..1.9f64,
        ) {
            let mut boxes = vec![[[0.0, 0.0, -0.04], [2.0, 2.0, 0.0]]];
            boxes.extend(blocks.iter().map(|&(x, y, dx, dy, h)| [[x, y, 0.0], [x + dx, y + dy, 0.04 * f64::from(h)]]));
            let floors = Floors::new((&SolidVoxels::of_boxes(&boxes, 0.04).unwrap(), None), StandingRoom { radius_m: 0.08, height_m: 0.55 }, &KnownMapTuning::default());
            let target = Target { at_m: [x, y], radius_m: 0.05, height_m: None };
            let mut field = CostField::default();
            floors.aim(&target, &vec![false; floors.count()], &mut field);
            for place in 0..floors.count() as u32 {
                let here = field.cost_m[place as usize];
                for (next, way_m) in floors.steps(place) {
                    prop_assert!(here <= field.cost_m[next as usize] + way_m as f32 + 1e-4);
                }
                let next = field.next[place as usize];
                if next != NONE {
                    let (_, way_m) = floors.steps(place).find(|(step, _)| *step == next).unwrap();
                    prop_assert!((here - field.cost_m[next as usize] - way_m as f32).abs() < 1e-4);
                }
            }
        }
    }
}
