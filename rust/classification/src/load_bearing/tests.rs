//! Claims about the ground under made-up grass.

use super::*;
use crate::learned_ground::{Canopy, LearnedGround, LearnedGroundConfig};
use crate::synthetic::Noise;

/// A meadow of 2 m x 2 m: rolling ground under grass of stems that are 5 mm wide.
struct Meadow {
    /// Stems a square metre.
    stems: f64,
    /// How high they stand, m.
    tall_m: f64,
    phase: f64,
}

impl Meadow {
    fn ground_m(&self, x: f64, y: f64) -> f64 {
        0.05 * libm::sin(2.0 * x + self.phase) + 0.06 * y
    }

    /// Where a ray ends: at the first stem, which comes after a way that is exponential in the stems it could meet, or on the ground.
    fn ray(&self, from: Point3, aim: [f64; 2], noise: &mut Noise) -> SensorRay {
        let aim = [aim[0], aim[1], self.ground_m(aim[0], aim[1])];
        let along = [0, 1, 2].map(|axis| aim[axis] - from[axis]);
        let level_m = (along[0] * along[0] + along[1] * along[1]).sqrt();
        let free_m = -libm::log(1.0 - noise.within(0.0, 1.0)) / (self.stems * 0.005);
        let at = |share: f64| [0, 1, 2].map(|axis| from[axis] + share * along[axis]);
        // The grass begins where the ray comes below its tips.
        let enters = (0..1000)
            .map(|step| f64::from(step) / 1000.0)
            .find(|share| {
                let [x, y, z] = at(*share);
                z < self.ground_m(x, y) + self.tall_m
            })
            .unwrap_or(1.0);
        let share = (enters + free_m / level_m).min(1.0);
        let range_m = (level_m * level_m + along[2] * along[2]).sqrt();
        SensorRay {
            from,
            to: at(share + noise.normal(0.01) / range_m),
        }
    }
}

/// What is found of a meadow by two looks of 4000 rays from 1 m above the ground.
fn found(meadow: &Meadow, seed: u64) -> (LoadBearing, Grid<Option<Support>>) {
    let mut noise = Noise::new(seed);
    let lattice = Lattice {
        origin_m: [0.0, 0.0],
        cell_m: 0.1,
    };
    let config = LoadBearingConfig::default();
    let mut load_bearing = LoadBearing::new(config, lattice, [20, 20]).unwrap();
    for from in [[-0.8, 1.0, 1.0], [1.0, -0.8, 1.0]] {
        let rays: Vec<_> = (0..4000)
            .map(|_| {
                let aim = [noise.within(0.0, 2.0), noise.within(0.0, 2.0)];
                meadow.ray(from, aim, &mut noise)
            })
            .collect();
        load_bearing.insert(&rays);
    }
    let surface = load_bearing.surface();
    (load_bearing, surface)
}

/// What came of a meadow's cells.
#[derive(Debug)]
struct Outcome {
    /// Share of the cells that a ground is told of.
    told: f64,
    /// Share of these that it is within 3 cm of the truth.
    within: f64,
    /// Their mean error, m.
    mean_m: f64,
    /// The mean error of the mean of all returns, m.
    raw_m: f64,
}

fn outcome(meadow: &Meadow, seed: u64) -> Outcome {
    let (load_bearing, surface) = found(meadow, seed);
    let cells = surface.values().iter().enumerate();
    let all: Vec<_> = cells
        .filter_map(|(index, support)| {
            let cell = Cell::new((index % 20) as i32, (index / 20) as i32);
            let [x, y] = load_bearing.lattice.center_of(cell);
            let truth_m = meadow.ground_m(x, y);
            support.map(|one| [one.height_m, one.raw_m].map(|height_m| (height_m - truth_m).abs()))
        })
        .collect();
    let count = all.len() as f64;
    let mean = |which: usize| all.iter().map(|errors_m| errors_m[which]).sum::<f64>() / count;
    Outcome {
        told: count / 400.0,
        within: all.iter().filter(|errors_m| errors_m[0] <= 0.03).count() as f64 / count,
        mean_m: mean(0),
        raw_m: mean(1),
    }
}

