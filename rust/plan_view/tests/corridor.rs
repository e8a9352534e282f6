//! Sonars in a corridor (004, Figs 36.2 and 36.3): 18 scans of 24 beams.

use std::time::Instant;

use geometry::{PlanarPose, SplitMix64};
use plan_view::{OccupancyConfig, OccupancyMap, PlanarBeam, PlanarScan, SonarConfig, SonarModel};

const WIDTH_M: f64 = 2.4;
const LENGTH_M: f64 = 9.0;
/// Doorways in the upper wall: from where to where along the corridor, and how far one can see into the room.
const DOORWAYS_M: [[f64; 2]; 2] = [[2.0, 2.9], [6.2, 7.1]];
const DEEP_M: f64 = 1.0;

/// Distance to the nearest wall in a direction.
fn true_range_m(x: f64, y: f64, angle: f64) -> f64 {
    let (sin, cos) = libm::sincos(angle);
    let mut best = f64::INFINITY;
    let mut wall = |from: [f64; 2], to: [f64; 2]| {
        let along = [to[0] - from[0], to[1] - from[1]];
        let across = cos * along[1] - sin * along[0];
        if across.abs() > 1e-12 {
            let off = [from[0] - x, from[1] - y];
            let range = (off[0] * along[1] - off[1] * along[0]) / across;
            let part = (off[0] * sin - off[1] * cos) / across;
            if range > 0.0 && (0.0..=1.0).contains(&part) {
                best = best.min(range);
            }
        }
    };
    wall([0.0, 0.0], [LENGTH_M, 0.0]);
    wall([0.0, 0.0], [0.0, WIDTH_M]);
    wall([LENGTH_M, 0.0], [LENGTH_M, WIDTH_M]);
    let mut from = 0.0;
    for [left, right] in DOORWAYS_M {
        wall([from, WIDTH_M], [left, WIDTH_M]);
        wall([left, WIDTH_M], [left, WIDTH_M + DEEP_M]);
        wall([left, WIDTH_M + DEEP_M], [right, WIDTH_M + DEEP_M]);
        wall([right, WIDTH_M + DEEP_M], [right, WIDTH_M]);
        from = right;
    }
    wall([from, WIDTH_M], [LENGTH_M, WIDTH_M]);
    best
}

/// What a sonar measures: the nearest thing in its cone, with noise of 2 cm.
fn sonar_range_m(x: f64, y: f64, angle: f64, half_opening: f64, numbers: &mut SplitMix64) -> f64 {
    let rays =
        (-10..=10).map(|step| true_range_m(x, y, angle + half_opening * f64::from(step) / 10.0));
    let noise: f64 = (0..12).map(|_| numbers.uniform()).sum::<f64>() - 6.0;
    rays.fold(f64::INFINITY, f64::min) + 0.02 * noise
}

fn scans(seed: u64, sonar: &SonarConfig) -> Vec<PlanarScan> {
    let mut numbers = SplitMix64::new(seed);
    (0..18)
        .map(|number| {
            let x = 0.7 + (LENGTH_M - 1.4) * f64::from(number) / 17.0;
            let y = 1.2 + 0.3 * (numbers.uniform() - 0.5);
            let yaw = 0.4 * (numbers.uniform() - 0.5);
            let beam = |step: i32| {
                let bearing = f64::from(step) * std::f64::consts::TAU / 24.0;
                let range = sonar_range_m(x, y, yaw + bearing, sonar.half_opening, &mut numbers);
                PlanarBeam::new(bearing, (range < sonar.max_range).then_some(range))
            };
            PlanarScan {
                map_from_sensor: PlanarPose::new(x, y, yaw),
                beams: (0..24).map(beam).collect(),
            }
        })
        .collect()
}

