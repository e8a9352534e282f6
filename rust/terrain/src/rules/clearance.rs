//! Rule: how far each cell is from the nearest obstacle, and from the nearest edge where there is any.

use crate::Terrain;

pub(super) fn apply(terrain: &mut Terrain) {
    terrain.distance.compute(&terrain.blocked, terrain.cols);
    if terrain.any_edge {
        terrain.edge_distance.compute(&terrain.edge, terrain.cols);
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
        assert!((terrain.edge_clearance_m(at) - 0.525).abs() < 1e-9);
    }
}
