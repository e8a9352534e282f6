//! Rule: how far each cell is from the nearest obstacle, and from the nearest edge where there is any.

use crate::Terrain;
use crate::rules::edge_costs::EdgeCostsConfig;

/// Edges further away than they matter to anyone count as far away.
pub(super) fn apply(terrain: &mut Terrain, config: &EdgeCostsConfig) {
    terrain.distance.compute(&terrain.blocked, terrain.cols);
    if terrain.any_edge {
        let soft_m = config.reach * terrain.settings.soft_range;
        // Feet need that much room; a cell more, as an edge lies between cells and the robot stands anywhere in its own.
        let reach = ((terrain.needs.feet_m + soft_m) / terrain.lattice.cell_m).ceil() + 1.0;
        (terrain.edge_distance).compute_within(&terrain.edge, terrain.cols, reach as usize);
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn an_obstacle_is_as_far_as_its_cells_middle_and_an_edge_lies_between_cells() {
        let mut floor = Floor::new();
        floor.paint([0.5, -0.3], [0.7, 0.3], Surface::Obstacle(0.5));
        floor.paint([-2.0, -2.0], [-0.5, 2.0], Surface::Floor(-0.2));
        let terrain = floor.after("clearance");
        let at = cell(&terrain, 0.025, 0.025);
        assert!((terrain.clearance_m(at) - 0.5).abs() < 1e-9);
        let beside = cell(&terrain, -0.375, 0.025);
        assert!((terrain.edge_clearance_m(beside) - 0.125).abs() < 1e-9);
    }

    #[test]
    fn an_edge_that_is_further_than_it_matters_is_far_away() {
        let mut floor = Floor::new();
        floor.paint([-2.0, -2.0], [-1.0, 2.0], Surface::Floor(-0.2));
        let terrain = floor.after("clearance");
        let away_m = |x_m: f64| terrain.edge_clearance_m(cell(&terrain, x_m, 0.025));
        let enough_m = terrain.needs.feet_m + terrain.settings.soft_range;
        assert!(away_m(-0.9) < 0.2 && away_m(1.5) > enough_m);
    }
}
