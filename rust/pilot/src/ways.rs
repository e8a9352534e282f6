//! Ways over a floor and stairs of anyone's, by a planner of the list: no senses, no map, no behaviour.

use geometry::{Goal, Map, Pose, Robot};
use mapping::FloorView;
use planning::{AStarConfig, NoWay, Plan, Planner, PlannerNeeds};
use robot::{Body, Description};
use settings::{Tables, read};
use stairs::{ClimbingConfig, Feet, Footing, Onward, Staircase};
use walking::GaitConfig;

use crate::{PLANNERS, PilotError, registry, sized};

/// Plans ways for one robot.
pub struct Ways {
    planner: Box<dyn Planner>,
    config: AStarConfig,
    climbing: ClimbingConfig,
    feet: Feet,
}

impl Ways {
    /// The planner of that name for a robot, with the tables of `[navigation]`.
    ///
    /// # Errors
    ///
    /// There is no such planner, or the robot or a setting cannot be used.
    pub fn new(name: &str, tables: &Tables, robot: Description) -> Result<Self, PilotError> {
        let body = Body::new(robot)?;
        let (gait, _) = GaitConfig::read(&body)?;
        let feet = registry::feet(&body, &gait);
        let tables = &sized(tables, &body.description().size());
        let needs = PlannerNeeds {
            tables,
            body: &body,
            feet,
            known_map: None,
        };
        Ok(Self {
            planner: PLANNERS.find(name)?(&needs)?,
            config: read(tables, "a_star")?,
            climbing: read(tables, "climbing")?,
            feet,
        })
    }

    /// The way from `start` to the goal, or why there is none.
    ///
    /// # Errors
    ///
    /// Start or goal is no place.
    pub fn plan(
        &mut self,
        view: &FloorView,
        stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> Result<Plan, PilotError> {
        Ok(self.planner.plan(view, stairs, start, goal)?)
    }

    /// Where the feet go on a stair that is `rise_m` higher than the ground before it and `width_m` wide, or why they do not.
    ///
    /// # Errors
    ///
    /// The stair is not stepped on: a word and a sentence with figures.
    pub fn footing(&self, rise_m: f64, width_m: f64, onward: Onward) -> Result<Footing, NoWay> {
        Footing::on_stair(&self.climbing, &self.feet, rise_m, width_m, onward)
            .map_err(|limit| NoWay::unfit(&self.climbing, &self.config, limit))
    }
}
