//! The equations of the occupancy grid, 36.1 to 36.6, and what follows from them (004, section 36.2.1).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use geometry::{Cell, Lattice, PlanarPose};
use plan_view::{
    BeamLikelihood, BeamLikelihoodConfig, LaserModel, OccupancyConfig, OccupancyError,
    OccupancyMap, PlanarBeam, PlanarScan, SonarConfig, SonarModel, log_odds, odds,
    probability_of_log_odds, probability_of_odds, updated_odds,
};
use proptest::prelude::*;
use settings::Table;

/// Settings under which nothing is clamped in these tests.
fn unclamped(prior: f64) -> OccupancyConfig {
    OccupancyConfig {
        prior,
        occupied: prior + 0.6 * (1.0 - prior),
        free: 0.6 * prior,
        least: 1e-8,
        most: 1.0 - 1e-8,
        obstacle: prior.max(0.6),
        ..OccupancyConfig::default()
    }
}

fn sized(config: OccupancyConfig, size: [usize; 2]) -> OccupancyMap {
    OccupancyMap::of_size(config, [0.0; 2], size).unwrap()
}

/// Bayes' rule on whole measurements, none of them approximated: 004, equation 36.2 without odds.
fn batch(prior: f64, measured: &[f64]) -> f64 {
    // p(m | z) is proportional to p(m) and, for each z, p(m | z) / p(m).
    let [occupied, free]: [f64; 2] = [
        measured.iter().map(|p| libm::log(p / prior)).sum::<f64>() + libm::log(prior),
        measured
            .iter()
            .map(|p| libm::log((1.0 - p) / (1.0 - prior)))
            .sum::<f64>()
            + libm::log(1.0 - prior),
    ];
    1.0 / (1.0 + libm::exp(free - occupied))
}

fn scan(pose: [f64; 3], beams: impl IntoIterator<Item = (f64, f64)>) -> PlanarScan {
    let beam = |(bearing_rad, range_m): (f64, f64)| PlanarBeam::new(bearing_rad, Some(range_m));
    PlanarScan {
        map_from_sensor: PlanarPose::new(pose[0], pose[1], pose[2]),
        beams: beams.into_iter().map(beam).collect(),
    }
}

