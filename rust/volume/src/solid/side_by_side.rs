//! Rays that are followed side by side: while the box of one is looked up, the others go on.

use super::{RangeField, range_field::unmirrored};

/// A number for each ray.
pub type Lanes = wide::f32x8;
/// Rays that are followed at once.
pub const LANES: usize = 8;

/// Axes along which a ray stands still are left after an eternity: no number here is infinite.
const STILL: f32 = 1e-20;

impl RangeField {
    /// Places given in metres, axis by axis, as [`Self::cast_side_by_side`] takes them: in cells from the grid's lowest corner.
    #[inline]
    pub fn in_voxels(&self, places_m: &[[f64; LANES]; 3]) -> [Lanes; 3] {
        std::array::from_fn(|a| {
            let voxels = |at_m: f64| ((at_m - self.corner_m[a]) * self.per_m) as f32;
            Lanes::new(places_m[a].map(voxels))
        })
    }

    /// What [`Self::cast`] says of eight rays, m, infinity where a ray meets nothing: in single precision, by which a ray that
    /// passes an edge within a ten-thousandth of a voxel may miss it or meet it. Origins by [`Self::in_voxels`]; fastest for rays
    /// that go much the same way.
    #[inline]
    pub fn cast_side_by_side(
        &self,
        origin: &[Lanes; 3],
        direction: &[Lanes; 3],
        max_range_m: Lanes,
    ) -> Lanes {
        if self.blocks.is_some() {
            return self.cast_one_by_one(origin, direction, max_range_m);
        }
        let (mut rays, boxes) = Rays::begin(self, origin, direction, max_range_m);
        let last = self.size.map(|count| Lanes::splat((count - 1) as f32));
        let [cols, rows] = [self.size[0], self.size[1]].map(wide::i32x8::splat);
        let mut ends = Lanes::splat(f32::INFINITY);
        while rays.live.any() {
            let [x, y, z] = rays.voxel.map(Lanes::fast_trunc_int);
            let index = (x + (y + z * rows) * cols).to_array();
            let (mut width, mut height) = ([0; LANES], [0; LANES]);
            for lane in 0..LANES {
                let found = self.octants[boxes[lane]].sides(index[lane] as usize);
                [width[lane], height[lane]] = found;
            }
            let width = Lanes::from_i32x8(width.into());
            let height = Lanes::from_i32x8(height.into());
            let solid = height.simd_eq(Lanes::ZERO);
            ends = (rays.live & solid).select(rays.at, ends);
            rays.live &= !solid;
            rays.leave_boxes([width, width, height], &last);
        }
        let ends_m = ends * Lanes::splat(self.resolution_m as f32);
        let Some(surfaces) = &self.surfaces else {
            return ends_m;
        };
        let last = self.size.map(|count| count - 1);
        let (mut ends_m, [x, y, z]) = (ends_m.to_array(), rays.voxel.map(Lanes::to_array));
        for lane in 0..LANES {
            if !ends_m[lane].is_finite() {
                continue;
            }
            let mirrored = [x[lane], y[lane], z[lane]].map(|at| at as i32);
            let voxel = unmirrored(mirrored, last, boxes[lane]);
            let (from_m, along) = self.lane(lane, origin, direction);
            let found_m = surfaces.along(voxel, from_m, along, f64::from(ends_m[lane]));
            ends_m[lane] = found_m as f32;
        }
        ends_m.into()
    }

    /// Where one of eight rays begins, m, and in which direction it goes.
    fn lane(
        &self,
        lane: usize,
        origin: &[Lanes; 3],
        direction: &[Lanes; 3],
    ) -> ([f64; 3], [f64; 3]) {
        let of = |lanes: &Lanes| f64::from(lanes.to_array()[lane]);
        let from_m = std::array::from_fn(|a| self.corner_m[a] + of(&origin[a]) * self.cell_m);
        (from_m, std::array::from_fn(|a| of(&direction[a])))
    }

