//! What a climb without stops promises.

use geometry::PlanarPose;

use crate::Outcome;
use crate::climbing::Pace;
use crate::climbing::simulation::{Simulation, straight};

#[test]
fn steps_too_high_for_a_climb_without_stops_are_climbed_with_both_feet_on_each() {
    let mut simulation = Simulation::new(
        PlanarPose::default(),
        straight(
            0.6,
            &[(0.05, 0.12), (0.05, 0.12), (0.05, 0.12), (0.05, 0.33)],
            0.33,
        ),
        [1.15, 0.0],
        Pace::Continuous,
    );
    let (outcome, _) = simulation.run(60.0);
    assert_eq!(outcome, Some(Outcome::GoalReached));
    for height_m in [0.05, 0.1, 0.15] {
        let on_it = simulation
            .landings
            .iter()
            .filter(|(_, foot)| (foot.height_m - height_m).abs() < 1e-6);
        assert_eq!(on_it.count(), 2, "{height_m}");
    }
}
