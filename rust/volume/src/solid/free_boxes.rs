//! How much free space lies ahead of each voxel, seen along an octant of directions.

/// Highest box that is told of, voxels.
const MOST: u8 = (1 << HEIGHT_BITS) - 1;
/// Bits of a box's height; those above say how many times doubled its width is.
const HEIGHT_BITS: u32 = 6;
/// Boxes may be as wide as high, twice or four times as wide: much of free space is low above a floor or below a ceiling.
const DOUBLINGS: std::ops::RangeInclusive<u32> = 0..=2;

/// For each voxel a box of free voxels that begins with it and extends along all three axes: a ray that goes up along all of them
/// cannot leave it but through its far faces. One byte each, 0 where the voxel is solid.
#[derive(Debug, Clone)]
pub(super) struct FreeBoxes(Vec<u8>);

impl FreeBoxes {
    /// The boxes of a grid of solid cells that is mirrored along the axes of which the octant has the bit set; x runs fastest, then y,
    /// then z.
    pub(super) fn towards(solid: &[bool], size: [usize; 3], octant: usize) -> Self {
        let solid = mirrored(solid, size, octant);
        let mut largest = vec![0; solid.len()];
        for doublings in DOUBLINGS {
            let heights = heights(&solid, size, 1 << doublings);
            for (best, height) in largest.iter_mut().zip(heights) {
                let found = height | (doublings << HEIGHT_BITS) as u8;
                if volume(found) > volume(*best) {
                    *best = found;
                }
            }
        }
        Self(largest)
    }

    /// Width, along x and y, and height of a voxel's box, in voxels.
    #[inline]
    pub(super) fn sides(&self, index: usize) -> [i32; 2] {
        sides(self.0[index])
    }
}

#[inline]
fn sides(found: u8) -> [i32; 2] {
    let height = i32::from(found & MOST);
    [height << (found >> HEIGHT_BITS), height]
}

fn volume(found: u8) -> i32 {
    let [width, height] = sides(found);
    width * width * height
}

fn mirrored(cells: &[bool], size: [usize; 3], octant: usize) -> Vec<bool> {
    let from = |axis: usize, at: usize| {
        if octant >> axis & 1 == 1 {
            size[axis] - 1 - at
        } else {
            at
        }
    };
    let mut solid = Vec::with_capacity(cells.len());
    for z in 0..size[2] {
        for y in 0..size[1] {
            let first = (from(2, z) * size[1] + from(1, y)) * size[0];
            let row = &cells[first..first + size[0]];
            if octant & 1 == 1 {
                solid.extend(row.iter().rev());
            } else {
                solid.extend(row);
            }
        }
    }
    solid
}

/// Height of the highest free box from each voxel that is `wide` times as wide as high. With the block of `wide x wide` voxels at
/// its corner, it is covered by the boxes that begin a block further along each of the axes: one more than the least of these.
fn heights(solid: &[bool], [cols, rows, layers]: [usize; 3], wide: usize) -> Vec<u8> {
    let mut heights = vec![0_u8; solid.len()];
    let mut blocked = vec![false; cols];
    let mut beyond = vec![MOST; cols];
    for number in (0..rows * layers).rev() {
        let (row, layer) = (number % rows, number / rows);
        let (before, after) = heights.split_at_mut((number + 1) * cols);
        let here = &mut before[number * cols..];
        // Outside all is free.
        beyond.fill(MOST);
        let next = |rows_on: usize, layers_on: usize| {
            let inside = row + rows_on < rows && layer + layers_on < layers;
            inside.then(|| &after[(rows_on + layers_on * rows - 1) * cols..][..cols])
        };
        for values in [next(wide, 0), next(0, 1), next(wide, 1)]
            .into_iter()
            .flatten()
        {
            for (least, &value) in beyond.iter_mut().zip(values) {
                *least = value.min(*least);
            }
        }
        blocked.fill(false);
        for on in 0..wide.min(rows - row) {
            for (blocked, &solid) in blocked.iter_mut().zip(&solid[(number + on) * cols..]) {
                *blocked |= solid;
            }
        }
        for col in (0..cols).rev() {
            let ahead = [beyond.get(col + wide), here.get(col + wide)];
            let least = (ahead.into_iter().flatten()).fold(beyond[col], |least, &v| least.min(v));
            let free = !blocked[col..cols.min(col + wide)].contains(&true);
            here[col] = if free { MOST.min(least + 1) } else { 0 };
        }
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::super::SolidVoxels;
    use super::*;
    use proptest::prelude::*;

    const SIZE: [usize; 3] = [9, 7, 6];

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn boxes_are_free_and_the_largest_of_their_shape(
            solid in prop::collection::btree_set((0..SIZE[0], 0..SIZE[1], 0..SIZE[2]), 1..12),
            octant in 0..8_usize,
        ) {
            let side = |at: usize| [at as f64 * 0.1, (at + 1) as f64 * 0.1];
            let cube = |x, y, z| [[side(x)[0], side(y)[0], side(z)[0]], [side(x)[1], side(y)[1], side(z)[1]]];
            let boxes: Vec<_> = solid.iter().map(|&(x, y, z)| cube(x, y, z)).collect();
            let voxels = SolidVoxels::of_boxes(&boxes, 0.1).unwrap();
            let found = FreeBoxes::towards(&voxels.dense(), voxels.size(), octant);
            let [cols, rows, layers] = voxels.size();
            let ahead = |corner: [usize; 3], on: [i32; 3]| std::array::from_fn(|axis| {
                let (first, on) = (corner[axis] as i64, i64::from(on[axis]));
                if octant >> axis & 1 == 1 { voxels.size()[axis] as i64 - 1 - first - on } else { first + on }
            });
            // Beyond the grid all is free.
            let along = |sides: i32| 0..sides.min(10);
            let is_free = |corner, [width, height]: [i32; 2]| along(width).all(|x| along(width).all(|y| {
                along(height).all(|z| !voxels.is_solid(ahead(corner, [x, y, z])))
            }));
            let corners = (0..layers).flat_map(|z| (0..rows).flat_map(move |y| (0..cols).map(move |x| [x, y, z])));
            for (index, corner) in corners.enumerate() {
                let highest = |wide: i32| match (1..=10).take_while(|&height| is_free(corner, [height * wide, height])).last() {
                    Some(10) => Some(i32::from(MOST)),
                    lower => lower,
                };
                let best = [1, 2, 4].map(|wide| highest(wide).map_or(0, |height| wide * wide * height.pow(3)));
                let sides = found.sides(index);
                prop_assert!(is_free(corner, sides));
                prop_assert_eq!(best.into_iter().max(), Some(sides[0] * sides[0] * sides[1]));
            }
        }
    }
}
