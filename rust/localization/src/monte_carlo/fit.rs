//! How well a place explains a frame.

/// How many beams end where the map says, before that, and beyond it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct FrameFit {
    on: f64,
    before: f64,
    beyond: f64,
}

impl FrameFit {
    /// A fit of counted beams: those that end where the map says, before that, and beyond it.
    #[cfg(test)]
    pub(super) fn of([on, before, beyond]: [f64; 3]) -> Self {
        Self { on, before, beyond }
    }

    /// Counts a beam that ends by so many standard deviations before where the map says; it fits within `within` of them.
    pub(super) fn count(&mut self, sigmas: f64, within: f64) {
        let kind = if sigmas > within {
            &mut self.before
        } else if sigmas < -within {
            &mut self.beyond
        } else {
            &mut self.on
        };
        *kind += 1.0;
    }

    /// Itself, where there are at least so many beams.
    pub(super) fn tells(self, least_beams: f64) -> Option<Self> {
        (self.on + self.before + self.beyond >= least_beams).then_some(self)
    }

    /// The share that ends where the map says. Those that pass through what the map has speak against a pose, those that end before
    /// it count only `before_counts` as much: what is not mapped stands there.
    pub(super) fn lenient(&self, before_counts: f64) -> f64 {
        self.on / (self.on + self.beyond + before_counts * self.before)
    }

    /// The share that ends where the map says, where nothing unmapped stands.
    pub(super) fn strict(&self) -> f64 {
        self.on / (self.on + self.beyond + self.before)
    }
}