/// Whether a cell is wall, with its middle and side; none where it is neither in the corridor nor in its walls.
fn truth(x: f64, y: f64, side: f64) -> Option<bool> {
    let doorway = DOORWAYS_M
        .iter()
        .any(|[left, right]| x > *left && x < *right);
    let in_wall = |at: f64, wall: f64| (at - wall).abs() <= side / 2.0;
    if x < side || x > LENGTH_M - side {
        return None; // the ends, which no scan gets near
    }
    if in_wall(y, 0.0) || (in_wall(y, WIDTH_M) && !doorway) {
        return Some(true);
    }
    (y > side && y < WIDTH_M - side).then_some(false)
}

/// H8.
#[test]
fn eighteen_scans_of_twenty_four_sonars_show_a_corridor() {
    let sonar = SonarConfig::default();
    let model = SonarModel::new(sonar.clone()).unwrap();
    let config = OccupancyConfig {
        cell: 0.1,
        ..OccupancyConfig::default()
    };
    let mut shares = Vec::new();
    for seed in 0..6 {
        let mut map = OccupancyMap::new(config.clone()).unwrap();
        let mut joined = OccupancyMap::new(OccupancyConfig {
            least: 1e-6,
            most: 1.0 - 1e-6,
            ..config.clone()
        })
        .unwrap();
        let mut whole = joined.clone();
        for scan in scans(seed, &sonar) {
            let _ = map.insert_sonar(&scan, &model).unwrap();
            let _ = whole.insert_sonar(&scan, &model).unwrap();
            let mut local = OccupancyMap::new(config.clone()).unwrap();
            let _ = local.insert_sonar(&scan, &model).unwrap();
            joined.join(&local).unwrap();
        }
        let (mut right, mut all, mut walls, mut found) = (0, 0, 0, 0);
        for cell in map.cells().area().cells() {
            let [x, y] = map.lattice().center_of(cell);
            let Some(wall) = truth(x, y, config.cell) else {
                continue;
            };
            // What is unknown is wrong, too.
            let said = map
                .probability(cell)
                .filter(|p| (p - 0.5).abs() > 0.02)
                .map(|p| p > 0.5);
            all += 1;
            right += i32::from(said == Some(wall));
            walls += i32::from(wall);
            found += i32::from(wall && said == Some(true));
        }
        shares.push((
            f64::from(right) / f64::from(all),
            f64::from(found) / f64::from(walls),
        ));
        for cell in whole.cells().area().cells() {
            let [x, y] = whole.lattice().center_of(cell);
            let both = [whole.probability(cell), joined.probability_at(x, y)];
            if let [Some(one), Some(other)] = both {
                assert!((one - other).abs() < 0.02, "{one} {other} at {x} {y}");
            } else {
                assert_eq!(both[0], both[1]);
            }
        }
    }
    let worst = shares.iter().map(|(right, _)| *right).fold(1.0, f64::min);
    let walls = shares.iter().map(|(_, found)| *found).fold(1.0, f64::min);
    assert!(worst >= 0.9, "right {worst}; {shares:?}");
    assert!(walls >= 0.7, "walls {walls}; {shares:?}");
}

/// H9: looking up takes the same time in a small map and in one 400 times as large.
#[test]
fn looking_up_a_cell_takes_no_longer_in_a_large_map() {
    let time = |side: usize| {
        let map =
            OccupancyMap::of_size(OccupancyConfig::default(), [0.0; 2], [side, side]).unwrap();
        let reach = 0.05 * side as f64;
        let mut best = f64::INFINITY;
        for _ in 0..5 {
            let mut numbers = SplitMix64::new(1);
            let started = Instant::now();
            let known = (0..20_000).filter(|_| {
                map.probability_at(numbers.uniform() * 0.5 + reach / 2.0, reach / 2.0)
                    .is_some()
            });
            assert_eq!(known.count(), 0);
            best = best.min(started.elapsed().as_secs_f64());
        }
        best
    };
    let (small, large) = (time(100), time(2000));
    assert!(large < 5.0 * small, "{small} s and {large} s");
}
