//! What the core is told before the first tick: the robot, where it starts, where it shall go, its components.

use std::collections::BTreeMap;

use geometry::{Map, Pose, Robot};
use planning::Goal;
use robot::Description;
use serde::Deserialize;

use crate::tables;

/// Everything the core is told at the start. Metres and radians.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The robot's body.
    pub robot: Description,
    /// Where the robot stands at the start; `null` where it has to find out.
    #[serde(deserialize_with = "Option::deserialize")] // or it might be left out
    pub start: Option<StartSettings>,
    /// Where it shall go: the via points in order, the goal last.
    pub goals: Vec<GoalSettings>,
    /// Its components and their parameters.
    pub navigation: Navigation,
}

/// The robot's frame in the map at the start.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StartSettings {
    /// Place x and y, m.
    pub position: [f64; 2],
    /// Height of the ground there, m.
    pub height: f64,
    /// Heading, rad.
    pub yaw: f64,
}

/// One place to go to.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalSettings {
    /// Place x and y, m.
    pub position: [f64; 2],
    /// Height of the level, m, where given.
    #[serde(default)]
    pub height: Option<f64>,
    /// Radius of the disc, m.
    pub radius: f64,
}

/// Names of the components, and a table of parameters for each name.
#[derive(Debug, Clone, Deserialize)]
pub struct Navigation {
    /// Name of the world model.
    pub world_model: String,
    /// Name of the segmenter.
    pub segmenter: String,
    /// Name of the localizer.
    pub localizer: String,
    /// Name of the planner.
    pub planner: String,
    /// Name of the behaviour.
    pub behaviour: String,
    /// Name of the walker. Recordings from before there was a choice do not say it.
    #[serde(default = "first_walker")]
    pub walker: String,
    /// `[navigation.<name>]`, as the user wrote them.
    #[serde(flatten)]
    pub tables: BTreeMap<String, serde_json::Value>,
}

fn first_walker() -> String {
    "dcm".to_owned()
}

impl Settings {
    /// The same with the defaults of a robot of this size.
    pub(crate) fn sized(&self) -> Self {
        let mut sized = self.clone();
        sized.navigation.tables = tables::sized(&sized.navigation.tables, &sized.robot.size());
        sized
    }

    /// The robot's frame in the map at the start: the map's origin where nobody says.
    pub(crate) fn start_or_origin(&self) -> Pose<Map, Robot> {
        self.start.map_or_else(Pose::identity, Pose::from)
    }
}

impl From<StartSettings> for Pose<Map, Robot> {
    fn from(start: StartSettings) -> Self {
        Self::from_yaw(
            start.position[0],
            start.position[1],
            start.height,
            start.yaw,
        )
    }
}

impl From<GoalSettings> for Goal {
    fn from(goal: GoalSettings) -> Self {
        Self {
            x_m: goal.position[0],
            y_m: goal.position[1],
            radius_m: goal.radius,
            height_m: goal.height,
        }
    }
}
