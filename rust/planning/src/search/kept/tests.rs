//! Ways that stand are cheapest ways.

use super::*;
use crate::search::Search;
use crate::search::testing::World;
use geometry::SplitMix64;

fn fresh(world: &World) -> Option<Route> {
    let ending = |cell: usize| world.ending(cell);
    let remaining = |cell: usize| world.remaining(cell);
    Search::default().run(&world.weights, world.cols, world.start, ending, remaining)
}

#[test]
fn what_stands_is_a_cheapest_way_whatever_changed() {
    let mut random = SplitMix64::new(1);
    let (mut stood, mut all) = (0, 0);
    for seed in 0..60 {
        let side = if seed % 2 == 0 { 12 } else { 40 };
        let mut world = World::random(side, side, &mut random);
        if seed % 3 == 0 {
            // Nothing but open and blocked cells: where ways of the same cost are many, corners decide.
            for weight in world.weights.iter_mut().filter(|weight| weight.is_finite()) {
                *weight = 1.0;
            }
        }
        let mut kept = KeptRoute::default();
        for _ in 0..200 {
            let before = world.weights.clone();
            let changes = world.change(&mut random);
            if seed % 3 == 0 {
                for weight in world.weights.iter_mut().filter(|weight| weight.is_finite()) {
                    *weight = 1.0;
                }
            }
            let changes = changes.into_iter().map(|change| WeightChange {
                cell: change.cell,
                before: before[change.cell],
                after: world.weights[change.cell],
            });
            let stands = kept.stands(world.start, changes, |cell| world.remaining(cell));
            let found = fresh(&world);
            all += 1;
            let route = if let Some(stands) = stands {
                stood += 1;
                let cost = found.as_ref().map(|found| found.cost).unwrap();
                assert!((stands.cost - cost).abs() < 1e-6, "{} {cost}", stands.cost);
                assert_eq!(stands.cells[0] as usize, world.start);
                Some(stands)
            } else {
                match &found {
                    Some(found) => kept.keep(found, &world.weights, world.cols),
                    None => kept.forget(),
                }
                found
            };
            world.walk(route.as_ref(), &mut random);
        }
    }
    assert!(stood > all / 10, "{stood} of {all} stand");
}

#[test]
fn a_corner_that_opens_beside_the_way_ends_it() {
    // From the south west to the north east of four cells, the south east blocked, then open.
    let cost = |weights: &[f32]| {
        let ending = |cell: usize| (cell == 3).then_some(0.0);
        Search::default()
            .run(weights, 2, 0, ending, |_| 0.0)
            .unwrap()
    };
    let before = [1.0, f32::INFINITY, 1.0, 1.0];
    let mut kept = KeptRoute::default();
    kept.keep(&cost(&before), &before, 2);
    let opened = WeightChange {
        cell: 1,
        before: f32::INFINITY,
        after: 1.0,
    };
    let remaining = |cell: usize| octile((1 - cell % 2) as f64, (1 - cell / 2) as f64);
    assert!(cost(&[1.0; 4]).cost < cost(&before).cost);
    assert!(kept.stands(0, [opened], remaining).is_none());
    let slightly = WeightChange {
        after: 1.0,
        before: 1.0,
        cell: 1,
    };
    assert_eq!(
        kept.stands(0, [slightly], remaining).unwrap().cells,
        [0, 2, 3]
    );
}
