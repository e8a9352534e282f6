//! Stairs, walls and boxes are told apart; thresholds follow the noise.

use super::*;

#[test]
fn stairs_of_thirty_millimetres_are_told_apart() {
    let mut noise = Noise::new(4);
    let (mut visible, mut correct, mut under) = (0, 0, 0);
    for front_m in [0.2, 0.25, 0.3, 0.35, 0.4] {
        for _ in 0..4 {
            let truth = camera_pose(0.0, 0.8);
            let scene = Scene::stairs(front_m, 0.03, 0.12, 4);
            let mut segmenter = tracking(&mut noise);
            let planes = look(&mut segmenter, &scene, &truth, &mut noise);
            let (_, labels) = scene.exact(&truth);
            let seen = |at: &usize| !planes.points_in_robot_m[*at][0].is_nan();
            let shared = |i: usize, surface: u16| {
                (0..labels.len())
                    .filter(|&at| labels[at] == surface && usize::from(planes.labels[at]) == i + 1)
                    .count()
            };
            // Risers of four rows lie within one matching window of both treads: they may go to either.
            let treads_of = |i: usize| (GROUND..10).step_by(2).map(|s| shared(i, s)).sum::<usize>();
            for surface in (GROUND..10).step_by(2) {
                let pixels: Vec<_> = (0..labels.len())
                    .filter(|&at| labels[at] == surface)
                    .filter(seen)
                    .collect();
                if pixels.len() > 100 {
                    visible += 1;
                    let hit = (0..planes.regions.len()).any(|i| {
                        let (both, all) = (shared(i, surface), treads_of(i));
                        5 * both >= 4 * pixels.len() && 5 * both >= 4 * all
                    });
                    correct += usize::from(hit);
                }
            }
            // A region that holds a good part of two surfaces' pixels was not cut where it should have been.
            for i in 0..planes.regions.len() {
                let parts = (GROUND..10)
                    .step_by(2)
                    .filter(|&surface| 5 * shared(i, surface) > treads_of(i))
                    .count();
                under += usize::from(parts > 1);
            }
        }
    }
    assert_eq!(under, 0);
    assert!(visible > 60);
    assert!(10 * correct >= 9 * visible, "{correct} of {visible}");
}

#[test]
fn one_level_is_one_surface_however_the_camera_leans() {
    let mut noise = Noise::new(17);
    let mut several = 0;
    for _ in 0..60 {
        let truth = camera_pose(noise.within(0.6), 0.8 + noise.within(0.2));
        let lean = Vector3::new(noise.within(0.02), noise.within(0.02), 0.0);
        let mut planes = planes();
        let believed = turned(&truth, &lean, 0.0);
        let scan = Scene::floor().scan(&truth, believed, SIGMA, &mut noise);
        tracking(&mut noise).segment(&scan, &mut planes).unwrap();
        several += usize::from(planes.regions.len() > 1);
    }
    assert!(several <= 1, "{several}");
}

#[test]
fn a_wall_is_no_floor() {
    let mut noise = Noise::new(6);
    let (mut seen, mut called_floor) = (0, 0);
    for at_m in [0.4, 0.5, 0.6, 0.8] {
        for pan in [-0.5, 0.0, 0.3] {
            let truth = camera_pose(pan, 0.7);
            let scene = Scene::with(&[wall(at_m)]);
            let planes = look(&mut tracking(&mut noise), &scene, &truth, &mut noise);
            for (at, point) in planes.points_in_robot_m.iter().enumerate() {
                // Close to the floor a wall cannot be told from it.
                if point[2] > 0.05 && point[0] > at_m as f32 - 0.05 {
                    seen += 1;
                    called_floor += usize::from(!planes.floor_height_m[at].is_nan());
                }
            }
        }
    }
    assert!(seen > 5000);
    assert!(
        f64::from(called_floor as u32) < 0.02 * f64::from(seen),
        "{called_floor} of {seen}"
    );
}

#[test]
fn a_wall_is_described_by_its_normal() {
    let mut noise = Noise::new(7);
    let truth = camera_pose(0.0, 0.6);
    let scene = Scene::with(&[wall(0.5)]);
    let planes = look(&mut tracking(&mut noise), &scene, &truth, &mut noise);
    let largest = planes
        .regions
        .iter()
        .filter(|region| region.floor_height_m.is_none())
        .max_by_key(|region| region.support)
        .unwrap();
    assert!(largest.support > 1000);
    assert!(largest.plane.normal.x < -0.995);
    assert!((largest.plane.distance_m + 0.5).abs() < 0.01);
    assert_eq!(largest.boundary, None);
}

#[test]
fn the_top_of_a_low_box_is_a_floor_of_its_own_height() {
    let mut noise = Noise::new(8);
    let truth = camera_pose(0.0, 0.75);
    let low = Block {
        low_m: [0.45, -0.15, 0.0],
        high_m: [0.65, 0.15, 0.06],
    };
    let mut errors = vec![];
    for _ in 0..20 {
        let planes = look(
            &mut tracking(&mut noise),
            &Scene::with(&[low]),
            &truth,
            &mut noise,
        );
        let (_, labels) = Scene::with(&[low]).exact(&truth);
        let top = (0..planes.regions.len())
            .find(|&i| true_label(&planes, &labels, i) == GROUND + 2)
            .unwrap();
        assert_ne!(planes.ground, Some(top));
        errors.push(planes.regions[top].floor_height_m.unwrap() - 0.06);
    }
    let bias = errors.iter().sum::<f64>() / 20.0;
    assert!(bias.abs() < 0.002, "{bias}");
    assert!(errors.iter().all(|error| error.abs() < 0.01), "{errors:?}");
}

#[test]
fn thresholds_follow_the_noise() {
    let share = |noise_ceiling: f64| {
        let mut noise = Noise::new(11);
        let config = GroundConfig {
            noise_ceiling,
            ..GroundConfig::default()
        };
        let mut share = 0.0;
        for _ in 0..5 {
            let pose = camera_pose(0.0, 0.75);
            let scan = Scene::floor().scan(&pose, pose, 3.0 * SIGMA, &mut noise);
            let mut planes = planes();
            let mut segmenter =
                ScanLine::new(&ScanLineConfig::default(), config.clone(), CAMERA).unwrap();
            segmenter.segment(&scan, &mut planes).unwrap();
            let largest = planes.regions.iter().map(|region| region.support).max();
            share += largest.unwrap_or(0) as f64 / scan.valid as f64 / 5.0;
        }
        share
    };
    let (adaptive, fixed) = (share(4.0), share(1.0));
    assert!(adaptive > 0.8, "{adaptive}");
    assert!(fixed < 0.6, "{fixed}");
}
