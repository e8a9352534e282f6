//! Where the head looks while the robot stands before a step or on one.

use crate::Gaze;
use crate::walking::gaze::{Gazer, Sweep};

/// Height of the eyes above the ground as far as looking at a place needs it, m.
const EYE_HEIGHT_M: f64 = 0.45;
/// How far the eyes are ahead of the robot's middle, m.
const EYE_AHEAD_M: f64 = 0.04;
/// The farthest that the head is panned, rad.
const WIDEST_RAD: f64 = 1.1;

/// The head, and what it is to look at.
#[derive(Debug, Clone)]
pub(crate) struct Head {
    pub(crate) gazer: Gazer,
    sweep: Sweep,
    speed_radps: f64,
    steep_rad: f64,
    looked_s: f64,
    frames_before: Option<u64>,
}

impl Head {
    pub(crate) fn new(speed_radps: f64, steep_rad: f64) -> Self {
        Self {
            gazer: Gazer::default(),
            sweep: Sweep::through(&[]),
            speed_radps,
            steep_rad,
            looked_s: 0.0,
            frames_before: None,
        }
    }

    /// Begins to look at a place of the ground and around it: the noise of the depth image is mostly a fixed pattern, so
    /// that only moving the image averages it.
    pub(crate) fn look_at(&mut self, [x_m, y_m]: [f64; 2]) {
        const APART_RAD: f64 = 0.12;
        let gaze = self.towards([x_m, y_m]);
        let (pan, down) = (gaze.pan_rad, gaze.down_rad);
        let upper = (down - 0.25).max(0.5);
        self.begin(&[
            (pan + APART_RAD, down),
            (pan - APART_RAD, down),
            (pan - APART_RAD, upper),
            (pan + APART_RAD, upper),
        ]);
    }

    /// Begins to look down and to swing the head from side to side (003, section V.A).
    pub(crate) fn search(&mut self, bearing_rad: f64) {
        const SWING_RAD: f64 = 0.5;
        let bearing_rad = bearing_rad.clamp(SWING_RAD - WIDEST_RAD, WIDEST_RAD - SWING_RAD);
        let (left, right) = (bearing_rad + SWING_RAD, bearing_rad - SWING_RAD);
        self.begin(&[
            (bearing_rad, self.steep_rad),
            (left, 0.85),
            (right, 0.85),
            (right, 0.55),
            (left, 0.55),
            (bearing_rad, 0.7),
        ]);
    }

    /// Begins to look at stairs from near by: at their first edge and up or down all of them.
    pub(crate) fn inspect(&mut self, place_m: [f64; 2]) {
        let Gaze { pan_rad, down_rad } = self.towards(place_m);
        let (left, right) = (pan_rad + 0.15, pan_rad - 0.15);
        self.begin(&[
            (left, down_rad),
            (right, down_rad),
            (right, 0.8),
            (left, 0.7),
            (left, 0.55),
            (right, 0.55),
        ]);
    }

    fn begin(&mut self, places: &[(f64, f64)]) {
        self.sweep = Sweep::through(places);
        self.looked_s = 0.0;
        self.frames_before = None;
    }

    /// One tick of the look; true when it is done and its frames were used, or when it takes too long.
    pub(crate) fn advance(&mut self, frames_used: u64, passed_s: f64) -> bool {
        const LONGEST_S: f64 = 8.0;
        self.looked_s += passed_s;
        let _ = self.frames_before.get_or_insert(frames_used);
        self.sweep
            .advance(&mut self.gazer, frames_used, passed_s, self.speed_radps)
            || self.looked_s > LONGEST_S
    }

    /// Whether some frames were used since the look began.
    pub(crate) fn has_glanced(&self, frames_used: u64) -> bool {
        const FRAMES: u64 = 3;
        self.frames_before
            .is_some_and(|before| frames_used >= before + FRAMES)
    }

    /// One tick towards a place of the ground in the robot's frame, m.
    pub(crate) fn turn_to(&mut self, place_m: [f64; 2], passed_s: f64) {
        let gaze = self.towards(place_m);
        self.gazer.turn(gaze, passed_s, self.speed_radps);
    }

    fn towards(&self, [x_m, y_m]: [f64; 2]) -> Gaze {
        let away_m = (x_m - EYE_AHEAD_M).hypot(y_m).max(0.05);
        Gaze {
            pan_rad: y_m
                .atan2((x_m - EYE_AHEAD_M).max(0.05))
                .clamp(-WIDEST_RAD, WIDEST_RAD),
            down_rad: EYE_HEIGHT_M.atan2(away_m).clamp(0.5, self.steep_rad),
        }
    }
}
