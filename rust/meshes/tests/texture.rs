//! What pictures show on a mesh is where it is (004, Fig. 36.15; H43).

mod common;

use common::fused::{fused, views};
use common::{CAMERA, NOISE, Scene, SplitMix64, ray, rule, standing};
use meshes::{TextureView, TexturedMesh, textured};
use nalgebra::{Isometry3, Vector3};

fn view(scene: &Scene, at: &Isometry3<f64>, luck: &mut SplitMix64) -> TextureView {
    let (points, _) = scene.look(CAMERA, at, NOISE, luck);
    TextureView {
        camera: CAMERA,
        map_from_camera: *at,
        ranges_m: points.iter().map(|at| Vector3::from(*at).norm()).collect(),
    }
}

/// Of points on the mesh how far, in pixels of a camera that stands like this, what the texture shows there is from where it truly is.
fn errors_px(
    found: &TexturedMesh,
    views: &[TextureView],
    (scene, other): (&Scene, &TextureView),
    luck: &mut SplitMix64,
) -> Vec<f64> {
    let mut errors = Vec::new();
    for &triangle in &found.mesh.triangles {
        let Some(number) = found.views[triangle[0] as usize] else {
            continue;
        };
        let (u, v) = (luck.uniform(), luck.uniform());
        let (u, v) = if u + v > 1.0 {
            (1.0 - u, 1.0 - v)
        } else {
            (u, v)
        };
        let [a, b, c] = found.mesh.places_m(triangle);
        let on_mesh = a + (b - a) * u + (c - a) * v;
        let [a, b, c] = triangle.map(|corner| found.at_px[corner as usize].map(f64::from));
        let px = [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * u + (c[axis] - a[axis]) * v);
        let shown = &views[number as usize];
        let eye = shown.map_from_camera.translation.vector;
        let along = shown.map_from_camera.rotation * ray(CAMERA, px);
        let Some((t, _)) = scene.meet(eye, along) else {
            continue;
        };
        let truth = eye + along * t;
        // Where the other camera sees that place, and nothing before it.
        let Some((there, range_m)) = other.project(truth) else {
            continue;
        };
        let other_eye = other.map_from_camera.translation.vector;
        let sight = (truth - other_eye) / range_m;
        let free = scene
            .meet(other_eye, sight)
            .is_some_and(|(t, _)| (t - range_m).abs() < 1e-6);
        let [width, height] = CAMERA.size_px.map(|px| px as f64);
        let inside = there[0] > 0.0 && there[1] > 0.0 && there[0] < width && there[1] < height;
        if let (true, true, Some((here, _))) = (free, inside, other.project(on_mesh)) {
            errors.push(libm::hypot(here[0] - there[0], here[1] - there[1]));
        }
    }
    errors
}

#[test]
fn what_the_texture_shows_is_within_two_pixels_of_where_it_is() {
    for seed in 0..2 {
        let scene = Scene::boxes();
        let mut luck = SplitMix64::new(seed);
        let mesh = fused(&scene, seed);
        let views: Vec<_> = views()
            .iter()
            .map(|at| view(&scene, at, &mut luck))
            .collect();
        let found = textured(&mesh, &views, &rule(NOISE));
        assert_eq!(found.mesh.triangles.len(), mesh.triangles.len());
        let shown = found.views.iter().flatten().count() as f64 / found.views.len() as f64;
        // From places where no picture was taken.
        for at in [
            standing([-0.1, 0.3, 0.7], 0.6, -0.3),
            standing([0.2, -0.3, 0.5], 0.5, 0.2),
        ] {
            let other = view(&scene, &at, &mut luck);
            let mut errors = errors_px(&found, &views, (&scene, &other), &mut luck);
            errors.sort_unstable_by(f64::total_cmp);
            let quantile = |share: f64| errors[(share * errors.len() as f64) as usize];
            assert!(errors.len() > 10_000);
            // The camera has half of the pixels of 002's: two of them would be four.
            assert!(quantile(0.99) <= 1.0, "{} px", quantile(0.99));
        }
        assert!(shown > 0.9, "{shown}");
    }
}