    /// Where eight rays end, each followed alone: cells are blocks.
    fn cast_one_by_one(
        &self,
        origin: &[Lanes; 3],
        direction: &[Lanes; 3],
        max_range_m: Lanes,
    ) -> Lanes {
        let reach_m = max_range_m.to_array();
        let ends_m: [f32; LANES] = std::array::from_fn(|lane| {
            let (from_m, along) = self.lane(lane, origin, direction);
            let end_m = self.cast(from_m, along, f64::from(reach_m[lane]));
            end_m.map_or(f32::INFINITY, |end_m| end_m as f32)
        });
        ends_m.into()
    }
}

/// Rays on their way, in voxels, mirrored so that all go up along all axes.
struct Rays {
    from: [Lanes; 3],
    along: [Lanes; 3],
    per_along: [Lanes; 3],
    /// Where they are, and in which voxels.
    at: Lanes,
    voxel: [Lanes; 3],
    /// Where they end or leave the grid.
    leave: Lanes,
    /// A mask: those that have not ended.
    live: Lanes,
}

impl Rays {
    /// Where they enter the grid; and the octants in which they go.
    #[inline]
    fn begin(
        field: &RangeField,
        origin: &[Lanes; 3],
        direction: &[Lanes; 3],
        max_range_m: Lanes,
    ) -> (Self, [usize; LANES]) {
        let zero = Lanes::ZERO;
        let mut octant = zero;
        let mut rays = Self {
            from: [zero; 3],
            along: [zero; 3],
            per_along: [zero; 3],
            at: zero,
            voxel: [zero; 3],
            leave: max_range_m * Lanes::splat(field.per_m as f32),
            live: zero,
        };
        for a in 0..3 {
            let size = Lanes::splat(field.size[a] as f32);
            let down = direction[a].simd_lt(zero);
            octant += down & Lanes::splat((1 << a) as f32);
            rays.from[a] = down.select(size - origin[a], origin[a]);
            rays.along[a] = direction[a].abs().max(Lanes::splat(STILL));
            rays.per_along[a] = Lanes::ONE / rays.along[a];
            rays.at = rays.at.max(-(rays.from[a] * rays.per_along[a]));
            rays.leave = rays.leave.min((size - rays.from[a]) * rays.per_along[a]);
        }
        for a in 0..3 {
            let voxel = floor(rays.from[a] + rays.along[a] * rays.at);
            let last = Lanes::splat((field.size[a] - 1) as f32);
            rays.voxel[a] = voxel.max(zero).min(last);
        }
        // What is no number is nowhere.
        let sum = rays.from[0] + rays.from[1] + rays.from[2] + rays.at;
        rays.live = rays.at.simd_lt(rays.leave) & sum.is_finite();
        (rays, octant.to_array().map(|octant| octant as usize))
    }

    /// To the faces by which they leave their boxes.
    #[inline]
    fn leave_boxes(&mut self, sides: [Lanes; 3], last: &[Lanes; 3]) {
        let (mut faces, mut exits) = ([Lanes::ZERO; 3], [Lanes::ZERO; 3]);
        for a in 0..3 {
            faces[a] = self.voxel[a] + sides[a];
            exits[a] = (faces[a] - self.from[a]) * self.per_along[a];
        }
        let at = exits[0].fast_min(exits[1]).fast_min(exits[2]);
        self.live &= at.simd_lt(self.leave);
        self.at = self.live.select(at, self.at);
        for a in 0..3 {
            // Rounding may take no axis back, nor out of the grid.
            let inside = floor(self.from[a] + self.along[a] * at);
            let inside = inside.fast_max(self.voxel[a]).fast_min(last[a]);
            let next = exits[a].simd_le(at).select(faces[a], inside);
            self.voxel[a] = self.live.select(next, self.voxel[a]);
        }
    }
}

