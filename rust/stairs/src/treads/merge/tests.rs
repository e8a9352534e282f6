//! Laws of merging: it ends, loses nothing, and does not depend on the order.

use geometry::{Outline, Point, Pose, Robot};
use nalgebra::Point2;
use proptest::prelude::*;

use super::*;
use crate::frame::extract::StairSighting;
use crate::stair::level_edge;
use crate::{Sides, Stair, StairsTuning};

/// A level rectangle ahead, of which no end was seen.
fn tread(x_m: f64, y_m: f64, depth_m: f64, height_m: f64) -> Tread {
    let corner = |x: f64, y: f64| Point2::new(x, y);
    let (near, far, right, left) = (x_m, x_m + depth_m, y_m - 0.1, y_m + 0.1);
    let corners = [
        corner(near, right),
        corner(far, right),
        corner(far, left),
        corner(near, left),
    ];
    let sighting = StairSighting {
        stair: Stair::seen(
            level_edge([corners[0], corners[3]], height_m),
            level_edge([corners[1], corners[2]], height_m),
            Point::<Robot>::new(x_m + depth_m / 2.0, y_m, height_m),
            100,
        ),
        hull: Outline::hull(&corners).unwrap(),
        own_level: false,
        large_enough: true,
    };
    Tread::new(&sighting, &Pose::identity(), &StairsTuning::default()).unwrap()
}

/// A sill ahead, its front from `right` to `left`, with what was seen to end it.
fn sill([right, left]: [(f64, f64); 2], seen: Sides) -> Tread {
    const DEEP_M: f64 = 0.09;
    let [right, left] = [right, left].map(|(x, y)| Point2::new(x, y));
    let behind = |p: Point2<f64>| Point2::new(p.x + DEEP_M, p.y);
    let corners = [right, behind(right), behind(left), left];
    let mut stair = Stair::seen(
        level_edge([right, left], 0.038),
        level_edge([behind(right), behind(left)], 0.038),
        Point::<Robot>::new(right.x + 0.5 * DEEP_M, 0.5 * (right.y + left.y), 0.038),
        800,
    );
    stair.seen_ends = seen;
    let sighting = StairSighting {
        stair,
        hull: Outline::hull(&corners).unwrap(),
        own_level: false,
        large_enough: true,
    };
    Tread::new(&sighting, &Pose::identity(), &StairsTuning::default()).unwrap()
}

#[test]
fn one_skewed_look_at_a_part_of_a_remembered_stair_does_not_cut_it_off() {
    let seen = |front: usize, back: usize, sides: usize| Sides {
        front,
        back,
        left: sides,
        right: sides,
    };
    let tuning = StairsTuning::default();
    let mut known = sill([(0.4, -0.45), (0.4, 0.4)], seen(800, 800, 0));
    for _ in 0..8 {
        known.add(
            &sill([(0.4, -0.45), (0.4, 0.4)], seen(800, 800, 0)),
            &tuning,
        );
    }
    known.step(&tuning);
    known.add(
        &sill([(0.35, -0.45), (0.46, -0.2)], seen(0, 100, 800)),
        &tuning,
    );
    let front = known.stair().unwrap().front;
    assert!(front.left.inner.y > 0.35, "{front:?}");
}

fn treads() -> impl Strategy<Value = Vec<Tread>> {
    let one = (0.3..1.5f64, -0.5..0.5f64, 0.08..0.3f64, 0..4i32);
    let one = one.prop_map(|(x, y, depth, level)| tread(x, y, depth, 0.03 * f64::from(level)));
    prop::collection::vec(one, 0..12)
}

/// What is left, as numbers to compare.
fn left(treads: &[Tread]) -> Vec<[i64; 6]> {
    let mut left: Vec<_> = treads
        .iter()
        .map(|tread| {
            let stair = tread.stair().unwrap();
            let (near, far) = (stair.front.middle().inner, stair.back.middle().inner);
            let numbers = [
                near.x,
                near.y,
                far.x,
                far.y,
                stair.height_m(),
                stair.front.length_m(),
            ];
            numbers.map(|number| (number * 1e6).round() as i64)
        })
        .collect();
    left.sort_unstable();
    left
}

