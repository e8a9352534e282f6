//! The watchdog: headway on the way to the goal, and what to do without.

use crate::walking::WalkingConfig;

/// What the watchdog says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Headway {
    /// Go on.
    Fine,
    /// Look around: nothing has been gained for a while.
    Stuck,
    /// Give up.
    Hopeless,
}

/// Watches what remains of the way. Knows no clock: time is told.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    best_m: f64,
    waited_s: f64,
    best_ever_m: f64,
    /// Since when the robot has not been nearer to the goal than ever, s.
    pub(crate) waited_ever_s: f64,
    tries: u32,
}

impl Default for Progress {
    fn default() -> Self {
        Self {
            best_m: f64::INFINITY,
            waited_s: 0.0,
            best_ever_m: f64::INFINITY,
            waited_ever_s: 0.0,
            tries: 0,
        }
    }
}

impl Progress {
    /// One tick. `detour` says that the way was planned anew: it may be longer than the old one.
    pub(crate) fn watch(
        &mut self,
        remaining_m: f64,
        detour: bool,
        passed_s: f64,
        config: &WalkingConfig,
    ) -> Headway {
        let tuning = &config.tuning.progress;
        self.waited_s += passed_s;
        self.waited_ever_s += passed_s;
        if remaining_m < self.best_ever_m - tuning.headway {
            self.best_ever_m = remaining_m;
            self.waited_ever_s = 0.0;
            self.tries = 0;
        }
        let longer = detour && remaining_m > self.best_m + tuning.detour * tuning.headway;
        if remaining_m < self.best_m - tuning.headway || longer {
            self.best_m = remaining_m;
            self.waited_s = 0.0;
        }
        if self.waited_ever_s > tuning.longest_detour * config.patience {
            return Headway::Hopeless;
        }
        if self.waited_s <= config.patience {
            return Headway::Fine;
        }
        self.waited_s = 0.0;
        self.tries += 1;
        if self.tries > config.tries {
            Headway::Hopeless
        } else {
            Headway::Stuck
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn whoever_gains_nothing_is_given_up_in_bounded_time(
            lengths in prop::collection::vec(1.0..5.0f64, 1..50)
        ) {
            let config = WalkingConfig::default();
            let mut progress = Progress::default();
            let _ = progress.watch(1.0, false, 0.01, &config);
            let hopeless = (0..200_000).position(|tick| {
                let remaining_m = lengths[tick / 100 % lengths.len()];
                progress.watch(remaining_m, true, 0.01, &config) == Headway::Hopeless
            });
            let longest_s = config.tuning.progress.longest_detour * config.patience;
            prop_assert!(hopeless.is_some_and(|tick| tick as f64 * 0.01 <= longest_s + 1.0));
        }

        #[test]
        fn whoever_walks_on_is_left_alone(speed_mps in 0.01..0.1f64) {
            let config = WalkingConfig::default();
            let mut progress = Progress::default();
            for tick in 0..3000 {
                let remaining_m = 5.0 - speed_mps * f64::from(tick) * 0.01;
                prop_assert_eq!(progress.watch(remaining_m, false, 0.01, &config), Headway::Fine);
            }
        }
    }
}