proptest! {
    /// H1: 36.1.
    #[test]
    fn a_maps_log_probability_is_the_sum_of_its_cells(
        told in prop::collection::vec(0.01..0.99f64, 9), prior in 0.1..0.9f64, pattern in 0..512_usize,
    ) {
        let mut map = sized(unclamped(prior), [3, 3]);
        for (cell, p) in map.cells().area().cells().collect::<Vec<_>>().into_iter().zip(&told) {
            map.update(cell, *p);
        }
        let occupied = |pattern: usize| (0..9).map(|bit| pattern >> bit & 1 == 1).collect::<Vec<_>>();
        let each: f64 = map.cells().area().cells().zip(occupied(pattern)).map(|(cell, occupied)| {
            let p = map.probability(cell).unwrap();
            if occupied { libm::log(p) } else { libm::log(1.0 - p) }
        }).sum();
        prop_assert!((map.log_probability_of(&occupied(pattern)) - each).abs() < 1e-9);
        let all: f64 = (0..512).map(|pattern| libm::exp(map.log_probability_of(&occupied(pattern)))).sum();
        prop_assert!((all - 1.0).abs() < 1e-9, "all maps together have {all}");
    }

    /// H2 and H4: 36.2, 36.4, priors other than 0.5 among them.
    #[test]
    fn measurements_in_any_order_give_what_bayes_gives_at_once(
        mut told in prop::collection::vec(0.2..0.8f64, 100), prior in 0.2..0.8f64, seed in 0..1000_u64,
    ) {
        let expected = batch(prior, &told);
        let by_odds = told.iter().fold(odds(prior), |before, p| updated_odds(before, odds(*p), odds(prior)));
        prop_assert!((probability_of_odds(by_odds) - expected).abs() < 1e-9);
        let mut numbers = geometry::SplitMix64::new(seed);
        for last in (1..told.len()).rev() {
            told.swap(last, (numbers.uniform() * (last + 1) as f64) as usize);
        }
        let shuffled = told.iter().fold(odds(prior), |before, p| updated_odds(before, odds(*p), odds(prior)));
        prop_assert!((probability_of_odds(shuffled) - expected).abs() < 1e-9);
        // The grid keeps 32 bits.
        let mut map = sized(OccupancyConfig { least: 1e-9, most: 1.0 - 1e-9, ..unclamped(prior) }, [1, 1]);
        let cell = Cell::new(0, 0);
        told.iter().take(8).for_each(|p| map.update(cell, *p));
        prop_assert!((map.probability(cell).unwrap() - batch(prior, &told[..8])).abs() < 1e-5);
    }

    /// H3 and H5: 36.3, 36.5.
    #[test]
    fn odds_rise_with_the_probability_and_lead_back_to_it(p in 0.0..1.0f64, more in 1e-6..0.5f64) {
        prop_assert!((probability_of_odds(odds(p)) - p).abs() < 1e-12);
        prop_assert!(p + more >= 1.0 || odds(p + more) > odds(p));
        prop_assert!(p == 0.0 || (probability_of_log_odds(log_odds(p)) - p).abs() < 1e-12);
    }

    /// H6: 36.6, its cases in their order.
    #[test]
    fn a_lasers_beam_says_what_the_first_case_that_holds_says(
        range in 0.1..10.0f64, distance in 0.0..12.0f64, covered in any::<bool>(),
    ) {
        let config = OccupancyConfig { prior: 0.45, ..OccupancyConfig::default() };
        let model = LaserModel::new(&config);
        prop_assert_eq!(model.probability(None, covered, distance), config.prior);
        let expected = if !covered {
            config.prior
        } else if (range - distance).abs() < config.cell / 2.0 {
            config.occupied
        } else if range >= distance {
            config.free
        } else {
            config.prior
        };
        prop_assert_eq!(model.probability(Some(range), covered, distance), expected);
    }

    /// H9: discretization.
    #[test]
    fn what_is_seen_lies_within_half_a_cell_of_the_middle_of_its_cell(x in -20.0..20.0f64, y in -20.0..20.0f64) {
        let lattice = Lattice { origin_m: [0.013, -0.4], cell_m: 0.05 };
        let [cx, cy] = lattice.center_of(lattice.cell_at(x, y));
        prop_assert!((cx - x).abs() <= 0.025 + 1e-9 && (cy - y).abs() <= 0.025 + 1e-9);
    }

    /// Fig. 36.2: local maps joined are the map of all scans.
    #[test]
    fn local_maps_join_to_the_map_of_all_scans(prior in 0.3..0.7f64, turns in prop::collection::vec(-3.0..3.0f64, 1..5)) {
        let mut whole = OccupancyMap::new(unclamped(prior)).unwrap();
        let mut joined = OccupancyMap::new(unclamped(prior)).unwrap();
        for (number, turn) in turns.iter().enumerate() {
            let one = scan([0.3 * number as f64 + 0.017, 0.113, *turn], (0..20).map(|step| (0.1 * f64::from(step), 1.5)));
            let mut local = OccupancyMap::new(unclamped(prior)).unwrap();
            let _ = local.insert(&one).unwrap();
            let _ = whole.insert(&one).unwrap();
            joined.join(&local).unwrap();
        }
        for cell in whole.cells().area().cells() {
            let [x, y] = whole.lattice().center_of(cell);
            match (whole.probability(cell), joined.probability_at(x, y)) {
                (Some(one), Some(other)) => prop_assert!((one - other).abs() < 1e-5),
                (one, other) => prop_assert_eq!(one, other),
            }
        }
    }

    /// The forward model is a distribution over ranges.
    #[test]
    fn the_density_of_a_range_adds_up_to_one(bearing in -3.0..3.0f64, wall in 0.6..1.5f64) {
        let mut map = OccupancyMap::new(OccupancyConfig::default()).unwrap();
        let ring = scan([0.0; 3], (0..200).map(|step| (0.0314 * f64::from(step), wall)));
        for _ in 0..2 { let _ = map.insert(&ring).unwrap(); }
        let config = BeamLikelihoodConfig { max_range: 4.0, ..BeamLikelihoodConfig::default() };
        let model = BeamLikelihood::new(config).unwrap();
        let pose = PlanarPose::new(0.05, -0.02, 0.3);
        let step = 0.005;
        let seen: f64 = (0..800).map(|at| {
            step * model.density(&map, &pose, &PlanarBeam::new(bearing, Some((f64::from(at) + 0.5) * step)))
        }).sum();
        let all = seen + model.density(&map, &pose, &PlanarBeam::new(bearing, None));
        prop_assert!((all - 1.0).abs() < 5e-3, "{all}");
    }
}

