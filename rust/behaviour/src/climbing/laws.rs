//! Laws of the climb that hold whatever befalls the robot: what it sees and knows comes and goes at random.

use geometry::PlanarPose;
use proptest::prelude::*;

use super::simulation::{Simulation, straight};
use super::state::State;
use crate::machine::State as _;
use crate::{Motion, Pace};

/// What holds for a while: how long, ticks; whether the robot is blind, does not know where it is, has no plan; whether something
/// stands on the stairs, and whether the next step is lower than it looks.
type Spell = (u32, bool, bool, bool, bool, bool);

fn spell() -> impl Strategy<Value = Spell> {
    let seldom = || prop::bool::weighted(0.12);
    (
        20..900u32,
        seldom(),
        seldom(),
        seldom(),
        seldom(),
        prop::bool::weighted(0.05),
    )
}

fn befall(simulation: &mut Simulation, (_, blind, lost, planless, occupied, sunk): Spell) {
    (simulation.blind, simulation.lost) = (blind, lost);
    simulation.planning = !planless;
    simulation.obstacle = occupied.then_some([0.9, 0.0, 0.1]);
    simulation.paint();
    if sunk && simulation.ground_m() < 0.01 {
        simulation.sunk_m[2] = 0.03;
    }
}

/// Whether a state may follow another within a tick: being blind may be over in the tick in which it begins.
fn follows(before: &State, state: &State) -> bool {
    let blind = State::Blind { looks: false };
    let through_blind = before.may_become(&blind) && blind.may_become(state);
    state.is_kind_of(before) || before.may_become(state) || through_blind
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn whatever_befalls_a_climb_only_legal_states_follow_and_who_refuses_stands_for_ever(
        spells in prop::collection::vec(spell(), 1..25), yaw_rad in -0.6..0.6f64, x_m in -0.2..0.2f64, continuous in any::<bool>(),
        height_m in prop::option::of(Just(0.12)), unseen_edge in prop::bool::weighted(0.1),
    ) {
        let pace = if continuous { Pace::Continuous } else { Pace::StepByStep };
        let start = PlanarPose::new(x_m, 0.0, yaw_rad);
        let course = straight(0.6, &[(0.03, 0.12), (0.03, 0.12), (0.03, 0.12), (0.03, 0.5)], 0.4);
        let mut simulation = Simulation::new(start, course, [1.15, 0.0], pace);
        simulation.goal.height_m = height_m;
        simulation.unseen_edge_m = unseen_edge.then_some(0.3);
        let mut before = State::Walk;
        for spell in spells {
            befall(&mut simulation, spell);
            for _ in 0..spell.0 {
                let decision = simulation.tick();
                let state = simulation.behaviour.machine.state().clone();
                prop_assert!(follows(&before, &state), "{:?} -> {:?}", before, state);
                if before.refusal().is_some() {
                    prop_assert_eq!(&decision.command.motion, &Motion::Stand);
                }
                before = state;
            }
        }
    }
}
