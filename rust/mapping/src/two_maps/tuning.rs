//! Settings of the two maps that few will want to turn.

use settings::{NOT_NEGATIVE, POSITIVE, at_least, settings, within};

settings! {
    /// Numbers behind the static and the local map.
    pub struct TwoMapsTuning("navigation.octree.tuning") {
        /// The window holds a static map as a whole up to so many cells along a side; a larger map is looked at around the robot.
        whole_map: f64 = 1000.0, "1", NOT_NEGATIVE;
        /// The robot is on another level, and all is looked at anew, when its height differs by more than so many voxels.
        same_level: f64 = 0.5, "1", NOT_NEGATIVE;
        /// Floors of other levels are looked for at least this far above and below what the robot stands on.
        levels: f64 = 0.3, "m", NOT_NEGATIVE;
        /// Floors of other levels are looked for at most this far below what the robot stands on: it can see no more of them.
        deepest: f64 = 1.0, "m", POSITIVE;
        /// What a frame's points tell the local map.
        beams: BeamsTuning;
        /// What is seen of the static map.
        known_surfaces: KnownSurfacesTuning;
        /// Lines of sight on which nothing was seen.
        empty_sight: EmptySightTuning;
    }
}

settings! {
    /// What a frame's points tell the local map.
    pub struct BeamsTuning("navigation.octree.tuning.beams") {
        /// Points beside each other lie on one surface when they are nearer to each other than this share of how far away they are:
        /// 8 pixels of 320 on a surface that is seen at 20 degrees.
        same_surface: f32 = 0.1, "1", POSITIVE;
        /// So many of the four pixels beside one have to see its surface; otherwise it is an error of the camera.
        support: usize = 2, "1", within(0.0, 4.0);
        /// So many beams a voxel, along rows and along columns of the picture, are enough to pass it; nearer there are more, which are
        /// left out.
        per_voxel: f64 = 2.0, "1", at_least(1.0);
    }
}

settings! {
    /// What is seen of the static map.
    pub struct KnownSurfacesTuning("navigation.octree.tuning.known_surfaces") {
        /// What is nearer than this is taken in even where the static map has it: there it matters, and there it is where it is seen.
        near: f64 = 1.2, "m", NOT_NEGATIVE;
        /// What is seen of the static map may lie this far off: by voxels and by where the robot is.
        off: f64 = 0.04, "m", NOT_NEGATIVE;
        /// What is seen of the static map may lie so much further off per metre of range: by the robot's heading and the camera.
        off_per_range: f64 = 0.04, "1", NOT_NEGATIVE;
    }
}

settings! {
    /// Lines of sight on which nothing was seen.
    pub struct EmptySightTuning("navigation.octree.tuning.empty_sight") {
        /// A line of sight is believed to be empty only where nothing was seen in so many pixels above, below and beside it either.
        beside: usize = 2, "1", within(0.0, 1000.0);
    }
}
