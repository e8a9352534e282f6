//! How well a place explains a frame.

/// A range fits within so many standard deviations.
pub(super) const MATCH_SIGMAS: f64 = 3.0;
/// What ends before the map's surface counts so much against a pose as what ends behind it.
const BEFORE_COUNTS: f64 = 0.03;
/// Fewer beams off the ground do not tell whether a frame fits.
const LEAST_BEAMS: f64 = 10.0;

/// How many beams end where the map says, before that, and beyond it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Fit {
    on: f64,
    before: f64,
    beyond: f64,
}

impl Fit {
    /// Of counted beams: that end where the map says, before that, and beyond it.
    #[cfg(test)]
    pub(super) fn of([on, before, beyond]: [f64; 3]) -> Self {
        Self { on, before, beyond }
    }

    /// Counts a beam that ends by so many standard deviations before where the map says.
    pub(super) fn count(&mut self, sigmas: f64) {
        let kind = if sigmas > MATCH_SIGMAS {
            &mut self.before
        } else if sigmas < -MATCH_SIGMAS {
            &mut self.beyond
        } else {
            &mut self.on
        };
        *kind += 1.0;
    }

    /// This, where there are enough beams.
    pub(super) fn tells(self) -> Option<Self> {
        (self.on + self.before + self.beyond >= LEAST_BEAMS).then_some(self)
    }

    /// The share that ends where the map says. Those that pass through what the map has speak against a pose, those that end before
    /// it speak little: what is not mapped stands there.
    pub(super) fn lenient(&self) -> f64 {
        self.on / (self.on + self.beyond + BEFORE_COUNTS * self.before)
    }

    /// The same where nothing unmapped stands.
    pub(super) fn strict(&self) -> f64 {
        self.on / (self.on + self.beyond + self.before)
    }
}
