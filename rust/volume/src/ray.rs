//! Exact voxel traversal of a segment (Amanatides and Woo 1987), clipped to the grid.

use geometry::{Cell, CellArea};

/// The part of a segment that lies inside the grid. Coordinates are in voxels: voxel (i, j, k) fills `i..i+1`, `j..j+1`,
/// `k..k+1`.
#[derive(Debug, Clone, Copy)]
pub(super) struct RayPart {
    pub(super) from: [f64; 3],
    pub(super) to: [f64; 3],
    /// Voxels of the two ends.
    pub(super) first: [i32; 3],
    pub(super) last: [i32; 3],
    /// Whether the segment's own end lies inside.
    pub(super) ends_inside: bool,
}

impl RayPart {
    /// `None` where segment and grid do not meet.
    #[inline]
    pub(super) fn inside(from: [f64; 3], to: [f64; 3], size: [i32; 3]) -> Option<Self> {
        let ends_inside = contains(size, to);
        let (mut start, mut end) = (from, to);
        if !ends_inside || !contains(size, from) {
            let along = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
            let (enter, leave) = clip(from, along, size)?;
            for a in 0..3 {
                let at = |t: f64| (from[a] + t * along[a]).clamp(0.0, f64::from(size[a]));
                start[a] = if enter > 0.0 { at(enter) } else { from[a] };
                end[a] = if leave < 1.0 { at(leave) } else { to[a] };
            }
        }
        // Casting rounds towards zero; nothing here is negative.
        let voxel = |at: [f64; 3]| std::array::from_fn(|a| (at[a] as i32).min(size[a] - 1));
        Some(Self {
            from: start,
            to: end,
            first: voxel(start),
            last: voxel(end),
            ends_inside,
        })
    }

    /// Widens an area to the cells over which the part lies.
    pub(super) fn add_to(&self, area: &mut CellArea) {
        for [col, row, _] in [self.first, self.last] {
            area.include(Cell::new(col, row));
        }
    }
}

/// The voxel in which a ray that meets the grid ends, if that is in the grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Last(pub(super) Option<[i32; 3]>);

/// The cells over which rays from one eye lie. Most rays end in the grid, and need not be cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    eye: [f64; 3],
    size: [i32; 3],
    eye_inside: bool,
    /// Around the ends in the grid: lowest and highest column and row.
    low: [i32; 2],
    high: [i32; 2],
    /// Around the parts of the others.
    area: CellArea,
}

impl Reach {
    /// The reach of no ray yet.
    pub(super) fn new(eye: [f64; 3], size: [i32; 3]) -> Self {
        Self {
            eye,
            size,
            eye_inside: contains(size, eye),
            low: [i32::MAX; 2],
            high: [i32::MIN; 2],
            area: CellArea::EMPTY,
        }
    }

    /// Takes in a ray: its last voxel where it ends in the grid; `None` where it does not meet it.
    #[inline]
    pub(super) fn add(&mut self, end: [f64; 3]) -> Option<Last> {
        if self.eye_inside && contains(self.size, end) {
            let last = [end[0] as i32, end[1] as i32, end[2] as i32];
            let [col, row, _] = last;
            self.low = [self.low[0].min(col), self.low[1].min(row)];
            self.high = [self.high[0].max(col), self.high[1].max(row)];
            return Some(Last(Some(last)));
        }
        self.add_part(end)
    }

    #[cold]
    fn add_part(&mut self, end: [f64; 3]) -> Option<Last> {
        let part = RayPart::inside(self.eye, end, self.size)?;
        part.add_to(&mut self.area);
        Some(Last(part.ends_inside.then_some(part.last)))
    }

    /// The cells of all rays.
    pub(super) fn area(mut self) -> CellArea {
        if self.low[0] <= self.high[0] {
            let [col, row, _] = self.eye.map(|at| at as i32);
            for [col, row] in [self.low, self.high, [col, row]] {
                self.area.include(Cell::new(col, row));
            }
        }
        self.area
    }
}

#[inline]
fn contains(size: [i32; 3], at: [f64; 3]) -> bool {
    (0..3).all(|a| at[a] >= 0.0 && at[a] < f64::from(size[a]))
}

/// The voxels that a segment passes, in order, from its start (or where it enters the grid) to its end (or where it
/// leaves the grid).
#[derive(Debug, Clone)]
pub struct VoxelWalk {
    voxel: [i32; 3],
    step: [i32; 3],
    /// Crossings still to come along each axis.
    left: [i32; 3],
    /// Where along the segment (0..1) the next crossing of each axis lies; infinity when none is left.
    t_next: [f64; 3],
    t_step: [f64; 3],
    remaining: i32,
    /// Last voxel of the walk.
    pub last: [i32; 3],
    /// Whether the segment's end lies in the grid; then `last` holds it.
    pub ends_inside: bool,
}