proptest! {
    /// S-M7 and S-M8.
    #[test]
    fn merging_ends_with_no_two_that_overlap_and_every_one_inside_one_of_them(mut treads in treads()) {
        let before = treads.clone();
        merge_all(&mut treads, &StairsConfig::default());
        prop_assert!(treads.len() <= before.len());
        for (i, a) in treads.iter().enumerate() {
            for b in &treads[i + 1..] {
                prop_assert!(!overlap(a, b, &StairsConfig::default()));
            }
        }
        for old in &before {
            let old = old.stair().unwrap();
            let inside = treads.iter().any(|new| {
                let level = (new.height_m() - old.height_m()).abs() < 1e-6;
                let new = new.stair().unwrap();
                let corners = [old.front.left, old.front.right, old.back.left, old.back.right];
                level && corners.iter().all(|corner| {
                    let at = [corner.inner.x, corner.inner.y];
                    new.front.beyond_m(at) > -1e-9 && new.back.beyond_m(at) < 1e-9
                })
            });
            prop_assert!(inside);
        }
    }

    /// S-M5.
    #[test]
    fn margins_are_never_negative_and_with_the_edges_cover_all_that_was_seen(mut treads in treads()) {
        let before = treads.clone();
        merge_all(&mut treads, &StairsConfig::default());
        for tread in &treads {
            let stair = tread.stair().unwrap();
            prop_assert!(stair.left_margin_m >= 0.0 && stair.right_margin_m >= 0.0);
            let along = (stair.front.left.inner - stair.front.right.inner).normalize();
            let span = |edge: &Edge<Map>| [edge.right, edge.left].map(|end| along.dot(&end.inner.coords));
            let ([right, left], [right_too, left_too]) = (span(&stair.front), span(&stair.back));
            let covers = [
                right.min(right_too) - stair.right_margin_m - 1e-9,
                left.max(left_too) + stair.left_margin_m + 1e-9,
            ];
            // Those that lie within it became part of it.
            for old in before.iter().filter(|old| shared(old, tread) > 0.999) {
                let old = old.stair().unwrap();
                let level = (old.height_m() - tread.height_m()).abs() < 1e-6;
                let [low, high] = span(&old.front);
                prop_assert!(!level || covers[0] <= low && high <= covers[1]);
            }
        }
    }

    #[test]
    fn what_is_merged_was_seen_from_as_near_as_the_nearest_of_its_parts(mut treads in treads()) {
        let nearest_m = |treads: &[Tread]| {
            let seen_from_m = treads.iter().map(|tread| tread.stair().unwrap().seen_from_m);
            seen_from_m.fold(f64::INFINITY, f64::min)
        };
        let before_m = nearest_m(&treads);
        merge_all(&mut treads, &StairsConfig::default());
        prop_assert_eq!(nearest_m(&treads), before_m);
    }

    /// A staircase on a floor whose hull is as large as this.
    #[test]
    fn a_floor_around_a_tread_stands_not_in_its_place_and_a_tread_as_large_does(
        x in 0.3..1.5f64, depth in 0.08..0.3f64, low in 0.01..0.1f64, wider in 2.1..20.0f64,
    ) {
        let tuning = MergingTuning::default();
        let step = tread(x, 0.0, depth, 0.0);
        let around = tread(x - 0.05, 0.0, wider * depth + 0.05, -low);
        prop_assert!(!contradict(&around, &step, &tuning) && !contradict(&step, &around, &tuning));
        let other = tread(x, 0.0, depth, -low);
        prop_assert!(contradict(&other, &step, &tuning) && contradict(&step, &other, &tuning));
    }

    /// Two steps that were taken for one reach from the front of the first to the back of the second.
    #[test]
    fn a_tread_that_lies_over_a_lower_one_cannot_be_there_with_it(
        x in 0.3..1.5f64, depth in 0.08..0.3f64, deeper in 1.0..8.0f64, rise in 0.01..0.05f64,
    ) {
        let tuning = MergingTuning::default();
        let step = tread(x, 0.0, depth, 0.0);
        let over = tread(x, 0.0, deeper * depth, rise);
        prop_assert!(contradict(&over, &step, &tuning) && contradict(&step, &over, &tuning));
    }

    #[test]
    fn overlap_is_symmetric(a in treads(), b in treads()) {
        let config = StairsConfig::default();
        for (a, b) in a.iter().zip(&b) {
            prop_assert_eq!(overlap(a, b, &config), overlap(b, a, &config));
        }
    }
}

/// Sightings of treads that lie well apart, each shifted a little, in any order.
#[test]
fn the_order_of_sightings_does_not_matter() {
    let mut noise = crate::synthetic::Noise::new(5);
    let sightings: Vec<_> = (0..24)
        .map(|i| {
            let level = f64::from(i % 4);
            tread(
                0.4 + 0.12 * level + noise.within(0.01),
                noise.within(0.05),
                0.1,
                0.03 * level,
            )
        })
        .collect();
    let mut expected = sightings.clone();
    merge_all(&mut expected, &StairsConfig::default());
    assert_eq!(expected.len(), 4);
    for round in 1..24 {
        let mut treads = sightings.clone();
        treads.rotate_left(round);
        if round % 2 == 0 {
            treads.reverse();
        }
        merge_all(&mut treads, &StairsConfig::default());
        assert_eq!(left(&treads), left(&expected));
    }
}
