//! A guide for planners that see only what is near: the way through a map that is known beforehand, over all its levels (002, III.D).

mod config;
mod laid;

use geometry::{Map, Pose, Robot};
use known_map::{CostField, Floors, KnownMap, Prior, StandingRoom, Target};
use mapping::FloorView;
use settings::{ConfigError, Table};
use stairs::Staircase;

use crate::{AStar, Goal, Path, Plan, PlanError, Planner, path::shortcut::lay, plan::place_of};
pub use config::{GuideConfig, GuideTuning};
use laid::laid_under;

/// Plans by [`AStar`] to places on the guide's way, one after the other, and to the goal in the end.
#[derive(Debug, Clone)]
pub struct Guided {
    tuning: GuideTuning,
    near: AStar,
    floors: Floors,
    prior: Prior,
    field: CostField,
    /// Places where something stands that the map does not have.
    blocked: Vec<bool>,
    goal: Option<Goal>,
    /// Where the planner is sent, unless to the goal itself, and the place of the floors that this is.
    sent: Option<(Goal, u32)>,
}

impl Guided {
    /// Guides a planner through a map for a body of a height, m, and of the planner's radius.
    pub fn new(
        near: AStar,
        map: &KnownMap,
        height_m: f64,
        config: GuideConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let floors = map.floors(StandingRoom {
            radius_m: near.needed_m(),
            height_m,
        })?;
        Ok(Self {
            tuning: config.tuning,
            blocked: vec![false; floors.count()],
            prior: map.prior(height_m)?,
            near,
            floors,
            field: CostField::default(),
            goal: None,
            sent: None,
        })
    }

    /// The guide's way from where the robot stands: its places.
    fn way(&self, at_m: [f64; 3]) -> Option<Vec<u32>> {
        let leads = |place: u32| self.field.cost_m(place).is_finite();
        let first = self.floors.under(at_m, leads)?;
        Some(std::iter::successors(Some(first), |place| self.field.next(*place)).collect())
    }

    /// Where on a way the planner is sent: so far ahead, or to where it is level again behind stairs; `None` to the goal itself.
    fn ahead(&self, way: &[u32], goal: &Goal) -> Option<(Goal, u32)> {
        let (mut walked_m, mut level_m, mut climbs) = (0.0, 0.0, false);
        for pair in way.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|place| self.floors.at_m(place));
            let step_m = geometry::hypot(to[0] - from[0], to[1] - from[1]);
            walked_m += step_m;
            if (to[2] - from[2]).abs() > self.near.climbing.levels.told {
                climbs = true;
                level_m = 0.0;
            } else {
                level_m += step_m;
            }
            let landed = climbs && level_m > self.tuning.landing;
            if landed || (walked_m > self.tuning.ahead && !climbs) {
                let height_m = match goal.height_m {
                    // What the goal says of its level is finer than voxels.
                    Some(height_m) if (height_m - to[2]).abs() < self.floors.side_m => height_m,
                    _ => to[2],
                };
                let place = Goal {
                    x_m: to[0],
                    y_m: to[1],
                    radius_m: self.tuning.radius,
                    height_m: climbs.then_some(height_m),
                };
                return Some((place, pair[1]));
            }
        }
        None
    }

    /// Room at a place more than the robot needs, m: less than none where something stands that the map may not have. `None` outside
    /// the window, on another level, and at steps.
    fn spare_m(&self, place: u32, robot_m: [f64; 3]) -> Option<f64> {
        let [x, y, z] = self.floors.at_m(place);
        if (z - robot_m[2]).abs() > self.near.climbing.levels.told || self.floors.is_at_step(place)
        {
            return None;
        }
        let near = geometry::hypot(x - robot_m[0], y - robot_m[1]) < self.tuning.own;
        let clearance_m = self.near.clearance_m(x, y)?;
        Some(if near {
            0.0
        } else {
            clearance_m - self.near.needed_m()
        })
    }

    /// Takes note of what stands in the window that the map does not have, on the robot's level, and repairs the way.
    fn look_again(&mut self, robot_m: [f64; 3]) {
        let mut changed = vec![];
        for place in 0..self.floors.count() as u32 {
            if let Some(spare_m) = self.spare_m(place, robot_m) {
                let is_blocked = spare_m < 0.0;
                let was_blocked = std::mem::replace(&mut self.blocked[place as usize], is_blocked);
                if is_blocked != was_blocked {
                    changed.push(place);
                }
            }
        }
        (self.floors).repair(&changed, &self.blocked, &mut self.field);
        self.sent = None;
    }

    /// Whether something stands in the guide's way beyond where the planner is sent: what lies before that is the planner's to see.
    fn meets_something(&self, way: &[u32], robot_m: [f64; 3]) -> bool {
        let Some((_, sent)) = self.sent else {
            return false;
        };
        let beyond = way.iter().skip_while(|place| **place != sent);
        beyond
            .filter_map(|place| self.spare_m(*place, robot_m))
            .any(|spare_m| spare_m < -self.near.terrain.room.slack)
    }

    /// The place where the planner is sent by now.
    fn send(&mut self, at_m: [f64; 3], goal: &Goal) -> Option<Vec<u32>> {
        let way = self.way(at_m)?;
        let stays = self.sent.is_some_and(|(sent, place)| {
            let far = geometry::hypot(sent.x_m - at_m[0], sent.y_m - at_m[1]) > self.tuning.send_on;
            let below = sent
                .height_m
                .is_some_and(|h| (h - at_m[2]).abs() > self.near.climbing.levels.told);
            (far || below) && way.contains(&place)
        });
        if !stays {
            self.sent = self.ahead(&way, goal);
        }
        Some(way)
    }

    /// A path that ends where the planner was sent, lengthened by the guide's way from there to the goal. One that ends elsewhere, at
    /// a place to look from or behind a step, may go on in another way than the guide's.
    fn lengthen(&self, path: &mut Path, way: &[u32], (sent, place): (Goal, u32), cell_m: f64) {
        let Some(rest) = way.iter().position(|at| *at == place) else {
            return;
        };
        let Some(&[x, y]) = path.points_m.last() else {
            return;
        };
        if geometry::hypot(x - sent.x_m, y - sent.y_m) > sent.radius_m {
            return;
        }
        for &place in &way[rest + 1..] {
            let [x, y, _] = self.floors.at_m(place);
            lay(&mut path.points_m, [x, y], cell_m);
        }
        path.unknown.resize(path.points_m.len(), false);
        path.clearance_m.resize(path.points_m.len(), f64::INFINITY);
        path.cost_m += f64::from(self.field.cost_m(place));
    }
}

