//! The same exact traversal as [`super::VoxelWalk`], many voxels at a time: for every cell that a segment passes, seen from
//! above, the run of layers that it passes there.

/// Fraction bits of the fixed-point coordinates: 2^-44 of a voxel, and room for half a million voxels.
const BITS: u32 = 44;
const ONE: i64 = 1 << BITS;
/// Fraction bits of the slope of height over the lesser axis.
const SLOPE_BITS: u32 = 32;

/// Calls `visit(index, layers)` for every cell that the segment passes: `index` is `row * cols + col`, `layers` has one
/// bit for every layer. Both ends must lie inside the grid (in voxels); `first` and `last` are their voxels.
///
/// The segment is cut at every border of the axis along which it goes further. Within such a slab it crosses at most one
/// border of the other axis. No error adds up beyond 2^-37 of a voxel.
#[inline]
pub(super) fn for_each_column(
    from: [f64; 3],
    to: [f64; 3],
    first: [i32; 3],
    last: [i32; 3],
    cols: usize,
    mut visit: impl FnMut(usize, u64),
) {
    // u is the axis along which the segment goes further, v the other one.
    let along_x = (to[0] - from[0]).abs() >= (to[1] - from[1]).abs();
    let (u, v) = if along_x { (0, 1) } else { (1, 0) };
    let stride = |axis: usize| if axis == 0 { 1 } else { cols as i64 };
    let (du, dv, dz) = (to[u] - from[u], to[v] - from[v], to[2] - from[2]);
    let slabs = (last[u] - first[u]).abs();
    let forward = du >= 0.0;
    let u_stride = if forward { stride(u) } else { -stride(u) };
    let v_stride = stride(v);
    let mut u_index = i64::from(first[u]) * stride(u);

    let per_slab = if slabs > 0 { 1.0 / du.abs() } else { 0.0 };
    let border = f64::from(first[u] + i32::from(forward));
    let to_border = (border - from[u]).abs() * per_slab;
    let v_step = fixed(dv * per_slab).clamp(1 - ONE, ONE - 1);
    let z_step = fixed(dz * per_slab);
    let slope = if dv == 0.0 {
        0
    } else {
        (dz / dv * f64::from(2.0_f32.powi(SLOPE_BITS as i32))) as i64
    };
    let (v_low, v_high) = (first[v].min(last[v]).into(), first[v].max(last[v]).into());
    let (z_low, z_high) = (first[2].min(last[2]).into(), first[2].max(last[2]).into());
    let cell = |fixed: i64| (fixed >> BITS).clamp(v_low, v_high);
    let layer = |fixed: i64| (fixed >> BITS).clamp(z_low, z_high);

    let (mut v_in, mut z_in) = (fixed(from[v]), fixed(from[2]));
    let (mut v0, mut z0) = (i64::from(first[v]), i64::from(first[2]));
    let mut v_out = fixed(from[v] + to_border * dv);
    let mut z_out = fixed(from[2] + to_border * dz);
    for slab in 0..=slabs {
        let (v1, z1) = if slab == slabs {
            (i64::from(last[v]), i64::from(last[2]))
        } else {
            (cell(v_out), layer(z_out))
        };
        let here = u_index + v0 * v_stride;
        if v0 == v1 {
            visit(here as usize, run(z0, z1));
        } else {
            let v_border = v0.max(v1) << BITS;
            let rise = (i128::from(v_border - v_in) * i128::from(slope)) >> SLOPE_BITS;
            let middle = layer(z_in + rise as i64);
            visit(here as usize, run(z0, middle));
            visit((u_index + v1 * v_stride) as usize, run(middle, z1));
        }
        u_index += u_stride;
        (v_in, z_in, v0, z0) = (v_out, z_out, v1, z1);
        v_out += v_step;
        z_out += z_step;
    }
}

const fn fixed(value: f64) -> i64 {
    (value * ONE as f64) as i64
}

/// Bits from one layer to the other, both included.
const fn run(a: i64, b: i64) -> u64 {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    (u64::MAX >> (63 - high)) & (u64::MAX << low)
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
        let floor = |p: [f64; 3]| p.map(|v| v.floor() as i32);
        let mut marks = vec![0; 100 * 100];
        for_each_column(from, to, floor(from), floor(to), 100, |index, layers| {
            marks[index] |= layers;
        });
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
