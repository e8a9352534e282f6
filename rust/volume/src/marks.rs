//! What the rays of one frame hit and passed, voxel by voxel: each counts once, however many rays touched it.

use geometry::{Cell, CellArea};

use super::columns::Slabs;
use super::fan::Fan;
use super::locator::Locator;
use super::picture::PictureSight;
use super::placement::{Placement, Ray, Size};
use super::projected::{Looks, Projector};
use super::ray::{Last, RayPart, Reach};
use super::reaches::Reaches;
use super::sweep::{Marked, RaySweep, SweepWay};
use super::voxels::{Column, Voxels};
use crate::Clearing;

/// Fewer rays of one way are followed one by one; the marks are the same either way.
const FEW: usize = 64;
/// Voxels that a ray goes ahead at most; more than a grid has.
const FARTHEST: f64 = 1e6;

/// Marks of the frame that is being inserted. Empty between frames.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Marks {
    size: Size,
    /// One bit a layer: hit, or passed, by a ray; what is hit may count as passed, too.
    hits: Vec<u64>,
    passed: Vec<u64>,
    /// Rays along x and along y, towards more and towards less, and the ends of all of them.
    fans: [Fan; 4],
    ends: Vec<[f64; 3]>,
    reaches: Reaches,
    pub(super) looks: Looks,
}

impl Marks {
    /// No marks on a grid of this size.
    pub(super) fn new(size: Size) -> Self {
        let cells = size.cols * size.rows;
        Self {
            size,
            hits: vec![0; cells],
            passed: vec![0; cells],
            fans: Default::default(),
            ends: Vec::new(),
            reaches: Reaches::default(),
            looks: Looks::USUAL,
        }
    }

    /// Makes empty marks ready for a grid of another size.
    pub(super) fn resize(&mut self, size: Size) {
        let cells = self.hits.len().max(size.cols * size.rows);
        self.size = size;
        self.hits.resize(cells, 0);
        self.passed.resize(cells, 0);
    }

    /// Marks what the rays from `eye` hit and passed, but for some voxels that are settled or hit, and says which cells they
    /// touched. Ends are in voxels, with whether something was seen there; `settled` has one bit for each layer of a cell that
    /// a miss does not change.
    pub(super) fn mark(
        &mut self,
        eye: [f64; 3],
        rays: impl Iterator<Item = ([f64; 3], bool)>,
        clearing: Clearing,
        settled: &[u64],
    ) -> CellArea {
        let mut reach = Reach::new(eye, self.size.voxels());
        let shared = clearing != Clearing::EveryRay && eye.iter().all(|at| at.abs() < FARTHEST);
        let first = eye.map(f64::floor);
        rays.for_each(|(end, hit)| {
            let Some(Last(inside)) = reach.add(end) else {
                return;
            };
            if let (Some([col, row, layer]), true) = (inside, hit) {
                let cell = row as usize * self.size.cols + col as usize;
                self.hits[cell] |= 1 << layer;
                self.passed[cell] |= 1 << layer;
            }
            if !(shared && self.gather([eye, first], end, inside)) {
                self.walk(eye, end);
            }
        });
        self.sweep(eye, settled);
        reach.area()
    }

    /// Marks what the rays of a picture, each with its pixel, hit and passed: looks from the voxels into the picture, and leaves out what is
    /// settled, and voxels of which no ray goes by the places that are looked at.
    pub(super) fn look(
        &mut self,
        sight: &PictureSight,
        placement: &Placement,
        rays: impl Iterator<Item = (usize, Ray)>,
        voxels: &Voxels,
    ) -> CellArea {
        let locator = Locator::of_voxels(placement, self.size);
        let mut area = CellArea::EMPTY;
        let mut farthest_m = 0.0_f32;
        self.reaches.clear(sight.size_px);
        for (pixel, Ray { end_m, hit }) in rays {
            let depth_m = sight.depth_of(end_m);
            if depth_m > farthest_m {
                farthest_m = depth_m;
            }
            self.reaches.note(pixel, depth_m);
            if hit && let Some([col, row, layer]) = locator.voxel_at(end_m) {
                let hits = &mut self.hits[row as usize * self.size.cols + col as usize];
                // Most pixels hit what the one before them hit.
                if *hits >> layer & 1 == 0 {
                    *hits |= 1 << layer;
                    area.include(Cell::new(col, row));
                }
            }
        }
        self.reaches.gather();
        let (hits, passed) = (&self.hits, &mut self.passed);
        let projector = Projector::new(sight, &self.reaches, (farthest_m, self.looks), self.size);
        area.join(projector.visit(
            |cell| {
                let Column { known, likely } = voxels.column(cell);
                Column {
                    known: known | hits[cell],
                    likely,
                }
            },
            |cell, layers| passed[cell] = layers,
        ));
        area
    }

