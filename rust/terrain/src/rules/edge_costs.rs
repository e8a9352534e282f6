//! Rule: a metre costs more the nearer the feet come to an edge, and may not be walked on one.

use settings::{SHARE, settings};

use crate::{Terrain, rules::by_distance::Costs};

settings! {
    /// What being near to an edge costs.
    pub struct EdgeCostsConfig("navigation.terrain.edge_costs") {
        /// Being near to an edge costs up to this share of `soft_range` beyond the room that the feet need.
        reach: f64 = 0.5, "1", SHARE;
    }
}

/// What a length costs by its squared distance to edges. Reused.
#[derive(Debug, Clone, Default)]
pub(super) struct EdgeCosts {
    costs: Costs,
}

impl EdgeCosts {
    pub(super) fn apply(&mut self, terrain: &mut Terrain, config: &EdgeCostsConfig) {
        if !terrain.any_edge {
            return;
        }
        let settings = terrain.settings;
        let (cell_m, feet_m) = (terrain.lattice.cell_m, terrain.needs.feet_m);
        let soft_m = config.reach * settings.soft_range;
        // An edge lies between the cells beside it.
        self.costs
            .fill(&settings, feet_m, soft_m, |cells| (cells + 0.5) * cell_m);
        let squared = &terrain.edge_distance.squared;
        for (weight, &squared) in terrain.weights.iter_mut().zip(squared) {
            *weight += self.costs.at(squared) - 1.0;
        }
        for (weight, &edge) in terrain.weights.iter_mut().zip(&terrain.edge) {
            if edge {
                *weight = f32::INFINITY;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn nobody_walks_on_an_edge_or_so_near_that_a_foot_comes_over_it() {
        let mut floor = Floor::new();
        floor.paint([0.5, -2.0], [2.0, 2.0], Surface::Floor(-0.2));
        let terrain = floor.after("edge_costs");
        let cost = |x_m: f64| terrain.weights[cell(&terrain, x_m, 0.025)];
        assert!(cost(0.475).is_infinite() && cost(0.425).is_infinite());
        assert!(cost(0.375) > 1.0 && cost(0.375).is_finite());
        assert_eq!(cost(0.025), 1.0);
        let level = Floor::new().after("edge_costs");
        assert!(level.weights.iter().all(|&weight| weight == 1.0));
    }
}
