//! On which side of the robot there is room, and which foot carries first by that: a walk begins with a shift of the weight, by half the
//! distance of the feet, away from what is beside the robot.

use robot::Side;
use terrain::support::obstacles_within;

use crate::Motion;
use crate::walking::WalkingBehaviour;
use crate::walking::tick::WayTick;

/// How many obstacle cells within a reach, m, lie to the left of the robot, each by the sine of its bearing; negative: to the right.
pub(super) fn obstacles_to_the_left(tick: &WayTick<'_>, reach_m: f64) -> f64 {
    let here_m = [tick.pose.x_m, tick.pose.y_m];
    obstacles_within(tick.situation.view, here_m, reach_m)
        .map(|(place_m, _)| libm::sin(tick.bearing_rad(place_m)))
        .sum()
}

impl WalkingBehaviour {
    /// The foot on the side with more room, where the shift of the weight could meet something; it matters while the robot stands.
    pub(super) fn carries_first(&self, tick: &WayTick<'_>) -> Option<Side> {
        if !tick.situation.standing || !matches!(self.motion, Motion::Walk(_)) {
            return None;
        }
        let to_the_left = obstacles_to_the_left(tick, self.radius_m + self.foot_side_m);
        if to_the_left > 0.0 {
            Some(Side::Right)
        } else if to_the_left < 0.0 {
            Some(Side::Left)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use super::*;
    use crate::walking::simulation::Simulation;

    /// The foot that is told to carry first when the robot sets out with a wall along its way, at `y_m`.
    fn carries_first(y_m: f64) -> Option<Side> {
        let mut simulation = Simulation::new(PlanarPose::default(), [1.5, 0.0]);
        let lattice = simulation.view.lattice;
        for step in -10..40 {
            let cell = lattice.cell_at(0.04 * f64::from(step), y_m);
            if let Some(surface) = simulation.view.cells.get_mut(cell) {
                *surface = mapping::Surface::Obstacle(0.3);
            }
        }
        simulation.boxes = vec![[[-0.5, y_m - 0.02], [1.5, y_m + 0.02]]];
        (0..6000).find_map(|_| {
            let command = simulation.tick().command;
            matches!(command.motion, Motion::Walk(_)).then_some(command.carries_first)
        })?
    }

    #[test]
    fn who_sets_out_beside_a_wall_shifts_its_weight_away_from_it() {
        assert_eq!(carries_first(0.18), Some(Side::Right));
        assert_eq!(carries_first(-0.18), Some(Side::Left));
        assert_eq!(carries_first(0.6), None);
    }
}
