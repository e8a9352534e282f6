//! Rule: a metre costs more the nearer it is to an obstacle, may not be walked where the robot has no room, and costs more where nothing
//! was seen yet.

use crate::{Terrain, rules::by_distance::Costs};

/// What a length costs by its squared distance to what is blocked. Reused.
#[derive(Debug, Clone, Default)]
pub(super) struct ObstacleCosts {
    costs: Costs,
}

impl ObstacleCosts {
    pub(super) fn apply(&mut self, terrain: &mut Terrain) {
        let settings = terrain.settings;
        let (cell_m, body_m) = (terrain.lattice.cell_m, terrain.needs.body_m);
        self.costs
            .fill(&settings, body_m, settings.soft_range, |cells| {
                cells * cell_m
            });
        let unseen = settings.unknown_cost as f32;
        terrain.weights.clear();
        let squared = &terrain.distance.squared;
        let cells = squared.iter().zip(&terrain.unknown);
        let weights = cells.map(|(&squared, &unknown)| {
            let unseen = if unknown { unseen } else { 0.0 };
            self.costs.at(squared) + unseen
        });
        terrain.weights.extend(weights);
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn a_metre_costs_more_beside_a_wall_and_where_nothing_was_seen_and_is_closed_where_there_is_no_room()
     {
        let mut floor = Floor::new();
        floor.paint([0.5, -2.0], [0.6, 2.0], Surface::Obstacle(0.5));
        floor.paint([-1.0, -0.3], [-0.5, 0.3], Surface::Unknown);
        let terrain = floor.after("obstacle_costs");
        let cost = |x_m: f64| terrain.weights[cell(&terrain, x_m, 0.025)];
        assert!(cost(0.375).is_infinite());
        assert!(cost(0.325) > cost(0.275) && cost(0.275) > 1.0);
        assert_eq!((cost(0.025), cost(-0.725)), (1.0, 2.0));
    }
}
