//! Tests of both cameras' errors on walls; what they are like as a whole is tested from Python.

use geometry::mix;

use super::*;
use crate::eye::CameraPose;
use crate::picture::TruePicture;
use crate::pinhole::Pinhole;

const WIDTH: usize = 60;
const HEIGHT: usize = 12;
const AHEAD: CameraPose = CameraPose {
    position_m: [0.1, 0.2, 0.3],
    rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
};

fn pinhole() -> Pinhole {
    Pinhole::new(WIDTH, HEIGHT, 100.0).unwrap()
}

/// A wall at 1 m with nothing right of column 50.
fn wall() -> TruePicture {
    let mut picture = TruePicture::new(&pinhole());
    let there = |column: usize| column % WIDTH < 50;
    let pixels = || 0..WIDTH * HEIGHT;
    let depth: Vec<f64> = pixels()
        .map(|i| if there(i) { 1.0 } else { f64::NAN })
        .collect();
    let body: Vec<i32> = pixels().map(|i| if there(i) { 0 } else { -1 }).collect();
    picture.read(&depth, &body).unwrap();
    picture
}

fn stereo(config: StereoConfig, seed: u64) -> StereoErrors {
    StereoErrors::new(config, &pinhole(), &[1.0], seed, seed + 1).unwrap()
}

fn seen(errors: &mut StereoErrors) -> Vec<f32> {
    let mut depth = vec![0.0; WIDTH * HEIGHT];
    errors.see(&wall(), &AHEAD, &mut depth).unwrap();
    depth
}

/// One number of all bits of a picture.
fn digest(depth: &[f32]) -> u64 {
    depth
        .iter()
        .fold(0, |all, value| mix(all ^ u64::from(value.to_bits())))
}

#[test]
fn a_silent_stereo_camera_sees_a_wall_where_both_eyes_have_it_in_their_windows() {
    let silent = StereoConfig {
        disparity_noise_fixed: 0.0,
        disparity_noise_temporal: 0.0,
        quantum: 0.0,
        mismatch_rate: 0.0,
        valid_textured: 1.0,
        ..StereoConfig::default()
    };
    let depth = seen(&mut stereo(silent, 1));
    for (pixel, depth) in depth.iter().enumerate() {
        let (row, column) = (pixel / WIDTH, pixel % WIDTH);
        // The disparity is 6 px, half a window 2 px; beyond column 48 the window sees past the wall.
        let inside = (2..HEIGHT - 2).contains(&row) && (8..48).contains(&column);
        if inside {
            assert!((depth - 1.0).abs() < 1e-6, "{row} {column}: {depth}");
        } else if !(48..50).contains(&column) {
            assert!(depth.is_nan(), "{row} {column}: {depth}");
        }
    }
}

#[test]
fn the_same_seeds_give_the_same_pictures_and_others_do_not() {
    let default = StereoConfig::default;
    let (mut one, mut again) = (stereo(default(), 1), stereo(default(), 1));
    for _ in 0..3 {
        assert_eq!(digest(&seen(&mut one)), digest(&seen(&mut again)));
    }
    assert_ne!(
        digest(&seen(&mut one)),
        digest(&seen(&mut stereo(default(), 2)))
    );
}

#[test]
fn a_structured_light_camera_sees_a_wall_and_leaves_out_what_is_too_near_and_nothing() {
    let errors = |nearest| {
        let config = StructuredLightConfig {
            nearest,
            ..StructuredLightConfig::default()
        };
        let mut errors = StructuredLightErrors::new(config, &pinhole(), 5).unwrap();
        let mut depth = vec![0.0; WIDTH * HEIGHT];
        errors.see(&wall(), &mut depth).unwrap();
        depth
    };
    let depth = errors(0.5);
    for (pixel, depth) in depth.iter().enumerate() {
        match pixel % WIDTH {
            ..48 => assert!((depth - 1.0).abs() < 0.03, "{pixel}: {depth}"),
            52.. => assert!(depth.is_nan(), "{pixel}: {depth}"),
            _ => {}
        }
    }
    assert!(errors(1.1).iter().all(|depth| depth.is_nan()));
}

#[test]
fn what_does_not_belong_to_the_camera_is_refused() {
    let mut depth = vec![0.0; 5];
    let refused = stereo(StereoConfig::default(), 1).see(&wall(), &AHEAD, &mut depth);
    assert_eq!(
        refused.unwrap_err().to_string(),
        "depth must have 720 values, got 5"
    );
    let none = StereoConfig {
        baseline: 0.0,
        ..StereoConfig::default()
    };
    assert!(StereoErrors::new(none, &pinhole(), &[], 0, 0).is_err());
}

#[test]
fn the_bits_of_a_picture_are_these_on_every_processor() {
    let mut errors = stereo(StereoConfig::default(), 7);
    assert_eq!(digest(&seen(&mut errors)), 16_239_249_815_920_710_027);
    let mut light =
        StructuredLightErrors::new(StructuredLightConfig::default(), &pinhole(), 7).unwrap();
    let mut depth = vec![0.0; WIDTH * HEIGHT];
    light.see(&wall(), &mut depth).unwrap();
    assert_eq!(digest(&depth), 10_641_665_448_413_924_802);
}
