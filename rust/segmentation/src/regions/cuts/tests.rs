//! A low step in what was taken for one surface, and one surface that is none.

use nalgebra::{Rotation3, Vector3};

use super::*;
use crate::regions::region::Region;
use testkit::synthetic::{CAMERA, GROUND, NOTHING, Noise, Scene, camera_pose};

const SIGMA_PX: f32 = 0.125;

/// A scene whose seen pixels are all one region, under a view that leans by a little: labels after the cut, and the regions.
fn cut(scene: &Scene, noise: &mut Noise) -> (Vec<u16>, Vec<u16>, Vec<Region>) {
    let truth = camera_pose(noise.within(0.3), 0.85 + noise.within(0.1));
    let (mut disparity_px, levels) = scene.exact(&truth);
    noise.correlated(CAMERA.width, f64::from(SIGMA_PX), &mut disparity_px);
    let lean = Vector3::new(noise.within(0.008), noise.within(0.008), 0.0);
    let rotation = Rotation3::new(lean) * truth.inner.rotation.to_rotation_matrix();
    let view = View::new(&CAMERA, &rotation);
    let (mut g, sigma_px) = (vec![0.0; levels.len()], vec![SIGMA_PX; levels.len()]);
    view.fill(CAMERA.width, &mut g);
    let picture = Picture {
        width: CAMERA.width,
        disparity_px: &disparity_px,
        g: &g,
        sigma_px: &sigma_px,
        finer: 1,
    };
    let mut labels: Vec<u16> = levels
        .iter()
        .map(|&level| u16::from(level != NOTHING))
        .collect();
    let own = || labels.iter().enumerate().filter(|(_, label)| **label > 0);
    let sum = |of: &[f32]| own().map(|(at, _)| of[at] * g[at]).sum::<f32>();
    let mut regions = vec![Region {
        q: sum(&disparity_px) / sum(&g),
        support: own().count(),
        ..Region::default()
    }];
    let tilt = TiltPrior {
        expected: Vector2::zeros(),
        sigma_rad: 0.008,
    };
    let any = Cuts::default().cut(picture, &view, tilt, &mut regions, &mut labels);
    assert_eq!(any, regions.len() > 1);
    (levels, labels, regions)
}

#[test]
fn a_step_of_16_mm_is_found_and_nearly_every_pixel_goes_to_its_side() {
    let mut noise = Noise::new(1);
    let (mut found, mut wrong, mut all) = (0, 0, 0);
    for front_m in [0.24, 0.28, 0.32, 0.36] {
        for _ in 0..10 {
            let (levels, labels, regions) = cut(&Scene::stairs(front_m, 0.016, 0.4, 1), &mut noise);
            if regions.len() != 2 {
                continue;
            }
            found += 1;
            let higher = if regions[0].q > regions[1].q { 1 } else { 2 };
            let tops = levels
                .iter()
                .zip(&labels)
                .filter(|(level, _)| **level % 2 == 1);
            for (&level, &label) in tops {
                all += 1;
                wrong += usize::from((level > GROUND) != (label == higher));
            }
        }
    }
    assert!(found >= 36, "{found} of 40");
    // A metre away the step is less than the noise of a matching window.
    assert!(100 * wrong < 8 * all, "{wrong} of {all}");
}

#[test]
fn one_surface_is_not_cut() {
    let mut noise = Noise::new(2);
    let cuts = (0..200).filter(|_| cut(&Scene::floor(), &mut noise).2.len() > 1);
    let cuts = cuts.count();
    assert!(cuts <= 1, "{cuts}");
}
