//! From stair to stair: the steps of a climb, and where it ends.

use geometry::{Map, same_level};
use stairs::{Footing, Onward, Stair, Unfit};

use super::directed_stairs::{After, ground_behind};
use super::room_at_edges::{
    distance_m, inside_m, range_m, run_to_cell, walk_m, weight_on_stairs, width_m,
};
use super::{ClimbLinks, Fit, Scene, Stride, Way};
use crate::Step;

/// A stair to step on first, and from where.
pub(super) struct Entry {
    pub(super) stair: Stair<Map>,
    /// Its index among the directed stairs; ground has none.
    pub(super) index: Option<usize>,
    /// Height of the ground before it, m.
    pub(super) level_m: f64,
    /// Whether that height was seen there: else it is taken to be the robot's own.
    pub(super) level_seen: bool,
    pub(super) offset_m: f64,
    pub(super) cell: usize,
    pub(super) enter_m: [f64; 2],
    /// Where the robot stands before the step when that is given: it does not move up to the edge, m.
    pub(super) fixed: bool,
}

/// A stair that was stepped on.
struct Landing {
    stair: Stair<Map>,
    index: Option<usize>,
    after: After,
}

impl ClimbLinks {
    /// Climbs on from stair to stair, and adds a link for each place where one can walk on.
    pub(super) fn follow(&mut self, scene: &Scene<'_>, entry: &Entry) {
        let first = self.strides.len();
        let tuning = &scene.config.tuning;
        let (mut stair, mut index, mut offset_m) = (entry.stair, entry.index, entry.offset_m);
        let (mut level_m, mut at_m) = (entry.level_m, entry.enter_m);
        let (mut fixed, mut fit, mut cost_m) = (entry.fixed, Fit::Holds, 0.0);
        let mut before: Option<(Way, Landing, f64)> = None;
        for _ in 0..tuning.climbs.most_steps {
            let line = stair.front.as_line();
            let crossing_m = line.at(offset_m, 0.0);
            let limits = (scene.climbing, &tuning.directed_stairs);
            let after = self
                .stairs
                .after(scene.terrain, limits, &stair, index, crossing_m);
            let mut stride = self.stride(scene, &stair, level_m, crossing_m, after);
            if fixed {
                stride.from_m = at_m;
            }
            let Some(stride_m) = stride_cost_m(scene, at_m, &mut stride, level_m) else {
                break;
            };
            let told = entry.level_seen || self.strides.len() > first;
            let doubt = doubt_of(scene, entry, &stride, told);
            if let (Doubt::Looked, Some((way, landing, cost_m))) = (doubt, &before) {
                self.hope(scene, entry, *way, landing, *cost_m);
            }
            fit = fit.max(doubt.fit());
            cost_m += stride_m;
            // What is higher than a step may turn out to be several.
            let steps = (stride.step.rise_m.abs() / tuning.climbs.rise).max(1.0);
            let steps = if stride.limit.is_some() { steps } else { 1.0 };
            cost_m += scene.config.climb_cost * steps * stride.beside;
            at_m = stride.to_m;
            self.strides.push(stride);
            let way = Way {
                first,
                end: self.strides.len(),
                enter_m: entry.enter_m,
                leave_m: None,
                fit,
                at_goal: false,
                turned_rad: None,
            };
            let landing = Landing {
                stair,
                index,
                after,
            };
            self.end(scene, entry, way, &landing, cost_m);
            before = Some((way, landing, cost_m));
            level_m = stair.height_m();
            let Some((next, next_index, depth_m)) = self.behind(scene, &stair, after) else {
                break;
            };
            (stair, index) = (next, next_index);
            fixed = depth_m <= scene.config.stride;
            let edge = stair.front.as_line();
            let range_m = range_m(scene, &edge);
            offset_m = edge.offset_m(at_m).clamp(-range_m, range_m);
        }
        // Steps that no way ends with are none.
        let used = self.ways.last().map_or(0, |way| way.end);
        self.strides.truncate(used.max(first));
    }

