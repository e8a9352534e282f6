//! Settings of the watch over the scene.

use settings::{POSITIVE, SHARE, above_to, at_least, settings};

settings! {
    /// When two pictures cannot have been taken from the two places that body and legs tell.
    pub struct SceneWatchConfig("navigation.scene_watch") {
        /// Pixels of a picture that are held against an earlier one, if so many were measured.
        points: usize = 500, "px", at_least(10.0);
        /// Share of them that both pictures must show.
        shared: f64 = 0.3, "1", above_to(0.0, 1.0);
        /// Longest time between a picture and the next that are compared: in a longer one things move.
        apart: f64 = 0.2, "s" of camera, POSITIVE;
        /// Largest turn of the camera between them: what the joints tell is off by degrees, and a turn about an axis that is off by
        /// as much leaves that share of it.
        turn: f64 = 0.15, "rad", POSITIVE;
        /// A torso that is tilted by more is that of a robot that stumbles: legs and gyroscope do not tell just where its camera is.
        upright: f64 = 0.15, "rad", POSITIVE;
        /// Time from the first picture of an upright robot on in which nothing is claimed: the head comes to where it is held.
        settling: f64 = 1.0, "s" of camera, POSITIVE;
        /// Pictures in a row that must contradict the last one that did not: one alone may be the head's jerk.
        pictures: u16 = 3, "1", at_least(1.0);
        /// A disparity that differs by more from all that was seen within a pixel of there is of something else.
        differs: f64 = 0.4, "px", POSITIVE;
        /// A robot was carried off where at least this share of the points shows something nearer than what was seen there, and at
        /// least as many something farther.
        changed: f64 = 0.05, "1", above_to(0.0, 1.0);
        /// It was not where more than this share of what stood out of the ground, and is not hidden, is where it was: what moves leaves
        /// what stands.
        kept: f64 = 0.25, "1", SHARE;
        /// What lay less high above the ground, or less deep below it, was floor; so much at the camera.
        floor: f64 = 0.03, "m", POSITIVE;
        /// For each metre of depth it may lie so much higher, or deeper.
        floor_noise: f64 = 0.05, "1", SHARE;
        /// The camera was turned, or measures otherwise, where the disparities of the floor are off by more than this share of them in
        /// the middle.
        turned: f64 = 0.03, "1", above_to(0.0, 1.0);
        /// What is off by more than this is something else, which came before the camera or went.
        turned_most: f64 = 0.3, "1", above_to(0.0, 1.0);
        /// A camera that was turned leaves hardly any floor off by less than this: what comes or goes leaves floor where it was.
        floor_off: f64 = 0.01, "1", above_to(0.0, 1.0);
        /// Share of the floor's points that may be off by less.
        floor_left: f64 = 0.2, "1", SHARE;
    }
}
