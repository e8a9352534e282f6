//! How well the edge of a step must be known for what.

use planning::Step;

use super::StairClimbing;

impl StairClimbing {
    /// Whether the front edge of a step is known well enough to step by it.
    pub(super) fn is_measured(&self, step: &Step) -> bool {
        self.is_known(step, 1, 1.0)
    }

    /// Whether it will do when no look tells more: sure enough, if only by few frames.
    pub(super) fn is_usable(&self, step: &Step) -> bool {
        self.is_known(step, 0, self.config.tuning.edges.usable)
    }

    /// Whether it is known so well that another look would tell little.
    pub(super) fn is_well_measured(&self, step: &Step) -> bool {
        let tuning = &self.config.tuning.edges;
        self.is_known(step, tuning.well_frames, tuning.well)
    }

    /// Whether so many times the frames told of it that it takes to step by it, with so many times the error at most.
    fn is_known(&self, step: &Step, frames: u32, sigmas: f64) -> bool {
        step.stair.front_fit.is_some_and(|fit| {
            fit.frames >= frames * self.config.edge_frames
                && fit.place_sigma_m <= sigmas * self.config.edge_sigma
                && fit.heading_sigma_rad <= sigmas * self.config.heading_sigma
        })
    }
}
