//! Where rays end in a map that noisy ranges made: on the mean where the surface is.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use std::sync::Arc;

use testkit::synthetic::Noise;
use volume::{
    DistanceField, InnerSurfaceRule, InnerSurfaces, RangeField, Ray, SolidVoxels, Update,
    octree::{Octree, OctreeConfig},
};

const SIDE_M: f64 = 0.04;
const WALLS: u32 = 24;

/// A wall across the view, mapped from 2 m before it in 30 frames.
fn mapped(wall_x_m: f64, sigma_m: f64, noise: &mut Noise) -> Arc<SolidVoxels> {
    let mut tree = Octree::new(OctreeConfig {
        resolution: SIDE_M,
        ..OctreeConfig::default()
    })
    .unwrap();
    for frame in 0..30 {
        let eye_m = [wall_x_m - 2.0, 0.01 * f64::from(frame), 0.0];
        let rays: Vec<Ray> = (-12..=12)
            .flat_map(|across| (-12..=12).map(move |up| [across, up]))
            .map(|[across, up]| {
                let along = [1.0, 0.03 * f64::from(across), 0.03 * f64::from(up)];
                let depth_m = 2.0 + sigma_m * noise.normal();
                let end_m = std::array::from_fn(|axis| eye_m[axis] + depth_m * along[axis]);
                Ray { end_m, hit: true }
            })
            .collect();
        let _beyond = tree.insert(eye_m, &rays, Update::PerFrame).unwrap();
    }
    Arc::new(SolidVoxels::occupied(&tree).unwrap())
}

/// How far behind walls rays end on the mean, m, and where beams that end `off_m` behind a wall are nearest to it.
fn behind_m(before: f64, sigma_m: f64) -> [f64; 2] {
    let rule = InnerSurfaceRule {
        reach: 2,
        flatness: 0.25,
        glancing: 0.05,
        before,
    };
    let mut noise = Noise::new(7);
    let (mut by_ray, mut by_field) = (0.0, 0.0);
    for wall in 0..WALLS {
        let wall_x_m = 1.0 + SIDE_M * f64::from(wall) / f64::from(WALLS);
        let solid = mapped(wall_x_m, sigma_m, &mut noise);
        let surfaces = Arc::new(InnerSurfaces::new(&solid, rule));
        let (eye_m, along) = ([wall_x_m - 1.5, 0.1, 0.05], [1.0, 0.0, 0.0]);
        let field = RangeField::measured(&solid, &surfaces);
        by_ray += field.cast(eye_m, along, 4.0).unwrap() - 1.5;
        let field = DistanceField::measured(&solid, &surfaces).unwrap();
        let off_m = |step: i32| 0.001 * f64::from(step);
        let nearest = (-40..=40).min_by(|&a, &b| {
            let away = |step: i32| field.distance_m([wall_x_m + off_m(step), 0.1, 0.05], along);
            away(a).total_cmp(&away(b))
        });
        by_field += nearest.map_or(f64::NAN, off_m);
    }
    [by_ray, by_field].map(|sum| sum / f64::from(WALLS))
}

#[test]
fn noise_marks_what_is_behind_a_wall_and_surfaces_are_found_before_the_middle_of_what_it_marks() {
    for sigma_m in [0.25 * SIDE_M, 0.5 * SIDE_M] {
        let middle_m = behind_m(0.0, sigma_m);
        let before_m = behind_m(0.1, sigma_m);
        for (middle_m, before_m) in middle_m.into_iter().zip(before_m) {
            assert!(middle_m > 0.05 * SIDE_M, "{middle_m}");
            assert!(before_m.abs() < 0.8 * middle_m, "{middle_m} {before_m}");
        }
    }
}
