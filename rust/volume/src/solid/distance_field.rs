//! How near the next surface of a map that does not change is.

use std::sync::Arc;

use super::{InnerSurfaces, SolidError, SolidVoxels};

/// No distance: there is no voxel of the kind.
const NONE: f64 = 1e20;

/// How near the next surface is to any place. Where surfaces are the faces between solid and free voxels, the distance is negative in what is
/// solid; a surface that was measured has no inside.
#[derive(Debug, Clone)]
pub struct DistanceField {
    per_m: f64,
    corner_m: [f64; 3],
    size: [usize; 3],
    kept: VoxelValues,
}

/// What is kept of each voxel.
#[derive(Debug, Clone)]
enum VoxelValues {
    /// The distance of its centre, m.
    Distance(Vec<f32>),
    /// The nearest solid voxel, in which the surface lies.
    Nearest(Vec<u32>, Arc<InnerSurfaces>),
}

/// A box of voxels with a border of free ones, so that whatever is solid has a surface.
struct Bordered {
    size: [usize; 3],
    solid: Vec<bool>,
    corner_m: [f64; 3],
}

impl Bordered {
    fn new(voxels: &SolidVoxels) -> Result<Self, SolidError> {
        let found = voxels.count();
        if found > SolidVoxels::MOST_WITH_DISTANCES {
            return Err(SolidError::TooLargeForDistances { found });
        }
        let size = voxels.size.map(|count| count + 2);
        let mut solid = vec![false; size.iter().product()];
        for [x, y, z] in voxels.solid() {
            solid[((z + 1) * size[1] + y + 1) * size[0] + x + 1] = true;
        }
        Ok(Self {
            size,
            solid,
            corner_m: voxels.corner_m([0; 3]).map(|low| low - voxels.resolution_m),
        })
    }
}

impl DistanceField {
    /// The field of these voxels, whose faces are surfaces.
    pub fn new(voxels: &SolidVoxels) -> Result<Self, SolidError> {
        let Bordered {
            size,
            solid,
            corner_m,
        } = Bordered::new(voxels)?;
        let to_solid = squared_distances(&solid, size, true);
        let to_free = squared_distances(&solid, size, false);
        let side_m = voxels.resolution_m;
        // Half a voxel lies between a centre and the face.
        let distances_m = (to_solid.iter().zip(&to_free))
            .map(|(&out, &inside)| {
                let voxels = out.sqrt() - inside.sqrt();
                (side_m * (voxels - 0.5 * voxels.signum())) as f32
            })
            .collect();
        Ok(Self {
            per_m: 1.0 / side_m,
            corner_m,
            size,
            kept: VoxelValues::Distance(distances_m),
        })
    }

    /// The field of voxels in which surfaces lie: a place's distance is the one from the surface in the nearest of them.
    pub fn measured(
        voxels: &SolidVoxels,
        surfaces: &Arc<InnerSurfaces>,
    ) -> Result<Self, SolidError> {
        let Bordered {
            size,
            solid,
            corner_m,
        } = Bordered::new(voxels)?;
        Ok(Self {
            per_m: 1.0 / voxels.resolution_m,
            corner_m,
            size,
            kept: VoxelValues::Nearest(nearest(&solid, size), Arc::clone(surfaces)),
        })
    }

    /// Distance of a place from the nearest surface, m, seen along a unit vector. Allocates nothing.
    #[inline]
    pub fn distance_m(&self, place_m: [f64; 3], along: [f64; 3]) -> f64 {
        match &self.kept {
            VoxelValues::Distance(distances_m) => self.between(distances_m, place_m),
            VoxelValues::Nearest(nearest, surfaces) => {
                let at: [usize; 3] = std::array::from_fn(|a| {
                    let at = (place_m[a] - self.corner_m[a]) * self.per_m;
                    (at.max(0.0) as usize).min(self.size[a] - 1)
                });
                let [cols, rows, _] = self.size;
                let found = nearest[(at[2] * rows + at[1]) * cols + at[0]] as usize;
                // The border is no part of the voxels.
                let voxel = [found % cols, found / cols % rows, found / cols / rows];
                surfaces.distance_m(voxel.map(|at| at as i64 - 1), place_m, along)
            }
        }
    }

