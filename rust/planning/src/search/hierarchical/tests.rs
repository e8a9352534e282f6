//! Ways from coarse to fine against A* over the whole grid.

use geometry::SplitMix64;

use super::*;
use crate::search::testing::{World, below};

/// Both ways: coarse to fine, and over everything.
fn both(search: &mut HierarchicalSearch, world: &World, links: &Links) -> [Option<Route>; 2] {
    let (ending, nothing) = (|cell| world.ending(cell), |_| 0.0);
    let mut plain = Search::default();
    let asked = (ending, nothing);
    search.read(&world.weights, world.cols);
    let with = (&mut plain, Some(links));
    let coarse_to_fine = search.run(with, |_| true, world.start, &world.ends, asked);
    let graph = Graph {
        weights: &world.weights,
        cols: world.cols,
        links: Some(links),
    };
    let over_all = plain.run_linked(graph, |_| true, world.start, ending, nothing);
    [coarse_to_fine, over_all]
}

#[test]
fn there_is_a_way_exactly_where_there_is_one_over_the_grid_also_after_changes_and_over_links() {
    let mut random = SplitMix64::new(8);
    let (mut found, mut missing) = (0, 0);
    for _ in 0..40 {
        let mut world = World::random(31, 26, &mut random);
        let config = HierarchicalConfig {
            local_map: 4 + below(9, &mut random),
            gate: 1 + below(6, &mut random),
        };
        let mut search = HierarchicalSearch::new(config);
        let mut links = Links::default();
        for _ in 0..20 {
            links.clear(world.weights.len());
            for _ in 0..below(4, &mut random) {
                let [from, to] = [0; 2].map(|_| below(world.weights.len(), &mut random));
                let _ = links.add(from, to, 5.0);
            }
            let [coarse, plain] = both(&mut search, &world, &links);
            assert_eq!(coarse.is_some(), plain.is_some());
            if let (Some(coarse), Some(plain)) = (&coarse, &plain) {
                assert!(coarse.cost >= plain.cost - 1e-6);
                found += 1;
            } else {
                missing += 1;
            }
            let _ = world.change(&mut random);
            world.walk(plain.as_ref(), &mut random);
        }
    }
    assert!(found > 200 && missing > 20, "{found} found, {missing} not");
}

#[test]
fn what_changed_is_found_as_it_would_be_anew() {
    let mut random = SplitMix64::new(2);
    let mut world = World::random(40, 33, &mut random);
    let links = Links::default();
    let mut kept = HierarchicalSearch::default();
    kept.config.local_map = 8;
    for _ in 0..50 {
        let mut anew = HierarchicalSearch::new(kept.config.clone());
        let [known, _] = both(&mut kept, &world, &links);
        let [new, _] = both(&mut anew, &world, &links);
        assert_eq!(known, new);
        let _ = world.change(&mut random);
    }
}
