//! Where in the voxels of a map that was measured its surfaces lie.
//!
//! A voxel is occupied where a range ended in it: the surface lies somewhere inside, not at the face by which a ray enters, and noise makes
//! the voxels before it and behind it occupied, too. So a ray that ends at the first face comes short, by a whole voxel in the mean and by
//! much more at a glancing angle. The surface is the plane through the middle of what is occupied about a voxel.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::SolidVoxels;

/// Steps of a voxel in which the middle of what lies about its centre is kept: two voxels to each side have room in a byte.
const MIDDLE_STEPS: f64 = 0.5 * i8::MAX as f64;
/// Steps in which the axes of a unit vector are kept.
const NORMAL_STEPS: f64 = i8::MAX as f64;

/// How surfaces are found in what is occupied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InnerSurfaceRule {
    /// The plane in a voxel is that of what is occupied within so many voxels.
    pub reach: usize,
    /// It is one where what is occupied is so much thinner than wide, as a share of the variance across the one along.
    pub flatness: f64,
    /// Sine of the angle below which a ray does not tell where it meets a plane.
    pub glancing: f64,
    /// By how much, as a share of a voxel, the surface lies before the middle of what is occupied, on the side from which it is seen: rays
    /// free what noise marks before it, and nothing frees what noise marks behind it.
    pub before: f64,
}

/// What is occupied about a voxel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct VoxelPatch {
    /// Its middle, from the voxel's centre.
    middle: [i8; 3],
    /// Normal of the plane that it lies in; zero where it is none.
    normal: [i8; 3],
}

/// The surfaces in solid voxels, six bytes for each.
#[derive(Debug, Clone)]
pub struct InnerSurfaces {
    solid: Arc<SolidVoxels>,
    rule: InnerSurfaceRule,
    /// For each block with solid voxels the first of its patches.
    first: Vec<u32>,
    patches: Vec<VoxelPatch>,
}

/// A surface where it passes a voxel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LocalSurface {
    /// A point of it, m.
    pub(super) middle_m: Vector3<f64>,
    /// Its normal, either way; zero where it is no plane.
    pub(super) normal: Vector3<f64>,
}

impl InnerSurfaces {
    /// The surfaces in these voxels.
    pub fn new(solid: &Arc<SolidVoxels>, rule: InnerSurfaceRule) -> Self {
        let about = about(rule.reach);
        let patches = solid.solid();
        let patches = patches.map(|voxel| patch(solid, voxel.map(|at| at as i64), &about, &rule));
        Self {
            patches: patches.collect(),
            first: solid.counts_before(),
            solid: Arc::clone(solid),
            rule,
        }
    }

    /// Where the patch of a voxel is kept, if it is solid.
    #[inline]
    fn index(&self, voxel: [i64; 3]) -> Option<usize> {
        let place = self.solid.number(voxel)?;
        Some((self.first[place.0] + self.solid.before(place)) as usize)
    }

    /// The surface that passes a voxel, where that is solid.
    pub(super) fn at(&self, voxel: [i64; 3]) -> Option<LocalSurface> {
        let VoxelPatch { middle, normal } = self.patches[self.index(voxel)?];
        let (low, side_m) = (self.solid.corner_m([0; 3]), self.solid.resolution_m);
        let middle_m = std::array::from_fn(|a| {
            let off = 0.5 + f64::from(middle[a]) / MIDDLE_STEPS;
            low[a] + (voxel[a] as f64 + off) * side_m
        });
        Some(LocalSurface {
            middle_m: Vector3::from(middle_m),
            normal: Vector3::from(normal.map(f64::from)) / NORMAL_STEPS,
        })
    }

    /// How far the surface lies before the middle of what is occupied, m.
    #[inline]
    fn before_m(&self) -> f64 {
        self.rule.before * self.solid.resolution_m
    }

