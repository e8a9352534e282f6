//! Where the head looks: sweeps while standing, glances while walking.

use crate::{Gaze, walking::WalkingConfig};

/// Moves the gaze with a limited speed, so that every patch of ground is in several frames.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Gazer {
    /// Where the head is told to look.
    pub(crate) at: Gaze,
}

impl Gazer {
    /// Takes up from where the head is.
    pub(crate) const fn start(&mut self, gaze: Gaze) {
        self.at = gaze;
    }

    /// One tick towards `goal`.
    pub(crate) fn turn(&mut self, goal: Gaze, passed_s: f64, speed_radps: f64) {
        let most = speed_radps * passed_s;
        self.at.pan_rad += (goal.pan_rad - self.at.pan_rad).clamp(-most, most);
        self.at.down_rad += (goal.down_rad - self.at.down_rad).clamp(-most, most);
    }

    fn is_at(&self, goal: Gaze) -> bool {
        (self.at.pan_rad - goal.pan_rad).abs() < 1e-6
            && (self.at.down_rad - goal.down_rad).abs() < 1e-6
    }
}

/// Most places in a list: an array's size, no list here is longer.
const LONGEST_SWEEP: usize = 8;

/// A list of places to look at, one after the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sweep {
    places: [Gaze; LONGEST_SWEEP],
    count: usize,
    next: usize,
    last_frame_at: Option<u64>,
    /// Frames that must be used after the last place was reached.
    last_frames: u64,
}

impl Sweep {
    /// Places as pan and down, rad, no more than eight; so many frames must be used after the last one was reached.
    pub(crate) fn through(places: &[(f64, f64)], last_frames: u64) -> Self {
        let mut sweep = Self {
            places: [Gaze::default(); LONGEST_SWEEP],
            count: places.len().min(LONGEST_SWEEP),
            next: 0,
            last_frame_at: None,
            last_frames,
        };
        for (slot, &(pan_rad, down_rad)) in sweep.places.iter_mut().zip(places) {
            *slot = Gaze { pan_rad, down_rad };
        }
        sweep
    }

    /// All that may be seen by who sees nothing: what it stands on first, which may show nowhere but right before the feet. No frame
    /// is waited for.
    pub(crate) fn in_the_dark(config: &WalkingConfig) -> Self {
        let (side, aside) = (config.sweep, config.tuning.gaze.aside);
        let (feet, near, far) = (config.gaze_feet, config.gaze_near, config.gaze_far);
        let places = [
            (0.0, feet),
            (aside, feet),
            (-aside, feet),
            (aside, feet),
            (side, near),
            (-side, near),
            (-side, far),
            (side, far),
        ];
        Self::through(&places, 0)
    }

    /// All that can be seen from here: near from left to right, then far from right to left; and the room for the head, with a gaze so
    /// far below the horizon, where one looks up.
    pub(crate) fn around(config: &WalkingConfig, up_rad: Option<f64>) -> Self {
        let (side, near, far) = (config.sweep, config.gaze_near, config.gaze_far);
        let on_the_floor = [
            (0.0, config.gaze_steep),
            (side, near),
            (-side, near),
            (-side, far),
            (side, far),
        ];
        let last_frames = config.tuning.gaze.last_frames;
        let Some(up_rad) = up_rad else {
            return Self::through(&on_the_floor, last_frames).and((0.0, far));
        };
        let aside = config.tuning.gaze.up_aside.min(side);
        // Where walls are near, neither look up nor far shows the ground, without which no frame is used for long.
        Self::through(&on_the_floor, last_frames)
            .and((aside, up_rad))
            .and((-aside, up_rad))
            .and((0.0, near))
    }

    /// Looks at one more place at its end, given as pan and down, rad.
    fn and(mut self, (pan_rad, down_rad): (f64, f64)) -> Self {
        if let Some(slot) = self.places.get_mut(self.count) {
            *slot = Gaze { pan_rad, down_rad };
            self.count += 1;
        }
        self
    }

