//! Claims about what a walk does that comes upon something.

use geometry::PlanarPose;

use super::simulation::Simulation;
use crate::Outcome;

#[test]
fn a_walk_upon_an_unseen_step_stops_and_tries_again_before_it_is_given_up() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.5, 0.0]);
    simulation.unseen_edge_m = Some(0.5);
    let (outcome, _) = simulation.run(120.0);
    assert!(
        matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("blocked: the feet")),
        "{outcome:?} {:?}",
        simulation.states
    );
    let stops = simulation.states.iter().filter(|(name, _)| *name == "stop");
    assert_eq!(stops.count(), 3, "{:?}", simulation.states);
    assert!(simulation.pose.x_m <= 0.5);
}

#[test]
fn who_has_met_something_steps_back_from_it_before_it_walks_on() {
    let mut simulation = Simulation::new(PlanarPose::default(), [1.5, 0.0]);
    (simulation.unseen_edge_m, simulation.feels) = (Some(0.5), true);
    let (outcome, _) = simulation.run(120.0);
    let Some(Outcome::Refused(reason)) = &outcome else {
        panic!("{outcome:?} {:?}", simulation.states);
    };
    assert!(
        reason.starts_with("blocked: a foot met something at (0.56, "),
        "{reason}"
    );
    let after = (simulation.states.windows(2)).find(|pair| pair[0].0 == "step_back");
    let [_, (_, pose)] = after.unwrap() else {
        panic!("{:?}", simulation.states);
    };
    let away_m = 0.56 - pose.x_m;
    assert!((0.18..0.26).contains(&away_m), "{away_m}");
}