impl VoxelWalk {
    /// The walk from `from` to `to` (both in voxels) through a grid of `size` voxels; `None` where they do not meet.
    pub fn new(from: [f64; 3], to: [f64; 3], size: [i32; 3]) -> Option<Self> {
        let part = RayPart::inside(from, to, size)?;
        let mut walk = Self {
            voxel: part.first,
            step: [0; 3],
            left: [0; 3],
            t_next: [f64::INFINITY; 3],
            t_step: [f64::INFINITY; 3],
            remaining: 1,
            last: part.last,
            ends_inside: part.ends_inside,
        };
        for a in 0..3 {
            let (first, last) = (part.first[a], part.last[a]);
            walk.left[a] = (last - first).abs();
            walk.remaining += walk.left[a];
            if walk.left[a] > 0 {
                let along = to[a] - from[a];
                walk.step[a] = (last - first).signum();
                let border = f64::from(first + i32::from(walk.step[a] > 0));
                walk.t_next[a] = (border - from[a]) / along;
                walk.t_step[a] = 1.0 / along.abs();
            }
        }
        Some(walk)
    }
}

impl Iterator for VoxelWalk {
    type Item = [i32; 3];

    #[inline]
    fn next(&mut self) -> Option<[i32; 3]> {
        if self.remaining == 0 {
            return None;
        }
        self.remaining -= 1;
        let here = self.voxel;
        let [x, y, z] = self.t_next;
        let axis = if x <= y {
            if x <= z { 0 } else { 2 }
        } else if y <= z {
            1
        } else {
            2
        };
        self.voxel[axis] += self.step[axis];
        self.left[axis] -= 1;
        self.t_next[axis] += self.t_step[axis];
        if self.left[axis] == 0 {
            self.t_next[axis] = f64::INFINITY;
        }
        Some(here)
    }
}

/// The part of the segment inside the grid, as fractions of its length.
fn clip(from: [f64; 3], along: [f64; 3], size: [i32; 3]) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for a in 0..3 {
        let high = f64::from(size[a]);
        if along[a] == 0.0 {
            if from[a] < 0.0 || from[a] >= high {
                return None;
            }
        } else {
            let (t0, t1) = (-from[a] / along[a], (high - from[a]) / along[a]);
            enter = enter.max(t0.min(t1));
            leave = leave.min(t0.max(t1));
        }
    }
    (enter <= leave).then_some((enter, leave))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: [i32; 3] = [12, 10, 7];

    /// Length of the overlap of the segment (as a fraction) with a voxel; negative where they are apart.
    fn overlap(from: [f64; 3], to: [f64; 3], voxel: [i32; 3]) -> f64 {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for a in 0..3 {
            let (low, high, along) = (
                f64::from(voxel[a]),
                f64::from(voxel[a] + 1),
                to[a] - from[a],
            );
            if along == 0.0 {
                if from[a] < low || from[a] >= high {
                    return -1.0;
                }
            } else {
                let (t0, t1) = ((low - from[a]) / along, (high - from[a]) / along);
                enter = enter.max(t0.min(t1));
                leave = leave.min(t0.max(t1));
            }
        }
        leave - enter
    }

    fn point() -> impl Strategy<Value = [f64; 3]> {
        (-4.0..16.0f64, -4.0..14.0f64, -3.0..10.0f64).prop_map(|(x, y, z)| [x, y, z])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(10_000))]
        #[test]
        fn the_walk_visits_exactly_the_voxels_that_the_segment_passes(from in point(), to in point()) {
            let walked: Vec<_> = VoxelWalk::new(from, to, SIZE).into_iter().flatten().collect();
            for x in 0..SIZE[0] { for y in 0..SIZE[1] { for z in 0..SIZE[2] {
                let passed = overlap(from, to, [x, y, z]);
                let visits = walked.iter().filter(|&&v| v == [x, y, z]).count();
                prop_assert!(visits <= 1);
                if passed > 1e-9 { prop_assert_eq!(visits, 1, "missed {:?}", [x, y, z]); }
                if passed < -1e-9 { prop_assert_eq!(visits, 0, "not passed {:?}", [x, y, z]); }
            }}}
            for pair in walked.windows(2) {
                let jump: i32 = (0..3).map(|a| (pair[1][a] - pair[0][a]).abs()).sum();
                prop_assert_eq!(jump, 1, "neighbours share a face");
            }
        }

        #[test]
        fn the_last_voxel_holds_the_end(from in point(), to in point()) {
            if let Some(walk) = VoxelWalk::new(from, to, SIZE) {
                let (last, inside) = (walk.last, walk.ends_inside);
                prop_assert_eq!(walk.last(), Some(last));
                if inside { prop_assert_eq!(last, to.map(|v| v.floor() as i32)); }
            }
        }
    }

    #[test]
    fn a_segment_within_one_voxel_visits_it_once() {
        let walk = VoxelWalk::new([1.2, 1.2, 1.2], [1.8, 1.3, 1.9], SIZE).unwrap();
        assert_eq!(walk.collect::<Vec<_>>(), [[1, 1, 1]]);
    }
}
