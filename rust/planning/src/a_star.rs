//! The planner: a path by A*, kept as long as it holds.

mod ceilings;
mod choice;
mod felt;
mod path_search;
mod replanners;

use geometry::{Map, Pose, Robot};
use mapping::FloorView;
use settings::{ConfigError, Table, require};
use stairs::{ClimbingConfig, Feet, Staircase};
use terrain::rules::escape;
use terrain::support::stood_on_m;
use terrain::{
    GoalLevel, HeightLimits, LongerLandings, Needs, Rectangle, Rules, Sight, StandingAt, Terrain,
};

use crate::climb_links::{ClimbLinks, Scene};
use crate::outside_window::OutsideWindow;
use crate::path::chosen_search::ChosenSearch;
use crate::path::viewpoints::Viewpoints;
use crate::plan::place_of;
use crate::search::Search;
use crate::{
    AStarConfig, Footprint, Goal, NoWay, Path, Plan, PlanError, Planner, Refusal, TerrainConfig,
    VoronoiConfig,
};

/// Plans by A* on the floor and obstacle grid, and over the stairs that join its levels.
#[derive(Debug, Clone)]
pub struct AStar {
    pub(crate) config: AStarConfig,
    pub(crate) climbing: ClimbingConfig,
    pub(crate) feet: Feet,
    pub(crate) rules: Rules,
    pub(crate) terrain: Terrain,
    pub(crate) links: ClimbLinks,
    pub(crate) search: Search,
    /// How the way to the goal is looked for.
    pub(crate) chosen: ChosenSearch,
    pub(crate) viewpoints: Viewpoints,
    goal_level: GoalLevel,
    landings: LongerLandings,
    pub(crate) outside: OutsideWindow,
    pub(crate) followed: Option<Path>,
    /// Where the path that is followed was to lead.
    goal: Option<Goal>,
    /// Whether that lay in the window when the path was found.
    goal_inside: bool,
}

impl AStar {
    /// The name by which it is chosen.
    pub const NAME: &'static str = "a_star";

    /// A planner for a robot of this radius, unless the configuration has another, that climbs with these feet.
    pub fn new(
        config: AStarConfig,
        climbing: ClimbingConfig,
        feet: Feet,
        robot_radius_m: f64,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        settings::Table::check(&climbing)?;
        let radius_m = config.radius.unwrap_or(robot_radius_m);
        let holds = radius_m > 0.0 && radius_m.is_finite();
        require(holds, "navigation.a_star.radius", "> 0", radius_m)?;
        let step_m = climbing.ascend.step_max_z.max(-climbing.descend.step_min_z);
        let limits = HeightLimits {
            floor_m: config.max_step,
            step_m: step_m + climbing.tolerance,
        };
        let needs = Needs {
            limits,
            body_m: radius_m + config.margin,
            feet_m: 0.5 * feet.pair_width_m + config.foot_margin,
            turned: None,
        };
        Ok(Self {
            terrain: Terrain::new(needs, config.cells()),
            viewpoints: Viewpoints::new(config.tuning.viewpoints.clone()),
            outside: OutsideWindow::new(config.tuning.outside_window.clone()),
            config,
            climbing,
            feet,
            rules: Rules::default(),
            links: ClimbLinks::default(),
            search: Search::default(),
            chosen: ChosenSearch::default(),
            goal_level: GoalLevel::default(),
            landings: LongerLandings::default(),
            followed: None,
            goal: None,
            goal_inside: false,
        })
    }

    /// The planner with rules of its own for what a cell is.
    pub fn with_rules(mut self, config: TerrainConfig) -> Result<Self, ConfigError> {
        config.check()?;
        self.terrain.room = config.room.clone();
        self.rules.config = config;
        Ok(self)
    }

    /// The planner for a robot that is as deep from front to back and as wide while it walks sideways, m: used with the footprint
    /// `oriented`.
    #[must_use]
    pub fn with_rectangle(mut self, [depth_m, width_m]: [f64; 2]) -> Self {
        let turns = self.config.footprint == Footprint::Oriented;
        self.terrain.needs.turned = turns.then_some(Rectangle {
            half_depth_m: 0.5 * depth_m + self.config.margin,
            half_width_m: 0.5 * width_m + self.config.margin,
        });
        self
    }

