//! Settings of recognition, and the parameter sets of 003's Table I.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

/// Settings of [`crate::Recognizer`]: `[navigation.stairs]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StairsConfig {
    /// A stair whose front or back edge is shorter is discarded, m (003, section IV.B).
    pub min_edge: f64,
    /// A surface whose front edge is further away is not taken for a stair yet, m: from afar steps run into each other.
    pub max_distance: f64,
    /// A stair that is less deep is discarded, m (003, section IV.B).
    pub min_depth: f64,
    /// Surfaces within this of the robot's height are the ground that it stands on, unless something lies between, m.
    pub own_height: f64,
    /// Stairs that overlap are one when their heights differ by no more than this, m.
    pub similar_height: f64,
    /// Frames in which a stair must be seen before it is believed.
    pub min_frames: u32,
    /// Frames in a row in which something lower is seen in a stair's place before it is dropped.
    pub contradicted_frames: u32,
    /// Steps after which a stair that was not seen again is forgotten.
    pub forget_steps: u32,
    /// Distance beyond which stairs are forgotten, m.
    pub forget_distance: f64,
}

impl Default for StairsConfig {
    fn default() -> Self {
        Self {
            min_edge: 0.15,
            max_distance: 0.9,
            min_depth: 0.07,
            own_height: 0.01,
            similar_height: 0.009,
            min_frames: 2,
            contradicted_frames: 4,
            forget_steps: 80,
            forget_distance: 3.0,
        }
    }
}

impl StairsConfig {
    /// Refuses what cannot be used.
    pub fn check(&self) -> Result<(), ConfigError> {
        let key = |name: &str| format!("navigation.stairs.{name}");
        for (name, value) in [
            ("min_edge", self.min_edge),
            ("max_distance", self.max_distance),
            ("min_depth", self.min_depth),
            ("own_height", self.own_height),
            ("similar_height", self.similar_height),
            ("forget_distance", self.forget_distance),
        ] {
            require(value.is_finite() && value > 0.0, &key(name), "> 0", value)?;
        }
        for (name, value) in [
            ("min_frames", self.min_frames),
            ("contradicted_frames", self.contradicted_frames),
        ] {
            require(value > 0, &key(name), "> 0", value)?;
        }
        Ok(())
    }
}

/// One column of Table I of 003. Places are of the toes past the edge ahead or of the heels past the edge behind, metres,
/// positive beyond the edge in walking direction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterSet {
    /// Least change of height, m: negative for a way down.
    pub step_min_z: f64,
    /// Largest change of height, m.
    pub step_max_z: f64,
    /// How far in front of the first edge the robot aligns, m.
    pub align_distance: f64,
    /// Where the toes are put before the step, past the edge ahead, m.
    pub approach_x: f64,
    /// Least place of the heels past the edge behind, after the step, m.
    pub front_x_limit: f64,
    /// Farthest place of the toes past the edge ahead, when that leads on with this set, m.
    pub back_x_limit: f64,
    /// Where the toes should be past that edge, m.
    pub back_x_desired: f64,
    /// Longest way of the robot's middle in one step onto a stair, m: not in Table I. With legs whose hips stretch back little, the
    /// ankle behind comes to its end as its foot is lifted off a lower step.
    pub longest_stride: f64,
}

/// What the robot climbs: `[navigation.climbing]`, used by planner and behaviour alike.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ClimbingConfig {
    /// Changes of height up to this are floor, m.
    pub floor_max: f64,
    /// Error of a measured height, or depth of a tread, that the limits allow for, m.
    pub tolerance: f64,
    /// Room beside the feet on a stair, to each side, m.
    pub side_room: f64,
    /// Place of the heels past the front edge of what goes on level, m, unless `front_x_limit` asks for more; on the way down 10 mm more.
    pub level_x: f64,
    /// Parameters of a step up.
    pub ascend: ParameterSet,
    /// Parameters of a step down.
    pub descend: ParameterSet,
}

impl Default for ClimbingConfig {
    fn default() -> Self {
        Self {
            floor_max: 0.01,
            tolerance: 0.0025,
            side_room: 0.02,
            level_x: 0.015,
            ascend: ParameterSet {
                step_min_z: 0.015,
                step_max_z: 0.050,
                align_distance: 0.100,
                approach_x: -0.015,
                front_x_limit: -0.025,
                back_x_limit: -0.005,
                back_x_desired: -0.015,
                longest_stride: 0.15,
            },
            descend: ParameterSet {
                step_min_z: -0.050,
                step_max_z: -0.015,
                align_distance: 0.050,
                approach_x: 0.015,
                front_x_limit: 0.015,
                back_x_limit: 0.025,
                back_x_desired: 0.015,
                longest_stride: 0.15,
            },
        }
    }
}

impl ClimbingConfig {
    /// The set for a change of height: up or down.
    pub fn set_for(&self, rise_m: f64) -> &ParameterSet {
        if rise_m > 0.0 {
            &self.ascend
        } else {
            &self.descend
        }
    }

    /// Refuses what cannot be used.
    pub fn check(&self) -> Result<(), ConfigError> {
        for (name, value) in [
            ("floor_max", self.floor_max),
            ("tolerance", self.tolerance),
            ("side_room", self.side_room),
        ] {
            let key = format!("navigation.climbing.{name}");
            require(value.is_finite() && value >= 0.0, &key, ">= 0", value)?;
        }
        for (set, parameters) in [("ascend", &self.ascend), ("descend", &self.descend)] {
            let key = format!("navigation.climbing.{set}.longest_stride");
            let stride = parameters.longest_stride;
            require(stride.is_finite() && stride > 0.0, &key, "> 0", stride)?;
        }
        let level_x = self.level_x;
        let key = "navigation.climbing.level_x";
        require(level_x.is_finite(), key, "finite", level_x)?;
        let up = &self.ascend;
        require(
            0.0 < up.step_min_z && up.step_min_z < up.step_max_z,
            "navigation.climbing.ascend.step_min_z",
            "> 0 and below step_max_z",
            up.step_min_z,
        )?;
        let down = &self.descend;
        require(
            down.step_min_z < down.step_max_z && down.step_max_z < 0.0,
            "navigation.climbing.descend.step_max_z",
            "< 0 and above step_min_z",
            down.step_max_z,
        )
    }
}
