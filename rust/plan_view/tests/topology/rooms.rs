//! Rooms and doorways against those of the plans.

use std::collections::BTreeMap;

use super::graph_of;
use super::plans::{House, house};

/// Matthews coefficient of the labels of the free cells, each true room matched with the one that covers most of it.
fn matthews(house: &House, labels: &[u32]) -> f64 {
    let mut shared: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    for (&truth, &label) in house.room_of.iter().zip(labels) {
        if truth != 0 {
            *shared.entry((truth, label)).or_default() += 1.0;
        }
    }
    let mut pairs: Vec<_> = shared.iter().map(|(&pair, &cells)| (cells, pair)).collect();
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (mut taken, mut given) = (BTreeMap::new(), BTreeMap::new());
    for &(_, (truth, label)) in &pairs {
        if label != 0 && !taken.contains_key(&truth) && !given.contains_key(&label) {
            let _ = (taken.insert(truth, label), given.insert(label, truth));
        }
    }
    // The coefficient for several classes (Gorodkin 2004).
    let (mut all, mut right) = (0.0, 0.0);
    let (mut of_truth, mut of_label): (BTreeMap<u32, f64>, BTreeMap<u32, f64>) = Default::default();
    for (&(truth, label), &cells) in &shared {
        let named = given.get(&label).copied().unwrap_or(1000 + label);
        all += cells;
        right += if named == truth { cells } else { 0.0 };
        *of_truth.entry(truth).or_default() += cells;
        *of_label.entry(named).or_default() += cells;
    }
    let cross: f64 = of_truth
        .iter()
        .map(|(room, cells)| cells * of_label.get(room).copied().unwrap_or(0.0))
        .sum();
    let square =
        |counts: &BTreeMap<u32, f64>| counts.values().map(|cells| cells * cells).sum::<f64>();
    (right * all - cross)
        / ((all * all - square(&of_label)) * (all * all - square(&of_truth))).sqrt()
}

#[test]
fn rooms_are_those_of_the_plan_and_doorways_lie_where_the_doors_are() {
    let mut coefficients = Vec::new();
    for seed in 0..20 {
        let house = house(seed);
        let rooms = graph_of(&house.free).rooms();
        coefficients.push(matthews(&house, rooms.room_of.values()));
        if rooms.count == house.rooms {
            assert_eq!(rooms.doorways.len(), house.doors, "seed {seed}");
        }
    }
    let mean = coefficients.iter().sum::<f64>() / 20.0;
    assert!(mean >= 0.95, "{mean}: {coefficients:.2?}");
}
