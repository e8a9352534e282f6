//! What a foot met, in the map.

use geometry::{Map, Point, Pose, Robot};
use localization::Estimate;
use mapping::{FeltPlace, FloorView, Surface};
use walking::{Met, Walker};

use crate::Perception;

/// Tells the map what a foot met at the last tick.
pub(crate) fn tell(walker: &dyn Walker, estimate: &Estimate, perception: &mut Perception) {
    if let Some(met) = walker.met() {
        let world_model = &mut perception.world_model;
        let felt = in_map(&met, &estimate.map_from_robot, world_model.view());
        world_model.feel(felt);
    }
}

/// What the feet of a robot that believes to be here met. A foot on something lifts the robot: the ground is no higher than the map's.
fn in_map(met: &Met, map_from_robot: &Pose<Map, Robot>, view: &FloorView) -> FeltPlace {
    let at = *map_from_robot * Point::<Robot>::new(met.at.x_m, met.at.y_m, met.height_m);
    let stands = map_from_robot.origin().inner;
    let lifted_m = match view.at(stands.x, stands.y) {
        Surface::Floor(ground_m) => (stands.z - f64::from(ground_m)).max(0.0),
        Surface::Unknown | Surface::Obstacle(_) => 0.0,
    };
    FeltPlace {
        at_m: [at.inner.x, at.inner.y],
        heading_rad: map_from_robot.yaw_rad() + met.at.yaw_rad,
        top_m: at.inner.z - lifted_m,
        ground_m: stands.z - lifted_m,
        half_width_m: met.half_width_m,
        thing: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Grid, Lattice, PlanarPose};
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_thing_before_the_feet_lies_where_the_robot_faces_and_as_high_above_its_ground() {
        let met = Met {
            at: PlanarPose::new(0.06, 0.04, 0.0),
            height_m: 0.015,
            half_width_m: 0.0375,
        };
        let lattice = Lattice {
            origin_m: [0.0, 0.0],
            cell_m: 1.0,
        };
        let view = |surface| FloorView::new(lattice, Grid::filled(3, 3, surface), 9);
        let robot = Pose::from_yaw(1.0, 2.0, 0.1, FRAC_PI_2);
        let felt = in_map(&met, &robot, &view(Surface::Unknown));
        assert!((felt.at_m[0] - 0.96).abs() < 1e-12 && (felt.at_m[1] - 2.06).abs() < 1e-12);
        assert!((felt.top_m - 0.115).abs() < 1e-12);
        assert!((felt.heading_rad - FRAC_PI_2).abs() < 1e-12);
        // The map says that it stands 12 mm above the ground.
        let lifted = in_map(&met, &robot, &view(Surface::Floor(0.088)));
        assert!((lifted.top_m - 0.103).abs() < 1e-6);
        assert!(lifted.told().contains("15 mm"), "{}", lifted.told());
        let sunk = in_map(&met, &robot, &view(Surface::Floor(0.12)));
        assert!((sunk.top_m - 0.115).abs() < 1e-12);
    }
}