#[test]
fn the_ground_under_grass_is_found_within_3_cm_and_the_raw_surface_is_not() {
    for seed in 0..20 {
        let mut noise = Noise::new(700 + seed);
        let meadow = Meadow {
            stems: noise.within(200.0, 600.0),
            tall_m: noise.within(0.15, 0.35),
            phase: noise.within(0.0, 6.0),
        };
        let found = outcome(&meadow, seed);
        let said = format!(
            "seed {seed}, {:.0} stems of {:.2} m: {found:?}",
            meadow.stems, meadow.tall_m
        );
        assert!(found.told >= 0.8, "{said}");
        assert!(found.within >= 0.95, "{said}");
        assert!(found.mean_m < 0.015, "{said}");
        assert!(found.raw_m > 0.03, "{said}");
    }
}

#[test]
fn bare_ground_is_the_ground() {
    let meadow = Meadow {
        stems: 1e-6,
        tall_m: 0.3,
        phase: 1.0,
    };
    let all = outcome(&meadow, 3);
    assert!(
        all.told > 0.99 && all.within > 0.99 && all.mean_m < 0.01,
        "{all:?}"
    );
    let (_, surface) = found(&meadow, 3);
    assert!(
        surface
            .values()
            .iter()
            .flatten()
            .all(|one| one.cover < 0.35)
    );
}

#[test]
fn no_ground_lies_where_a_ray_went_on() {
    let lattice = Lattice {
        origin_m: [0.0, 0.0],
        cell_m: 0.1,
    };
    let one = || LoadBearing::new(LoadBearingConfig::default(), lattice, [10, 1]).unwrap();
    // A tuft that returns at one height, as ground would, and rays that go through it lower down.
    let tuft = [SensorRay {
        from: [-1.0, 0.05, 1.0],
        to: [0.55, 0.05, 0.2],
    }; 6];
    let below = [SensorRay {
        from: [-1.0, 0.05, 0.3],
        to: [0.95, 0.05, 0.0],
    }; 6];
    let height_m = |load_bearing: &LoadBearing, col: i32| {
        let surface = load_bearing.surface();
        surface
            .get(Cell::new(col, 0))
            .copied()
            .flatten()
            .map(|support| support.height_m)
    };
    let mut alone = one();
    alone.insert(&tuft);
    assert!(height_m(&alone, 5).is_some_and(|height_m| (height_m - 0.2).abs() < 1e-9));
    let mut through = one();
    through.insert(&tuft);
    through.insert(&below);
    assert_eq!(height_m(&through, 5), None);
    assert!(height_m(&through, 9).is_some());
}

/// Claims that take seconds.
mod slow {
    use super::*;

    #[test]
    fn what_the_feet_felt_of_meadows_halves_the_error_of_the_raw_surface() {
        for seed in 0..20 {
            let mut noise = Noise::new(40 + seed);
            let mut learned = LearnedGround::new(LearnedGroundConfig::default()).unwrap();
            let (mut squares, mut raw) = (0.0, 0.0);
            for patch in 0..2 {
                // Grass that hides the ground nearly everywhere.
                let meadow = Meadow {
                    stems: noise.within(300.0, 900.0),
                    tall_m: noise.within(0.1, 0.4),
                    phase: noise.within(0.0, 6.0),
                };
                let (load_bearing, surface) = found(&meadow, 2 * seed + patch);
                for _ in 0..100 {
                    let cell = Cell::new(
                        noise.within(2.0, 18.0) as i32,
                        noise.within(2.0, 18.0) as i32,
                    );
                    let Some(support) = surface.get(cell).copied().flatten() else {
                        continue;
                    };
                    let [x, y] = load_bearing.lattice.center_of(cell);
                    let (canopy, truth_m) = (Canopy::from(support), meadow.ground_m(x, y));
                    let (height_m, _) = learned.predict(&canopy); // before a foot was there
                    squares += (height_m - truth_m) * (height_m - truth_m);
                    raw += (canopy.raw_m - truth_m) * (canopy.raw_m - truth_m);
                    learned.learn(&canopy, truth_m + noise.normal(0.005));
                }
            }
            let ratio = f64::sqrt(squares / raw);
            assert!(
                ratio <= 0.5,
                "seed {seed}: {ratio:.3} of the raw surface's error"
            );
        }
    }
}
