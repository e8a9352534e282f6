//! The planner: a path by A*, kept as long as it holds.

use geometry::{ConfigError, Map, PlanarPose, Pose, Robot, angle_between, require};
use mapping::FloorView;
use stairs::{ClimbingConfig, Feet, Staircase};

use crate::keep::{End, Kept};
use crate::legs::Draft;
use crate::levels::{Limits, Stand};
use crate::portals::{Portals, Scene};
use crate::refusal::{explain, first_limit};
use crate::route::{Ends, end_of, run};
use crate::search::{Route, Search};
use crate::seek::Seek;
use crate::terrain::{Needs, Terrain};
use crate::{AStarConfig, Goal, NoWay, Path, Plan, PlanError, Planner};

/// Where a path leads at first is seen this far from the robot, m.
const SETTING_OFF_M: f64 = 0.25;

/// Plans by A* on the floor and obstacle grid, and over the stairs that join its levels.
#[derive(Debug, Clone)]
pub struct AStar {
    config: AStarConfig,
    climbing: ClimbingConfig,
    feet: Feet,
    terrain: Terrain,
    portals: Portals,
    search: Search,
    seek: Seek,
    kept: Option<Kept>,
}

/// What is left of the path before.
struct Rest {
    draft: Draft,
    path: Path,
    end: End,
    certain: bool,
    /// Whether part of it became known.
    revealed: bool,
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
        let radius_m = config.radius.unwrap_or(robot_radius_m);
        let holds = radius_m > 0.0 && radius_m.is_finite();
        require(holds, "navigation.a_star.radius", "> 0", radius_m)?;
        let step_m = climbing.ascend.step_max_z.max(-climbing.descend.step_min_z);
        let limits = Limits {
            floor_m: config.max_step,
            step_m: step_m + climbing.tolerance,
        };
        let needs = Needs {
            limits,
            body_m: radius_m + config.margin,
            feet_m: 0.5 * feet.pair_width_m + config.foot_margin,
        };
        Ok(Self {
            config,
            climbing,
            feet,
            terrain: Terrain::new(needs),
            portals: Portals::default(),
            search: Search::default(),
            seek: Seek::default(),
            kept: None,
        })
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

    /// A new path over the terrain.
    fn find(&mut self, stand: &Stand, goal: &Goal) -> Result<Kept, NoWay> {
        let terrain = &self.terrain;
        let outside = || NoWay {
            refusal: crate::Refusal::NoPath,
            sentence: "the robot stands outside of its map".into(),
        };
        let start = terrain.index_at(stand.at_m).ok_or_else(outside)?;
        let ends = Ends::new(terrain, goal, stand.height_m, self.config.climb_cost);
        let (search, portals) = (&mut self.search, &self.portals);
        let route = run(search, terrain, portals, &ends, start, false);
        let hoped = |route: &Route| {
            route
                .cells
                .last()
                .is_some_and(|&c| ends.is_blind(c as usize))
        };
        if route.as_ref().is_none_or(hoped)
            && let Some(lifted) = run(search, terrain, portals, &ends, start, true)
            && route.as_ref().is_none_or(|route| lifted.cost < route.cost)
            && let Some(no_way) = first_limit(terrain, portals, &self.climbing, &lifted)
        {
            return Err(no_way);
        }
        let end = route
            .as_ref()
            .map(|route| end_of(route, terrain, portals, &ends));
        let Some((route, end)) = route.zip(end).or_else(|| {
            let levels = terrain.levels.any || ends.on_another_level();
            let route = levels.then(|| self.seek.route(search, terrain, portals, &ends, start));
            route.flatten().map(|route| (route, End::Look))
        }) else {
            return Err(explain(terrain, &self.climbing, &ends, start, goal));
        };
        let end_m = |last: usize| {
            let middle = [goal.x_m, goal.y_m];
            if terrain.index_at(middle) == Some(last) {
                middle
            } else {
                terrain.center_m(last)
            }
        };
        Ok(Kept {
            draft: Draft::of(terrain, portals, &route, stand.at_m, end_m),
            goal: *goal,
            end,
            unknown: 0,
        })
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
        let origin = start.origin().inner;
        let start = PlanarPose::new(origin.x, origin.y, start.yaw_rad());
        if !(start.x_m + start.y_m + start.yaw_rad + origin.z).is_finite() {
            return Err(PlanError::NotFinite("the start"));
        }
        let height = goal.height_m.unwrap_or(0.0);
        if !(goal.x_m + goal.y_m + goal.radius_m + height).is_finite() {
            return Err(PlanError::NotFinite("the goal"));
        }
        let stand = Stand {
            at_m: [start.x_m, start.y_m],
            height_m: origin.z,
            heading_rad: start.yaw_rad,
        };
        self.look(view, stairs, stand, goal);
        self.seek.begin(goal);
        let settled = stairs.stairs.is_empty();
        let kept = self.rest(&stand, goal);
        let kept = match kept {
            Some(rest) if rest.certain && settled && !rest.revealed => return Ok(self.hold(rest)),
            other => other,
        };
        let found = self.find(&stand, goal);
        Ok(self.choose(kept, found, &start))
    }