    /// Signed distance of a place from the nearest face, m, between the eight centres about it. Beyond the outermost centres it is the one
    /// there and how far beyond the place is.
    #[inline]
    fn between(&self, distances_m: &[f32], place_m: [f64; 3]) -> f64 {
        let (mut low, mut share, mut beyond2) = ([0; 3], [0.0; 3], 0.0);
        for a in 0..3 {
            let at = (place_m[a] - self.corner_m[a]) * self.per_m - 0.5;
            let inside = at.max(0.0).min((self.size[a] - 1) as f64);
            beyond2 += (at - inside) * (at - inside);
            low[a] = (inside as usize).min(self.size[a] - 2);
            share[a] = inside - low[a] as f64;
        }
        let strides = [1, self.size[0], self.size[0] * self.size[1]];
        let first = low[0] + low[1] * strides[1] + low[2] * strides[2];
        let at = |offset: usize| f64::from(distances_m[first + offset]);
        let along_x = |offset: usize| mix(at(offset), at(offset + 1), share[0]);
        let in_layer = |offset: usize| mix(along_x(offset), along_x(offset + strides[1]), share[1]);
        let distance_m = mix(in_layer(0), in_layer(strides[2]), share[2]);
        distance_m + distance_m.signum() * beyond2.sqrt() / self.per_m
    }
}

#[inline]
fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// For each voxel the squared distance to the nearest one that is solid, or that is not, in voxels squared; one axis after the other
/// (Felzenszwalb and Huttenlocher 2012).
fn squared_distances(solid: &[bool], size: [usize; 3], kind: bool) -> Vec<f64> {
    let mut squares = squares(solid, kind);
    let mut envelope = LowerEnvelope::new(size.into_iter().fold(0, usize::max));
    for (first, stride, count) in lines(size) {
        envelope.transform(&mut squares, first, stride, count);
    }
    squares
}

/// For each voxel the nearest one that is solid.
fn nearest(solid: &[bool], size: [usize; 3]) -> Vec<u32> {
    let mut squares = squares(solid, true);
    let mut nearest: Vec<u32> = (0..solid.len() as u32).collect();
    let longest = size.into_iter().fold(0, usize::max);
    let (mut envelope, mut line) = (LowerEnvelope::new(longest), vec![0; longest]);
    for (first, stride, count) in lines(size) {
        envelope.transform(&mut squares, first, stride, count);
        for (place, kept) in line[..count].iter_mut().enumerate() {
            *kept = nearest[first + place * stride];
        }
        for (place, &from) in envelope.nearest.iter().enumerate() {
            nearest[first + place * stride] = line[from];
        }
    }
    nearest
}

fn squares(solid: &[bool], kind: bool) -> Vec<f64> {
    let square = |&is: &bool| if is == kind { 0.0 } else { NONE };
    solid.iter().map(square).collect()
}

/// All lines of voxels along x, then those along y, then z: where each begins, how far its voxels are apart, and how many they are.
fn lines([cols, rows, layers]: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
    let along_x = (0..rows * layers).map(move |row| (row * cols, 1, cols));
    let along_y = (0..layers)
        .flat_map(move |layer| (0..cols).map(move |col| (layer * rows * cols + col, cols, rows)));
    let along_z = (0..cols * rows).map(move |column| (column, cols * rows, layers));
    along_x.chain(along_y).chain(along_z)
}

/// The lower envelope of parabolas along one line of voxels.
struct LowerEnvelope {
    line: Vec<f64>,
    /// Places of the parabolas.
    at: Vec<usize>,
    /// Place from which on each of the parabolas is the lowest.
    from: Vec<f64>,
    /// For each place whose parabola is the lowest there.
    nearest: Vec<usize>,
}

impl LowerEnvelope {
    fn new(longest: usize) -> Self {
        Self {
            line: vec![0.0; longest],
            at: Vec::with_capacity(longest),
            from: Vec::with_capacity(longest),
            nearest: Vec::with_capacity(longest),
        }
    }

