//! What a walk promises that comes upon a step which nobody saw.

use geometry::PlanarPose;

use crate::Outcome;
use crate::climbing::simulation::Simulation;
use crate::climbing::tests::up;

fn before_an_unseen_edge() -> Simulation {
    let mut simulation = up(PlanarPose::default());
    simulation.unseen_edge_m = Some(0.2);
    simulation
}

#[test]
fn a_walk_that_comes_upon_an_unseen_step_looks_and_goes_on() {
    let mut simulation = before_an_unseen_edge();
    simulation.run_until(60.0, Simulation::has_stumbled);
    simulation.run_until(5.0 + simulation.now_s(), Simulation::stands);
    simulation.unseen_edge_m = None;
    let (outcome, _) = simulation.run(120.0);
    assert_eq!(outcome, Some(Outcome::GoalReached));
}

#[test]
fn a_walk_that_comes_upon_it_again_and_again_is_given_up_where_it_is() {
    let mut simulation = before_an_unseen_edge();
    let (outcome, _) = simulation.run(120.0);
    assert!(
        matches!(&outcome, Some(Outcome::Refused(reason)) if reason.starts_with("blocked: ")),
        "{outcome:?} {:?}",
        simulation.states
    );
    assert!(simulation.pose().x_m <= 0.2);
}
