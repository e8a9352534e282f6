//! H70: doors are learned as two states from visits, and localization with them is better than with one map.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Wall, scan};
use dynamic_scenes::{StatefulMap, StatesConfig, learn_states};
use geometry::SplitMix64;
use plan_view::{BeamLikelihood, BeamLikelihoodConfig, OccupancyConfig, OccupancyMap, PlanarScan};

const FIRST_M: [f64; 2] = [2.0, 2.8];
const SECOND_M: [f64; 2] = [4.4, 5.6];

/// A corridor of 8 m with a small room behind each of two doors, one wider than the other, open or shut.
fn corridor(open: [bool; 2]) -> Vec<Wall> {
    let mut walls = vec![[[0.0, 0.0], [8.0, 0.0]]];
    let mut from = 0.0;
    for (door, open) in [FIRST_M, SECOND_M].into_iter().zip(open) {
        walls.push([[from, 1.4], [door[0], 1.4]]);
        if !open {
            walls.push([[door[0], 1.4], [door[1], 1.4]]);
        }
        for x in door {
            walls.push([[x, 1.4], [x, 2.6]]);
        }
        walls.push([[door[0], 2.6], [door[1], 2.6]]);
        from = door[1];
    }
    walls.push([[from, 1.4], [8.0, 1.4]]);
    walls
}

fn look(pose: [f64; 3], open: [bool; 2], numbers: &mut SplitMix64) -> PlanarScan {
    scan(
        pose,
        [3.1, 0.03],
        (&corridor(open), &[]),
        (0.02, 3.0),
        numbers,
    )
    .0
}

/// The map of a walk along the corridor.
fn visit(open: [bool; 2], numbers: &mut SplitMix64) -> OccupancyMap {
    let config = OccupancyConfig {
        cell: 0.05,
        ..OccupancyConfig::default()
    };
    let mut map = OccupancyMap::of_size(config, [-0.5, -0.5], [180, 70]).unwrap();
    for step in 0..24 {
        let pose = [0.6 + 0.3 * f64::from(step), 0.7, 0.0];
        let _counts = map.insert(&look(pose, open, numbers)).unwrap();
    }
    map
}

fn learned(seed: u64) -> (StatefulMap, Vec<[bool; 2]>) {
    let mut numbers = SplitMix64::new(seed);
    // Both doors open and shut in each combination, one more often than the other.
    let doors: Vec<[bool; 2]> = (0..8)
        .map(|at| [at % 2 == 0, at % 4 < 3 && at < 6])
        .collect();
    let maps: Vec<_> = doors
        .iter()
        .map(|open| visit(*open, &mut numbers))
        .collect();
    (
        learn_states(&maps, &StatesConfig::default())
            .unwrap()
            .unwrap(),
        doors,
    )
}

#[test]
fn each_door_is_one_part_with_two_states_and_every_visit_is_in_the_right_one() {
    for seed in 0..3 {
        let (map, doors) = learned(seed);
        assert_eq!(map.parts().len(), 2, "parts that change");
        for (door, part) in map.parts().iter().enumerate() {
            assert_eq!(part.states.len(), 2, "open and shut");
            let open = |visit: usize| doors[visit][door];
            let states: Vec<_> = part.of_visits.iter().enumerate().collect();
            let of_open = states.iter().find(|(visit, _)| open(*visit)).unwrap().1;
            for (visit, state) in &states {
                assert_eq!(
                    open(*visit),
                    *state == of_open,
                    "door {door}, visit {visit}"
                );
            }
            assert!((part.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }
}

/// Where along the corridor, m, a scan is likeliest.
fn located(worth: impl Fn(&PlanarScan) -> f64, seen: &PlanarScan) -> f64 {
    let at = |step: i32| {
        let x_m = 1.0 + 0.1 * f64::from(step);
        let mut moved = seen.clone();
        moved.map_from_sensor.x_m = x_m;
        (worth(&moved), x_m)
    };
    (0..=60)
        .map(at)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap()
        .1
}

#[test]
fn localization_with_the_states_is_better_than_with_one_map() {
    let (map, _) = learned(7);
    let likelihood = BeamLikelihood::new(BeamLikelihoodConfig {
        max_range: 3.0,
        sigma: 0.05,
        ..BeamLikelihoodConfig::default()
    })
    .unwrap();
    let mut numbers = SplitMix64::new(99);
    let trials = 40;
    let [mut with_states, mut with_one] = [0, 0];
    for trial in 0..trials {
        let open = [trial % 2 == 0, trial / 2 % 2 == 0];
        let x_m = 1.4 + 4.4 * numbers.uniform();
        let mut seen = look([x_m, 0.7, 0.0], open, &mut numbers);
        let mut number = 0;
        seen.beams.retain(|_| {
            number += 1;
            number % 4 == 0
        });
        let right = |found_m: f64| usize::from((found_m - x_m).abs() <= 0.2);
        with_states += right(located(
            |scan| map.likeliest(&likelihood, std::slice::from_ref(scan)).1,
            &seen,
        ));
        with_one += right(located(
            |scan| likelihood.log_likelihood(map.as_one_map(), scan).0,
            &seen,
        ));
    }
    assert!(with_states > with_one + 5, "{with_states} {with_one}");
}
