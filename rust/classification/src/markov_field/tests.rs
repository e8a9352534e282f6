//! Claims about smoothed labels.

use proptest::prelude::*;

use super::*;
use crate::moments::{MomentsConfig, PointClass, PointClasses};
use crate::synthetic::Noise;

/// A map of 40 x 40 cells with three regions, each cell read as another class than it is with probability 0.15, and the readings' costs.
fn regions(seed: u64) -> (Vec<usize>, Vec<usize>, Vec<Vec<f64>>) {
    let mut noise = Noise::new(seed);
    let edge = noise.within(12.0, 28.0);
    let middle = [noise.within(10.0, 30.0), noise.within(10.0, 30.0)];
    let mut truth = Vec::new();
    let mut read = Vec::new();
    for cell in 0..1600 {
        let [x, y] = [f64::from(cell % 40), f64::from(cell / 40)];
        let away = (x - middle[0]) * (x - middle[0]) + (y - middle[1]) * (y - middle[1]);
        let class = if away < 49.0 {
            2
        } else {
            usize::from(x > edge)
        };
        truth.push(class);
        let wrong = noise.within(0.0, 1.0) < 0.15;
        read.push(if wrong {
            (class + 1 + usize::from(noise.within(0.0, 1.0) < 0.5)) % 3
        } else {
            class
        });
    }
    let cost = |read: &usize| {
        let of = |label| -libm::log(if label == *read { 0.85 } else { 0.075 });
        (0..3).map(of).collect()
    };
    let costs = read.iter().map(cost).collect();
    (truth, read, costs)
}

fn wrong(found: &[usize], truth: &[usize]) -> usize {
    found.iter().zip(truth).filter(|(a, b)| a != b).count()
}

#[test]
fn of_isolated_errors_on_a_map_more_than_half_go() {
    for seed in 0..20 {
        let (truth, read, costs) = regions(seed);
        let field = MarkovField::of_grid(MarkovFieldConfig::default(), 40, 40).unwrap();
        let (before, after) = (wrong(&read, &truth), wrong(&field.labels(&costs), &truth));
        assert!(2 * after <= before, "seed {seed}: {before} to {after}");
    }
}

#[test]
fn of_isolated_errors_in_a_cloud_of_bush_wire_and_wall_more_than_half_go() {
    for seed in 0..20 {
        let mut noise = Noise::new(seed);
        let (points, truth) = crate::moments::tests::scene(seed, 0.1);
        // Measured with errors that stand alone: a tenth of the points is read as another class.
        let truth: Vec<usize> = truth.iter().map(|class| *class as usize - 1).collect();
        let read: Vec<usize> = (truth.iter())
            .map(|class| {
                if noise.within(0.0, 1.0) < 0.1 {
                    (class + 1) % 3
                } else {
                    *class
                }
            })
            .collect();
        let costs: Vec<Vec<f64>> = (read.iter())
            .map(|read| {
                (0..3)
                    .map(|label| -libm::log(if label == *read { 0.9 } else { 0.05 }))
                    .collect()
            })
            .collect();
        let field = MarkovField::of_cloud(MarkovFieldConfig::default(), &points).unwrap();
        let (before, after) = (wrong(&read, &truth), wrong(&field.labels(&costs), &truth));
        assert!(2 * after <= before, "seed {seed}: {before} to {after}");
    }
}

#[test]
fn what_the_moments_get_wrong_becomes_no_more() {
    let classes = PointClasses::new(MomentsConfig::default()).unwrap();
    for seed in 0..3 {
        let (points, truth) = crate::moments::tests::scene(seed, 0.25);
        let truth: Vec<usize> = truth.iter().map(|class| *class as usize - 1).collect();
        let saliencies = classes.saliencies(&points).unwrap();
        let costs: Vec<Vec<f64>> = (saliencies.iter())
            .map(|one| {
                let shares = one.map_or([1.0; 3], |one| [one.scatter, one.linear, one.surface]);
                shares.map(|share| -libm::log(share.max(0.01))).to_vec()
            })
            .collect();
        let alone: Vec<usize> = costs.iter().map(|costs| least(costs)).collect();
        let field = MarkovField::of_cloud(MarkovFieldConfig::default(), &points).unwrap();
        let (before, after) = (wrong(&alone, &truth), wrong(&field.labels(&costs), &truth));
        assert!(after <= before, "seed {seed}: {before} to {after}");
    }
    assert_eq!(PointClass::Scatter as usize, 1);
}

#[test]
fn nothing_has_no_labels() {
    let field = MarkovField::of_cloud(MarkovFieldConfig::default(), &[]).unwrap();
    assert!(field.labels(&[]).is_empty());
    assert!(
        MarkovField::of_grid(MarkovFieldConfig::default(), 0, 0)
            .unwrap()
            .labels(&[])
            .is_empty()
    );
}

/// The least energy of all labellings, written out.
fn least_energy(field: &MarkovField, costs: &[Vec<f64>], labels: usize) -> f64 {
    let count = costs.len() as u32;
    let written = (0..labels.pow(count)).map(|number| {
        let each: Vec<usize> = (0..count)
            .map(|cell| number / labels.pow(cell) % labels)
            .collect();
        field.energy(costs, &each)
    });
    written.fold(f64::INFINITY, f64::min)
}

proptest! {
    #[test]
    fn two_labels_on_a_small_grid_cost_the_least_of_all(
        costs in prop::collection::vec(prop::collection::vec(0.0..3.0_f64, 2), 12),
        smoothness in 0.0..2.0_f64,
    ) {
        let config = MarkovFieldConfig { smoothness, ..MarkovFieldConfig::default() };
        let field = MarkovField::of_grid(config, 4, 3).unwrap();
        let found = field.energy(&costs, &field.labels(&costs));
        prop_assert!((found - least_energy(&field, &costs, 2)).abs() < 1e-9);
    }

    #[test]
    fn three_labels_cost_at_most_twice_the_least_and_never_more_than_each_alone(
        costs in prop::collection::vec(prop::collection::vec(0.0..3.0_f64, 3), 9),
        smoothness in 0.0..2.0_f64,
    ) {
        let config = MarkovFieldConfig { smoothness, ..MarkovFieldConfig::default() };
        let field = MarkovField::of_grid(config, 3, 3).unwrap();
        let found = field.energy(&costs, &field.labels(&costs));
        let alone: Vec<usize> = costs.iter().map(|costs| least(costs)).collect();
        prop_assert!(found <= field.energy(&costs, &alone) + 1e-9);
        prop_assert!(found <= 2.0 * least_energy(&field, &costs, 3) + 1e-9);
    }
}
