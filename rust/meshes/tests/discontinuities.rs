//! Surfaces that are not one are not joined, and what is one has no holes (004, section 36.3.3; H42).

mod common;

use common::{CAMERA, NOISE, Scene, SplitMix64, rule, standing};
use meshes::{
    JoiningConfig, JoiningRule, SeenFrom, SeenMesh, Topology, mesh_of_cloud, mesh_of_picture,
};
use nalgebra::Isometry3;
use sensing::RangeNoise;

/// Triangles whose corners were not all seen of one thing.
fn bridging(seen: &SeenMesh, of: &[usize]) -> usize {
    let what = |corner: u32| of[seen.points[corner as usize] as usize];
    let triangles = seen.mesh.triangles.iter();
    triangles
        .filter(|[a, b, c]| what(*a) != what(*b) || what(*a) != what(*c))
        .count()
}

/// Views of a table from near and from further away, across its front edge and its sides.
fn views(height_m: f64) -> Vec<Isometry3<f64>> {
    let mut views = Vec::new();
    for x in [-0.5, 0.0, 0.2] {
        for pan in [-0.3, 0.0, 0.4] {
            let pitch = libm::atan2(0.95 - height_m, 0.7 - x);
            views.push(standing([x, 0.0, 0.95], pitch, pan));
        }
    }
    views
}

#[test]
fn no_triangle_joins_the_edge_of_a_table_and_the_floor() {
    let exact = RangeNoise {
        sigma_m: 0.0,
        per_metre: 0.0,
    };
    for (noise, heights) in [(NOISE, [0.3, 0.45, 0.6]), (exact, [0.1, 0.2, 0.4])] {
        for height_m in heights {
            for (seed, view) in views(height_m).iter().enumerate() {
                let mut luck = SplitMix64::new(seed as u64);
                let scene = Scene::table(height_m);
                let (points, of) = scene.look(CAMERA, view, noise, &mut luck);
                let tables = of.iter().filter(|&&what| what == 1).count();
                assert!(tables > 500, "{tables}");
                let camera = Isometry3::identity();
                let picture = mesh_of_picture(&points, CAMERA.size_px[0], &camera, &rule(noise));
                let cloud = mesh_of_cloud(&points, SeenFrom::Eye([0.0; 3]), &rule(noise)).unwrap();
                for (kind, seen) in [("picture", picture), ("cloud", cloud)] {
                    let told = format!("{kind}, table of {height_m} m, view {seed}");
                    assert_eq!(bridging(&seen, &of), 0, "{told}");
                    assert!(Topology::of(&seen.mesh).is_manifold(), "{told}");
                }
            }
        }
    }
}

#[test]
fn a_surface_of_its_own_has_hardly_a_hole_however_it_is_seen() {
    for pitch in [0.9, 0.5, 0.25] {
        let view = standing([0.0, 0.0, 0.5], pitch, 0.0);
        let mut luck = SplitMix64::new(7);
        let (points, of) = Scene::default().look(CAMERA, &view, NOISE, &mut luck);
        let camera = Isometry3::identity();
        let seen = mesh_of_picture(&points, CAMERA.size_px[0], &camera, &rule(NOISE));
        let [width, height] = CAMERA.size_px;
        let whole = (1..height).flat_map(|row| (1..width).map(move |col| row * width + col));
        let all = [0, 1, width, width + 1];
        let full = whole
            .filter(|at| all.iter().all(|back| of[at - back] == 0))
            .count();
        let share = seen.mesh.triangles.len() as f64 / (2 * full) as f64;
        assert!(share > 0.97, "{share} at a pitch of {pitch}");
    }
}

#[test]
fn a_height_field_from_the_air_is_whole_but_at_its_walls() {
    let mut luck = SplitMix64::new(3);
    let mut points = Vec::new();
    for _ in 0..6000 {
        let [x, y] = [luck.uniform(), luck.uniform()].map(|share| 40.0 * share);
        let roof = (10.0..20.0).contains(&x) && (10.0..25.0).contains(&y);
        let ground = 0.1 * x;
        let z = if roof { 9.0 } else { ground } + 0.02 * common::normal(&mut luck);
        points.push([x as f32, y as f32, z as f32]);
    }
    let noise = RangeNoise {
        sigma_m: 0.02,
        per_metre: 0.0,
    };
    // Ground is no steeper than 60 degrees here.
    let config = JoiningConfig {
        grazing: 0.52,
        gap: 5.0,
        ..JoiningConfig::default()
    };
    let rule = JoiningRule::new(&config, noise);
    let seen = mesh_of_cloud(&points, SeenFrom::Above(500.0), &rule).unwrap();
    assert!(Topology::of(&seen.mesh).is_manifold());
    let of: Vec<_> = points.iter().map(|at| usize::from(at[2] > 7.0)).collect();
    assert_eq!(bridging(&seen, &of), 0);
    let triangles = seen.mesh.triangles.iter();
    let covered: f64 = triangles.map(|&one| seen.mesh.area_vector_m2(one).z).sum();
    assert!(covered > 0.93 * 1600.0 && covered < 1600.0, "{covered}");
}

#[test]
fn clouds_of_nothing_and_of_copies_give_no_triangle() {
    for points in [vec![], vec![[f32::NAN; 3]; 5], vec![[1.0, 2.0, 3.0]; 9]] {
        for from in [SeenFrom::Above(10.0), SeenFrom::Eye([0.0; 3])] {
            let seen = mesh_of_cloud(&points, from, &rule(NOISE)).unwrap();
            assert!(seen.mesh.triangles.is_empty() && seen.points.is_empty());
        }
    }
}
