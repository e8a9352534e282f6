//! Settings of the correction of the camera's pose.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, settings, within};

settings! {
    /// How the camera's pose is corrected by the ground, from frame to frame.
    pub struct CorrectionTuning("navigation.ground.tuning.correction") {
        /// Standard deviation of the body's roll error before any ground was seen. Nothing but the legs' encoders lets the trunk roll.
        body_roll: f64 = 0.015, "rad", POSITIVE;
        /// Standard deviation of the body's pitch error before any ground was seen.
        body_pitch: f64 = 0.025, "rad", POSITIVE;
        /// Standard deviation of the head's pitch error and of its roll error before any ground was seen. The neck's joint errs more
        /// than the trunk's.
        head: f64 = 0.09, "rad", POSITIVE;
        /// Standard deviation of the error of the camera's height before any ground was seen.
        height: f64 = 0.008, "m", POSITIVE;
        /// Standard deviation of the error of the camera's place in the head, ahead and above, before any ground was seen.
        place: f64 = 0.005, "m", POSITIVE;
        /// Share of the camera's height by which the place that the trunk turns about lies below the camera.
        trunk: f64 = 0.45, "1", SHARE;
        /// Standard deviation by which each angle of the correction may wander from frame to frame.
        wander: f64 = 0.0003, "rad", NOT_NEGATIVE;
        /// Standard deviation by which the correction of the height may wander from frame to frame.
        height_wander: f64 = 0.0002, "m", NOT_NEGATIVE;
        /// Standard deviation by which the body's angles may wander from frame to frame until the track is seasoned: a robot that was
        /// put down has yet to find out how it stands.
        settling_wander: f64 = 0.001, "rad", NOT_NEGATIVE;
        /// Standard deviation of one frame's attitude against the filtered one while walking.
        sway: f64 = 0.01, "rad", POSITIVE;
        /// Standard deviation of the floor's height in the middle of one frame's picture while walking.
        height_sway: f64 = 0.003, "m", POSITIVE;
        /// Cosine of the turn of the camera's axis from which on it looks in another direction: two pixels. Frames from one direction
        /// err alike, so that each tells less than the one before it.
        other_direction: f64 = 0.9998, "1", within(-1.0, 1.0);
        /// Farthest that the middle of the picture counts as floor.
        farthest: f64 = 0.6, "m", POSITIVE;
        /// Frames with ground after which a track is settled. Before that the ground is searched as widely as at first, for the
        /// attitude settles in these frames, too, and a first find may be a bad one.
        settled: u32 = 8, "frames", within(1.0, 1e6);
        /// Frames with ground after which a track is seasoned: what contradicts it then is no floor.
        seasoned: u32 = 25, "frames", within(1.0, 1e6);
        /// Frames without ground after which a track that has not settled is given up: as many as the head takes to look elsewhere
        /// and come back.
        young_misses: u32 = 40, "frames", within(0.0, 1e6);
        /// Finds from afar that contradict a young track in a row after which it is given up.
        young_contradictions: u32 = 3, "1", within(0.0, 1e6);
        /// Tilt by which a find contradicts a young track: one of both was no ground.
        contradicting_tilt: f64 = 0.05, "rad", POSITIVE;
        /// Height by which a find contradicts a young track.
        contradicting_height: f64 = 0.012, "m", POSITIVE;
        /// Tilt by which a find contradicts a young track when one of both was told by what is near the feet and the other was not.
        contradicting_near: f64 = 0.025, "rad", POSITIVE;
    }
}
