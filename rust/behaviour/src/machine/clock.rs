//! The clock of a behaviour: it runs by the times of the situations alone.

use geometry::PlanarPose;

use super::Tick;
use crate::Situation;

/// How far a behaviour has come: in time, and in the frames that it has seen.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Clock {
    /// Time of the last tick; `None` before the first.
    time_ns: Option<u64>,
    elapsed_s: f64,
    frames_used: u64,
}

impl Clock {
    /// Whether there was a tick.
    pub(crate) const fn has_begun(&self) -> bool {
        self.time_ns.is_some()
    }

    /// What a tick brings, before it is counted.
    pub(crate) fn read<'a>(&self, situation: &'a Situation<'a>) -> Tick<'a> {
        let origin = situation.estimate.map_from_robot.origin().inner;
        let yaw_rad = situation.estimate.map_from_robot.yaw_rad();
        let passed_ns = self
            .time_ns
            .map_or(0, |before_ns| situation.time_ns.saturating_sub(before_ns));
        let passed_s = passed_ns as f64 * 1e-9;
        Tick {
            situation,
            pose: PlanarPose::new(origin.x, origin.y, yaw_rad),
            ground_m: origin.z,
            passed_s,
            elapsed_s: self.elapsed_s + passed_s,
            new_frame: situation.frames_used != self.frames_used || !self.has_begun(),
        }
    }

    /// Counts a tick.
    pub(crate) const fn count(&mut self, tick: &Tick<'_>) {
        self.time_ns = Some(tick.situation.time_ns);
        self.elapsed_s = tick.elapsed_s;
        self.frames_used = tick.situation.frames_used;
    }

    /// Leaves out the time in which another behaviour decided.
    pub(crate) const fn skip_to(&mut self, time_ns: u64) {
        self.time_ns = Some(time_ns);
    }
}

/// How long something has held without a break.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Stopwatch {
    held_s: f64,
}

impl Stopwatch {
    /// Counts a tick in which it holds or does not.
    pub(crate) const fn count(&mut self, holds: bool, passed_s: f64) {
        self.held_s = if holds { self.held_s + passed_s } else { 0.0 };
    }

    /// Begins anew.
    pub(crate) const fn reset(&mut self) {
        self.held_s = 0.0;
    }

    /// The time so far, s.
    pub(crate) const fn s(self) -> f64 {
        self.held_s
    }
}
