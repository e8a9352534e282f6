//! The planner: a path by A*, kept as long as it holds.

use geometry::{ConfigError, Map, PlanarPose, Pose, Robot, angle_between, require};
use mapping::FloorView;
use stairs::{ClimbingConfig, Feet, Staircase};

use crate::refusal::explain;
use crate::route::Ends;
use crate::search::Search;
use crate::shortcut::{annotate, path};
use crate::terrain::Terrain;
use crate::{AStarConfig, Goal, NoWay, Path, Plan, PlanError, Planner};

/// How far ahead on the path the robot is looked for, m: a path may come back to where it passed.
const PROGRESS_M: f64 = 0.6;
/// Where a path leads at first is seen this far from the robot, m.
const SETTING_OFF_M: f64 = 0.25;
/// A path that ends at the window's border is planned anew when less than this is left of it, m.
const HORIZON_M: f64 = 1.0;

/// Plans by A* on the floor and obstacle grid.
#[derive(Debug, Clone)]
pub struct AStar {
    config: AStarConfig,
    radius_m: f64,
    terrain: Terrain,
    search: Search,
    kept: Option<Kept>,
}

/// The path that is being followed.
#[derive(Debug, Clone)]
struct Kept {
    path: Path,
    goal: Goal,
    /// Whether it leads to the goal, or only to the border of the window.
    complete: bool,
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
        climbing.check()?;
        let _ = feet;
        let radius_m = config.radius.unwrap_or(robot_radius_m);
        let holds = radius_m > 0.0 && radius_m.is_finite();
        require(holds, "navigation.a_star.radius", "> 0", radius_m)?;
        Ok(Self {
            config,
            radius_m,
            terrain: Terrain::new(),
            search: Search::default(),
            kept: None,
        })
    }

    /// Room that the robot needs around its middle, m.
    pub fn needed_m(&self) -> f64 {
        self.radius_m + self.config.margin
    }

    /// Distance from a place to the nearest obstacle as of the last plan, m; `None` outside the window.
    pub fn clearance_m(&self, x_m: f64, y_m: f64) -> Option<f64> {
        let index = self.terrain.index_at([x_m, y_m])?;
        Some(self.terrain.clearance_m(index))
    }

    /// The path before, its passed part cut off, if it still holds; and whether part of it became known.
    fn keep(&self, start_m: [f64; 2], goal: &Goal) -> Option<(Path, bool)> {
        let kept = self.kept.as_ref().filter(|kept| kept.goal == *goal)?;
        let points = rest_of(&kept.path.points_m, start_m, self.config.stray)?;
        if !kept.complete {
            let inside = self.terrain.index_at([goal.x_m, goal.y_m]).is_some();
            let left = points.len() as f64 * self.terrain.lattice.cell_m;
            if inside || left < HORIZON_M {
                return None;
            }
        }
        let path = annotate(&self.terrain, points);
        // An obstacle may seem half a cell nearer without a new plan.
        let least_m = (self.needed_m() - 0.5 * self.terrain.lattice.cell_m).max(self.radius_m);
        let holds = path
            .points_m
            .iter()
            .zip(&path.clearance_m)
            .all(|(point, &clearance_m)| {
                let Some(index) = self.terrain.index_at(*point) else {
                    return false;
                };
                clearance_m >= least_m || self.terrain.weights[index].is_finite()
            });
        let unseen = |path: &Path| path.unknown.iter().filter(|&&u| u).count();
        let revealed = unseen(&path) < unseen(&kept.path);
        holds.then_some((path, revealed))
    }

    /// A new path over the terrain.
    fn find(&mut self, view: &FloorView, start_m: [f64; 2], goal: &Goal) -> Result<Kept, NoWay> {
        let terrain = &self.terrain;
        let outside = || NoWay {
            refusal: crate::Refusal::NoPath,
            sentence: "the robot stands outside of its map".into(),
        };
        let start = terrain.index_at(start_m).ok_or_else(outside)?;
        let ends = Ends::new(terrain, view, goal);
        let route = self.search.run(
            &terrain.weights,
            terrain.cols,
            start,
            |cell| ends.cost(cell),
            |cell| ends.remaining(cell),
        );
        let Some(route) = route else {
            let needed_m = self.radius_m + self.config.margin;
            return Err(explain(terrain, &ends, start, needed_m, goal));
        };
        let last = route.cells.last().map_or(start, |&cell| cell as usize);
        let middle = [goal.x_m, goal.y_m];
        let holds_middle = terrain.index_at(middle) == Some(last);
        let end = if holds_middle {
            middle
        } else {
            terrain.center_m(last)
        };
        Ok(Kept {
            path: path(terrain, &route.cells, start_m, end),
            goal: *goal,
            complete: ends.inside,
        })
    }
}

