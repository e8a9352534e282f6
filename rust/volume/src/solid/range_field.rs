//! How far a ray gets through a map that does not change.

use std::cmp::Ordering;
use std::sync::Arc;

use super::voxels::{BLOCK, bit};
use super::{InnerSurfaces, SolidVoxels, free_boxes::FreeBoxes};

/// Voxels of a box up to which each has its own free boxes, eight bytes: where there are more, each block of voxels has.
const MOST_SINGLE: usize = 1 << 26;

/// For each octant of directions, how much free space lies ahead of each cell.
///
/// A ray cannot leave a free box but through its far faces, so that it is followed from box to box instead of from voxel to
/// voxel, and ends at the face at which a traversal of all voxels would end. Cells are voxels; in a map of very many they are blocks, and a
/// block that holds something is gone through voxel by voxel.
#[derive(Debug, Clone)]
pub struct RangeField {
    pub(super) resolution_m: f64,
    /// Side of a cell, m.
    pub(super) cell_m: f64,
    pub(super) per_m: f64,
    /// The grid's lowest corner, m.
    pub(super) corner_m: [f64; 3],
    /// Cells along each axis.
    pub(super) size: [i32; 3],
    /// Bit `a` of an octant's number is set where the direction is negative along axis `a`; its grid is mirrored there.
    pub(super) octants: [FreeBoxes; 8],
    /// What is in the cells, where they are blocks.
    pub(super) blocks: Option<Arc<SolidVoxels>>,
    /// Where in the voxels the surface lies; none where that is their faces.
    pub(super) surfaces: Option<Arc<InnerSurfaces>>,
}

/// A ray in cells, mirrored so that it goes up along all axes.
struct MirroredRay {
    from: [f64; 3],
    along: [f64; 3],
    per_along: [f64; 3],
    /// Where it ends, or leaves the grid.
    leave: f64,
    octant: usize,
}

impl RangeField {
    /// The field of these voxels, whose faces are what a ray ends at.
    pub fn new(voxels: &Arc<SolidVoxels>) -> Self {
        Self::with_cells(voxels, voxels.count() > MOST_SINGLE)
    }

    /// The field of voxels in which surfaces lie: rays end at these.
    pub fn measured(voxels: &Arc<SolidVoxels>, surfaces: &Arc<InnerSurfaces>) -> Self {
        Self {
            surfaces: Some(Arc::clone(surfaces)),
            ..Self::new(voxels)
        }
    }

    /// The field whose cells are voxels, or blocks.
    pub(super) fn with_cells(voxels: &Arc<SolidVoxels>, are_blocks: bool) -> Self {
        let (solid, size, edge) = if are_blocks {
            (voxels.filled_blocks(), voxels.blocks, BLOCK)
        } else {
            (voxels.dense(), voxels.size, 1)
        };
        let cell_m = voxels.resolution_m * edge as f64;
        Self {
            resolution_m: voxels.resolution_m,
            cell_m,
            per_m: 1.0 / cell_m,
            corner_m: voxels.corner_m([0; 3]),
            size: size.map(|count| count as i32),
            octants: std::array::from_fn(|octant| FreeBoxes::towards(&solid, size, octant)),
            blocks: are_blocks.then(|| Arc::clone(voxels)),
            surfaces: None,
        }
    }

    /// Side of a voxel, m.
    pub fn resolution_m(&self) -> f64 {
        self.resolution_m
    }