    /// Takes a ray into the fan of its way, unless it is too steep: by the eye and its voxel, the end, and its voxel if inside.
    #[inline]
    fn gather(
        &mut self,
        [eye, first]: [[f64; 3]; 2],
        end: [f64; 3],
        inside: Option<[i32; 3]>,
    ) -> bool {
        let (dx, dy, dz) = (end[0] - eye[0], end[1] - eye[1], end[2] - eye[2]);
        let along_x = dx.abs() >= dy.abs();
        let (ahead, across, axis) = if along_x { (dx, dy, 0) } else { (dy, dx, 1) };
        let last = inside.map_or_else(|| floor(end[axis]), |voxel| f64::from(voxel[axis]));
        let slabs = (last - first[axis]).abs().min(FARTHEST) as u32;
        let per_slab = 1.0 / ahead.abs();
        let ray = self.ends.len() as u32;
        let fan = &mut self.fans[usize::from(!along_x) * 2 + usize::from(ahead < 0.0)];
        let taken = fan.take([across * per_slab, dz * per_slab], slabs, ray);
        if taken {
            self.ends.push(end);
        }
        taken
    }

    /// Marks what the rays in the fans pass, and forgets them.
    fn sweep(&mut self, eye: [f64; 3], settled: &[u64]) {
        for (number, fan) in self.fans.iter_mut().enumerate() {
            let way = SweepWay {
                along_x: number < 2,
                forward: number % 2 == 0,
            };
            let mut marked = Marked {
                passed: &mut self.passed,
                settled,
            };
            let sweep = RaySweep::new(way, eye, &self.ends, self.size);
            if fan.len() < FEW {
                (fan.reaching(0)).for_each(|ray| sweep.walk(ray, 0..i32::MAX, &mut marked));
            } else {
                sweep.mark(fan, &mut marked);
            }
            fan.clear();
        }
        self.ends.clear();
    }

    /// Marks the voxels that a ray passes.
    fn walk(&mut self, eye: [f64; 3], end: [f64; 3]) {
        if let Some(part) = RayPart::inside(eye, end, self.size.voxels()) {
            Slabs::new(&part, self.size.cols).visit(0, i32::MAX, |cell, layers| {
                self.passed[cell] |= layers;
            });
        }
    }

    /// Takes the layers of a cell that were hit, and those that were only passed.
    pub(super) fn take(&mut self, cell: usize) -> [u64; 2] {
        let hits = std::mem::take(&mut self.hits[cell]);
        [hits, std::mem::take(&mut self.passed[cell]) & !hits]
    }
}

