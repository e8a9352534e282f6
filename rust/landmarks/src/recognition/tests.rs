//! Places of a wide field of rocks, come to again from elsewhere, and fields that were never seen.

use super::*;
use geometry::{SplitMix64, wrap_angle};
use proptest::prelude::*;

const SIDE_M: f64 = 30.0;
const ROCKS: usize = 150;
const REACH_M: f64 = 6.0;

fn field(random: &mut SplitMix64) -> Vec<LookingLike> {
    let mut rocks: Vec<LookingLike> = Vec::new();
    while rocks.len() < ROCKS {
        let [x, y] = [(); 2].map(|()| SIDE_M * random.uniform());
        let at_m = Vector2::new(x, y);
        if rocks.iter().all(|other| (other.at_m - at_m).norm() > 0.7) {
            let [width, height] = [(); 2].map(|()| random.uniform());
            let size_m = [0.15 + 0.6 * width, 0.1 + 0.7 * height];
            rocks.push(LookingLike { at_m, size_m });
        }
    }
    rocks
}

/// What is seen all around from a place: one in ten is missed, one in ten is something else, places and sizes err.
fn look(
    rocks: &[LookingLike],
    robot: &PlanarPose,
    random: &mut SplitMix64,
    config: &RecognitionConfig,
) -> Vec<LookingLike> {
    let back = robot.inverse();
    let mut seen = Vec::new();
    for rock in rocks {
        let (x, y) = back.apply(rock.at_m.x, rock.at_m.y);
        if geometry::hypot(x, y) > REACH_M || random.uniform() < 0.1 {
            continue;
        }
        let [east, north, width, height] = random.normals();
        let sd = core::f64::consts::FRAC_1_SQRT_2 * config.place_noise;
        let [wider, higher] = config.appearance_noise;
        let stands_elsewhere = random.uniform() < 0.1;
        let at_m = if stands_elsewhere {
            Vector2::from([(); 2].map(|()| REACH_M * (2.0 * random.uniform() - 1.0)))
        } else {
            Vector2::new(x + sd * east, y + sd * north)
        };
        let size_m = [
            rock.size_m[0] + wider * width,
            rock.size_m[1] + higher * height,
        ];
        seen.push(LookingLike { at_m, size_m });
    }
    seen
}

fn place(random: &mut SplitMix64) -> PlanarPose {
    let [x, y] = [(); 2].map(|()| REACH_M + (SIDE_M - 2.0 * REACH_M) * random.uniform());
    PlanarPose::new(x, y, wrap_angle(core::f64::consts::TAU * random.uniform()))
}

/// How many of so many places are recognised, and how many by mistake: elsewhere in the field, or one that was never seen.
fn counted(seeds: core::ops::Range<u64>) -> [usize; 2] {
    let config = RecognitionConfig::default();
    let (mut right, mut wrong) = (0, 0);
    for seed in seeds {
        let mut random = SplitMix64::new(seed);
        let (rocks, elsewhere) = (field(&mut random), field(&mut random));
        let at = place(&mut random);
        let seen = look(&rocks, &at, &mut random, &config);
        if let Some(found) = recognise(&seen, &rocks, &config).unwrap() {
            let off = at.inverse().compose(&found.map_from_robot);
            if geometry::hypot(off.x_m, off.y_m) < 0.3 && off.yaw_rad.abs() < 0.1 {
                right += 1;
            } else {
                wrong += 1;
            }
        }
        let seen = look(&elsewhere, &at, &mut random, &config);
        wrong += usize::from(recognise(&seen, &rocks, &config).unwrap().is_some());
    }
    [right, wrong]
}

#[test]
fn places_are_recognised_by_what_they_look_like_and_none_that_was_never_seen() {
    let [right, wrong] = counted(0..20);
    assert_eq!(wrong, 0);
    assert!(right >= 19, "{right} of 20");
}

/// `cargo test --release -p landmarks --lib recognition -- --ignored`
#[test]
#[ignore = "a thousand fields"]
fn nineteen_of_twenty_places_are_recognised_and_none_by_mistake() {
    let [right, wrong] = counted(0..1000);
    assert!(right >= 950 && wrong == 0, "{right} right, {wrong} wrong");
}

#[test]
fn two_places_that_look_alike_are_not_told_apart() {
    let config = RecognitionConfig::default();
    let mut random = SplitMix64::new(3);
    let mut rocks = field(&mut random);
    let shift = Vector2::new(2.0 * SIDE_M, 0.0);
    let copies: Vec<LookingLike> = rocks
        .iter()
        .map(|one| LookingLike {
            at_m: one.at_m + shift,
            ..*one
        })
        .collect();
    let at = place(&mut random);
    let seen = look(&rocks, &at, &mut random, &config);
    assert!(recognise(&seen, &rocks, &config).unwrap().is_some());
    rocks.extend(copies);
    assert_eq!(recognise(&seen, &rocks, &config).unwrap(), None);
}

#[test]
fn of_nothing_seen_or_known_no_place_is_recognised() {
    let config = RecognitionConfig::default();
    let rocks = field(&mut SplitMix64::new(1));
    assert_eq!(recognise(&[], &rocks, &config).unwrap(), None);
    assert_eq!(recognise(&rocks[..8], &[], &config).unwrap(), None);
    assert_eq!(recognise(&rocks[..1], &rocks, &config).unwrap(), None);
    // All in one place say nothing of a heading.
    let heap = [rocks[0]; 6];
    assert_eq!(recognise(&heap, &heap, &config).unwrap(), None);
}

proptest! {
    #[test]
    fn the_tail_of_the_binomial_falls_from_one(tries in 0..30_usize, probability in 0.0..1.0f64) {
        let tail: Vec<f64> = (0..=tries + 1).map(|least| binomial_tail(tries, least, probability)).collect();
        prop_assert!((tail[0] - 1.0).abs() < 1e-9 && tail[tries + 1] == 0.0);
        prop_assert!(tail.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9));
        let mean: f64 = tail[1..].iter().sum();
        prop_assert!((mean - tries as f64 * probability).abs() < 1e-6);
    }
}
