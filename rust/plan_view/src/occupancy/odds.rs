//! Odds, and how a measurement changes them (004, equations 36.3 to 36.5).

/// Odds of a probability in 0..1 (004, equation 36.3): 1 for 0.5, infinite for 1.
pub fn odds(probability: f64) -> f64 {
    probability / (1.0 - probability)
}

/// The probability that has these odds, 0 or more (004, equation 36.5): the inverse of [`odds`].
pub fn probability_of_odds(odds: f64) -> f64 {
    // Also of infinite odds, of which the quotient is no number.
    1.0 - 1.0 / (1.0 + odds)
}

/// Logarithm of the odds of a probability.
pub fn log_odds(probability: f64) -> f64 {
    libm::log(probability) - libm::log1p(-probability)
}

/// The probability that has odds of this logarithm.
pub fn probability_of_log_odds(log_odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-log_odds))
}

/// Odds of a cell after a measurement (004, equation 36.4): those before it, the odds that the measurement alone gives, and those of the prior,
/// which each measurement has in it once.
pub fn updated_odds(before: f64, measured: f64, prior: f64) -> f64 {
    measured / prior * before
}
