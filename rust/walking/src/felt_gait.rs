//! What the feet tell of a gait whose walker says nothing of it: whether the robot stands, and how many steps it took.

use behaviour::Motion;
use robot::Body;

use crate::config::GaitConfig;
use crate::error::WalkError;

/// What a foot did last.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Foot {
    /// It has carried nothing yet.
    New,
    Bears,
    /// It has carried nothing for so long, s.
    Off(f64),
}

/// Watches the loads of the feet. A foot bears from the load on that counts as a landing (`gait.landing_load`); it was lifted where it
/// bore nothing for as long as both feet carry in a step (`gait.double_support`), else it bounced. The robot stands once it was told to
/// and no foot was lifted for as long as a step takes (`gait.step_time`).
#[derive(Debug, Clone)]
pub struct FeltGait {
    landing_load_n: f64,
    bounce_s: f64,
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
            bounce_s: gait.double_support,
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
        for (foot, bears) in [0, 1].into_iter().zip(self.contacts(foot_loads_n)) {
            let landed = bears && self.is_lifted(foot);
            self.steps_taken += u64::from(landed);
            self.feet[foot] = match (bears, self.feet[foot]) {
                (true, _) => Foot::Bears,
                (false, Foot::New) => Foot::New,
                (false, Foot::Bears) => Foot::Off(passed_s),
                (false, Foot::Off(since_s)) => Foot::Off(since_s + passed_s),
            };
        }
        let rests = *told == Motion::Stand && ![0, 1].iter().any(|&foot| self.is_lifted(foot));
        self.rested_s = if rests { self.rested_s + passed_s } else { 0.0 };
    }

    fn is_lifted(&self, foot: usize) -> bool {
        matches!(self.feet[foot], Foot::Off(since_s) if since_s > self.bounce_s)
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
        // A foot that sways off the ground does not end it, one that lifts does.
        felt.feel([60.0, 0.0], &Motion::Stand, 0.5 * felt.bounce_s);
        assert!(felt.standing());
        felt.feel([60.0, 0.0], &Motion::Stand, felt.bounce_s);
        assert!(!felt.standing());
    }

    #[test]
    fn every_landing_counts_once_and_neither_the_first_touch_nor_a_bounce() {
        let mut felt = FeltGait::new(&biped()).unwrap();
        let step_s = felt.settle_s;
        let mut pass = |loads_n, passed_s| {
            felt.feel(loads_n, &WALK, passed_s);
            felt.steps_taken()
        };
        assert_eq!(pass([0.0; 2], step_s), 0);
        assert_eq!(pass(ON_BOTH, TICK_S), 0);
        assert_eq!(pass([60.0, 0.0], step_s), 0);
        assert_eq!(pass([60.0, 1.0], step_s), 0);
        assert_eq!(pass(ON_BOTH, TICK_S), 1);
        assert_eq!(pass([60.0, 0.0], TICK_S), 1);
        assert_eq!(pass(ON_BOTH, TICK_S), 1);
        assert_eq!(pass([0.0, 60.0], step_s), 1);
        assert_eq!(pass(ON_BOTH, TICK_S), 2);
    }
}
