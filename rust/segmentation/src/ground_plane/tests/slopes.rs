//! A slope is one surface with its own plane; stairs are none.

use super::*;

/// Steps so low that nothing tells them from a slope, m.
const FINE_M: f64 = 0.001;

/// A slope of 0.7 m from `front_m` on.
fn slope(front_m: f64, tilt_rad: f64) -> Scene {
    let depth_m = FINE_M / libm::tan(tilt_rad);
    let block = |i: i32| {
        let near = front_m + f64::from(i) * depth_m;
        Block {
            low_m: [near, -0.6, -0.1],
            high_m: [near + depth_m, 0.6, (f64::from(i) + 0.5) * FINE_M],
        }
    };
    let count = (0.7 / depth_m) as i32;
    Scene::with(&(0..count).map(block).collect::<Vec<_>>())
}

fn sloping(slopes: bool, noise: &mut Noise) -> ScanLine {
    let config = GroundConfig {
        slopes,
        ..GroundConfig::default()
    };
    let mut segmenter = ScanLine::new(&ScanLineConfig::default(), config, CAMERA).unwrap();
    let pose = camera_pose(0.0, 0.75);
    for _ in 0..10 {
        let scan = Scene::floor().scan(&pose, pose, SIGMA, noise);
        segmenter.segment(&scan, &mut planes()).unwrap();
    }
    segmenter
}

/// The tilt of the largest region that is no level surface and yet floor, rad, and its pixels.
fn found(planes: &Planes) -> Option<(f64, usize)> {
    let labels = planes.labels.iter().zip(&planes.floor_height_m);
    let mut floor = vec![0; planes.regions.len() + 1];
    labels
        .filter(|(_, height_m)| !height_m.is_nan())
        .for_each(|(&label, _)| floor[usize::from(label)] += 1);
    let regions = planes.regions.iter().zip(&floor[1..]);
    regions
        .filter(|(region, count)| region.floor_height_m.is_none() && **count > 0)
        .map(|(region, &count)| (libm::acos(region.plane.normal.z), count))
        .max_by_key(|&(_, count)| count)
}

#[test]
fn without_the_setting_a_slope_falls_into_level_surfaces() {
    let mut noise = Noise::new(1);
    let mut segmenter = sloping(false, &mut noise);
    for _ in 0..6 {
        let pose = camera_pose(0.0, 0.7);
        let planes = look(&mut segmenter, &slope(0.5, 0.12), &pose, &mut noise);
        assert_eq!(found(&planes), None);
    }
}

#[test]
fn where_a_slope_was_seen_just_now_level_strips_of_it_are_left_out_of_maps() {
    let mut noise = Noise::new(2);
    let mut segmenter = sloping(true, &mut noise);
    let pose = camera_pose(0.0, 0.7);
    for _ in 0..8 {
        let planes = look(&mut segmenter, &slope(0.5, 0.14), &pose, &mut noise);
        assert!(planes.ground.is_some());
    }
    // A low step in its place, which no plane explains.
    let step = Scene::stairs(0.8, 0.04, 1.0, 1);
    let planes = look(&mut segmenter, &step, &pose, &mut noise);
    assert_eq!(found(&planes), None);
    let raised = planes.floor_height_m.iter().zip(&planes.at_step);
    let mut raised = raised.filter(|(height_m, _)| **height_m > 0.03).peekable();
    assert!(raised.peek().is_some());
    assert!(raised.all(|(_, &left_out)| left_out));
}

/// 0.12 rad of a slope that fills the picture for 8 s, longer than the ground may be out of view.
#[test]
fn a_robot_that_sees_nothing_but_the_slope_that_it_knows_does_not_take_it_for_the_ground() {
    let (front_m, tilt_rad) = (0.1, 0.12);
    let mut noise = Noise::new(3);
    let mut segmenter = sloping(true, &mut noise);
    let scene = slope(front_m, tilt_rad);
    let known = |x_m: f64, _: f64| Some((x_m - front_m) * libm::tan(tilt_rad));
    let (mut planes, mut tilts) = (planes(), Vec::new());
    for _ in 0..100 {
        let pose = camera_pose(noise.within(0.1), 0.95 + noise.within(0.05));
        let scan = scene.scan(&pose, pose, SIGMA, &mut noise);
        segmenter.segment_known(&scan, &known, &mut planes).unwrap();
        tilts.extend(found(&planes).map(|(tilt, _)| (tilt - tilt_rad).abs()));
    }
    assert!(planes.reliable && planes.ground.is_none());
    assert!(tilts.len() >= 90, "{}", tilts.len());
    let off_rad = median(tilts);
    assert!(off_rad < 0.018, "{off_rad}");
}