impl Planner for AStar {
    fn plan(
        &mut self,
        view: &FloorView,
        _stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> Result<Plan, PlanError> {
        let origin = start.origin().inner;
        let start = PlanarPose::new(origin.x, origin.y, start.yaw_rad());
        if !(start.x_m.is_finite() && start.y_m.is_finite()) {
            return Err(PlanError::NotFinite("the start"));
        }
        let height = goal.height_m.unwrap_or(0.0);
        if !(goal.x_m + goal.y_m + goal.radius_m + height).is_finite() {
            return Err(PlanError::NotFinite("the goal"));
        }
        let start_m = [start.x_m, start.y_m];
        let needed_m = self.needed_m();
        self.terrain.read(view, start_m, needed_m, &self.config);
        let kept = self.keep(start_m, goal);
        if let Some((path, false)) = kept {
            return Ok(self.hold(path));
        }
        let found = self.find(view, start_m, goal);
        let cost_m = |path: &Path| path.cost_m + self.config.turn_cost * turn_rad(path, &start);
        match (kept, found) {
            (Some((path, _)), Ok(new))
                if cost_m(&new.path) >= self.config.better * cost_m(&path) =>
            {
                Ok(self.hold(path))
            }
            (Some((path, _)), Err(_)) => Ok(self.hold(path)),
            (_, Ok(new)) => {
                let path = new.path.clone();
                self.kept = Some(new);
                Ok(Plan {
                    way: Ok(path),
                    replanned: true,
                })
            }
            (None, Err(no_way)) => {
                self.kept = None;
                Ok(Plan {
                    way: Err(no_way),
                    replanned: true,
                })
            }
        }
    }

    fn distance_field_m(&self) -> Option<Vec<f32>> {
        let cells = 0..self.terrain.blocked.len();
        Some(cells.map(|i| self.terrain.clearance_m(i) as f32).collect())
    }
}

impl AStar {
    /// Goes on with the path before.
    fn hold(&mut self, path: Path) -> Plan {
        if let Some(kept) = &mut self.kept {
            kept.path.clone_from(&path);
        }
        Plan {
            way: Ok(path),
            replanned: false,
        }
    }
}

/// How far the robot has to turn to set off on a path, rad.
fn turn_rad(path: &Path, start: &PlanarPose) -> f64 {
    let away_m = |point: &&[f64; 2]| (point[0] - start.x_m).hypot(point[1] - start.y_m);
    let ahead = path
        .points_m
        .iter()
        .find(|point| away_m(point) > SETTING_OFF_M);
    ahead.map_or(0.0, |[x, y]| {
        let bearing_rad = (y - start.y_m).atan2(x - start.x_m);
        angle_between(start.yaw_rad, bearing_rad).abs()
    })
}

/// The points from where the robot is beside the path onward; `None` where it strayed too far.
fn rest_of(points: &[[f64; 2]], at: [f64; 2], stray_m: f64) -> Option<Vec<[f64; 2]>> {
    let mut best: Option<(f64, usize, [f64; 2])> = None;
    let mut along = 0.0;
    for (i, pair) in points.windows(2).enumerate() {
        let d = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = d[0].hypot(d[1]);
        let dot = (at[0] - pair[0][0]) * d[0] + (at[1] - pair[0][1]) * d[1];
        let t = if length > 0.0 {
            (dot / (length * length)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let foot = [pair[0][0] + t * d[0], pair[0][1] + t * d[1]];
        let away = (at[0] - foot[0]).hypot(at[1] - foot[1]);
        if best.is_none_or(|(least, ..)| away < least) {
            best = Some((away, i, foot));
        }
        along += length;
        if along > PROGRESS_M {
            break;
        }
    }
    let (away, i, foot) = best?;
    (away <= stray_m).then(|| {
        std::iter::once(foot)
            .chain(points[i + 1..].iter().copied())
            .collect()
    })
}