    /// What is stepped on behind a stair: the stair or the ground there, its index among the stairs, and how far behind it begins, m.
    fn behind(
        &self,
        scene: &Scene<'_>,
        stair: &Stair<Map>,
        after: After,
    ) -> Option<(Stair<Map>, Option<usize>, f64)> {
        match after {
            After::Stair(next, depth_m) => Some((self.stairs.all[next].stair, Some(next), depth_m)),
            After::Ground(height_m, depth_m) => {
                let ground_depth_m = scene.config.tuning.directed_stairs.ground_depth;
                let ground = ground_behind(stair, height_m, ground_depth_m);
                Some((ground, None, depth_m))
            }
            After::Level | After::Wall | After::Unknown => None,
        }
    }

    /// One step onto a stair.
    fn stride(
        &self,
        scene: &Scene<'_>,
        stair: &Stair<Map>,
        level_m: f64,
        crossing_m: [f64; 2],
        after: After,
    ) -> Stride {
        let line = stair.front.as_line();
        let rise_m = stair.height_m() - level_m;
        let next = match after {
            After::Stair(next, depth_m) => Some((self.stairs.all[next].stair.height_m(), depth_m)),
            After::Ground(height_m, depth_m) => Some((height_m, depth_m)),
            After::Level | After::Wall | After::Unknown => None,
        };
        let onward = next.filter(|&(_, depth_m)| depth_m <= scene.config.stride);
        let onward = onward.map_or(Onward::Level, |(height_m, depth_m)| Onward::Edge {
            depth_m,
            rise_m: height_m - stair.height_m(),
        });
        let width_m = width_m(&line, stair);
        let footing = Footing::on_stair(scene.climbing, scene.feet, rise_m, width_m, onward);
        let heel_m = footing.map_or(scene.config.tuning.climbs.heel, |footing| footing.heel_m);
        let toes_m = scene.climbing.set_for(rise_m).approach_x;
        let offset_m = line.offset_m(crossing_m);
        Stride {
            step: Step {
                stair: *stair,
                rise_m,
                crossing_m,
            },
            from_m: line.at(offset_m, toes_m - 0.5 * scene.feet.length_m),
            to_m: line.at(offset_m, heel_m + 0.5 * scene.feet.length_m),
            range_m: range_m(scene, &line),
            beside: 1.0,
            limit: footing.err(),
        }
    }

    /// Adds the links that end on a stair: at a cell where one walks on, at the goal, or with what is not known yet.
    fn end(&mut self, scene: &Scene<'_>, entry: &Entry, way: Way, on: &Landing, cost_m: f64) {
        let (goal, stair) = (&scene.goal, &on.stair);
        let tuning = &scene.config.tuning;
        let tolerance_m = scene.climbing.levels.same;
        let line = stair.front.as_line();
        let Some(at_m) = self.strides.last().map(|stride| stride.to_m) else {
            return;
        };
        // Unseen ground may be the floor at the foot of an edge, but no stair goes on over it.
        let on_level = |height: Option<f64>| {
            height.map_or(on.index.is_none(), |height_m| {
                same_level(height_m, stair.height_m(), tolerance_m)
            })
        };
        let (offset_m, beyond_m) = (line.offset_m(at_m), line.beyond_m(at_m));
        let run = run_to_cell(scene, &line, offset_m, beyond_m, 1.0, on_level);
        if let Some((cell, leave_m)) = run {
            let run_m = walk_m(at_m, leave_m);
            let way = Way {
                leave_m: Some(leave_m),
                ..way
            };
            self.add(scene.terrain, (entry.cell, Some(cell)), cost_m + run_m, way);
        } else {
            let away_m = distance_m(at_m, [goal.x_m, goal.y_m]);
            let on_goals_level = goal.height_m.is_none_or(|height_m| {
                same_level(height_m, stair.height_m(), scene.climbing.levels.told)
            });
            if away_m <= goal.radius_m && on_goals_level {
                let way = Way {
                    at_goal: true,
                    ..way
                };
                let cost_m = cost_m + tuning.ends.pull * away_m;
                self.add(scene.terrain, (entry.cell, None), cost_m, way);
                return;
            }
        }
        // Floor that is too short to walk on may be a stair that is not known as one yet.
        let short = on.index.is_none() && on.after == After::Level && run.is_none();
        if on.after == After::Unknown || short {
            self.hope(scene, entry, way, on, cost_m);
        }
    }

