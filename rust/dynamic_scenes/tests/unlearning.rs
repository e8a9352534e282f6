//! H67: how long an occupancy grid takes to unlearn (004, section 36.4).

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use dynamic_scenes::free_looks_to_unlearn;
use geometry::PlanarPose;
use plan_view::{OccupancyConfig, OccupancyMap, PlanarBeam, PlanarScan};
use proptest::prelude::*;

/// A scan of one beam from the origin.
fn look(range_m: f64) -> PlanarScan {
    PlanarScan {
        map_from_sensor: PlanarPose::new(0.02, 0.02, 0.0),
        beams: vec![PlanarBeam::new(0.0, Some(range_m))],
    }
}

/// Scans of a map that pass a cell until it is less probably occupied than one of which nothing is known, after so many that ended in it.
fn measured(config: &OccupancyConfig, occupied_looks: u32) -> u32 {
    let mut map = OccupancyMap::of_size(config.clone(), [0.0; 2], [60, 1]).unwrap();
    for _ in 0..occupied_looks {
        let _counts = map.insert(&look(1.0)).unwrap();
    }
    (1..100_000)
        .find(|_| {
            let _counts = map.insert(&look(2.0)).unwrap();
            map.probability_at(1.02, 0.02).unwrap() < config.prior
        })
        .unwrap()
}

fn unclamped(occupied: f64, free: f64, prior: f64) -> OccupancyConfig {
    OccupancyConfig {
        occupied,
        free,
        prior,
        least: 1e-9,
        most: 1.0 - f64::EPSILON,
        obstacle: prior.max(0.6),
        ..OccupancyConfig::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The formula is that of the map, but for a look where sums of 32 bits end on the prior itself.
    #[test]
    fn a_map_takes_as_many_free_looks_as_the_formula_says(
        occupied in 0.05..0.45f64, free in 0.05..0.45f64, prior in 0.3..0.7f64, limit in 0.8..0.999f64,
        looks in 1..300_u32, clamped in any::<bool>(),
    ) {
        let mut config = unclamped(prior + occupied * (1.0 - prior), prior * (1.0 - free), prior);
        if clamped {
            config.most = limit.max(config.obstacle + 0.01);
        }
        let formula = free_looks_to_unlearn(&config, looks);
        // Beyond what a probability of 64 bits can say, a map is clamped by that.
        prop_assert!(measured(&config, looks).abs_diff(formula) <= 1, "{formula}");
    }
}

#[test]
fn without_limits_as_many_looks_as_it_was_occupied_are_needed_with_them_a_few() {
    // What a look says of occupied and of free are each other's opposite: the chapter's case.
    let plain = unclamped(0.6, 0.4, 0.5);
    let clamped = OccupancyConfig {
        most: 0.97,
        least: 0.02,
        ..plain.clone()
    };
    for looks in [10, 30, 80] {
        assert!(measured(&plain, looks).abs_diff(looks) <= 2);
        let few = measured(&clamped, looks);
        assert!(
            few <= free_looks_to_unlearn(&clamped, u32::MAX),
            "{looks}: {few}"
        );
    }
    // The default grid: 0.7 and 0.4 with the limit 0.97 are nine looks, whatever came before.
    let default = OccupancyConfig::default();
    assert_eq!(free_looks_to_unlearn(&default, 1_000_000), 9);
    assert!(measured(&default, 500).abs_diff(9) <= 1);
    assert_eq!(free_looks_to_unlearn(&unclamped(0.7, 0.4, 0.5), 17), 36);
}
