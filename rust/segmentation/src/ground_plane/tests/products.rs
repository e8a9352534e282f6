//! Whatever is seen, the product is whole.

use super::*;

#[test]
fn records_are_whole_planes_have_unit_normals_and_outlines_hold_their_points() {
    let mut noise = Noise::new(9);
    let truth = camera_pose(0.2, 0.75);
    let scene = Scene::stairs(0.3, 0.03, 0.12, 3);
    let planes = look(&mut tracking(&mut noise), &scene, &truth, &mut noise);
    let camera = planes.robot_from_camera.inner;
    assert!(planes.regions.len() > 2);
    for (i, region) in planes.regions.iter().enumerate() {
        assert!((region.plane.normal.norm() - 1.0).abs() < 1e-9);
        assert!(
            (region.plane.normal.dot(&region.mean.inner.coords) - region.plane.distance_m).abs()
                < 1e-4
        );
        let pixels: Vec<_> = (0..planes.labels.len())
            .filter(|&at| usize::from(planes.labels[at]) == i + 1)
            .collect();
        assert_eq!(region.support, pixels.len());
        let (Some(outline), Some(height_m)) = (&region.boundary, region.floor_height_m) else {
            continue;
        };
        for at in pixels {
            let ray =
                camera.rotation * Vector3::from(CAMERA.ray(at % CAMERA.width, at / CAMERA.width));
            let depth = (height_m - camera.translation.z) / ray.z;
            let point = camera.translation.vector + ray * depth;
            let outside = outline
                .edges()
                .map(|(a, b)| -(b - a).normalize().perp(&(point.xy() - a.coords)))
                .fold(f64::MIN, f64::max);
            assert!(outside < 1e-4, "{outside}");
            assert_eq!(planes.floor_height_m[at], height_m as f32);
        }
    }
}

#[test]
fn a_ground_that_is_named_from_one_picture_has_all_the_pieces_that_a_wall_across_it_leaves() {
    let mut noise = Noise::new(3);
    let truth = camera_pose(0.0, 0.75);
    // From side to side, so low that the floor behind it shows.
    let wall = Block {
        low_m: [0.45, -1.0, 0.0],
        high_m: [0.47, 1.0, 0.06],
    };
    let planes = look(&mut segmenter(), &Scene::with(&[wall]), &truth, &mut noise);
    let ground = planes.ground.unwrap();
    let is_ground = |at: &usize| usize::from(planes.labels[*at]) == ground + 1;
    let pixels: Vec<usize> = (0..planes.labels.len()).filter(is_ground).collect();
    assert_eq!(planes.regions[ground].support, pixels.len());
    let x_m = |at: &usize| planes.points_in_robot_m[*at][0];
    assert!(pixels.iter().filter(|at| x_m(at) < 0.42).count() > 300);
    assert!(pixels.iter().filter(|at| x_m(at) > 0.65).count() > 300);
}

#[test]
fn nothing_seen_is_an_ordinary_product() {
    for value in [f32::NAN, 0.0, 3.0, 24.0, f32::INFINITY, -5.0] {
        let mut segmenter = segmenter();
        let mut planes = planes();
        let mut scan = Scan::new(CAMERA);
        scan.robot_from_camera = camera_pose(0.0, 0.75);
        scan.disparity_px.fill(value);
        segmenter.segment(&scan, &mut planes).unwrap();
        assert_eq!(planes.ground, None, "{value}");
        assert!(!planes.reliable, "{value}");
        let camera = planes.robot_from_camera.inner;
        assert!(camera.translation.vector.iter().all(|x| x.is_finite()));
    }
}

#[test]
fn a_scan_of_another_size_is_refused_and_changes_nothing() {
    let mut scan = Scan::new(CAMERA);
    let _ = scan.disparity_px.pop();
    let error = segmenter().segment(&scan, &mut planes()).unwrap_err();
    let (expected, found) = (88 * 72, 88 * 72 - 1);
    assert_eq!(error, SegmentError::WrongSize { expected, found });
}

#[test]
fn the_same_frames_give_the_same_products() {
    let run = || {
        let mut noise = Noise::new(12);
        let mut segmenter = tracking(&mut noise);
        let scene = Scene::stairs(0.3, 0.03, 0.12, 4);
        let truth = camera_pose(0.1, 0.75);
        let planes = look(&mut segmenter, &scene, &truth, &mut noise);
        (planes.regions, planes.labels, planes.robot_from_camera)
    };
    assert_eq!(run(), run());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn every_product_is_consistent_whatever_stands_around(
        blocks in blocks(),
        pan in -0.6..0.6f64, tilt in 0.2..1.0f64, seed in 0..1000u64,
    ) {
        let mut noise = Noise::new(seed);
        let truth = camera_pose(pan, tilt);
        let planes = look(&mut tracking(&mut noise), &Scene::with(&blocks), &truth, &mut noise);
        let (_, labels) = Scene::with(&blocks).exact(&truth);
        for (at, &label) in planes.labels.iter().enumerate() {
            let point = planes.points_in_robot_m[at];
            prop_assert!(usize::from(label) <= planes.regions.len());
            if label > 0 {
                let region = &planes.regions[usize::from(label) - 1];
                let height = planes.floor_height_m[at];
                prop_assert_eq!(region.floor_height_m.map(|h| h as f32), (!height.is_nan()).then_some(height));
                prop_assert!(!point[0].is_nan());
            } else {
                prop_assert!(planes.floor_height_m[at].is_nan());
            }
            if point[0].is_nan() {
                prop_assert_eq!(label, 0);
            }
        }
        if let Some(ground) = planes.ground {
            prop_assert_eq!(planes.regions[ground].floor_height_m, Some(0.0));
            prop_assert!(true_label(&planes, &labels, ground) != NOTHING);
            prop_assert!(pose_error(&planes, &truth).1.abs() < 0.02);
        }
    }
}
