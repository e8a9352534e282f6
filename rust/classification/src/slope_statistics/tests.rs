//! Claims about made-up ground with boxes, ditches and banks.

use proptest::prelude::*;

use super::*;
use crate::synthetic::Noise;

/// Side of a cell, m.
pub(crate) const CELL_M: f64 = 0.05;
const SIDE: usize = 60;

/// Ground of 3 m x 3 m: it rolls gently, and has boxes and plates, a ditch and a bank.
struct Site {
    phase: f64,
    /// Corner, size and height of each, m: negative for a hole.
    blocks: Vec<[f64; 5]>,
    /// Where a bank begins, and how steeply it rises.
    bank: [f64; 2],
}

impl Site {
    fn new(noise: &mut Noise) -> Self {
        let mut block = |height_m| {
            let [x, y] = [noise.within(0.2, 2.0), noise.within(0.2, 2.5)];
            [
                x,
                y,
                noise.within(0.2, 0.6),
                noise.within(0.2, 0.6),
                height_m,
            ]
        };
        let blocks = vec![
            block(0.1),
            block(0.25),
            block(-0.12),
            block(0.015),
            block(0.01),
        ];
        Self {
            phase: noise.within(0.0, 6.0),
            blocks,
            bank: [noise.within(2.5, 2.7), noise.within(0.7, 1.2)],
        }
    }

    fn height_m(&self, x: f64, y: f64) -> f64 {
        let rolling_m = 0.08 * libm::sin(1.3 * x + self.phase) + 0.05 * libm::sin(2.0 * y);
        let blocks = self.blocks.iter();
        let on = blocks.filter(|[left, low, wide, long, _]| {
            (*left..left + wide).contains(&x) && (*low..low + long).contains(&y)
        });
        let [begin, slope] = self.bank;
        rolling_m + on.map(|block| block[4]).sum::<f64>() + slope * (x - begin).max(0.0)
    }

    /// Whether a foot of 8 cm around a place would meet a step of 4 cm or a slope of 0.45.
    fn is_obstacle(&self, x: f64, y: f64) -> bool {
        let fine_m = 0.02;
        let steps = (-4..=4).flat_map(|row| (-4..=4).map(move |col| (col, row)));
        let mut steep = 0;
        for (col, row) in steps {
            let at = [x + f64::from(col) * fine_m, y + f64::from(row) * fine_m];
            let here_m = self.height_m(at[0], at[1]);
            let along_m = self.height_m(at[0] + fine_m, at[1]) - here_m;
            let across_m = self.height_m(at[0], at[1] + fine_m) - here_m;
            if along_m.abs() > 0.04 || across_m.abs() > 0.04 {
                return true;
            }
            steep += usize::from(hypot(along_m, across_m) > 0.45 * fine_m);
        }
        steep > 9 * 9 / 2
    }
}

/// A noisy map of a site, one cell in ten unknown, and which cells are obstacles.
pub(crate) fn site(seed: u64, noise_m: f64) -> (Grid<Option<f64>>, Vec<bool>) {
    let mut noise = Noise::new(seed);
    let site = Site::new(&mut noise);
    let mut heights_m = Grid::filled(SIDE, SIDE, None);
    let mut truth = Vec::new();
    for (index, height_m) in heights_m.values_mut().iter_mut().enumerate() {
        let [x, y] = [index % SIDE, index / SIDE].map(|at| (at as f64 + 0.5) * CELL_M);
        truth.push(site.is_obstacle(x, y));
        if noise.within(0.0, 1.0) < 0.9 {
            *height_m = Some(site.height_m(x, y) + noise.normal(noise_m));
        }
    }
    (heights_m, truth)
}

/// The mean of the shares of obstacles and of traversable cells that are told right; what is not told is wrong.
pub(crate) fn accuracy(found: &[Option<bool>], truth: &[bool]) -> f64 {
    let of = |kind: bool| {
        let cells = found.iter().zip(truth).filter(|(_, truth)| **truth == kind);
        let right = cells
            .clone()
            .filter(|(found, _)| **found == Some(kind))
            .count();
        right as f64 / cells.count() as f64
    };
    f64::midpoint(of(true), of(false))
}

#[test]
fn obstacles_are_told_from_what_can_be_walked_nine_times_in_ten() {
    let statistics = SlopeStatistics::new(SlopeStatisticsConfig::default()).unwrap();
    for seed in 0..20 {
        let (heights_m, truth) = site(seed, 0.005);
        let found = statistics.obstacles(&heights_m, CELL_M);
        let right = accuracy(found.values(), &truth);
        assert!(right >= 0.9, "seed {seed}: {right:.3}");
    }
}

#[test]
fn where_little_is_known_nothing_is_said() {
    let statistics = SlopeStatistics::new(SlopeStatisticsConfig::default()).unwrap();
    let mut heights_m = Grid::filled(9, 9, None);
    assert!(
        statistics
            .obstacles(&heights_m, CELL_M)
            .values()
            .iter()
            .all(Option::is_none)
    );
    for col in 0..9 {
        *heights_m.get_mut(Cell::new(col, 4)).unwrap() = Some(1.0);
    }
    // Five cells, and all on one line.
    assert!(
        statistics
            .obstacles(&heights_m, CELL_M)
            .values()
            .iter()
            .all(Option::is_none)
    );
}

proptest! {
    #[test]
    fn a_plane_has_its_slope_and_no_step(
        x in -1.0..1.0_f64, y in -1.0..1.0_f64, up in -1e4..1e4_f64,
    ) {
        let mut heights_m = Grid::filled(7, 7, None);
        for (index, height_m) in heights_m.values_mut().iter_mut().enumerate() {
            *height_m = Some(up + CELL_M * (x * (index % 7) as f64 + y * (index / 7) as f64));
        }
        let statistics = SlopeStatistics::new(SlopeStatisticsConfig::default()).unwrap();
        for one in statistics.statistics(&heights_m, CELL_M).values().iter().flatten() {
            prop_assert!((one.slope - hypot(x, y)).abs() < 1e-6);
            prop_assert!(one.step_m < 1e-8 && one.roughness_m < 1e-8);
        }
    }
}
