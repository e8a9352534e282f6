//! Rule: where the robot already stands too near to something it may leave, but come no nearer.

use crate::{Needs, Sight, Terrain};

pub(super) fn apply(terrain: &mut Terrain, sight: &Sight<'_>) {
    let stand = &sight.stand;
    if let Some(start) = terrain.index_at(stand.at_m) {
        terrain.clearance_at_start_m = terrain.clearance_m(start);
    }
    if !terrain.is_in_passage(stand) {
        open(terrain, stand.at_m);
    }
}

/// Opens what leads away from where the robot stands, m, if it stands too near to something.
pub fn open(terrain: &mut Terrain, start_m: [f64; 2]) {
    let Some(start) = terrain.index_at(start_m) else {
        return;
    };
    let Needs { body_m, feet_m, .. } = terrain.needs;
    let settings = terrain.settings;
    let (at_start_m, to_edge_m) = (terrain.clearance_m(start), terrain.edge_clearance_m(start));
    if at_start_m >= body_m && to_edge_m >= feet_m {
        return;
    }
    // The robot stands anywhere in its cell.
    let half_m = 0.5 * terrain.lattice.cell_m;
    let least_m = (at_start_m - half_m).min(body_m);
    let least_edge_m = (to_edge_m - half_m).min(feet_m);
    for index in 0..terrain.weights.len() {
        let near = || {
            let [x, y] = terrain.center_m(index);
            geometry::hypot(x - start_m[0], y - start_m[1]) <= settings.escape_range
        };
        let no_ground = terrain.blocked[index] || terrain.edge[index];
        let barred = terrain.weights[index].is_infinite() && !no_ground;
        if barred
            && near()
            && terrain.clearance_m(index) >= least_m
            && terrain.edge_clearance_m(index) >= least_edge_m
        {
            terrain.weights[index] = 1.0 + settings.escape_cost as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn who_stands_too_near_to_a_wall_may_leave_it_but_come_no_nearer() {
        let mut floor = Floor::new();
        floor.paint([0.1, -2.0], [0.2, 2.0], Surface::Obstacle(0.5));
        let sideways = floor.after("escape");
        let here = cell(&sideways, 0.025, 0.025);
        assert!(sideways.weights[here].is_infinite(), "it goes on sideways");
        floor.stand.heading_rad = std::f64::consts::FRAC_PI_2;
        let before = floor.before("escape");
        let terrain = floor.after("escape");
        let at = |x_m: f64| cell(&terrain, x_m, 0.025);
        assert!(before.weights[at(0.025)].is_infinite());
        assert_eq!(terrain.weights[at(0.025)], 21.0);
        assert!(terrain.weights[at(0.075)].is_infinite(), "it is nearer");
        let far = cell(&terrain, 0.025, 1.025);
        assert!(
            terrain.weights[far].is_infinite(),
            "it is far from the robot"
        );
    }
}
