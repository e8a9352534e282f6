//! What the feet tell of a gait whose walker says nothing of it: whether the robot stands, and how many steps it took.

use behaviour::Motion;
use robot::Body;

use crate::config::GaitConfig;
use crate::error::WalkError;

/// What a foot did last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Foot {
    /// It has carried nothing yet.
    New,
    Bears,
    Lifted,
}

/// Watches the loads of the feet. A foot bears from the load on that counts as a landing (`gait.landing_load`); the robot stands once
/// it was told to and both have borne for as long as a step takes (`gait.step_time`).
#[derive(Debug, Clone)]
pub struct FeltGait {
    landing_load_n: f64,
    settle_s: f64,
    feet: [Foot; 2],
    rested_s: f64,
    steps_taken: u64,
}

impl FeltGait {
    /// For a robot with this body, which stands.
    ///
    /// # Errors
    ///
    /// Its `[gait]` has a setting that cannot be used.
    pub fn new(body: &Body) -> Result<Self, WalkError> {
        let (gait, _) = GaitConfig::read(body)?;
        Ok(Self {
            landing_load_n: gait.landing_load,
            settle_s: gait.step_time,
            feet: [Foot::New; 2],
            rested_s: gait.step_time,
            steps_taken: 0,
        })
    }

    /// Whether each foot bears a load, left and right.
    pub fn contacts(&self, foot_loads_n: [f64; 2]) -> [bool; 2] {
        foot_loads_n.map(|load_n| load_n >= self.landing_load_n)
    }

    /// Takes in the loads that the feet had, what they were told, and the time that has passed.
    pub fn feel(&mut self, foot_loads_n: [f64; 2], told: &Motion, passed_s: f64) {
        let contacts = self.contacts(foot_loads_n);
        for (foot, bears) in self.feet.iter_mut().zip(contacts) {
            let landed = bears && *foot == Foot::Lifted;
            self.steps_taken += u64::from(landed);
            *foot = match (bears, *foot) {
                (true, _) => Foot::Bears,
                (false, Foot::New) => Foot::New,
                (false, Foot::Bears | Foot::Lifted) => Foot::Lifted,
            };
        }
        let new = self.feet == [Foot::New; 2];
        let rests = *told == Motion::Stand && (new || contacts == [true; 2]);
        self.rested_s = if rests { self.rested_s + passed_s } else { 0.0 };
    }

    /// Whether the robot stands still on both soles.
    pub fn standing(&self) -> bool {
        self.rested_s >= self.settle_s
    }

    /// Landings so far.
    pub const fn steps_taken(&self) -> u64 {
        self.steps_taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::biped;
    use behaviour::Velocity;
    use sensing::TICK_S;

    const ON_BOTH: [f64; 2] = [30.0, 30.0];
    const WALK: Motion = Motion::Walk(Velocity {
        x_mps: 0.1,
        y_mps: 0.0,
        yaw_radps: 0.0,
    });

    #[test]
    fn a_robot_stands_until_it_is_told_to_walk_and_a_step_after_it_was_told_to_stand() {
        let mut felt = FeltGait::new(&biped()).unwrap();
        assert!(felt.standing());
        // Until it is let down nothing is felt.
        felt.feel([0.0; 2], &Motion::Stand, TICK_S);
        felt.feel(ON_BOTH, &Motion::Stand, TICK_S);
        assert!(felt.standing());
        felt.feel(ON_BOTH, &WALK, TICK_S);
        assert!(!felt.standing());
        let waited = (0..1000)
            .take_while(|_| {
                felt.feel(ON_BOTH, &Motion::Stand, TICK_S);
                !felt.standing()
            })
            .count();
        assert!((waited as f64 * TICK_S - felt.settle_s).abs() < 2.0 * TICK_S);
        // A foot that lifts ends it.
        felt.feel([60.0, 0.0], &Motion::Stand, TICK_S);
        assert!(!felt.standing());
    }

    #[test]
    fn every_landing_counts_once_and_the_first_touch_is_none() {
        let mut felt = FeltGait::new(&biped()).unwrap();
        let mut pass = |loads_n| {
            felt.feel(loads_n, &WALK, TICK_S);
            felt.steps_taken()
        };
        assert_eq!(pass([0.0; 2]), 0);
        assert_eq!(pass(ON_BOTH), 0);
        assert_eq!(pass([60.0, 0.0]), 0);
        assert_eq!(pass([60.0, 1.0]), 0);
        assert_eq!(pass(ON_BOTH), 1);
        assert_eq!(pass(ON_BOTH), 1);
        assert_eq!(pass([0.0, 60.0]), 1);
        assert_eq!(pass(ON_BOTH), 2);
    }
}
