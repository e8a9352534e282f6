//! When frames stop to fit: after augmented Monte Carlo localization (Thrun, Burgard, Fox 2005, table 8.3).
//!
//! How well a frame fits is there the mean likelihood of all particles; here the share of beams that the best estimate explains, since what
//! is not in the map makes frames as unlikely as a wrong place does.

/// The slow mean forgets so much slower while frames do not fit: what is normal is not to be learned from what is not.
const WHILE_LOST: f64 = 0.1;
/// A few guesses anywhere find nothing: where some are needed, many are.
const GAIN: f64 = 10.0;

/// Means of how well frames fit, over a long and over a short time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Recovery {
    means: Option<[f64; 2]>,
}

impl Recovery {
    /// Takes in how well a frame fits; returns how much should be drawn anywhere, from none to all that may be: by
    /// `1 - w_fast / (below w_slow)`.
    pub(super) fn update(&mut self, fit: f64, [slow_rate, fast_rate]: [f64; 2], below: f64) -> f64 {
        let [slow, fast] = self.means.get_or_insert([fit; 2]);
        *fast += fast_rate * (fit - *fast);
        let rate = if *fast < below * *slow {
            WHILE_LOST * slow_rate
        } else if fit > *slow {
            // What is better is what is normal.
            fast_rate
        } else {
            slow_rate
        };
        *slow += rate * (fit - *slow);
        (GAIN * (1.0 - *fast / (below * *slow))).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_as_it_is_needs_nothing_what_falls_does() {
        let mut recovery = Recovery::default();
        for step in 0..200 {
            let fit = 1.0 + 0.1 * f64::from(step).sin();
            assert_eq!(recovery.update(fit, [0.01, 0.2], 0.7), 0.0);
        }
        let shares: Vec<f64> = (0..200)
            .map(|_| recovery.update(0.3, [0.01, 0.2], 0.7))
            .collect();
        assert!(shares[10] > 0.3 && shares[199] > 0.3, "{}", shares[199]);
        // Found again.
        let after: Vec<f64> = (0..20)
            .map(|_| recovery.update(1.0, [0.01, 0.2], 0.7))
            .collect();
        assert_eq!(after[19], 0.0);
    }
}
