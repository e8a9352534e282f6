//! Where the head looks while the robot stands before a step or on one.

use crate::climbing::StairClimbingConfig;
use crate::climbing::tuning::HeadTuning;
use crate::walking::gaze::{Gazer, Sweep};
use crate::{Gaze, WalkingConfig};

/// The head, and what it is to look at.
#[derive(Debug, Clone)]
pub(crate) struct ClimbingHead {
    pub(crate) gazer: Gazer,
    sweep: Sweep,
    /// How the head looks around while the robot walks, and so here.
    walking: WalkingConfig,
    /// Height of the eyes above the ground, m.
    eye_height_m: f64,
    /// How far the eyes are ahead of the robot's middle, m.
    eye_ahead_m: f64,
    tuning: HeadTuning,
    looked_s: f64,
    frames_before: Option<u64>,
}

impl ClimbingHead {
    pub(crate) fn new(
        config: &StairClimbingConfig,
        walking: &WalkingConfig,
        eyes: &robot::Head,
    ) -> Self {
        let tuning = config.tuning.head.clone();
        Self {
            gazer: Gazer::default(),
            sweep: Sweep::through(&[], walking.tuning.gaze.last_frames),
            walking: walking.clone(),
            eye_height_m: eyes.eye_height,
            eye_ahead_m: eyes.eye_ahead,
            tuning,
            looked_s: 0.0,
            frames_before: None,
        }
    }

    /// Begins to look at a place of the ground and around it: the noise of the depth image is mostly a fixed pattern, so
    /// that only moving the image averages it.
    pub(crate) fn look_at(&mut self, [x_m, y_m]: [f64; 2]) {
        let apart_rad = self.tuning.apart;
        let gaze = self.towards([x_m, y_m]);
        let (pan, down) = (gaze.pan_rad, gaze.down_rad);
        let upper = (down - self.tuning.flatter).max(self.walking.gaze_far);
        self.begin(&[
            (pan + apart_rad, down),
            (pan - apart_rad, down),
            (pan - apart_rad, upper),
            (pan + apart_rad, upper),
        ]);
    }

    /// Begins to look down and to swing the head from side to side (003, section V.A).
    pub(crate) fn search(&mut self, bearing_rad: f64) {
        let (swing_rad, widest_rad) = (self.tuning.swing, self.walking.sweep);
        let swing_rad = swing_rad.min(widest_rad);
        let bearing_rad = bearing_rad.clamp(swing_rad - widest_rad, widest_rad - swing_rad);
        let (left, right) = (bearing_rad + swing_rad, bearing_rad - swing_rad);
        let (near, middle, far) = self.downs();
        self.begin(&[
            (bearing_rad, self.walking.gaze_steep),
            (left, near),
            (right, near),
            (right, far),
            (left, far),
            (bearing_rad, middle),
        ]);
    }

    /// Begins to look for what the feet stand on: down before them, far to both sides, and down again, where it waits for frames.
    pub(crate) fn look_down(&mut self) {
        let aside_rad = self.walking.tuning.gaze.aside;
        let swing_rad = self.tuning.swing.min(self.walking.sweep);
        let (feet, near) = (self.walking.gaze_feet, self.walking.gaze_near);
        self.begin(&[
            (0.0, feet),
            (swing_rad, near),
            (-swing_rad, near),
            (-aside_rad, feet),
            (aside_rad, feet),
            (0.0, feet),
        ]);
    }

    /// Begins to look at stairs from near by: at their first edge and up or down all of them.
    pub(crate) fn inspect(&mut self, place_m: [f64; 2]) {
        let Gaze { pan_rad, down_rad } = self.towards(place_m);
        let tuning = &self.tuning;
        let (left, right) = (
            pan_rad + tuning.inspect_aside,
            pan_rad - tuning.inspect_aside,
        );
        let (near, middle, far) = self.downs();
        self.begin(&[
            (left, down_rad),
            (right, down_rad),
            (right, near),
            (left, middle),
            (left, far),
            (right, far),
        ]);
    }

    /// How far below the horizon it looks at the ground near by, at that further away, and between them, rad.
    const fn downs(&self) -> (f64, f64, f64) {
        let (near, far) = (self.walking.gaze_near, self.walking.gaze_far);
        (near, f64::midpoint(near, far), far)
    }

    fn begin(&mut self, places: &[(f64, f64)]) {
        self.sweep = Sweep::through(places, self.walking.tuning.gaze.last_frames);
        self.looked_s = 0.0;
        self.frames_before = None;
    }

    /// One tick of the look; true when it is done and its frames were used, or when it takes too long.
    pub(crate) fn advance(&mut self, frames_used: u64, passed_s: f64) -> bool {
        self.looked_s += passed_s;
        let _ = self.frames_before.get_or_insert(frames_used);
        self.sweep.advance(
            &mut self.gazer,
            frames_used,
            passed_s,
            self.walking.gaze_speed,
        ) || self.looked_s > self.walking.tuning.look_around.longest
    }

    /// Whether some frames were used since the look began.
    pub(crate) fn has_glanced(&self, frames_used: u64) -> bool {
        self.frames_before
            .is_some_and(|before| frames_used >= before + self.tuning.glance_frames)
    }

    /// One tick towards a place of the ground in the robot's frame, m.
    pub(crate) fn turn_to(&mut self, place_m: [f64; 2], passed_s: f64) {
        let gaze = self.towards(place_m);
        self.gazer.turn(gaze, passed_s, self.walking.gaze_speed);
    }

    fn towards(&self, [x_m, y_m]: [f64; 2]) -> Gaze {
        let (widest_rad, nearest_m) = (self.walking.sweep, self.tuning.nearest);
        let from_eyes_m = x_m - self.eye_ahead_m;
        let away_m = geometry::hypot(from_eyes_m, y_m).max(nearest_m);
        let pan_rad = libm::atan2(y_m, from_eyes_m.max(nearest_m));
        let down_rad = libm::atan2(self.eye_height_m, away_m);
        Gaze {
            pan_rad: pan_rad.clamp(-widest_rad, widest_rad),
            down_rad: down_rad.clamp(self.walking.gaze_far, self.walking.gaze_steep),
        }
    }
}
