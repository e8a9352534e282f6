//! H69: maps on several time scales; the fast one adapts within a second, the slow one keeps walls, and the likeliest is used.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

mod common;

use common::{Person, Wall, room, scan};
use dynamic_scenes::{TimescaleMaps, TimescalesConfig};
use geometry::SplitMix64;
use plan_view::{BeamLikelihoodConfig, OccupancyConfig};

const FRAME_S: f64 = 0.1;
const FAST: usize = 0;
const SLOW: usize = 2;

struct World {
    maps: TimescaleMaps,
    numbers: SplitMix64,
    frame: u32,
}

impl World {
    fn new(seed: u64) -> Self {
        let occupancy = OccupancyConfig {
            cell: 0.06,
            ..OccupancyConfig::default()
        };
        let likelihood = BeamLikelihoodConfig {
            max_range: 10.0,
            ..BeamLikelihoodConfig::default()
        };
        let config = TimescalesConfig::default();
        let maps = TimescaleMaps::of_size(config, &occupancy, likelihood, [-2.1, -2.1], [80, 80]);
        Self {
            maps: maps.unwrap(),
            numbers: SplitMix64::new(seed),
            frame: 0,
        }
    }

    /// Scans for so long, in a room with these walls and people; which map was in use at each.
    fn watch(
        &mut self,
        seconds: f64,
        walls: &[Wall],
        people: impl Fn(f64) -> Vec<Person>,
    ) -> Vec<usize> {
        let mut used = Vec::new();
        for step in 0..(seconds / FRAME_S).round() as u32 {
            let people = people(f64::from(step) * FRAME_S);
            let (scan, _) = scan(
                [0.0; 3],
                [std::f64::consts::PI, 0.03],
                (walls, &people),
                (0.02, 8.0),
                &mut self.numbers,
            );
            self.maps
                .insert(f64::from(self.frame) * FRAME_S, &scan)
                .unwrap();
            self.frame += 1;
            used.push(self.maps.in_use());
        }
        used
    }

    fn probability(&self, number: usize, at_m: [f64; 2]) -> f64 {
        self.maps
            .map(number)
            .unwrap()
            .probability_at(at_m[0], at_m[1])
            .unwrap()
    }

    /// Share of the wall at x = 2 that a map has as an obstacle.
    fn wall_kept(&self, number: usize) -> f64 {
        let obstacle = |step: i32| {
            let y_m = 0.06 * f64::from(step);
            let at = [1.94, 2.0, 2.06].map(|x_m| {
                let map = self.maps.map(number).unwrap();
                map.probability_at(x_m, y_m).unwrap_or(0.0)
            });
            at.into_iter().fold(0.0, f64::max) > 0.5
        };
        (-30..=30).filter(|step| obstacle(*step)).count() as f64 / 61.0
    }
}

#[test]
fn the_fast_map_adapts_within_a_second_and_the_slow_one_keeps_walls() {
    for seed in 0..2 {
        let walls = room([-2.0, -2.0], [2.0, 2.0]);
        let mut world = World::new(seed);
        let _used = world.watch(6.0, &walls, |_| Vec::new());
        assert!(world.wall_kept(SLOW) >= 0.98, "{}", world.wall_kept(SLOW));
        // Something is put down: its front is where the beams end.
        let _used = world.watch(1.0, &walls, |_| vec![Person::at(1.0, 0.0)]);
        assert!(world.probability(FAST, [0.86, 0.0]) > 0.6);
        assert!(world.probability(SLOW, [0.86, 0.0]) < 0.4);
        // And taken away.
        let _used = world.watch(1.0, &walls, |_| Vec::new());
        assert!(world.probability(FAST, [0.86, 0.0]) < 0.4);
        // Somebody walks about, and what was the wall is a curtain, which is drawn aside for a second.
        let round = |time_s: f64| {
            let (sin, cos) = libm::sincos(0.4 * time_s);
            vec![Person::at(1.2 * cos, 1.2 * sin)]
        };
        let _used = world.watch(8.0, &walls, round);
        let mut opened = walls.clone();
        opened[1] = [[3.0, -3.0], [3.0, 3.0]];
        let _used = world.watch(1.0, &opened, |_| Vec::new());
        assert!(world.wall_kept(SLOW) >= 0.98, "{}", world.wall_kept(SLOW));
        assert!(world.wall_kept(FAST) < 0.1, "{}", world.wall_kept(FAST));
    }
}

#[test]
fn the_likeliest_map_is_in_use_the_slow_one_in_peace_the_fast_one_when_all_was_moved() {
    for seed in 0..3 {
        let walls = room([-2.0, -2.0], [2.0, 2.0]);
        let mut world = World::new(100 + seed);
        let quiet = world.watch(12.0, &walls, |_| Vec::new());
        let slow = quiet[60..].iter().filter(|used| **used == SLOW).count();
        assert!(
            slow * 10 >= 9 * (quiet.len() - 60),
            "{slow} of {}",
            quiet.len() - 60
        );
        let moved = room([-1.6, -1.7], [1.5, 1.8]);
        let after = world.watch(3.0, &moved, |_| Vec::new());
        let first = after.iter().position(|used| *used == FAST);
        assert!(first.is_some_and(|first| first <= 10), "{after:?}");
        // What was seen in the map in use was at least as likely as in the map of all time.
        let (scan, _) = scan(
            [0.0; 3],
            [3.1, 0.03],
            (&moved, &[]),
            (0.02, 8.0),
            &mut world.numbers,
        );
        let likelihoods = world.maps.log_likelihoods(&scan);
        assert!(
            likelihoods[world.maps.in_use()] > likelihoods[SLOW] + 0.25,
            "{likelihoods:?}"
        );
    }
}
