//! Laws that hold for every state of all behaviours.

use geometry::{Grid, Lattice, Pose};
use localization::Estimate;
use mapping::{FloorView, Surface};
use planning::Goal;
use proptest::prelude::*;
use stairs::Staircase;

use super::*;
use crate::{Gaze, Stepping, climbing, footsteps, walking};

const LIMITS: Limits = Limits {
    blind_after_s: 1.0,
    patience: 4.0,
    blind_limit_s: 4.05,
    dark: (0.0, 0.3),
    idle_limit_s: 9.0,
    idle_words: "nothing could be done",
    place_words: ", here",
};
const TICK_S: f64 = 0.1;

/// What a robot knows that stands somewhere.
struct World {
    estimate: Estimate,
    view: FloorView,
    stairs: Staircase,
    goal: Goal,
}

impl World {
    fn new(lost: bool) -> Self {
        Self {
            estimate: Estimate {
                time_ns: 0,
                map_from_robot: Pose::identity(),
                map_from_odometry: Pose::identity(),
                lost,
            },
            view: FloorView::new(
                Lattice {
                    origin_m: [0.0, 0.0],
                    cell_m: 0.04,
                },
                Grid::filled(1, 1, Surface::Unknown),
                0,
            ),
            stairs: Staircase::default(),
            goal: Goal {
                x_m: 1.0,
                y_m: 0.0,
                radius_m: 0.1,
                height_m: None,
            },
        }
    }

    fn at(&self, tick: u64, sees: bool) -> Situation<'_> {
        let time_ns = tick * 100_000_000;
        Situation {
            time_ns,
            estimate: &self.estimate,
            view: &self.view,
            stairs: &self.stairs,
            plan: None,
            goal: &self.goal,
            last_goal: true,
            soles: crate::walking::simulation::SOLES,
            standing: true,
            takes_footsteps: true,
            stepping: Stepping::default(),
            gaze: Gaze::default(),
            frames_used: if sees { tick } else { 0 },
            last_frame_ns: sees.then_some(time_ns),
            measured_share: Some(1.0),
        }
    }
}

fn keep_time<S: State>(machine: &mut Machine<S>, situation: &Situation<'_>) {
    let tick = machine.read(situation);
    machine.keep_time(&tick);
}

/// Every pair of states: what may follow is entered, and its time begins; in a state that is on nothing begins.
fn assert_enters_what_may_follow<S: State>(all: &[S]) {
    let world = World::new(false);
    for from in all {
        for to in all {
            let follows = from.may_become(to) && !from.is_kind_of(to);
            if !(follows || from.is_kind_of(to)) {
                continue;
            }
            let mut machine = Machine::new(from.clone(), LIMITS);
            for tick in 0..5 {
                keep_time(&mut machine, &world.at(tick, true));
            }
            assert_eq!(machine.enter(to.clone()), follows, "{from:?} {to:?}");
            assert!(machine.state().is_kind_of(to));
            assert_eq!(machine.lasted_s() == 0.0, follows, "{from:?} {to:?}");
        }
    }
}

/// A refusal is final and says why; every other state can be left, and all but being at the goal by giving up.
fn assert_refusing_is_final<S: State>(all: &[S]) {
    let refused = S::refuse("because".to_owned());
    assert_eq!(refused.refusal(), Some("because"));
    assert!(all.iter().all(|next| !refused.may_become(next)));
    for state in all.iter().filter(|state| state.refusal().is_none()) {
        let ways_out = all.iter().filter(|next| !next.is_kind_of(state));
        assert!(ways_out.into_iter().any(|next| state.may_become(next)));
        assert!(
            state.may_become(&refused) || !state.is_interruptible(),
            "{state:?}"
        );
    }
}

