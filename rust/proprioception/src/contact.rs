//! Which foot carries the robot: loads on the soles, holds with hysteresis, and how much each foot counts.

use robot::Side;

use crate::config::ProprioceptionConfig;

/// Loads and holds of both feet.
#[derive(Debug, Clone)]
pub(crate) struct FootContacts {
    loads_n: [f64; 2],
    slow_loads_n: [f64; 2],
    holds: [bool; 2],
    /// The foot that carries more, with hysteresis.
    pub(crate) support: Side,
    least_load_n: f64,
    started: bool,
}

impl FootContacts {
    /// `weight_n`: weight of the whole robot.
    pub(crate) fn new(weight_n: f64, config: &ProprioceptionConfig) -> Self {
        Self {
            loads_n: [0.0; 2],
            slow_loads_n: [0.0; 2],
            holds: [false; 2],
            support: Side::Left,
            least_load_n: weight_n * config.least_load,
            started: false,
        }
    }

    /// Load on each sole now, N.
    pub(crate) const fn loads_n(&self) -> [f64; 2] {
        self.loads_n
    }

    /// Whether this foot stands firmly enough to measure by.
    pub(crate) const fn holds(&self, side: Side) -> bool {
        self.holds[side.index()]
    }

    /// Whether both feet do.
    pub(crate) const fn both_hold(&self) -> bool {
        self.holds[0] && self.holds[1]
    }

    /// How much each foot counts for odometry; sums to 1. A foot that does not hold counts nothing, and one that has just
    /// begun to hold or is about to let go counts next to nothing: no jump where it does.
    pub(crate) fn weights(&self, config: &ProprioceptionConfig) -> [f64; 2] {
        match self.holds {
            [true, true] => {
                let sum = self.slow_loads_n[0] + self.slow_loads_n[1];
                let share = if sum > 0.0 {
                    self.slow_loads_n[0] / sum
                } else {
                    0.5
                };
                let left = (share - config.hold_share) / (1.0 - 2.0 * config.hold_share);
                let left = left.clamp(0.0, 1.0);
                [left, 1.0 - left]
            }
            [true, false] => [1.0, 0.0],
            [false, true] => [0.0, 1.0],
            [false, false] => match self.support {
                Side::Left => [1.0, 0.0],
                Side::Right => [0.0, 1.0],
            },
        }
    }

    /// Takes in the force on each corner of each sole, N.
    pub(crate) fn update(&mut self, foot_forces_n: &[[f64; 4]; 2], config: &ProprioceptionConfig) {
        for (foot, forces) in foot_forces_n.iter().enumerate() {
            self.loads_n[foot] = forces.iter().sum();
            let share = if self.started {
                config.load_filter
            } else {
                1.0
            };
            self.slow_loads_n[foot] += (self.loads_n[foot] - self.slow_loads_n[foot]) * share;
        }
        let sum = self.slow_loads_n[0] + self.slow_loads_n[1];
        if sum < self.least_load_n {
            return; // in the air, or nothing to decide by: what held before goes on
        }
        for side in Side::BOTH {
            let share = self.slow_loads_n[side.index()] / sum;
            let limit = if self.holds(side) {
                config.release_share
            } else {
                config.hold_share
            };
            self.holds[side.index()] = share > limit;
            if share > config.support_share || (!self.started && share >= 0.5) {
                self.support = side;
            }
        }
        self.started = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn after(loads: &[(f64, f64)]) -> (FootContacts, ProprioceptionConfig) {
        let config = ProprioceptionConfig::default();
        let mut contacts = FootContacts::new(65.0, &config);
        for &(left, right) in loads {
            for _ in 0..20 {
                contacts.update(&[[left / 4.0; 4], [right / 4.0; 4]], &config);
            }
        }
        (contacts, config)
    }

    proptest! {
        #[test]
        fn the_weights_sum_to_one_and_a_hanging_foot_has_none(
            loads in prop::collection::vec((0.0..80.0f64, 0.0..80.0f64), 1..20)
        ) {
            let (contacts, config) = after(&loads);
            let weights = contacts.weights(&config);
            prop_assert!((weights[0] + weights[1] - 1.0).abs() < 1e-12);
            for side in Side::BOTH {
                if !contacts.holds(side) && contacts.holds(side.other()) {
                    prop_assert_eq!(weights[side.index()], 0.0);
                }
            }
        }

        #[test]
        fn a_foot_takes_hold_without_a_jump_in_weight(share in 0.0..1.0f64) {
            let config = ProprioceptionConfig::default();
            let mut contacts = FootContacts::new(65.0, &config);
            contacts.update(&[[15.0; 4], [0.0; 4]], &config);
            contacts.slow_loads_n = [60.0 * (1.0 - share), 60.0 * share];
            let before = contacts.weights(&config)[1];
            contacts.holds[1] = share > config.hold_share;
            prop_assert!(before == 0.0);
            if contacts.holds[1] && share < config.hold_share + 0.01 {
                prop_assert!(contacts.weights(&config)[1] < 0.03);
            }
        }
    }

    #[test]
    fn the_support_foot_changes_with_the_load_but_not_at_an_even_one() {
        assert_eq!(after(&[(60.0, 5.0)]).0.support, Side::Left);
        assert_eq!(after(&[(60.0, 5.0), (31.0, 34.0)]).0.support, Side::Left);
        assert_eq!(after(&[(60.0, 5.0), (5.0, 60.0)]).0.support, Side::Right);
        assert_eq!(after(&[(5.0, 60.0), (34.0, 31.0)]).0.support, Side::Right);
    }

    #[test]
    fn a_robot_in_the_air_keeps_its_support() {
        let (contacts, _) = after(&[(5.0, 60.0), (0.0, 0.0)]);
        assert_eq!(contacts.support, Side::Right);
        assert!(contacts.holds(Side::Right));
    }
}