    /// How far it is along a unit vector to the surface of a solid voxel, which a ray enters at `face_m`. No further than what is looked
    /// at about a voxel.
    #[inline]
    pub(super) fn along(
        &self,
        voxel: [i32; 3],
        origin_m: [f64; 3],
        direction: [f64; 3],
        face_m: f64,
    ) -> f64 {
        let Some(surface) = self.at(voxel.map(i64::from)) else {
            return face_m;
        };
        let (side_m, along) = (self.solid.resolution_m, Vector3::from(direction));
        let off_m = surface.middle_m - Vector3::from(origin_m);
        let steepness = surface.normal.dot(&along);
        let (reach_m, before_m) = (self.rule.reach as f64 * side_m, self.before_m());
        let found_m = if steepness.abs() > self.rule.glancing {
            let met_m = surface.normal.dot(&off_m) / steepness - before_m / steepness.abs();
            met_m.clamp(face_m - side_m, face_m + 2.0 * reach_m)
        } else {
            (along.dot(&off_m) - before_m).clamp(face_m, face_m + reach_m)
        };
        found_m.max(0.0)
    }

    /// Distance of a place from the surface of a solid voxel as it is seen along a unit vector, m: a plane reaches a voxel to each side.
    #[inline]
    pub(super) fn distance_m(&self, voxel: [i64; 3], at_m: [f64; 3], along: [f64; 3]) -> f64 {
        let Some(surface) = self.at(voxel) else {
            return f64::INFINITY;
        };
        let (off_m, along) = (Vector3::from(at_m) - surface.middle_m, Vector3::from(along));
        if surface.normal == Vector3::zeros() {
            return (off_m + along * self.before_m()).norm();
        }
        let middle_m = surface.normal.dot(&off_m);
        let beside_m = (off_m.norm_squared() - middle_m * middle_m).max(0.0).sqrt();
        let away_m = middle_m + self.before_m().copysign(surface.normal.dot(&along));
        geometry::hypot(away_m, (beside_m - self.solid.resolution_m).max(0.0))
    }

    /// Height of the surface of a solid voxel above the middle of its column, m; none where it is no plane, or upright.
    pub fn height_m(&self, voxel: [usize; 3]) -> Option<f64> {
        let surface = self.at(voxel.map(|at| at as i64))?;
        let low = self.solid.corner_m(voxel);
        let half_m = 0.5 * self.solid.resolution_m;
        let off_m = Vector3::new(low[0] + half_m, low[1] + half_m, 0.0) - surface.middle_m;
        let level = surface.normal.z.abs() > std::f64::consts::FRAC_1_SQRT_2;
        level.then(|| {
            let [x, y, z] = surface.normal.into();
            surface.middle_m.z - (x * off_m.x + y * off_m.y) / z
        })
    }
}

/// Voxels within a reach of one.
fn about(reach: usize) -> Vec<[i64; 3]> {
    let reach = reach as i64;
    let along = || -reach..=reach;
    let all = along().flat_map(|z| along().flat_map(move |y| along().map(move |x| [x, y, z])));
    // A ball: half a voxel is added to its radius, about.
    all.filter(|off| off.iter().map(|at| at * at).sum::<i64>() <= reach * (reach + 1) - reach / 2)
        .collect()
}