    /// The room for the head at `bearing_rad` and beside it, with a gaze so far below the horizon, and then the floor there.
    pub(crate) fn up(bearing_rad: f64, up_rad: f64, config: &WalkingConfig) -> Self {
        let bearing_rad = bearing_rad.clamp(-config.sweep, config.sweep);
        let aside_rad = config.tuning.gaze.aside;
        let places = [
            (bearing_rad + aside_rad, up_rad),
            (bearing_rad - aside_rad, up_rad),
            (bearing_rad, config.gaze_far),
        ];
        Self::through(&places, config.tuning.gaze.last_frames)
    }

    /// A place at `bearing_rad`, and what lies around it.
    pub(crate) fn at(bearing_rad: f64, config: &WalkingConfig) -> Self {
        let bearing_rad = bearing_rad.clamp(-config.sweep, config.sweep);
        let aside_rad = config.tuning.gaze.aside;
        let (left, right) = (bearing_rad + aside_rad, bearing_rad - aside_rad);
        let (steep, near) = (config.gaze_steep, config.gaze_near);
        let places = [
            (left, steep),
            (right, steep),
            (right, near),
            (left, near),
            (bearing_rad, near),
        ];
        Self::through(&places, config.tuning.gaze.last_frames)
    }

    /// One tick; true when all was looked at and the frames of it were used.
    pub(crate) fn advance(
        &mut self,
        gazer: &mut Gazer,
        frames_used: u64,
        passed_s: f64,
        speed_radps: f64,
    ) -> bool {
        if self.next < self.count {
            let goal = self.places[self.next];
            gazer.turn(goal, passed_s, speed_radps);
            self.next += usize::from(gazer.is_at(goal));
            return false;
        }
        let since = *self.last_frame_at.get_or_insert(frames_used);
        frames_used >= since + self.last_frames
    }
}

/// Where to look while walking: along the path, by turns far and near, swaying a little.
pub(crate) fn glance(time_s: f64, bearing_rad: f64, config: &WalkingConfig) -> Gaze {
    let tuning = &config.tuning.gaze;
    let phase = (time_s / tuning.period).fract();
    let sway_period_s = tuning.sway_periods * tuning.period;
    let sway_rad = tuning.sway * libm::sin(std::f64::consts::TAU * time_s / sway_period_s);
    Gaze {
        pan_rad: (bearing_rad + sway_rad).clamp(-config.sweep, config.sweep),
        down_rad: if phase < tuning.far_share {
            config.gaze_far
        } else {
            config.gaze_near
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(mut sweep: Sweep, frame_every: usize) -> (usize, Vec<Gaze>) {
        let config = WalkingConfig::default();
        let mut gazer = Gazer::default();
        let mut seen = Vec::new();
        for tick in 0..3000_usize {
            seen.push(gazer.at);
            let frames = tick.checked_div(frame_every).unwrap_or(0);
            if sweep.advance(&mut gazer, frames as u64, 0.01, config.gaze_speed) {
                return (tick, seen);
            }
        }
        (usize::MAX, seen)
    }

    #[test]
    fn a_look_around_reaches_both_sides_near_and_far_and_ends() {
        let config = WalkingConfig::default();
        let (ticks, seen) = run(Sweep::around(&config, None), 8);
        assert!(ticks < 1200, "{ticks}");
        for (pan, down) in [
            (1.1, 0.85),
            (-1.1, 0.85),
            (1.1, 0.5),
            (-1.1, 0.5),
            (0.0, 1.0),
        ] {
            let reached = |gaze: &Gaze| {
                (gaze.pan_rad - pan).abs() < 0.02 && (gaze.down_rad - down).abs() < 0.02
            };
            assert!(seen.iter().any(reached), "{pan} {down}");
        }
    }

    #[test]
    fn a_sweep_does_not_end_without_frames() {
        assert_eq!(
            run(Sweep::at(0.3, &WalkingConfig::default()), 0).0,
            usize::MAX
        );
    }

    #[test]
    fn a_glance_stays_within_the_necks_reach_and_sees_near_and_far() {
        let config = WalkingConfig::default();
        let glances: Vec<_> = (0..600)
            .map(|i| glance(f64::from(i) * 0.01, 2.0, &config))
            .collect();
        assert!(
            glances
                .iter()
                .all(|gaze| gaze.pan_rad.abs() <= config.sweep)
        );
        assert!(glances.iter().any(|gaze| gaze.down_rad == config.gaze_far));
        assert!(glances.iter().any(|gaze| gaze.down_rad == config.gaze_near));
    }
}