/// Rounds down without the call that `f64::floor` is on the oldest processors; of what is beyond 63 bits nothing is left to round.
#[inline]
fn floor(value: f64) -> f64 {
    let towards_zero = value as i64 as f64;
    if towards_zero > value {
        towards_zero - 1.0
    } else {
        towards_zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: Size = Size {
        cols: 60,
        rows: 50,
        layers: 20,
    };

    const CELLS: usize = SIZE.cols * SIZE.rows;

    /// Ends of a picture's rays: from the eye into a box-shaped room with a pillar, row by row.
    fn picture(eye: [f64; 3], [heading, pitch]: [f64; 2], width: usize) -> Vec<([f64; 3], bool)> {
        let height = width * 3 / 4;
        let focal = width as f64;
        let mut ends = Vec::new();
        for index in 0..width * height {
            let u = ((index % width) as f64 - 0.5 * width as f64) / focal;
            let v = ((index / width) as f64 - 0.5 * height as f64) / focal;
            let (level, z) = (
                libm::cos(pitch) + v * libm::sin(pitch),
                libm::sin(pitch) - v * libm::cos(pitch),
            );
            let along = [
                level * libm::cos(heading) + u * libm::sin(heading),
                level * libm::sin(heading) - u * libm::cos(heading),
                z,
            ];
            let to = |low: [f64; 3], high: [f64; 3], far: bool| {
                let bound = |a: usize| {
                    let t = [low[a], high[a]].map(|border| (border - eye[a]) / along[a]);
                    [t[0].min(t[1]), t[0].max(t[1])]
                };
                let [x, y, z] = [bound(0), bound(1), bound(2)];
                let (enter, leave) = (x[0].max(y[0]).max(z[0]), x[1].min(y[1]).min(z[1]));
                if far {
                    leave
                } else if enter < leave && enter > 0.0 {
                    enter
                } else {
                    f64::INFINITY
                }
            };
            let wall = to([-5.0, -5.0, 2.5], [70.0, 45.5, 30.0], true);
            let pillar = to([40.0, 20.0, 2.5], [43.0, 26.0, 9.0], false);
            let far = wall.min(pillar).min(70.0);
            ends.push((std::array::from_fn(|a| eye[a] + far * along[a]), far < 70.0));
        }
        ends
    }

    fn marked(eye: [f64; 3], rays: &[([f64; 3], bool)], settled: &[u64]) -> Vec<[u64; 2]> {
        let mut marks = Marks::new(SIZE);
        let _area = marks.mark(eye, rays.iter().copied(), Clearing::Shared, settled);
        let found = (0..CELLS).map(|cell| marks.take(cell)).collect();
        assert_eq!(
            marks,
            Marks::new(SIZE),
            "nothing is left for the next frame"
        );
        found
    }

    /// Ray by ray, without what neighbours have in common.
    fn walked(eye: [f64; 3], rays: &[([f64; 3], bool)]) -> Vec<[u64; 2]> {
        let mut marks = Marks::new(SIZE);
        for &(end, hit) in rays {
            let Some(part) = RayPart::inside(eye, end, SIZE.voxels()) else {
                continue;
            };
            Slabs::new(&part, SIZE.cols).visit(0, i32::MAX, |cell, layers| {
                marks.passed[cell] |= layers;
            });
            if hit && part.ends_inside {
                marks.hits[part.last[1] as usize * SIZE.cols + part.last[0] as usize] |=
                    1 << part.last[2];
            }
        }
        (0..CELLS).map(|cell| marks.take(cell)).collect()
    }

    /// Most eyes are inside of the grid, on a voxel's border or not.
    fn eye() -> impl Strategy<Value = [f64; 3]> {
        let axis = |low: f64, high: f64| prop_oneof![4 => low..high, 1 => Just(high - 4.0)];
        (axis(-3.0, 35.0), axis(2.0, 40.0), axis(3.0, 18.0)).prop_map(|(x, y, z)| [x, y, z])
    }

    fn view() -> impl Strategy<Value = [f64; 2]> {
        (-0.9..0.9_f64, -1.5..0.3_f64).prop_map(|(heading, pitch)| [heading, pitch])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]
        #[test]
        fn what_neighbours_have_in_common_changes_no_mark(eye in eye(), view in view()) {
            let rays = picture(eye, view, 160);
            prop_assert_eq!(marked(eye, &rays, &vec![0; CELLS]), walked(eye, &rays));
        }

        #[test]
        fn what_is_settled_hides_nothing_else(
            eye in eye(),
            view in view(),
            [col, row] in [0..SIZE.cols, 0..SIZE.rows],
            layers in any::<u64>(),
        ) {
            let rays = picture(eye, view, 160);
            // All up to a corner, as if a part of the room had been seen long enough.
            let settled: Vec<u64> = (0..CELLS)
                .map(|cell| {
                    let here = cell % SIZE.cols < col && cell / SIZE.cols < row;
                    if here { u64::MAX } else { layers }
                })
                .collect();
            let found = marked(eye, &rays, &settled);
            let marks = found.into_iter().zip(walked(eye, &rays)).zip(settled);
            for (([hits, passed], [all_hits, all_passed]), settled) in marks {
                prop_assert_eq!(hits, all_hits);
                prop_assert_eq!(passed & !settled, all_passed & !settled);
            }
        }
    }

    #[test]
    fn rounding_down_is_that_of_the_library() {
        for value in [
            0.0,
            0.5,
            -0.5,
            2.0,
            -2.0,
            -1e-300,
            1e15 + 0.5,
            -1e15 - 0.5,
            1e300,
        ] {
            assert_eq!(floor(value).min(FARTHEST), value.floor().min(FARTHEST));
        }
    }

    #[test]
    fn rays_that_are_no_picture_are_followed_too() {
        let eye = [10.5, 10.5, 10.5];
        for rays in [
            vec![],
            vec![([30.5, 10.5, 10.5], true)],
            vec![(eye, true); 1000],
            vec![([10.5, 10.5, 2.5], true); 1000],
            vec![([90.5, 12.5, 8.5], false); 1000],
        ] {
            assert_eq!(marked(eye, &rays, &vec![0; CELLS]), walked(eye, &rays));
        }
    }
}