    /// `d(p) = min_q (p - q)^2 + f(q)` in place along a line of voxels.
    fn transform(&mut self, squares: &mut [f64], first: usize, stride: usize, count: usize) {
        let Self {
            line,
            at,
            from,
            nearest: lowest_at,
        } = self;
        at.clear();
        from.clear();
        lowest_at.clear();
        for place in 0..count {
            let value = squares[first + place * stride];
            line[place] = value;
            if value >= NONE {
                continue;
            }
            let mut begin = f64::NEG_INFINITY;
            while let (Some(&last), Some(&last_from)) = (at.last(), from.last()) {
                begin = (value - line[last] + (place * place - last * last) as f64)
                    / (2 * (place - last)) as f64;
                if begin > last_from {
                    break;
                }
                let _ = (at.pop(), from.pop());
                begin = f64::NEG_INFINITY;
            }
            at.push(place);
            from.push(begin);
        }
        let mut lowest = 0;
        for place in 0..count {
            while lowest + 1 < at.len() && from[lowest + 1] < place as f64 {
                lowest += 1;
            }
            lowest_at.push(at.get(lowest).copied().unwrap_or(place));
            if let Some(&nearest) = at.get(lowest) {
                let off = place.abs_diff(nearest);
                squares[first + place * stride] = line[nearest] + (off * off) as f64;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const DOWN: [f64; 3] = [0.0, 0.0, -1.0];
    const SIDE_M: f64 = 0.1;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn distances_are_those_of_brute_force(
            corners in prop::collection::vec((prop::array::uniform3(-0.5..0.5f64), prop::array::uniform3(0.1..0.4f64)), 1..4),
        ) {
            let boxes: Vec<_> = corners.iter().map(|&(low, side)| [low, std::array::from_fn(|a| low[a] + side[a])]).collect();
            let voxels = SolidVoxels::of_boxes(&boxes, SIDE_M).unwrap();
            let [cols, rows, layers] = voxels.size();
            let all: Vec<[usize; 3]> = (0..layers).flat_map(|z| (0..rows).flat_map(move |y| (0..cols).map(move |x| [x, y, z]))).collect();
            for kind in [true, false] {
                let squares = squared_distances(&voxels.dense(), voxels.size, kind);
                for (&here, &square) in all.iter().zip(&squares) {
                    let nearest = all.iter().filter(|&&v| voxels.is_solid(v.map(|v| v as i64)) == kind)
                        .map(|v| (0..3).map(|a| v[a].abs_diff(here[a]).pow(2)).sum::<usize>() as f64)
                        .fold(NONE, f64::min);
                    prop_assert_eq!(square, nearest);
                }
            }
        }

        #[test]
        fn before_a_wall_the_distance_is_the_one_to_its_face(height in -0.15..0.5f64, x in -0.3..0.3f64) {
            // A floor, and a small thing far above it, so that the grid is high.
            let boxes = [[[-1.0, -1.0, -0.3], [1.0, 1.0, 0.0]], [[0.9, 0.9, 1.4], [1.0, 1.0, 1.5]]];
            let field = DistanceField::new(&SolidVoxels::of_boxes(&boxes, SIDE_M).unwrap()).unwrap();
            let found = field.distance_m([x, 0.0, height], DOWN);
            prop_assert!((found - height).abs() < 1e-6, "{found}");
        }
    }

    #[test]
    fn beyond_the_grid_the_way_to_it_counts() {
        let floor = [[-1.0, -1.0, -0.1], [1.0, 1.0, 0.0]];
        let post = [[-1.0, -1.0, 0.0], [-0.9, -0.9, 1.0]];
        let field =
            DistanceField::new(&SolidVoxels::of_boxes(&[floor, post], SIDE_M).unwrap()).unwrap();
        assert!((field.distance_m([0.95, 0.0, 1.55], DOWN) - 1.55).abs() < 1e-6);
        // Below the floor lies another side of it.
        assert!((field.distance_m([0.5, 0.5, -0.02], DOWN) + 0.02).abs() < 1e-6);
        assert!((field.distance_m([0.5, 0.5, -0.4], DOWN) - 0.3).abs() < 1e-6);
        assert!(field.distance_m([f64::NAN, 0.5, 0.5], DOWN).is_nan());
        let flat = DistanceField::new(&SolidVoxels::of_boxes(&[floor], SIDE_M).unwrap()).unwrap();
        assert!((flat.distance_m([0.0, 0.0, 1.0], DOWN) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_measured_floor_is_nearest_in_the_middle_of_its_voxels_and_has_no_inside() {
        let rule = super::super::InnerSurfaceRule {
            reach: 2,
            flatness: 0.25,
            glancing: 0.05,
            before: 0.0,
        };
        let floor = [[-1.0, -1.0, -0.1], [1.0, 1.0, 0.1]];
        let post = [[-1.0, -1.0, 0.0], [-0.9, -0.9, 1.0]];
        let voxels = Arc::new(SolidVoxels::of_boxes(&[floor, post], SIDE_M).unwrap());
        let field =
            DistanceField::measured(&voxels, &Arc::new(InnerSurfaces::new(&voxels, rule))).unwrap();
        for height_m in [-0.05_f64, 0.0, 0.05, 0.15, 0.4] {
            let found = field.distance_m([0.3, 0.3, height_m], DOWN);
            // The plane of each layer is drawn an eighth of a voxel to its own side.
            assert!(
                (found - height_m.abs()).abs() < 0.015,
                "{height_m}: {found}"
            );
        }
        // Beyond the edge of a surface the way to it counts.
        let beyond_m = field.distance_m([1.4, 0.0, 0.0], DOWN);
        assert!((0.25..0.55).contains(&beyond_m), "{beyond_m}");
    }
}
