//! How long each stage took at the last tick. Nothing in the loop reads it.

use std::time::Instant;

/// The stages of a tick, in their order, by the names that `timing_ms` has for them.
pub const STAGES: [&str; 7] = [
    "segment", "map", "stairs", "localize", "plan", "behave", "walk",
];

/// Seconds that each of [`STAGES`] took at the last tick; NaN where it did not run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// In the order of [`STAGES`].
    pub seconds: [f64; STAGES.len()],
}

impl Default for Timing {
    fn default() -> Self {
        Self {
            seconds: [f64::NAN; STAGES.len()],
        }
    }
}

/// One of [`STAGES`].
#[derive(Debug, Clone, Copy)]
pub(crate) enum Stage {
    Segment = 0,
    Map = 1,
    Stairs = 2,
    Localize = 3,
    Plan = 4,
    Behave = 5,
    Walk = 6,
}

impl Timing {
    /// Runs `work` and adds its time to that of `stage`.
    pub(crate) fn measure<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let product = work();
        let slot = &mut self.seconds[stage as usize];
        let before = if slot.is_nan() { 0.0 } else { *slot };
        *slot = before + start.elapsed().as_secs_f64();
        product
    }
}