/// Height of the floor in the robot's frame, m, as seen by a robot 10 mm above it, and whether it is named the ground.
fn floor_below(on_slope: bool) -> (f64, bool) {
    let mut noise = Noise::new(4);
    let mut segmenter = sloping(true, &mut noise);
    let pose = camera_pose(0.0, 0.75);
    let above_floor = turned(&pose, &Vector3::zeros(), 0.01);
    let mut planes = planes();
    for _ in 0..20 {
        let mut scan = Scene::floor().scan(&above_floor, pose, SIGMA, &mut noise);
        scan.on_slope = on_slope;
        segmenter.segment(&scan, &mut planes).unwrap();
    }
    let heights_m = planes
        .floor_height_m
        .iter()
        .filter(|height_m| !height_m.is_nan());
    let height_m = median(heights_m.map(|&height_m| f64::from(height_m)).collect());
    (height_m, planes.ground.is_some())
}

#[test]
fn the_floor_at_the_foot_of_a_slope_is_no_ground_of_a_robot_on_it() {
    let (height_m, is_ground) = floor_below(true);
    assert!(!is_ground);
    assert!((height_m + 0.01).abs() < 0.003, "{height_m}");
    assert_eq!(floor_below(false), (0.0, true));
}

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    #[test]
    fn a_slope_is_one_surface_with_its_tilt_and_its_height_at_each_pixel() {
        for degrees in [5.0_f64, 7.0, 9.5, 15.0] {
            let tilt_rad = degrees.to_radians();
            let (mut tilts, mut errors_m, mut seen) = (Vec::new(), Vec::new(), 0);
            for seed in 0..4 {
                let mut noise = Noise::new(seed);
                let mut segmenter = sloping(true, &mut noise);
                let scene = slope(0.5, tilt_rad);
                for frame in 0..12 {
                    let pose = camera_pose(noise.within(0.1), 0.7 + noise.within(0.05));
                    let planes = look(&mut segmenter, &scene, &pose, &mut noise);
                    let (_, truth) = scene.exact(&pose);
                    let slope = found(&planes).filter(|_| frame >= 4);
                    let Some((tilt, _)) = slope else { continue };
                    seen += 1;
                    tilts.push((tilt - tilt_rad).abs());
                    for (at, &height_m) in planes.floor_height_m.iter().enumerate() {
                        // Tops of the fine steps: where the ray meets them is the true height.
                        if truth[at] > GROUND && !height_m.is_nan() {
                            let true_m = f64::from((truth[at] - GROUND) / 2) * FINE_M;
                            errors_m.push((f64::from(height_m) - true_m).abs());
                        }
                    }
                }
            }
            assert!(seen >= 24, "{degrees}: {seen} of 32 frames");
            let (tilt, error_m) = (median(tilts).to_degrees(), median(errors_m));
            assert!(tilt < 1.0, "{degrees}: off by {tilt}");
            assert!(error_m < 0.004, "{degrees}: {error_m} m");
        }
    }

    #[test]
    fn stairs_are_no_slope() {
        let (mut slopes, mut frames) = (0, 0);
        for (rise_m, tread_m) in [
            (0.015, 0.2),
            (0.018, 0.15),
            (0.03, 0.12),
            (0.03, 0.25),
            (0.04, 0.15),
            (0.05, 0.2),
        ] {
            for (seed, front_m) in (0..6).zip([0.45, 0.9].into_iter().cycle()) {
                let mut noise = Noise::new(seed);
                let mut segmenter = sloping(true, &mut noise);
                let scene = Scene::stairs(front_m + noise.within(0.05), rise_m, tread_m, 4);
                for _ in 0..10 {
                    let pose = camera_pose(noise.within(0.2), 0.7 + noise.within(0.1));
                    let planes = look(&mut segmenter, &scene, &pose, &mut noise);
                    frames += 1;
                    slopes += usize::from(found(&planes).is_some());
                }
            }
        }
        assert!(slopes <= frames / 100, "{slopes} of {frames} frames");
    }
}
