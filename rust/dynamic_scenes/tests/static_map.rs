//! H71: a map of what is static alone, by expectation maximization: people removed, walls kept.

mod common;

use common::{Person, room, scan};
use dynamic_scenes::{StaticMapConfig, static_map};
use geometry::{PlanarPose, SplitMix64};
use plan_view::{PlanarBeam, PlanarScan};
use proptest::prelude::*;

/// Scans on a way through a room, with three people in every other 15 of them who turn at the walls; and which beams end in people.
fn recording(seed: u64) -> (Vec<PlanarScan>, Vec<Vec<bool>>) {
    let mut numbers = SplitMix64::new(seed);
    let walls = room([-2.0, -2.0], [4.0, 2.0]);
    let mut way = |low: f64, high: f64| low + (high - low) * numbers.uniform();
    let mut drawn = || {
        [
            way(-1.6, 3.6),
            way(-1.6, 1.6),
            way(-0.3, 0.3),
            way(-0.3, 0.3),
        ]
    };
    let ways = [drawn(), drawn(), drawn()];
    let fold = |at: f64, low: f64, high: f64| {
        let along = (at - low).rem_euclid(2.0 * (high - low));
        low + along.min(2.0 * (high - low) - along)
    };
    let looks = (0..120).map(|step| {
        let time_s = 0.25 * f64::from(step);
        let pose = [0.06 * time_s, 0.3 * libm::sin(0.5 * time_s), 0.2 * time_s];
        let there = if step / 15 % 2 == 1 { &ways[..] } else { &[] };
        let people: Vec<_> = there
            .iter()
            .map(|[x, y, vx, vy]| {
                Person::at(
                    fold(x + vx * time_s, -1.7, 3.7),
                    fold(y + vy * time_s, -1.7, 1.7),
                )
            })
            .filter(|person| geometry::distance_m(person.at_m, [pose[0], pose[1]]) > 0.3)
            .collect();
        scan(
            pose,
            [2.4, 0.015],
            (&walls, &people),
            (0.02, 8.0),
            &mut numbers,
        )
    });
    looks.unzip()
}

#[test]
fn people_in_half_of_the_scans_are_removed_and_walls_kept() {
    for seed in 0..5 {
        let (scans, labels) = recording(seed);
        let config = StaticMapConfig::default();
        let found = static_map(&scans, [-2.5, -2.5], [140, 100], &config).unwrap();
        let beams = found.beam_is_static.iter().flatten();
        let labelled: Vec<_> = beams.zip(labels.iter().flatten()).collect();
        let count = |kept: bool, person: bool| {
            let these = labelled
                .iter()
                .filter(|(p, label)| (**p > 0.5) == kept && **label == person);
            these.count() as f64
        };
        let (people, wall) = (count(true, true), count(true, false));
        let (precision, recall) = (wall / (wall + people), wall / (wall + count(false, false)));
        assert!(people + count(false, true) > 1000.0);
        assert!(
            precision >= 0.97 && recall >= 0.97,
            "seed {seed}: {precision} {recall}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Expectation maximization never makes what was seen less likely, and ends where it is as likely as it gets.
    #[test]
    fn each_round_makes_the_looks_likelier(
        ranges in prop::collection::vec((-3.0..3.0f64, 0.05..3.0f64), 1..120),
        stopped in 0.6..0.99f64, passing in 0.01..0.5f64,
    ) {
        let beams = ranges.iter().map(|&(bearing, range)| PlanarBeam::new(bearing, Some(range)));
        let scan = PlanarScan { map_from_sensor: PlanarPose::new(0.0, 0.0, 0.0), beams: beams.collect() };
        let config = StaticMapConfig {
            stopped, passing, rounds: 300, gain: 1e-9, cell: 0.4, ..StaticMapConfig::default()
        };
        let found = static_map(&[scan], [-4.0, -4.0], [20, 20], &config).unwrap();
        for pair in found.log_likelihoods.windows(2) {
            prop_assert!(pair[1] >= pair[0] - 1e-9, "{pair:?}");
        }
        for &m in found.occupied.values() {
            prop_assert!(m.is_nan() || (0.0..=1.0).contains(&m));
        }
    }
}
