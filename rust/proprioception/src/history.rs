//! Body states of the last moments, so that a depth frame is posed by the joints at its exposure.

use sensing::TICK_NS;

use crate::{body_state::BodyState, tuning::HistoryTuning};

/// The last body states, in a ring. Allocates until it is full, then never.
#[derive(Debug, Clone)]
pub struct BodyStateHistory {
    states: Vec<BodyState>,
    capacity: usize,
    newest: usize,
    tolerance_ns: u64,
}

impl BodyStateHistory {
    /// Keeps states back to the exposure of the latest picture that may arrive, to within a tick.
    pub fn for_pictures(tuning: &HistoryTuning) -> Self {
        let latency_ns = (tuning.longest_latency * 1e9) as u64;
        // The states at both ends count, and a picture may arrive between two ticks.
        Self::new((latency_ns / TICK_NS) as usize + 2, TICK_NS)
    }

    /// Keeps the last `capacity` states (at least one). A state is given for times up to `tolerance_ns` beside it.
    pub fn new(capacity: usize, tolerance_ns: u64) -> Self {
        let capacity = capacity.max(1);
        Self {
            states: Vec::with_capacity(capacity),
            capacity,
            newest: 0,
            tolerance_ns,
        }
    }

    /// Keeps a copy of `state`; forgets the oldest when full.
    pub fn push(&mut self, state: &BodyState) {
        if self.states.len() < self.capacity {
            self.newest = self.states.len();
            self.states.push(state.clone());
            return;
        }
        self.newest = (self.newest + 1) % self.capacity;
        let slot = &mut self.states[self.newest];
        let mut links = std::mem::take(&mut slot.links);
        links
            .torso_from_link
            .clone_from(&state.links.torso_from_link);
        *slot = BodyState {
            time_ns: state.time_ns,
            odometry_from_torso_rotation: state.odometry_from_torso_rotation,
            angular_velocity_radps: state.angular_velocity_radps,
            links,
            foot_loads_n: state.foot_loads_n,
            support: state.support,
            stands_level: state.stands_level,
            on_slope: state.on_slope,
            odometry_from_robot: state.odometry_from_robot,
            robot_from_torso: state.robot_from_torso,
        };
    }

    /// The state nearest to `exposure_ns`; none where that is further away than the tolerance.
    pub fn at(&self, exposure_ns: u64) -> Option<&BodyState> {
        self.states
            .iter()
            .min_by_key(|state| state.time_ns.abs_diff(exposure_ns))
            .filter(|state| state.time_ns.abs_diff(exposure_ns) <= self.tolerance_ns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn state_at(time_ns: u64) -> BodyState {
        let body = testkit::biped();
        let proprioception =
            crate::Proprioception::new(&body, crate::ProprioceptionConfig::default());
        let mut state = proprioception.unwrap().state().clone();
        state.time_ns = time_ns;
        state
    }

    proptest! {
        #[test]
        fn the_state_at_a_time_is_the_nearest_one(ticks in 1..60u64, back_ns in 0..500_000_000u64) {
            let mut history = BodyStateHistory::new(20, TICK_NS / 2);
            for tick in 0..ticks {
                history.push(&state_at(tick * TICK_NS));
            }
            let newest_ns = (ticks - 1) * TICK_NS;
            prop_assert_eq!(history.states[history.newest].time_ns, newest_ns);
            let asked_ns = newest_ns.saturating_sub(back_ns);
            let oldest_ns = newest_ns.saturating_sub(19 * TICK_NS);
            match history.at(asked_ns) {
                Some(state) => prop_assert!(state.time_ns.abs_diff(asked_ns) <= TICK_NS / 2),
                None => prop_assert!(asked_ns + TICK_NS / 2 < oldest_ns),
            }
        }
    }

    #[test]
    fn a_full_ring_reuses_its_memory() {
        let mut history = BodyStateHistory::new(3, TICK_NS);
        for tick in 0..3 {
            history.push(&state_at(tick * TICK_NS));
        }
        let before: Vec<_> = history
            .states
            .iter()
            .map(|s| s.links.torso_from_link.as_ptr())
            .collect();
        for tick in 3..9 {
            history.push(&state_at(tick * TICK_NS));
        }
        let after: Vec<_> = history
            .states
            .iter()
            .map(|s| s.links.torso_from_link.as_ptr())
            .collect();
        assert_eq!(before, after);
    }

    #[test]
    fn a_picture_with_the_longest_latency_finds_the_state_at_its_exposure() {
        let mut history = BodyStateHistory::for_pictures(&HistoryTuning::default());
        for tick in 0..500 {
            history.push(&state_at(tick * TICK_NS));
        }
        for late_ns in [0, 1_290_000_000, 2_000_000_000] {
            let exposure_ns = 499 * TICK_NS - late_ns;
            let found = history.at(exposure_ns).map(|state| state.time_ns);
            assert_eq!(found, Some(exposure_ns));
        }
    }

    #[test]
    fn an_empty_history_knows_nothing() {
        assert!(BodyStateHistory::new(5, TICK_NS).at(0).is_none());
    }
}