#[test]
fn the_odds_of_one_half_are_one() {
    assert_eq!(odds(0.5), 1.0);
    assert_eq!(probability_of_odds(f64::INFINITY), 1.0);
}

#[test]
fn probabilities_in_another_order_than_free_prior_occupied_are_refused() {
    let default = OccupancyConfig::default;
    let bad = [
        (
            OccupancyConfig {
                free: 0.5,
                ..default()
            },
            "navigation.occupancy_2d.free must be < prior (0.5), got 0.5",
        ),
        (
            OccupancyConfig {
                occupied: 0.4,
                free: 0.3,
                ..default()
            },
            "navigation.occupancy_2d.prior must be < occupied (0.4), got 0.5",
        ),
        (
            OccupancyConfig {
                free: -0.1,
                ..default()
            },
            "navigation.occupancy_2d.free must be from 0 to 1, got -0.1",
        ),
    ];
    for (config, said) in bad {
        assert_eq!(config.check().unwrap_err().to_string(), said);
    }
}

/// H7: Fig. 36.1 a and b.
#[test]
fn a_sonar_says_most_on_the_axis_near_its_range_and_less_the_further_that_is() {
    let config = SonarConfig::default();
    let model = SonarModel::new(config.clone()).unwrap();
    let mut peaks = Vec::new();
    for range in [2.0, 2.5] {
        let at = |distance: f64, off: f64| model.probability(Some(range), distance, off);
        let best = (0..400)
            .map(|step| 0.01 * f64::from(step))
            .max_by(|a, b| at(*a, 0.0).total_cmp(&at(*b, 0.0)))
            .unwrap();
        assert!((best - range).abs() < 0.011, "most at {best}");
        for step in 0..40 {
            let (off, next) = (0.005 * f64::from(step), 0.005 * f64::from(step + 1));
            if next < config.half_opening {
                assert!(at(range, next) < at(range, off), "falls with the angle");
                assert!(
                    at(1.0, next) > at(1.0, off),
                    "before it, too: nearer to the prior"
                );
            }
        }
        assert_eq!(at(range, config.half_opening + 0.01), config.prior);
        assert_eq!(
            at(range + 0.3, 0.0),
            config.prior,
            "nothing is said of what is behind"
        );
        assert_eq!(model.probability(None, 1.0, 0.0), config.prior);
        peaks.push((at(range, 0.0) - config.prior, config.prior - at(1.0, 0.0)));
    }
    assert!(
        peaks[1].0 < peaks[0].0 && peaks[1].1 < peaks[0].1,
        "{peaks:?}"
    );
}

