//! Parameters of the mesh, checked once.

use meshes::{FusionConfig, JoiningConfig, SimplifyConfig};
use settings::{POSITIVE, at_least, settings, within};

settings! {
    /// What the mesh (004, section 36.3.3) has beside `[navigation.elevation]`, which it reads, too; of that `cells`, `pyramid` and `fill` are not
    /// used.
    pub struct MeshConfig("navigation.mesh") {
        /// Room between two things above each other with which both are kept. Left out: the robot's own height.
        headroom: Option<f64> = None, "m", within(0.01, 100.0);
        /// Triangles that are inclined more than this are walls, no ground.
        steepest: f64 = 0.7, "rad", within(0.01, 1.5);
        /// What is further away from the robot than this is forgotten.
        kept: f64 = 20.0, "m", within(0.1, 1e6);
        /// Where surfaces end.
        joining: JoiningConfig;
        /// How frames are fused.
        fusion: FusionConfig;
        /// How the mesh is simplified for files; the robot walks on the whole one.
        simplify: SimplifyConfig;
        /// Numbers that few will want to turn.
        tuning: MeshTuning;
    }
}

settings! {
    /// Numbers behind the mesh.
    pub struct MeshTuning("navigation.mesh.tuning") {
        /// Levels that lie this near above each other, in rises of `[navigation.elevation]`, are one way for the robot.
        joined: f64 = 1.0, "1", POSITIVE;
        /// Surfaces that fewer frames saw are not shown: single ones are mismatches.
        least_frames: u16 = 1, "1", at_least(1.0);
        /// Triangles of a cell that lie less than this apart, in rises of `[navigation.elevation]`, are of one thing.
        apart: f64 = 1.0, "1", POSITIVE;
    }
}