/// Whatever the state, a robot that sees nothing, or does nothing for its goal, is interrupted in bounded time.
fn assert_waits_in_bounded_time<S: State>(all: &[S]) {
    let world = World::new(false);
    for state in all.iter().filter(|state| state.is_interruptible()) {
        for sees in [false, true] {
            let mut machine = Machine::new(state.clone(), LIMITS);
            let waited = (0..1000).find(|&tick| {
                let situation = world.at(tick, sees);
                keep_time(&mut machine, &situation);
                let tick = machine.read(&situation);
                machine.interruption(&tick, || false).is_some()
            });
            let bound_s = if sees {
                LIMITS.idle_limit_s
            } else if state.is_patient() {
                LIMITS.patience * LIMITS.blind_after_s
            } else {
                LIMITS.blind_after_s
            };
            let counts = state.idling() == Idling::Counts || !sees;
            assert_eq!(waited.is_some(), counts, "{state:?}");
            let waited_s = waited.map_or(0.0, |ticks| ticks as f64 * TICK_S);
            assert!(waited_s <= bound_s + 2.0 * TICK_S, "{state:?} {waited_s}");
        }
    }
}

#[test]
fn what_may_follow_is_entered_and_its_time_begins() {
    assert_enters_what_may_follow(&walking::State::all());
    assert_enters_what_may_follow(&climbing::State::all());
    assert_enters_what_may_follow(&footsteps::State::all());
}

#[test]
fn refusing_is_final_and_any_state_that_can_be_interrupted_may_end_so() {
    assert_refusing_is_final(&walking::State::all());
    assert_refusing_is_final(&climbing::State::all());
    assert_refusing_is_final(&footsteps::State::all());
}

#[test]
fn whoever_sees_nothing_or_does_nothing_is_interrupted_in_bounded_time() {
    assert_waits_in_bounded_time(&walking::State::all());
    assert_waits_in_bounded_time(&climbing::State::all());
    assert_waits_in_bounded_time(&footsteps::State::all());
}

#[test]
fn blindness_is_hopeless_after_its_limit_and_over_when_something_is_seen() {
    for lost in [false, true] {
        let world = World::new(lost);
        let mut machine = Machine::new(climbing::State::Blind { looks: false }, LIMITS);
        for tick in 0..100 {
            let situation = world.at(tick, false);
            keep_time(&mut machine, &situation);
            let sight = machine.sight(&machine.read(&situation));
            let waits = tick as f64 * TICK_S <= LIMITS.blind_limit_s;
            if tick > 10 || lost {
                assert_eq!(sight == SightAgain::Away, waits, "{lost} {tick}");
                assert!(
                    waits
                        || matches!(sight, SightAgain::Hopeless(reason) if reason.ends_with(", here"))
                );
            }
        }
        let situation = world.at(100, true);
        let sight = machine.sight(&machine.read(&situation));
        assert_eq!(sight == SightAgain::Back, !lost);
    }
}

proptest! {
    /// The clock is that of the situations, whatever they skip or repeat, and a state has lasted as long as it was on.
    #[test]
    fn a_state_has_lasted_for_the_time_that_passed_in_it(
        steps in prop::collection::vec((0..9u64, prop::option::weighted(0.2, 0..9usize)), 1..80)
    ) {
        let world = World::new(false);
        let mut machine = Machine::new(climbing::State::Walk, LIMITS);
        let (mut now, mut lasted, mut refused) = (0, 0, false);
        keep_time(&mut machine, &world.at(0, true));
        for (step, next) in steps {
            now += step;
            lasted += step;
            keep_time(&mut machine, &world.at(now, true));
            prop_assert!((machine.lasted_s() - lasted as f64 * TICK_S).abs() < 1e-9);
            let next = next.map(|next| climbing::State::all()[next].clone());
            if let Some(next) = next.filter(|next| machine.state().may_become(next)) {
                prop_assert!(!refused && machine.enter(next));
                lasted = 0;
            }
            refused |= machine.state().refusal().is_some();
            prop_assert_eq!(machine.refusal(true).is_some(), refused);
            prop_assert_eq!(machine.refusal(false), None);
        }
    }
}