/// A goal as the known map's floors see it.
const fn target(goal: &Goal) -> Target {
    Target {
        at_m: [goal.x_m, goal.y_m],
        radius_m: goal.radius_m,
        height_m: goal.height_m,
    }
}

/// What a plan is made of.
struct Near<'a> {
    view: &'a FloorView,
    stairs: &'a Staircase,
    start: &'a Pose<Map, Robot>,
    /// Where the robot stands, m.
    at_m: [f64; 3],
}

impl Guided {
    /// One plan along the guide's way, and whether that way is broken.
    fn plan_near(&mut self, near: &Near<'_>, goal: &Goal) -> Result<(Plan, bool), PlanError> {
        let way = self.send(near.at_m, goal);
        let target = self.sent.filter(|_| way.is_some());
        let mut plan = (self.near).plan(
            &laid_under(&self.prior, near.view, near.at_m),
            near.stairs,
            near.start,
            target.as_ref().map_or(goal, |(g, _)| g),
        )?;
        let meets = (way.as_ref()).is_some_and(|way| self.meets_something(way, near.at_m));
        let broken = plan.way.is_err() || meets;
        if let (Ok(path), Some(way), Some(sent)) = (&mut plan.way, &way, target) {
            self.lengthen(path, way, sent, near.view.lattice.cell_m);
        }
        Ok((plan, broken))
    }
}

impl Planner for Guided {
    fn plan(
        &mut self,
        view: &FloorView,
        stairs: &Staircase,
        start: &Pose<Map, Robot>,
        goal: &Goal,
    ) -> Result<Plan, PlanError> {
        let (place, height_m) = place_of(start, goal)?;
        let at_m = [place.x_m, place.y_m, height_m];
        if self.goal != Some(*goal) {
            self.blocked.fill(false);
            (self.floors).aim(&target(goal), &self.blocked, &mut self.field);
            (self.goal, self.sent) = (Some(*goal), None);
        }
        let near = Near {
            view,
            stairs,
            start,
            at_m,
        };
        let (plan, broken) = self.plan_near(&near, goal)?;
        if !broken {
            return Ok(plan);
        }
        // What breaks a way is avoided by the plan that has it, not by the one after the next frame.
        self.look_again(at_m);
        let (plan, _) = self.plan_near(&near, goal)?;
        Ok(plan)
    }

    fn forget(&mut self) {
        self.near.forget();
        // The next plan looks for the way anew, over the map as it was given.
        self.goal = None;
    }

    fn distance_field_m(&self) -> Option<Vec<f32>> {
        self.near.distance_field_m()
    }
}

#[cfg(test)]
mod tests;
