//! Settings of the known map.

use serde::{Deserialize, Serialize};
use settings::{ANY, NOT_NEGATIVE, POSITIVE, above, choices, settings, within};

/// Where in the occupied voxels of the map its surfaces lie.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, settings::schemars::JsonSchema,
)]
#[schemars(crate = "settings::schemars")]
#[serde(rename_all = "snake_case")]
pub enum MapSurfaces {
    /// As free space says: rays that told of it measured the map, and one in which there is none was made of solids.
    Auto,
    /// At the faces between occupied voxels and others: solids fill the voxels whose centres they hold.
    Faces,
    /// Inside: a voxel is occupied where a measured range ended in it.
    Inside,
}

choices!(MapSurfaces);

settings! {
    /// The map that the robot is told before it starts: made of the course, or read from the OctoMap file (`.bt`, `.ot`) that a scenario
    /// names as `file`, by its path from the scenario file's folder.
    pub struct KnownMapConfig("navigation.static_map") {
        /// Side of the voxels of the map that the harness makes of a course. A map from a file has its own.
        resolution: f64 = 0.04, "m", POSITIVE;
        /// Where in the occupied voxels the surfaces lie, which rays and distances end at.
        surfaces: MapSurfaces = MapSurfaces::Auto, "-", ANY;
        /// Numbers behind what the robot reads from the map.
        tuning: KnownMapTuning;
    }
}

settings! {
    /// What the robot reads from the map that it is told.
    pub struct KnownMapTuning("navigation.static_map.tuning") {
        /// A map is not cut into voxels of another size when that makes more solid ones than this; it is refused.
        most_voxels: f64 = 2e7, "1", POSITIVE;
        /// Where in voxels that were measured the surface lies.
        surface: InnerSurfaceTuning;
        /// Where a body has room to stand.
        standing: StandingTuning;
        /// Ways over the map's floors, by which the planner is guided.
        floors: FloorsTuning;
        /// What the planner expects where nothing was seen yet.
        prior: PriorTuning;
        /// The map around the robot, as the world model `octree` reads it.
        around: AroundTuning;
    }
}

settings! {
    /// Where in voxels that were measured the surface lies: in the plane of what is occupied about each.
    pub struct InnerSurfaceTuning("navigation.static_map.tuning.surface") {
        /// Voxels to each side that are looked at: measured surfaces are one to three voxels thick.
        reach: usize = 2, "1", within(1.0, 4.0);
        /// It is a plane where the variance across is at most this share of the next one; else rays end beside the middle.
        flatness: f64 = 0.25, "1", within(0.0, 1.0);
        /// Sine of the angle between a ray and a plane below which it ends beside the middle, too: 3 degrees.
        glancing: f64 = 0.05, "1", within(0.001, 1.0);
        /// By how much, as a share of a voxel, the surface lies before the middle of what is occupied, seen from where rays come from: they
        /// free what noise marks before it, and nothing frees what noise marks behind it.
        before: f64 = 0.1, "1", within(0.0, 1.0);
    }
}

settings! {
    /// Where a body has room to stand in the known map.
    pub struct StandingTuning("navigation.static_map.tuning.standing") {
        /// What rises by no more than this beside a place is a step, not a wall: a body needs room only above it.
        step: f64 = 0.08, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// Floors of the known map, on all its levels, and the ways over them.
    pub struct FloorsTuning("navigation.static_map.tuning.floors") {
        /// Places beside each other are joined when their heights differ by no more than this: floor, a slope, or a step of stairs.
        step: f64 = 0.055, "m", NOT_NEGATIVE;
        /// A metre of height costs as much as so many metres of level way, so that levels are changed only where they have to be.
        climb: f64 = 10.0, "1", NOT_NEGATIVE;
        /// The robot stands on a place that is no further away than this, seen from above.
        near: f64 = 0.3, "m", POSITIVE;
        /// The robot stands on a place, and a goal lies on its level, when their heights differ by less than this.
        level: f64 = 0.06, "m", POSITIVE;
        /// A place is at a step when the height of a place that joins it differs by more than this.
        edge: f32 = 0.01, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// What the known map says of ground that was not seen yet.
    pub struct PriorTuning("navigation.static_map.tuning.prior") {
        /// Floor of the map is on the robot's level when its height differs by no more than this.
        level: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Where the map has another floor within this above or below the robot's, nothing stands: it is another level.
        other_level: f64 = 0.5, "m", NOT_NEGATIVE;
        /// What the map has no higher than this above the robot's floor is no obstacle.
        step: f64 = 0.1, "m", NOT_NEGATIVE;
        /// Nothing that is seen further than this from the map's steps is a riser: the robot may be as far off, and its camera at an angle.
        stairs: f64 = 0.25, "m", NOT_NEGATIVE;
    }
}

settings! {
    /// The known map around the robot, as the world model `octree` reads it.
    pub struct AroundTuning("navigation.static_map.tuning.around") {
        /// The floor that the robot stands on is looked for so far around it: the map, or its pose, is a little wrong.
        start: f64 = 0.2, "m", NOT_NEGATIVE;
        /// The floor that the robot stands on is looked for so far below its soles, in voxels.
        start_below: f64 = 1.5, "1", NOT_NEGATIVE;
        /// The floor that the robot stands on is looked for so far above its soles, in voxels.
        start_above: f64 = 0.5, "1", above(-1.0);
        /// A surface this near to the robot's height, in voxels, is its own level and has that height: half a voxel is how it was cut
        /// into voxels, the rest is the pose.
        own_level: f64 = 0.75, "1", NOT_NEGATIVE;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use settings::Table;

    #[test]
    fn the_defaults_can_be_used_and_a_bad_number_is_refused_by_its_key() {
        let mut config = KnownMapConfig::default();
        assert_eq!(config.check(), Ok(()));
        config.tuning.floors.near = 0.0;
        assert_eq!(
            config.check().unwrap_err().to_string(),
            "navigation.static_map.tuning.floors.near must be > 0, got 0"
        );
    }
}