    /// Distance from `origin_m` along the unit vector `direction` to where the ray enters a solid voxel, or meets the surface in it, m; none
    /// where it enters none within `max_range_m`. 0 for an origin in a solid voxel without a surface. Allocates nothing.
    #[inline]
    pub fn cast(&self, origin_m: [f64; 3], direction: [f64; 3], max_range_m: f64) -> Option<f64> {
        // Axes along which the ray goes down are mirrored, so that it goes up along all of them.
        let mut course = MirroredRay {
            from: [0.0; 3],
            along: [0.0; 3],
            per_along: [0.0; 3],
            leave: max_range_m * self.per_m,
            octant: 0,
        };
        let mut enter = 0.0_f64;
        for a in 0..3 {
            let mut from = (origin_m[a] - self.corner_m[a]) * self.per_m;
            let mut along = direction[a];
            if direction[a] < 0.0 {
                from = f64::from(self.size[a]) - from;
                along = -along;
                course.octant |= 1 << a;
            }
            let per_along = 1.0 / along;
            let to_end = f64::from(self.size[a]) - from;
            if along > 0.0 {
                enter = -lesser(-enter, from * per_along);
                course.leave = lesser(course.leave, to_end * per_along);
            } else if from < 0.0 || to_end <= 0.0 {
                return None;
            }
            (course.from[a], course.along[a]) = (from, along);
            course.per_along[a] = per_along;
        }
        let (at, voxel) = self.follow(&course, enter)?;
        let face_m = at * self.cell_m;
        let Some(surfaces) = &self.surfaces else {
            return Some(face_m);
        };
        Some(surfaces.along(voxel, origin_m, direction, face_m))
    }

    /// Where a ray ends, in cells, and the solid voxel there.
    #[inline]
    fn follow(&self, course: &MirroredRay, enter: f64) -> Option<(f64, [i32; 3])> {
        let MirroredRay {
            from,
            along,
            per_along,
            leave,
            octant,
        } = course;
        if enter >= *leave {
            return None;
        }
        let boxes = &self.octants[*octant];
        let last = self.size.map(|count| count - 1);
        let mut cell = [0; 3];
        for a in 0..3 {
            cell[a] = floor(from[a] + along[a] * enter).clamp(0, last[a]);
        }
        let mut at = enter;
        loop {
            let row = cell[2] * self.size[1] + cell[1];
            let [mut width, mut height] = boxes.sides((row * self.size[0] + cell[0]) as usize);
            if height == 0 {
                match &self.blocks {
                    None => return Some((at, unmirrored(cell, last, *octant))),
                    Some(voxels) => {
                        let found = within(voxels, course, (cell, last), at);
                        if found.is_some() {
                            return found;
                        }
                        (width, height) = (1, 1);
                    }
                }
            }
            // Along an axis on which the ray stands still the exit is infinitely far: the face lies ahead of it.
            let faces = [cell[0] + width, cell[1] + width, cell[2] + height];
            let mut exits = [0.0; 3];
            for a in 0..3 {
                exits[a] = (f64::from(faces[a]) - from[a]) * per_along[a];
            }
            at = lesser(lesser(exits[0], exits[1]), exits[2]);
            // No number for a time, from an origin that is none, ends it too.
            if at.partial_cmp(leave) != Some(Ordering::Less) {
                return None;
            }
            for a in 0..3 {
                // Rounding may take no axis back, nor out of the grid.
                let inside = floor(from[a] + along[a] * at).max(cell[a]).min(last[a]);
                cell[a] = if exits[a] <= at { faces[a] } else { inside };
            }
        }
    }
}

/// Where in a block, which it enters at `at`, a ray ends, in cells, and the solid voxel there.
fn within(
    voxels: &SolidVoxels,
    course: &MirroredRay,
    (cell, last): ([i32; 3], [i32; 3]),
    mut at: f64,
) -> Option<(f64, [i32; 3])> {
    const EDGE: i32 = BLOCK as i32;
    let block = unmirrored(cell, last, course.octant).map(|at| at as usize);
    let bits = voxels.bits_of(block);
    let edge = f64::from(EDGE);
    let mut voxel: [i32; 3] = std::array::from_fn(|a| {
        let inside = floor(edge * (course.from[a] + course.along[a] * at));
        inside.clamp(EDGE * cell[a], EDGE * cell[a] + EDGE - 1)
    });
    loop {
        let place = unmirrored(voxel, last.map(|at| EDGE * at + EDGE - 1), course.octant);
        if bits >> bit(place.map(|at| at as usize)) & 1 == 1 {
            return Some((at, place));
        }
        let exits: [f64; 3] = std::array::from_fn(|a| {
            (f64::from(voxel[a] + 1) / edge - course.from[a]) * course.per_along[a]
        });
        let axis = (0..3).fold(
            0,
            |least, a| if exits[a] < exits[least] { a } else { least },
        );
        if exits[axis].partial_cmp(&course.leave) != Some(Ordering::Less) {
            return None;
        }
        at = exits[axis];
        voxel[axis] += 1;
        if voxel[axis] == EDGE * (cell[axis] + 1) {
            return None;
        }
    }
}

