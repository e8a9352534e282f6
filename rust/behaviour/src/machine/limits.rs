//! How long a machine waits for what, and in what words it gives up: `walking.rs` and `climbing.rs` fill it from their settings.

/// The limits of a machine, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits {
    /// Seeing nothing for this long is being blind.
    pub(crate) blind_after_s: f64,
    /// In some states nothing may be seen for so many times as long ([`super::State::is_patient`]).
    pub(crate) patience: f64,
    /// Being blind for this long is hopeless.
    pub(crate) blind_limit_s: f64,
    /// Whether a robot that never saw anything has been without sight since it began.
    pub(crate) blind_from_the_start: bool,
    /// Nothing has been done for the goal for this long: the robot gives up.
    pub(crate) idle_limit_s: f64,
    /// What could not be done then.
    pub(crate) idle_words: &'static str,
    /// Where the robot was blind, as the end of a sentence.
    pub(crate) place_words: &'static str,
}
