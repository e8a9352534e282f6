//! Rule: slopes that are too steep to be walked on are edges, of which no stair is one.

use crate::Terrain;

pub(super) fn apply(terrain: &mut Terrain) {
    for index in terrain.slopes.too_steep() {
        terrain.edge[index] = true;
        terrain.any_edge = true;
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Floor, cell};

    #[test]
    fn a_slope_is_an_edge_where_it_is_too_steep_to_be_walked_on() {
        let mut floor = Floor::new();
        floor.tilt([0.5, -0.5], [1.0, 0.5], 0.15);
        floor.tilt([-1.0, -0.5], [-0.5, 0.5], -0.25);
        let terrain = floor.after("steep_slopes");
        let edge = |x_m: f64| terrain.edge[cell(&terrain, x_m, 0.025)];
        assert!(edge(-0.725) && !edge(0.725));
        assert!(!terrain.open[cell(&terrain, -0.725, 0.025)]);
    }
}