/// A cell as it is counted in the grid that is not mirrored.
#[inline]
pub(super) fn unmirrored(cell: [i32; 3], last: [i32; 3], octant: usize) -> [i32; 3] {
    std::array::from_fn(|a| {
        if octant >> a & 1 == 1 {
            last[a] - cell[a]
        } else {
            cell[a]
        }
    })
}

/// The lesser of two numbers, by the one instruction that does not ask whether they are numbers.
#[inline]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The whole number below, or at a whole number that one or the one before: without the checks of a cast, for what lies far within
/// 2^31.
#[inline]
fn floor(value: f64) -> i32 {
    // In this binade the last bit is worth one.
    const ONES: f64 = 6_755_399_441_055_744.0;
    (value - 0.5 + ONES).to_bits() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VoxelWalk;
    use proptest::prelude::*;

    const SIDE_M: f64 = 0.1;

    /// What a traversal of every voxel finds, m: where the segment enters the first solid one.
    fn traversed(voxels: &SolidVoxels, from: [f64; 3], along: [f64; 3], max: f64) -> Option<f64> {
        let corner = voxels.corner_m([0; 3]);
        let from: [f64; 3] = std::array::from_fn(|a| (from[a] - corner[a]) / SIDE_M);
        let to = std::array::from_fn(|a| from[a] + along[a] * max / SIDE_M);
        let size = voxels.size().map(|v| v as i32);
        let solid =
            VoxelWalk::new(from, to, size)?.find(|voxel| voxels.is_solid(voxel.map(i64::from)))?;
        let enter = (0..3).filter(|&a| along[a] != 0.0).map(|a| {
            let near = f64::from(solid[a] + i32::from(along[a] < 0.0));
            (near - from[a]) / along[a]
        });
        Some(enter.fold(0.0, f64::max) * SIDE_M)
    }

    fn direction() -> impl Strategy<Value = [f64; 3]> {
        // Many of them along an axis or in a plane of the grid, where ties are.
        prop::array::uniform3(prop_oneof![3 => -1.0..1.0f64, 1 => Just(0.0)])
            .prop_filter("no direction", |d| d.iter().any(|v| v.abs() > 1e-3))
            .prop_map(|d| {
                let norm = d.iter().map(|v| v * v).sum::<f64>().sqrt();
                d.map(|v| v / norm)
            })
    }

    fn boxes() -> impl Strategy<Value = Vec<[[f64; 3]; 2]>> {
        let place = prop::array::uniform3(-1.5..1.5f64);
        prop::collection::vec((place, prop::array::uniform3(0.1..0.9f64)), 1..8).prop_map(|list| {
            (list.iter())
                .map(|(low, side)| [*low, std::array::from_fn(|a| low[a] + side[a])])
                .collect()
        })
    }

    /// Six walls about a room that extends by `half` to both sides, m.
    fn room(half: [f64; 3]) -> Vec<[[f64; 3]; 2]> {
        let outer = half.map(|v| v + 0.3);
        let wall = |a: usize, sign: f64| {
            let (mut low, mut high) = (outer.map(|v| -v), outer);
            if sign > 0.0 {
                low[a] = half[a];
            } else {
                high[a] = -half[a];
            }
            [low, high]
        };
        (0..3).flat_map(|a| [wall(a, 1.0), wall(a, -1.0)]).collect()
    }

    #[test]
    fn a_ray_with_a_number_that_is_none_ends() {
        let field = RangeField::new(&Arc::new(
            SolidVoxels::of_boxes(&room([1.0; 3]), SIDE_M).unwrap(),
        ));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let _ = field.cast([0.0, 0.0, 0.0], [bad, 0.0, 1.0], 5.0);
            let _ = field.cast([bad, 0.0, 0.0], [0.6, 0.0, 0.8], 5.0);
            let _ = field.cast([bad; 3], [0.6, 0.0, 0.8], 5.0);
        }
        assert_eq!(field.cast([1.1, 0.0, 0.0], [1.0, 0.0, 0.0], 5.0), Some(0.0));
    }

    /// What takes seconds: not in the fast part of the tests.
    mod slow {
        use super::*;

        proptest! {
            #![proptest_config(ProptestConfig::with_cases(1000))]

            #[test]
            fn a_cast_ends_where_a_traversal_of_all_voxels_ends(
                boxes in boxes(),
                rays in prop::collection::vec((prop::array::uniform3(-2.5..2.5f64), direction(), 0.1..6.0f64), 20),
            ) {
                let voxels = Arc::new(SolidVoxels::of_boxes(&boxes, SIDE_M).unwrap());
                let fields = [false, true].map(|are_blocks| RangeField::with_cells(&voxels, are_blocks));
                for ((from, along, max), field) in rays.iter().flat_map(|&ray| fields.iter().map(move |field| (ray, field))) {
                    let (found, expected) = (field.cast(from, along, max), traversed(&voxels, from, along, max));
                    match (found, expected) {
                        (Some(found), Some(expected)) => prop_assert!((found - expected).abs() < 1e-9, "{found} {expected}"),
                        // Where the ray ends on the face itself.
                        (None, Some(at)) | (Some(at), None) => prop_assert!((at - max).abs() < 1e-9, "{found:?} {expected:?}"),
                        (None, None) => {}
                    }
                }
            }

            #[test]
            fn a_wall_is_met_within_half_a_voxel_of_where_it_stands(
                half in prop::array::uniform3(0.5..2.0f64),
                from in prop::array::uniform3(-0.4..0.4f64),
                along in direction(),
            ) {
                let voxels = Arc::new(SolidVoxels::of_boxes(&room(half), SIDE_M).unwrap());
                let field = RangeField::new(&voxels);
                let to_wall = |a: usize| if along[a] == 0.0 { f64::INFINITY } else { (half[a] * along[a].signum() - from[a]) / along[a] };
                let expected = to_wall(0).min(to_wall(1)).min(to_wall(2));
                let found = field.cast(from, along, 9.0).unwrap();
                // The end point lies at most half a voxel off the wall, however flat the ray meets it;
                let end: [f64; 3] = std::array::from_fn(|a| from[a] + along[a] * found);
                let off = (0..3).map(|a| (half[a] - end[a].abs()).abs()).fold(f64::INFINITY, f64::min);
                prop_assert!(off <= 0.5 * SIDE_M + 1e-9, "{off}");
                // so the range is within half a voxel's diagonal where it meets all walls at less than 54.7 degrees.
                if along.iter().all(|v| v.abs() > 0.578) || along.iter().filter(|v| **v == 0.0).count() == 2 {
                    prop_assert!((found - expected).abs() <= 0.5 * SIDE_M * 3.0_f64.sqrt() + 1e-9, "{found} {expected}");
                }
            }

            #[test]
            fn walls_on_faces_of_voxels_are_met_exactly(
                half in prop::array::uniform3(5..20i32),
                from in prop::array::uniform3(-0.4..0.4f64),
                along in direction(),
            ) {
                let half = half.map(|v| f64::from(v) * SIDE_M);
                let field = RangeField::new(&Arc::new(SolidVoxels::of_boxes(&room(half), SIDE_M).unwrap()));
                let to_wall = |a: usize| if along[a] == 0.0 { f64::INFINITY } else { (half[a] * along[a].signum() - from[a]) / along[a] };
                let expected = to_wall(0).min(to_wall(1)).min(to_wall(2));
                prop_assert!((field.cast(from, along, 9.0).unwrap() - expected).abs() < 1e-9);
            }
        }
    }
}
