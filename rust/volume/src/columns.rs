//! The exact traversal of [`super::VoxelWalk`], many voxels at a time: for every cell that a segment passes, seen from
//! above, the run of layers that it passes there.

use super::ray::RayPart;

/// Fraction bits of the fixed-point coordinates: 2^-44 of a voxel, and room for half a million voxels.
const BITS: u32 = 44;
const ONE: i64 = 1 << BITS;
/// Fraction bits of the slope of height over the lesser axis.
const SLOPE_BITS: u32 = 32;

/// More layers than a grid has.
const MOST_LAYERS: i64 = 65 * ONE;

/// A segment within the grid, cut at every border of the axis along which it goes further: u. Within such a slab it
/// crosses at most one border of the other axis, v. No error adds up beyond 2^-37 of a voxel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slabs {
    /// Slabs after the first.
    count: i32,
    /// Fixed-point v and height where the segment starts, at the first border, and from border to border.
    start: [i64; 2],
    at_border: [i64; 2],
    step: [i64; 2],
    first: [i64; 2],
    last: [i64; 2],
    /// Height over v.
    slope: i64,
    u_index: i64,
    u_stride: i64,
    v_stride: i64,
}

impl Slabs {
    /// The segment of a part of a ray, in a grid of so many columns.
    #[inline]
    pub(super) fn new(part: &RayPart, cols: usize) -> Self {
        let RayPart {
            from,
            to,
            first,
            last,
            ..
        } = *part;
        let along_x = (to[0] - from[0]).abs() >= (to[1] - from[1]).abs();
        let (u, v) = if along_x { (0, 1) } else { (1, 0) };
        let stride = |axis: usize| if axis == 0 { 1 } else { cols as i64 };
        let (du, dv, dz) = (to[u] - from[u], to[v] - from[v], to[2] - from[2]);
        let count = (last[u] - first[u]).abs();
        let forward = du >= 0.0;
        let per_slab = if count > 0 { 1.0 / du.abs() } else { 0.0 };
        let border = f64::from(first[u] + i32::from(forward));
        let to_border = (border - from[u]).abs() * per_slab;
        let slope = if dv == 0.0 {
            0
        } else {
            (dz / dv * f64::from(2.0_f32.powi(SLOPE_BITS as i32))) as i64
        };
        Self {
            count,
            start: [fixed(from[v]), fixed(from[2])],
            at_border: [
                fixed(from[v] + to_border * dv),
                fixed(from[2] + to_border * dz),
            ],
            step: [
                fixed(dv * per_slab).clamp(1 - ONE, ONE - 1),
                // More is never used: a segment that leaves the slab that it starts in stays within the layers.
                fixed(dz * per_slab).clamp(-MOST_LAYERS, MOST_LAYERS),
            ],
            first: [first[v].into(), first[2].into()],
            last: [last[v].into(), last[2].into()],
            slope,
            u_index: i64::from(first[u]) * stride(u),
            u_stride: if forward { stride(u) } else { -stride(u) },
            v_stride: stride(v),
        }
    }

    /// Calls `visit(index, layers)` for every cell that the segment passes in slabs `from` to before `end`: `index` is
    /// `row * cols + col`, `layers` has one bit for every layer.
    #[inline]
    pub(super) fn visit(&self, from: i32, end: i32, visit: impl FnMut(usize, u64)) {
        // What is inside at the first border and at the last one is inside at all of them.
        let behind = i64::from(self.count - 1);
        let within = |axis: usize| {
            let (first, last) = (self.first[axis], self.last[axis]);
            let at = |border: i64| self.at_border[axis] + border * self.step[axis];
            let inside =
                |fixed: i64| (first.min(last)..=first.max(last)).contains(&(fixed >> BITS));
            self.count == 0 || inside(at(0)) && inside(at(behind))
        };
        if within(0) && within(1) {
            self.visit_at(from, end, |_, fixed| fixed >> BITS, visit);
        } else {
            self.visit_at(from, end, |axis, fixed| self.unit(axis, fixed), visit);
        }
    }

    /// The cell along v (axis 0) or the layer (axis 1) at a coordinate that rounding may have put beyond the ends.
    #[inline]
    fn unit(&self, axis: usize, fixed: i64) -> i64 {
        let (first, last) = (self.first[axis], self.last[axis]);
        (fixed >> BITS).clamp(first.min(last), first.max(last))
    }

