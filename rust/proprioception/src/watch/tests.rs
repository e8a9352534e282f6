//! Claims about the watch: what is whole is never blamed, what is broken is named within a second.

use proptest::prelude::*;
use robot::Side;
use sensing::{Observation, TICK_S};
use testkit::synthetic::Noise;
use testkit::{Walk, biped};

use super::*;
use crate::{Proprioception, ProprioceptionConfig};

/// A walk with a turn, with the noise of real senses.
fn noisy_walk(seed: u64) -> Walk {
    let mut walk = Walk::new().stand(150).walk(12, 0.04, 0.05).stand(100);
    let mut numbers = Noise::new(seed);
    for observation in &mut walk.observations {
        for value in &mut observation.angular_velocity_radps {
            *value += 0.002 * numbers.normal();
        }
        for value in &mut observation.specific_force_mps2 {
            *value += 0.15 * numbers.normal();
        }
        for force_n in observation.foot_forces_n.as_flattened_mut() {
            let error_n = (0.02 * *force_n).mul_add(numbers.normal(), 0.1 * numbers.normal());
            *force_n = (*force_n + error_n).max(0.0);
        }
    }
    walk
}

/// Walks with senses that `spoil` spoils, by the number of the tick; what was found, and at which tick.
fn found(walk: &Walk, spoil: impl FnMut(usize, &mut Observation)) -> Option<(usize, String)> {
    found_on(walk, false, spoil)
}

/// What was found on such a walk where the ground is known to slope, or is not.
fn found_on(
    walk: &Walk,
    slopes: bool,
    mut spoil: impl FnMut(usize, &mut Observation),
) -> Option<(usize, String)> {
    let body = &walk.body;
    let mut proprioception = Proprioception::new(body, ProprioceptionConfig::default()).unwrap();
    let mut watch = SenseWatch::new(body, SenseWatchConfig::default()).unwrap();
    watch.note_uneven([slopes; 2]);
    for (tick, observation) in walk.observations.iter().enumerate() {
        let mut observation = observation.clone();
        spoil(tick, &mut observation);
        let state = proprioception.update(&observation).unwrap();
        if let Some(fault) = watch.look(&observation, state) {
            return Some((tick, fault.to_string()));
        }
        watch.note_command(&walk.observations[tick].joint_positions_rad);
    }
    None
}

const FROM: usize = 180;

/// Whether a fault from [`FROM`] on is named so, within a second and not before.
fn assert_named(word: &str, seconds: f64, spoil: impl Fn(&mut Observation)) {
    let (tick, reason) = found(&noisy_walk(3), |tick, observation| {
        if tick >= FROM {
            spoil(observation);
        }
    })
    .unwrap();
    assert!(
        reason.starts_with("sensor: ") && reason.contains(word),
        "{reason}"
    );
    assert!(
        tick >= FROM && (tick - FROM) as f64 * TICK_S <= seconds,
        "{tick} {reason}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn senses_that_are_whole_are_never_blamed(seed in 0..1000u64) {
        prop_assert_eq!(found(&noisy_walk(seed), |_, _| {}), None);
    }
}

#[test]
fn exact_senses_are_never_blamed() {
    let walk = Walk::new().stand(150).walk(12, 0.04, 0.05).stand(100);
    assert_eq!(found(&walk, |_, _| {}), None);
}

#[test]
fn a_stuck_force_cell_is_named() {
    assert_named(
        "left foot's rear left force cell is stuck",
        0.1,
        |observation| {
            observation.foot_forces_n[0][2] = 20.0;
        },
    );
}

#[test]
fn a_dead_foot_is_named_by_the_weight_that_is_missing() {
    assert_named("right foot's force cells", 1.0, |observation| {
        observation.foot_forces_n[1] = [0.0; 4];
    });
}

#[test]
fn a_dead_cell_is_named_and_not_the_foot_that_swings() {
    assert_named(
        "left foot's front left force cell tells nothing",
        4.0,
        |observation| {
            // The weight lies ahead, on the cell that is dead.
            observation.foot_forces_n[0][2] *= 0.3;
            observation.foot_forces_n[0][0] = 0.0;
        },
    );
}