    /// Adds a link that ends on a stair behind which the way may go on.
    fn hope(&mut self, scene: &Scene<'_>, entry: &Entry, way: Way, on: &Landing, cost_m: f64) {
        let (goal, stair) = (&scene.goal, &on.stair);
        let tuning = &scene.config.tuning.climbs;
        let Some(at_m) = self.strides[..way.end].last().map(|stride| stride.to_m) else {
            return;
        };
        let goal_m = [goal.x_m, goal.y_m];
        let remaining_m = walk_m(at_m, goal_m);
        // Beyond the window nothing is known of any way, and all of them are paid for alike.
        let unseen_m = remaining_m.min(inside_m(scene.terrain, at_m, goal_m));
        let ahead_m = remaining_m + scene.config.unknown_cost * unseen_m + tuning.hope;
        let missing_m = goal.height_m.map_or(0.0, |h| (h - stair.height_m()).abs());
        let rises_m = scene.config.climb_cost * missing_m / tuning.rise;
        let cost_m = cost_m + ahead_m + rises_m;
        self.add(scene.terrain, (entry.cell, None), cost_m, way);
    }
}

/// Whether the ground before or behind an edge slopes so much that a sole that is set there level is farther off it than what is floor. The
/// cells right beside the edge need not show it.
fn is_on_slope(scene: &Scene<'_>, stride: &Stride) -> bool {
    let along = |axis: usize, share: f64| {
        stride.from_m[axis] + share * (stride.to_m[axis] - stride.from_m[axis])
    };
    // In halves of the stride, from one before it to a half behind it; the second is the edge itself.
    let halves = (-2..=3).filter(|&halves| halves != 1);
    let mut shares = halves.map(|halves| 0.5 * f64::from(halves));
    shares.any(|share| {
        let [x, y] = (scene.view).gradient_at(along(0, share), along(1, share));
        geometry::hypot(x, y) * scene.feet.length_m > scene.terrain.needs.limits.floor_m
    })
}

/// What the way over a step costs by its length and by what stands beside it, m; `None` where the body has no room, or the feet no level ground.
fn stride_cost_m(
    scene: &Scene<'_>,
    at_m: [f64; 2],
    stride: &mut Stride,
    level_m: f64,
) -> Option<f64> {
    if is_on_slope(scene, stride) {
        return None;
    }
    let below = weight_on_stairs(scene, stride.from_m, level_m)?;
    let above = weight_on_stairs(scene, stride.to_m, stride.step.stair.height_m())?;
    stride.beside = below.max(above);
    Some(below * walk_m(at_m, stride.from_m) + above * walk_m(stride.from_m, stride.to_m))
}

/// What is thought of the limit that a step breaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Doubt {
    /// It breaks none.
    Fits,
    /// It was not seen from near by yet.
    Afar,
    /// It was looked at as far as it can be from before the first step: the steps before it can be climbed to see more.
    Looked,
    /// None: it was measured, or seen from near by.
    Sure,
}

impl Doubt {
    const fn fit(self) -> Fit {
        match self {
            Self::Fits => Fit::Holds,
            Self::Afar => Fit::Doubtful,
            Self::Looked | Self::Sure => Fit::Broken,
        }
    }
}

/// How sure it is that a step cannot be taken; `level_known`: whether the level before it was seen.
fn doubt_of(scene: &Scene<'_>, entry: &Entry, stride: &Stride, level_known: bool) -> Doubt {
    let stair = &stride.step.stair;
    let measured = match stride.limit {
        None => return Doubt::Fits,
        Some(Unfit::TooHigh(_) | Unfit::TooLow(_)) => level_known && stair.front_fit.is_some(),
        Some(_) => stair.front_fit.is_some() && stair.back_fit.is_some(),
    };
    let near = |place_m| scene.terrain.nearest_m(place_m) <= scene.config.limit_range;
    // A tread may have been seen from its other side; wide floor has no other side that says anything of this one.
    let other_side = stair.depth_m() <= scene.config.limit_range && near(stair.back.middle_m());
    let looked_m = scene.config.tuning.climbs.looked;
    let mut looked = scene.looked_m.iter();
    if measured || near(stride.step.crossing_m) || other_side {
        Doubt::Sure
    } else if looked.any(|&from_m| distance_m(from_m, entry.enter_m) <= looked_m) {
        Doubt::Looked
    } else {
        Doubt::Afar
    }
}