    fn distance_field_m(&self) -> Option<Vec<f32>> {
        let cells = 0..self.terrain.blocked.len();
        Some(cells.map(|i| self.terrain.clearance_m(i) as f32).collect())
    }
}

impl AStar {
    /// Reads the view and the stairs.
    fn look(&mut self, view: &FloorView, stairs: &Staircase, stand: Stand, goal: &Goal) {
        self.terrain
            .read(view, stairs, &stand, goal.height_m, &self.config);
        let scene = Scene {
            terrain: &self.terrain,
            view,
            climbing: &self.climbing,
            feet: &self.feet,
            config: &self.config,
            stand,
            goal: *goal,
        };
        self.portals.read(&scene, stairs);
    }

    /// What is left of the path before where it holds.
    fn rest(&mut self, stand: &Stand, goal: &Goal) -> Option<Rest> {
        let kept = self.kept.as_ref().filter(|kept| kept.goal == *goal)?;
        if kept.end == End::Look
            && let Some(&end_m) = kept.draft.points_m.last()
            && self.seek.arrive(stand.at_m, end_m)
        {
            return None;
        }
        let draft = kept.rest(&self.terrain, &self.portals, stand.at_m, &self.config)?;
        let path = draft.annotate(&self.terrain, self.config.climb_cost);
        Some(Rest {
            revealed: unknown_in(&path) < kept.unknown,
            certain: kept.end.is_certain(),
            end: kept.end,
            draft,
            path,
        })
    }

    /// The path before, or the new one if it is much better or leads further.
    fn choose(
        &mut self,
        kept: Option<Rest>,
        found: Result<Kept, NoWay>,
        start: &PlanarPose,
    ) -> Plan {
        let (new, kept) = match (found, kept) {
            (Ok(new), kept) => (new, kept),
            (Err(_), Some(rest)) if rest.certain => return self.hold(rest),
            (Err(no_way), _) => {
                self.kept = None;
                return Plan {
                    way: Err(no_way),
                    replanned: true,
                };
            }
        };
        let path = new.draft.annotate(&self.terrain, self.config.climb_cost);
        let Some(rest) = kept else {
            return self.follow(new, path);
        };
        let cost_m = |path: &Path| path.cost_m + self.config.turn_cost * turn_rad(path, start);
        let worse = cost_m(&path) >= self.config.better * cost_m(&rest.path);
        let stays = match (rest.certain, new.end.is_certain()) {
            (true, true) => worse,
            (true, false) => true,
            (false, true) => false,
            (false, false) => {
                worse && rest.end == new.end && rest.draft.steps() == new.draft.steps()
            }
        };
        if stays {
            self.hold(rest)
        } else {
            self.follow(new, path)
        }
    }

    /// Goes on with the path before.
    fn hold(&mut self, rest: Rest) -> Plan {
        if let Some(kept) = &mut self.kept {
            kept.draft = rest.draft;
            kept.unknown = unknown_in(&rest.path);
        }
        Plan {
            way: Ok(rest.path),
            replanned: false,
        }
    }

    /// Takes a new path.
    fn follow(&mut self, new: Kept, path: Path) -> Plan {
        self.kept = Some(Kept {
            unknown: unknown_in(&path),
            ..new
        });
        Plan {
            way: Ok(path),
            replanned: true,
        }
    }
}

/// How many of a path's points were not seen.
fn unknown_in(path: &Path) -> usize {
    path.unknown.iter().filter(|&&unknown| unknown).count()
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