    /// The planner on the lines of the generalized Voronoi diagram: with as much room to either side as there is.
    pub fn along_voronoi(mut self, config: VoronoiConfig) -> Result<Self, ConfigError> {
        config.check()?;
        self.rules.follow_lines(config);
        Ok(self)
    }

    /// Room that the robot needs around its middle, m.
    pub fn needed_m(&self) -> f64 {
        self.terrain.needs.body_m
    }

    /// Distance from a place to the nearest obstacle as of the last plan, m; `None` outside the window.
    pub fn clearance_m(&self, x_m: f64, y_m: f64) -> Option<f64> {
        let index = self.terrain.index_at([x_m, y_m])?;
        Some(self.terrain.clearance_m(index))
    }
}

impl Planner for AStar {
    fn plan(
        &mut self,
        view: &FloorView,
        stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> Result<Plan, PlanError> {
        let (start, by_legs_m) = place_of(start, goal)?;
        let told_m = self.climbing.levels.told;
        let height_m = stood_on_m(stairs, [start.x_m, start.y_m], by_legs_m, told_m);
        let stand = StandingAt {
            at_m: [start.x_m, start.y_m],
            height_m,
            heading_rad: start.yaw_rad,
            gradient: view.gradient_at(start.x_m, start.y_m),
        };
        let levels = &self.climbing.levels;
        let mut levelled =
            (self.goal_level).of(goal, view, &stand, (&self.rules.config.goal_level, levels));
        self.viewpoints.begin(&levelled);
        self.look(view, stairs, stand, &levelled);
        self.outside.look(&self.terrain, stand.at_m, &levelled);
        let settled = stairs.stairs.is_empty();
        let rest = match self.rest(&stand, &levelled) {
            Some(rest) if rest.in_passage() => return Ok(self.hold(rest)),
            Some(rest) if rest.end.is_certain() && settled && !self.is_revealed(&rest) => {
                return Ok(self.hold(rest));
            }
            other => other,
        };
        let mut found = self.find(&stand, &levelled);
        let elsewhere = |no_way: &NoWay| no_way.refusal != Refusal::TooSteep;
        if found.as_ref().is_err_and(elsewhere) && self.goal_level.is_seen() {
            levelled = self.goal_level.give_up(goal);
            found = self.find(&stand, &levelled);
        }
        let barred = (found.as_ref()).map_or(true, |path| !path.end.is_certain());
        if found.is_err()
            && let Some(no_way) = self.over_felt((view, stairs), &stand, &levelled)
        {
            found = Err(no_way);
        } else if barred
            && let Some(no_way) = self.under_ceilings((view, stairs), &stand, &levelled)
        {
            found = Err(no_way);
        }
        Ok(self.choose(rest, found, &levelled, &start))
    }

    fn forget(&mut self) {
        self.followed = None;
        self.chosen.forget();
        self.viewpoints.forget();
        self.goal_level = GoalLevel::default();
        self.outside.forget();
    }

    fn distance_field_m(&self) -> Option<Vec<f32>> {
        let cells = 0..self.terrain.blocked.len();
        Some(cells.map(|i| self.terrain.clearance_m(i) as f32).collect())
    }
}

impl AStar {
    /// Reads the view and the stairs.
    fn look(&mut self, view: &FloorView, stairs: &Staircase, stand: StandingAt, goal: &Goal) {
        let sightings = self.config.step_sightings;
        let seen = (&stand, goal);
        let landings = (&self.rules.config.longer_landings, &self.climbing.levels);
        let stairs = (self.landings).read(stairs, view, seen, sightings, landings);
        let sight = Sight {
            view,
            stairs,
            stand,
            goal_m: goal.height_m,
        };
        self.rules.read(&mut self.terrain, &sight);
        let scene = Scene {
            terrain: &self.terrain,
            view,
            climbing: &self.climbing,
            feet: &self.feet,
            config: &self.config,
            stand,
            goal: *goal,
            looked_m: self.viewpoints.looked_m(),
        };
        self.links.read(&scene, stairs);
        self.links.add_passages(&scene);
        let stuck = (self.terrain.index_at(stand.at_m))
            .is_some_and(|start| self.links.links.from(start).next().is_none());
        if stuck && self.terrain.is_in_passage(&stand) {
            escape::open(&mut self.terrain, stand.at_m);
        }
    }
}