#[test]
fn a_robot_that_nothing_carries_says_so() {
    assert_named("nothing carries the robot", 1.0, |observation| {
        observation.foot_forces_n = [[0.0; 4]; 2];
    });
}

#[test]
fn a_dead_inertial_unit_is_named() {
    assert_named("the inertial unit is dead", 0.1, |observation| {
        observation.angular_velocity_radps = [0.0; 3];
        observation.specific_force_mps2 = [0.0; 3];
    });
}

#[test]
fn an_accelerometer_that_feels_no_gravity_is_named() {
    assert_named("the accelerometer", 0.5, |observation| {
        observation.specific_force_mps2[2] -= 7.0;
    });
}

#[test]
fn a_gyroscope_that_turns_more_than_the_legs_is_named() {
    assert_named("the gyroscope tells another turn", 1.5, |observation| {
        observation.angular_velocity_radps[2] += 0.035;
    });
}

#[test]
fn a_gyroscope_that_turns_a_robot_at_rest_is_named_before_it_walks() {
    let (tick, reason) = found(&noisy_walk(5), |_, observation| {
        observation.angular_velocity_radps[2] += 0.035;
    })
    .unwrap();
    assert!(
        tick < 100 && reason.contains("the gyroscope"),
        "{tick} {reason}"
    );
}

/// The body turns with the sole, and the legs know nothing of it.
#[test]
fn a_sole_that_slips_is_no_fault_of_the_gyroscope() {
    let slip = FROM..FROM + 8;
    let found = found(&noisy_walk(3), |tick, observation| {
        if slip.contains(&tick) {
            observation.angular_velocity_radps[2] += 0.6;
        }
    });
    assert_eq!(found, None);
}

#[test]
fn an_encoder_that_does_not_move_with_its_target_is_named() {
    let walk = noisy_walk(3);
    let joint = walk.body.leg_joints(Side::Left)[3];
    let stuck_rad = walk.observations[FROM].joint_positions_rad[joint];
    assert_named("the encoder of", 1.5, |observation| {
        observation.joint_positions_rad[joint] = stuck_rad;
    });
}

#[test]
fn what_is_made_up_for_a_cell_and_a_foot_carries_the_weight() {
    let body = biped();
    let weight_n = body.mass_kg() * GRAVITY_MPS2;
    let standing = repair::LegTurn::default();
    let mut observation = Walk::new().stand(1).observations.remove(0);
    observation.foot_forces_n = [[0.125 * weight_n; 4]; 2];
    let whole = observation.clone();
    observation.foot_forces_n[0][1] = 60.0;
    let cell = Repair::Cell {
        side: Side::Left,
        cell: 1,
    };
    cell.apply(&mut observation, weight_n, &standing);
    assert!((observation.foot_forces_n[0][1] - whole.foot_forces_n[0][1]).abs() < 1e-9);
    observation.foot_forces_n[1] = [0.0; 4];
    Repair::Foot(Side::Right).apply(&mut observation, weight_n, &standing);
    let total_n: f64 = observation.foot_forces_n.as_flattened().iter().sum();
    assert!((total_n - weight_n).abs() < 1e-9);
}

/// The body turns with the sole, and the legs know nothing of it.
#[test]
fn a_sole_that_turns_onto_a_slope_or_rocks_on_something_is_no_fault_of_the_gyroscope() {
    let settling = FROM..FROM + 10;
    for slopes in [false, true] {
        let found = found_on(&noisy_walk(3), slopes, |tick, observation| {
            if settling.contains(&tick) {
                observation.angular_velocity_radps[1] += 0.8;
            }
        });
        assert_eq!(found, None, "{slopes}");
    }
}

#[test]
fn a_gyroscope_that_tilts_the_robot_over_both_feet_is_named() {
    assert_named("the gyroscope tells another tilt", 1.5, |observation| {
        observation.angular_velocity_radps[0] += 0.6;
    });
}