    /// [`Self::visit`] with the units at borders found by `unit(axis, coordinate)`.
    #[inline]
    fn visit_at(
        &self,
        from: i32,
        end: i32,
        unit: impl Fn(usize, i64) -> i64,
        mut visit: impl FnMut(usize, u64),
    ) {
        let [v_step, z_step] = self.step;
        let mut u_index = self.u_index + i64::from(from) * self.u_stride;
        let ([mut v_in, mut z_in], [mut v0, mut z0]) = (self.start, self.first);
        if from > 0 {
            v_in = self.at_border[0] + i64::from(from - 1) * v_step;
            z_in = self.at_border[1] + i64::from(from - 1) * z_step;
            (v0, z0) = (unit(0, v_in), unit(1, z_in));
        }
        let mut v_out = self.at_border[0] + i64::from(from) * v_step;
        let mut z_out = self.at_border[1] + i64::from(from) * z_step;
        let mut pass =
            |u_index: i64, [v_in, z_in]: [i64; 2], [v0, z0]: [i64; 2], [v1, z1]: [i64; 2]| {
                let here = u_index + v0 * self.v_stride;
                if v0 == v1 {
                    visit(here as usize, run(z0, z1));
                } else {
                    let v_border = v0.max(v1) << BITS;
                    let rise = (i128::from(v_border - v_in) * i128::from(self.slope)) >> SLOPE_BITS;
                    let middle = self.unit(1, z_in + rise as i64);
                    visit(here as usize, run(z0, middle));
                    visit((u_index + v1 * self.v_stride) as usize, run(middle, z1));
                }
            };
        for _ in from..end.min(self.count) {
            let (v1, z1) = (unit(0, v_out), unit(1, z_out));
            pass(u_index, [v_in, z_in], [v0, z0], [v1, z1]);
            u_index += self.u_stride;
            (v_in, z_in, v0, z0) = (v_out, z_out, v1, z1);
            v_out += v_step;
            z_out += z_step;
        }
        if from <= self.count && end > self.count {
            pass(u_index, [v_in, z_in], [v0, z0], self.last);
        }
    }
}

#[inline]
const fn fixed(value: f64) -> i64 {
    (value * ONE as f64) as i64
}

/// Bits from one layer to the other, both included.
#[inline]
pub(super) const fn run(a: i64, b: i64) -> u64 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    (2_u64 << high).wrapping_sub(1 << low)
}

#[cfg(test)]
mod tests {
    use super::super::VoxelWalk;
    use super::*;
    use proptest::prelude::*;

    const SIZE: [i32; 3] = [100, 100, 16];

    fn point() -> impl Strategy<Value = [f64; 3]> {
        let axis = |high: f64| prop_oneof![4 => 0.0..high, 1 => Just(high / 2.0 + 0.5)];
        (axis(100.0), axis(100.0), axis(16.0)).prop_map(|(x, y, z)| [x, y, z])
    }

    fn marks(from: [f64; 3], to: [f64; 3]) -> Vec<u64> {
        let part = RayPart::inside(from, to, SIZE).unwrap();
        let mut marks = vec![0; 100 * 100];
        Slabs::new(&part, 100).visit(0, i32::MAX, |index, layers| marks[index] |= layers);
        marks
    }

    /// How long the segment is inside the voxel grown by a margin, as a fraction; negative: not at all.
    fn overlap(from: [f64; 3], to: [f64; 3], voxel: [i32; 3], margin: f64) -> f64 {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for a in 0..3 {
            let (low, high) = (
                f64::from(voxel[a]) - margin,
                f64::from(voxel[a] + 1) + margin,
            );
            let along = to[a] - from[a];
            let (t0, t1) = ((low - from[a]) / along, (high - from[a]) / along);
            if along == 0.0 {
                if from[a] < low || from[a] > high {
                    return -1.0;
                }
            } else {
                enter = enter.max(t0.min(t1));
                leave = leave.min(t0.max(t1));
            }
        }
        leave - enter
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(10_000))]
        #[test]
        fn columns_hold_the_voxels_of_the_walk(from in point(), to in point()) {
            let found = marks(from, to);
            let mut walked = vec![0_u64; 100 * 100];
            for [x, y, z] in VoxelWalk::new(from, to, SIZE).into_iter().flatten() {
                walked[y as usize * 100 + x as usize] |= 1 << z;
            }
            for (index, (a, b)) in found.iter().zip(&walked).enumerate() {
                for z in (0..16).filter(|z| (a ^ b) >> z & 1 == 1) {
                    // Rounding may decide otherwise only where the segment touches an edge of the voxel.
                    let voxel = [(index % 100) as i32, (index / 100) as i32, z];
                    prop_assert!(overlap(from, to, voxel, -1e-8) < 0.0, "{:?} is passed", voxel);
                    prop_assert!(overlap(from, to, voxel, 1e-8) >= 0.0, "{:?} is not passed", voxel);
                }
            }
        }
    }

    #[test]
    fn a_vertical_segment_is_one_run() {
        let found = marks([3.5, 4.5, 12.5], [3.5, 4.5, 2.5]);
        assert_eq!(found[403], run(2, 12));
        assert_eq!(found.iter().filter(|&&m| m != 0).count(), 1);
    }

    #[test]
    fn a_diagonal_segment_touches_no_cell_twice_removed() {
        let found = marks([0.5, 0.5, 0.5], [9.5, 9.5, 0.5]);
        assert!((0..10).all(|i| found[i * 101] == 1));
    }
}