/// H9: what is not known is neither free nor occupied, even where the prior is 0.5.
#[test]
fn unknown_cells_are_told_from_cells_of_which_measurements_cancel() {
    let mut map = sized(unclamped(0.5), [2, 1]);
    map.update(Cell::new(0, 0), 0.8);
    map.update(Cell::new(0, 0), 0.2);
    assert!((map.probability(Cell::new(0, 0)).unwrap() - 0.5).abs() < 1e-6);
    assert_eq!(map.probability(Cell::new(1, 0)), None);
    assert_eq!(map.probability_at(-9.0, 9.0), None);
}

#[test]
fn cells_stay_where_they_are_when_the_map_grows_and_when_its_window_moves() {
    let mut map = OccupancyMap::new(OccupancyConfig::default()).unwrap();
    let _ = map.insert(&scan([0.0; 3], [(0.0, 1.02)])).unwrap();
    let before = map.probability_at(1.02, 0.01).unwrap();
    assert!(before > 0.6);
    let _ = map
        .insert(&scan([-8.0, -9.0, 1.0], [(0.0, 3.0), (2.0, 5.0)]))
        .unwrap();
    assert_eq!(map.probability_at(1.02, 0.01), Some(before));
    map.shift(3, 2);
    assert_eq!(map.probability_at(1.02, 0.01), Some(before));
}

#[test]
fn bad_beams_are_counted_and_bad_poses_refused() {
    let mut map = OccupancyMap::new(OccupancyConfig::default()).unwrap();
    let mut one = scan(
        [0.0; 3],
        [
            (0.0, 1.0),
            (0.1, 0.0),
            (0.2, f64::INFINITY),
            (0.3, f64::NAN),
            (0.4, -2.0),
        ],
    );
    one.beams.push(PlanarBeam::new(0.5, None));
    let counts = map.insert(&one).unwrap();
    assert_eq!(
        [counts.used, counts.nothing_seen, counts.unusable],
        [1, 1, 4]
    );
    one.map_from_sensor.yaw_rad = f64::NAN;
    assert_eq!(map.insert(&one), Err(OccupancyError::PoseNotFinite));
    let far = scan([1e7, 0.0, 0.0], [(0.0, 1.0)]);
    assert!(matches!(
        map.insert(&far),
        Err(OccupancyError::TooLarge { .. })
    ));
}

#[test]
fn a_scan_is_most_probable_from_where_it_was_taken() {
    let mut map = OccupancyMap::new(OccupancyConfig::default()).unwrap();
    let room = |x: f64, y: f64, yaw: f64| {
        let range = |bearing: f64| {
            let (sin, cos) = libm::sincos(yaw + bearing);
            let to = |at: f64, way: f64, low: f64, high: f64| {
                if way > 0.0 {
                    (high - at) / way
                } else {
                    (low - at) / way
                }
            };
            to(x, cos, -1.0, 2.0).min(to(y, sin, -1.5, 1.5))
        };
        scan(
            [x, y, yaw],
            (0..120)
                .map(|step| 0.05 * f64::from(step))
                .map(|bearing| (bearing, range(bearing))),
        )
    };
    for step in 0..10 {
        let _ = map.insert(&room(0.1 * f64::from(step), 0.05, 0.3)).unwrap();
    }
    let model = BeamLikelihood::new(BeamLikelihoodConfig::default()).unwrap();
    let mut seen = room(0.33, -0.21, 1.0);
    let (best, beams) = model.log_likelihood(&map, &seen);
    assert_eq!(beams, 120);
    for (x, y, yaw) in [
        (0.1, 0.0, 0.0),
        (-0.1, 0.0, 0.0),
        (0.0, 0.1, 0.0),
        (0.0, -0.1, 0.0),
        (0.0, 0.0, 0.1),
        (0.0, 0.0, -0.1),
    ] {
        seen.map_from_sensor = PlanarPose::new(0.33 + x, -0.21 + y, 1.0 + yaw);
        assert!(model.log_likelihood(&map, &seen).0 < best, "{x} {y} {yaw}");
    }
}
