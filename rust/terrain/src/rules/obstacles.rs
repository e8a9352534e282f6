//! Rule: what the view shows as an obstacle stands there, but a riser beside a stair is none; what it does not show is unknown.

use mapping::Surface;
use settings::{settings, within};

use crate::{Sight, Terrain};

settings! {
    /// What stands there, and what is only a riser.
    pub struct ObstaclesConfig("navigation.terrain.obstacles") {
        /// An obstacle on a stair is higher than the stair by more than this: a riser that is taken for one is not.
        riser: f32 = 0.05, "m", within(0.0, 1.0);
    }
}

pub(super) fn apply(terrain: &mut Terrain, sight: &Sight<'_>, config: &ObstaclesConfig) {
    let riser_m = config.riser;
    let Terrain {
        blocked,
        unknown,
        stairs,
        ..
    } = terrain;
    let surfaces = sight.view.cells.values();
    blocked.clear();
    blocked.extend((surfaces.iter()).map(|surface| matches!(surface, Surface::Obstacle(_))));
    unknown.clear();
    unknown.extend((surfaces.iter()).map(|surface| *surface == Surface::Unknown));
    if !stairs.any {
        return;
    }
    let cells = blocked.iter_mut().zip(unknown).zip(surfaces).enumerate();
    for (index, ((blocked, unknown), surface)) in cells {
        if let Surface::Obstacle(top_m) = *surface {
            *blocked = stairs.is_obstacle(index, top_m, riser_m);
            *unknown = !*blocked;
        }
        *unknown &= !stairs.covers(index);
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell, stair};

    #[test]
    fn a_riser_beside_a_stair_is_unknown_and_what_stands_on_it_an_obstacle() {
        let mut floor = Floor::new();
        floor.stairs.stairs = vec![stair(0.5, 0.4, 0.04, 0.6)];
        floor.paint([0.45, -0.3], [0.5, 0.3], Surface::Obstacle(0.06));
        floor.paint([0.6, -0.3], [0.65, 0.3], Surface::Obstacle(0.3));
        floor.paint([0.7, -0.3], [0.75, 0.3], Surface::Unknown);
        floor.paint([-1.0, -0.3], [-0.9, 0.3], Surface::Obstacle(0.06));
        let terrain = floor.after("obstacles");
        let known = |x_m: f64| {
            let at = cell(&terrain, x_m, 0.025);
            (terrain.blocked[at], terrain.unknown[at])
        };
        assert_eq!(known(0.475), (false, true));
        assert_eq!(known(0.625), (true, false));
        assert_eq!(known(0.725), (false, false), "the stair is known there");
        assert_eq!(known(-0.925), (true, false), "no stair is near");
        assert_eq!(known(0.225), (false, false));
    }
}
