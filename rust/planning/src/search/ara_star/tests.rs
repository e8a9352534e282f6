//! ARA* against the cheapest way, wherever it is interrupted.

use super::*;
use crate::search::Search;
use crate::search::testing::World;
use geometry::SplitMix64;

fn graph(world: &World) -> Graph<'_> {
    Graph {
        weights: &world.weights,
        cols: world.cols,
        links: None,
    }
}

fn found(search: &mut AraStar, world: &World, config: &AraStarConfig) -> Option<BoundedRoute> {
    let question = (
        |cell: usize| world.ending(cell),
        |cell: usize| world.remaining(cell),
    );
    search.run(graph(world), |_| true, world.start, question, config)
}

fn cheapest(world: &World) -> Option<f64> {
    let ending = |cell: usize| world.ending(cell);
    let remaining = |cell: usize| world.remaining(cell);
    let route = Search::default().run(&world.weights, world.cols, world.start, ending, remaining);
    Some(route?.cost)
}

#[test]
fn at_every_interrupt_the_way_costs_no_more_than_its_epsilon_times_the_cheapest() {
    let mut random = SplitMix64::new(1);
    let mut search = AraStar::default();
    let mut anytime = 0;
    for _ in 0..30 {
        let world = World::random(30, 25, &mut random);
        let Some(cheapest) = cheapest(&world) else {
            assert!(found(&mut search, &world, &AraStarConfig::default()).is_none());
            continue;
        };
        let mut before = f64::INFINITY;
        for expansions in (1..1500).step_by(7) {
            let config = AraStarConfig {
                expansions,
                ..AraStarConfig::default()
            };
            let BoundedRoute { route, epsilon } = found(&mut search, &world, &config).unwrap();
            assert!(epsilon <= config.epsilon);
            assert!(route.cost <= epsilon * cheapest + 1e-9, "{epsilon}");
            assert!(route.cost <= before + 1e-9);
            // What it says of itself is so.
            let steps = crate::search::cost_along(&route.cells, &world.weights, world.cols);
            let end = world.ending(*route.cells.last().unwrap() as usize).unwrap();
            assert!(steps + end <= route.cost + 1e-9);
            anytime += usize::from(epsilon > 1.0);
            before = route.cost;
        }
        assert!((before - cheapest).abs() < 1e-9);
    }
    assert!(anytime > 100);
}

#[test]
fn with_budget_enough_it_is_the_cheapest_and_says_so() {
    let mut random = SplitMix64::new(2);
    let mut search = AraStar::default();
    for _ in 0..300 {
        let world = World::random(30, 25, &mut random);
        let found = found(&mut search, &world, &AraStarConfig::default());
        match (found, cheapest(&world)) {
            (Some(found), Some(cost)) => {
                assert!((found.route.cost - cost).abs() < 1e-9);
                assert!(found.epsilon <= 1.0);
            }
            (found, cost) => assert_eq!(found.is_some(), cost.is_some()),
        }
    }
}

#[test]
fn the_same_question_has_the_same_answer_whatever_was_asked_before() {
    let mut random = SplitMix64::new(3);
    let config = AraStarConfig {
        expansions: 150,
        ..AraStarConfig::default()
    };
    let mut used = AraStar::default();
    for _ in 0..100 {
        let world = World::random(30, 25, &mut random);
        let again = found(&mut used, &world, &config);
        assert_eq!(again, found(&mut AraStar::default(), &world, &config));
    }
}
