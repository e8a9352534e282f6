//! Rule: what ends higher above the robot's feet than a step is an obstacle to its body, flat as its top may be, unless it is part of a
//! staircase.

use crate::{Sight, Terrain};

pub(super) fn apply(terrain: &mut Terrain, sight: &Sight<'_>) {
    if !terrain.any_edge {
        return;
    }
    let highest_m = sight.stand.height_m + terrain.needs.limits.step_m;
    for (index, &edge) in terrain.edge.iter().enumerate() {
        let tall = f64::from(terrain.height_m[index]) > highest_m;
        if edge && tall && !terrain.stairs.is_near_climbable(index) {
            terrain.blocked[index] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn the_edge_of_a_high_box_is_an_obstacle_and_that_of_a_low_one_is_not() {
        let mut floor = Floor::new();
        floor.paint([0.3, -0.5], [0.6, 0.5], Surface::Floor(0.3));
        floor.paint([-0.6, -0.5], [-0.3, 0.5], Surface::Floor(0.04));
        let terrain = floor.after("tall_edges");
        let blocked = |x_m: f64| terrain.blocked[cell(&terrain, x_m, 0.025)];
        assert!(blocked(0.325) && !blocked(0.275), "from the box on");
        assert!(!blocked(0.425), "not well inside");
        assert!(!blocked(-0.325));
    }
}