/// The whole number below, or at a whole number that one or the one before, for what lies far within 2^22.
#[inline]
fn floor(value: Lanes) -> Lanes {
    // In this binade the last bit is worth one.
    let ones = Lanes::splat(12_582_912.0);
    (value - Lanes::splat(0.5) + ones) - ones
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::SolidVoxels;
    use super::*;
    use proptest::prelude::*;

    const SIDE_M: f64 = 0.1;

    fn boxes() -> impl Strategy<Value = Vec<[[f64; 3]; 2]>> {
        let place = prop::array::uniform3(-1.5..1.5f64);
        prop::collection::vec((place, prop::array::uniform3(0.1..0.9f64)), 1..8).prop_map(|list| {
            (list.iter())
                .map(|(low, side)| [*low, std::array::from_fn(|a| low[a] + side[a])])
                .collect()
        })
    }

    /// A place, a unit vector, some along an axis or in a plane of the grid, and a range.
    fn ray() -> impl Strategy<Value = ([f64; 3], [f64; 3], f64)> {
        let direction = prop::array::uniform3(prop_oneof![3 => -1.0..1.0f64, 1 => Just(0.0)])
            .prop_filter("no direction", |d| d.iter().any(|v| v.abs() > 1e-3))
            .prop_map(|d| {
                let norm = d.iter().map(|v| v * v).sum::<f64>().sqrt();
                d.map(|v| v / norm)
            });
        (prop::array::uniform3(-2.5..2.5f64), direction, 0.1..6.0f64)
    }

    fn together(field: &RangeField, rays: &[([f64; 3], [f64; 3], f64); LANES]) -> [f32; LANES] {
        let places = std::array::from_fn(|a| rays.map(|(from, _, _)| from[a]));
        let along = std::array::from_fn(|a| rays.map(|(_, along, _)| along[a] as f32).into());
        let ranges = rays.map(|(_, _, range_m)| range_m as f32).into();
        let ends = field.cast_side_by_side(&field.in_voxels(&places), &along, ranges);
        ends.to_array()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn rays_side_by_side_end_where_each_ends_alone(boxes in boxes(), rays in prop::array::uniform8(ray())) {
            let field = RangeField::new(&Arc::new(SolidVoxels::of_boxes(&boxes, SIDE_M).unwrap()));
            for ((from, along, range_m), found_m) in rays.into_iter().zip(together(&field, &rays)) {
                // Or where one ends that passes within a ten-thousandth of a voxel: single precision.
                let off_m = 1e-4 * SIDE_M;
                let near = (0..27).map(|number: i32| {
                    let shift = [number % 3, number / 3 % 3, number / 9].map(|step| f64::from((step + 1) % 3 - 1) * off_m);
                    field.cast(std::array::from_fn(|a| from[a] + shift[a]), along, range_m)
                });
                let mut near = near.map(|end_m| end_m.unwrap_or(f64::INFINITY));
                let found_m = f64::from(found_m);
                // What ends at the range itself may lie on either side of it.
                let same = |end_m: f64| end_m == found_m || (end_m.min(range_m) - found_m.min(range_m)).abs() < 10.0 * off_m;
                prop_assert!(near.any(same), "{found_m} {:?}", field.cast(from, along, range_m));
            }
        }
    }

    #[test]
    fn a_ray_with_a_number_that_is_none_ends_and_leaves_the_others_alone() {
        let floor = [[-1.0, -1.0, -0.1], [1.0, 1.0, 0.0]];
        let field = RangeField::new(&Arc::new(SolidVoxels::of_boxes(&[floor], SIDE_M).unwrap()));
        let down = ([0.3, 0.3, 0.7], [0.0, 0.0, -1.0], 5.0);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut rays = [down; LANES];
            rays[1].0[0] = bad;
            rays[2].1[1] = bad;
            rays[3].2 = bad;
            let ends_m = together(&field, &rays);
            assert!(ends_m[1].is_infinite());
            for lane in [0, 4, 5, 6, 7] {
                assert!((ends_m[lane] - 0.7).abs() < 1e-5);
            }
        }
    }
}
