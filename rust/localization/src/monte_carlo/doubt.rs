//! When frames stop to fit: after augmented Monte Carlo localization (Thrun, Burgard, Fox 2005, table 8.3).
//!
//! How well a frame fits is there the mean likelihood of all particles; here the share of beams that the best estimate explains, since what
//! is not in the map makes frames as unlikely as a wrong place does.

use super::{config::MonteCarloConfig, fit::FrameFit};

/// Means of how well frames fit.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PlaceDoubt {
    /// Over a long and over a short time, what is not mapped being put up with.
    lenient: Option<[f64; 2]>,
    /// Over a short time, what is not mapped counting against the place.
    strict: Option<f64>,
}

impl PlaceDoubt {
    /// Takes in how well a frame fits.
    pub(super) fn update(&mut self, fit: FrameFit, config: &MonteCarloConfig) {
        let before_counts = config.tuning.fit.before_counts;
        let [slow_rate, fast_rate] = config.recovery_rates;
        let strict = self.strict.get_or_insert(fit.strict());
        *strict += fast_rate * (fit.strict() - *strict);
        let fit = fit.lenient(before_counts);
        let [slow, fast] = self.lenient.get_or_insert([fit; 2]);
        *fast += fast_rate * (fit - *fast);
        let rate = if *fast < config.recovery_below * *slow {
            config.tuning.doubt.while_lost * slow_rate
        } else if fit > *slow {
            // What is better is what is normal.
            fast_rate
        } else {
            slow_rate
        };
        *slow += rate * (fit - *slow);
    }

    /// Whether frames fit so much worse than they did that the robot has to be somewhere else: `w_fast < below w_slow`.
    pub(super) fn is_lost(&self, config: &MonteCarloConfig) -> bool {
        (self.lenient).is_some_and(|[slow, fast]| fast < config.recovery_below * slow)
    }

    /// The share of what stands on the ground that is where the map has it, lately.
    pub(super) fn explained(&self) -> f64 {
        self.strict.unwrap_or(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_as_it_is_is_right_what_falls_is_not() {
        let config = MonteCarloConfig::default();
        let mut doubt = PlaceDoubt::default();
        assert!(!doubt.is_lost(&config) && doubt.explained() > 0.9);
        let fit = |on: f64, before: f64| FrameFit::of([on, before, 50.0 - on - before]);
        for step in 0..200 {
            doubt.update(fit(40.0 + 5.0 * f64::from(step).sin(), 0.0), &config);
            assert!(!doubt.is_lost(&config));
        }
        // Much that is not mapped: no reason to be lost, but one to look whether another place is better.
        let mut blocked = doubt;
        for _ in 0..50 {
            blocked.update(fit(15.0, 35.0), &config);
        }
        assert!(!blocked.is_lost(&config) && blocked.explained() < 0.35);
        for step in 0..200 {
            doubt.update(fit(12.0, 0.0), &config);
            assert!(step < 10 || doubt.is_lost(&config), "{step}");
        }
        for _ in 0..20 {
            doubt.update(fit(45.0, 0.0), &config);
        }
        assert!(!doubt.is_lost(&config));
    }
}