/// What is occupied about a solid voxel.
fn patch(
    solid: &SolidVoxels,
    voxel: [i64; 3],
    about: &[[i64; 3]],
    rule: &InnerSurfaceRule,
) -> VoxelPatch {
    let (mut count, mut sum, mut squares) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for off in about {
        if solid.is_solid(std::array::from_fn(|a| voxel[a] + off[a])) {
            let off = Vector3::from(off.map(|at| at as f64));
            count += 1.0;
            sum += off;
            squares += off * off.transpose();
        }
    }
    let middle = sum / count;
    let spread = (squares / count - middle * middle.transpose()).symmetric_eigen();
    let thinnest = spread.eigenvalues.imin();
    let mut variances: [f64; 3] = spread.eigenvalues.into();
    variances.sort_by(f64::total_cmp);
    let is_plane = variances[0] < rule.flatness * variances[1];
    let normal = if is_plane {
        spread.eigenvectors.column(thinnest).into_owned()
    } else {
        Vector3::zeros()
    };
    VoxelPatch {
        middle: middle.map(|at| (at * MIDDLE_STEPS).round() as i8).into(),
        normal: normal.map(|at| (at * NORMAL_STEPS).round() as i8).into(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::octree::{Octree, OctreeConfig};
    use super::super::RangeField;
    use super::*;
    use proptest::prelude::*;

    const RULE: InnerSurfaceRule = InnerSurfaceRule {
        reach: 2,
        flatness: 0.25,
        glancing: 0.05,
        before: 0.0,
    };

    /// The voxels in which points of a plane at `height_m`, tilted, lie: some a little off.
    fn floor(side_m: f64, height_m: f64, slope: f64, noise_m: f64) -> Arc<SolidVoxels> {
        let mut tree = Octree::new(OctreeConfig {
            resolution: side_m,
            ..OctreeConfig::default()
        })
        .unwrap();
        let points: Vec<_> = (0..40_000_u32)
            .map(|number| {
                let [x, y] = [number % 200, number / 200].map(|at| f64::from(at) * 0.01 - 1.0);
                let off = f64::from(number.wrapping_mul(2_654_435_761) >> 16) / 32_768.0 - 1.0;
                [x, y, height_m + slope * x + noise_m * off]
            })
            .collect();
        let _beyond = tree.occupy(&points).unwrap();
        Arc::new(SolidVoxels::occupied(&tree).unwrap())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn rays_meet_a_measured_floor_in_its_voxels_however_flat_they_come(
            side_m in 0.02..0.08f64, height_m in -0.1..0.1f64, slope in -0.3..0.3f64, fall in 0.12..1.5f64, turn in -3.0..3.0f64, blocks in any::<bool>(),
        ) {
            let solid = floor(side_m, height_m, slope, 0.3 * side_m);
            let surfaces = Arc::new(InnerSurfaces::new(&solid, RULE));
            let field = RangeField { surfaces: Some(surfaces), ..RangeField::with_cells(&solid, blocks) };
            let fall = if slope.abs() > 0.02 { fall.max(0.5) } else { fall };
            let along = [libm::cos(turn) * libm::cos(fall), libm::sin(turn) * libm::cos(fall), -libm::sin(fall)];
            let begin = std::array::from_fn(|a| -0.4 * along[a] + if a == 2 { height_m } else { 0.0 });
            let found_m = field.cast(begin, along, 5.0).unwrap();
            let rise = along[2] - slope * along[0];
            let off_m = (found_m - 0.4) * rise;
            // Half a voxel is all that its voxels say of a level plane.
            prop_assert!(off_m.abs() < 0.75 * side_m, "{off_m}");
        }
    }

    #[test]
    fn on_the_mean_a_surface_is_met_where_it_is_and_not_where_its_voxels_begin() {
        let (mut by_face, mut by_surface, mut count) = (0.0, 0.0, 0.0);
        for step in 0..40 {
            let height_m = f64::from(step) * 0.001;
            let solid = floor(0.04, height_m, 0.0, 0.0);
            let faces = RangeField::new(&solid);
            let measured =
                RangeField::measured(&solid, &Arc::new(InnerSurfaces::new(&solid, RULE)));
            let [begin, along] = [[0.1, 0.1, 1.0], [0.6, 0.0, -0.8]];
            let truth_m = (1.0 - height_m) / 0.8;
            by_face += faces.cast(begin, along, 5.0).unwrap() - truth_m;
            by_surface += measured.cast(begin, along, 5.0).unwrap() - truth_m;
            count += 1.0;
        }
        assert!(by_face / count < -0.02, "{}", by_face / count);
        assert!((by_surface / count).abs() < 0.002, "{}", by_surface / count);
    }

    #[test]
    fn a_pole_is_met_about_its_middle() {
        let pole = [[0.0, 0.0, 0.0], [0.04, 0.04, 1.0]];
        let solid = Arc::new(SolidVoxels::of_boxes(&[pole], 0.04).unwrap());
        let field = RangeField::measured(&solid, &Arc::new(InnerSurfaces::new(&solid, RULE)));
        let found_m = field
            .cast([-1.0, 0.025, 0.5], [1.0, 0.0, 0.0], 5.0)
            .unwrap();
        assert!((found_m - 1.02).abs() < 0.005, "{found_m}");
    }
}
