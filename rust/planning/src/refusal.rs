//! Why there is no way: the most specific word that holds, and a sentence with figures.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use geometry::two_levels;
use stairs::{ClimbingConfig, Unfit};
use terrain::Terrain;

use crate::climb_links::{ClimbLinks, Fit};
use crate::path::ends::PathEnds;
use crate::search::neighbours::Cells;
use crate::search::steps::ANYWHERE;
use crate::search::{Route, Search};
use crate::steep_slopes::{first_too_steep, steep_way, too_steep};
use crate::tuning::RefusalTuning;
use crate::{AStarConfig, Goal, NoWay, Refusal};

/// What decides on a word.
type Words<'a> = (&'a ClimbingConfig, &'a RefusalTuning);

/// The first limit that a route breaks which was found as if there were none, and how many steps come before.
pub(crate) fn first_limit(
    terrain: &Terrain,
    links: &ClimbLinks,
    words: Words<'_>,
    route: &Route,
) -> Option<(NoWay, usize)> {
    let pairs = route.cells.windows(2);
    let ways = pairs.filter_map(|pair| links.between(terrain, pair[0], pair[1], Fit::Broken));
    let strides = ways.flat_map(|way| links.strides(way)).enumerate();
    let mut limits = strides.filter_map(|(before, stride)| Some((stride.limit?, before)));
    let (limit, before) = limits.next()?;
    Some((unfit(words, limit), before))
}

impl NoWay {
    /// The word and the sentence for a stair that is not stepped on.
    pub fn unfit(climbing: &ClimbingConfig, config: &AStarConfig, limit: Unfit) -> Self {
        unfit((climbing, &config.tuning.refusal), limit)
    }
}

/// The word and sentence for a step that is not taken.
fn unfit((climbing, tuning): Words<'_>, limit: Unfit) -> NoWay {
    let refusal = match limit {
        Unfit::TooHigh(rise_m) if rise_m < -tuning.drop => {
            let (deep, limit) = (-1e3 * rise_m, -1e3 * climbing.descend.step_min_z);
            let sentence = format!("it goes down {deep:.0} mm, {limit:.0} mm is the limit");
            return NoWay::new(Refusal::Drop, sentence);
        }
        Unfit::TooHigh(_) => Refusal::StepTooHigh,
        Unfit::TooLow(_) => Refusal::StepTooLow,
        Unfit::TreadTooShort(..) => Refusal::TreadTooShort,
        Unfit::GapTooShort(..) => Refusal::GapTooShort,
        Unfit::TooNarrow(..) => Refusal::TooNarrow,
    };
    NoWay::new(refusal, limit.sentence(climbing))
}

/// Explains why the robot finds no way from `start`.
pub(crate) fn explain(
    terrain: &Terrain,
    words: Words<'_>,
    ends: &PathEnds<'_>,
    start: usize,
    goal: &Goal,
) -> NoWay {
    let turned_m = terrain.needs.turned.map(|turned| turned.half_depth_m);
    let needed_m = turned_m.map_or(terrain.needs.body_m, |m| m.min(terrain.needs.body_m));
    let crack_m = words.1.crack;
    let widest = widest_way(terrain, ends, start, crack_m);
    let gap_m = 2.0 * widest.clearance_m;
    let needed = 2.0 * needed_m;
    if gap_m >= crack_m && gap_m < needed && widest.is_seen {
        return NoWay {
            refusal: Refusal::TooNarrow,
            sentence: format!("the widest gap is {gap_m:.2} m, {needed:.2} m are needed"),
            shuts_goal_in: is_shut_in(terrain, ends),
        };
    }
    if let Some(way) = steep_way(terrain, ends, start) {
        return way.refused(terrain);
    }
    if let Some(route) = way_over_levels(terrain, ends, start) {
        if let Some(rise_per_m) = first_too_steep(terrain, &route) {
            return too_steep(terrain, rise_per_m);
        }
        if let Some(rise_m) = first_rise(terrain, &route) {
            return unjoined(words, rise_m);
        }
    }
    let nearest = widest.nearest_cells * terrain.lattice.cell_m;
    let cells = 0..terrain.blocked.len();
    let free = |index: &usize| !terrain.blocked[*index];
    let mut shuts_goal_in = is_shut_in(terrain, ends);
    let sentence = if cells
        .clone()
        .any(|index| free(&index) && ends.cost(index).is_some())
    {
        format!("no way around what stands there leads nearer to the goal than {nearest:.2} m")
    } else if let Some(height_m) = goal.height_m
        && cells.clone().any(|index| free(&index) && ends.holds(index))
    {
        let radius = goal.radius_m;
        // Floor of that height may show elsewhere, and what leads to it.
        shuts_goal_in = false;
        format!("no floor within {radius:.2} m of the goal lies {height_m:.2} m high")
    } else {
        let radius = goal.radius_m;
        format!("no place within {radius:.2} m of the goal is free to stand on")
    };
    NoWay {
        refusal: Refusal::Blocked,
        sentence,
        shuts_goal_in,
    }
}

/// Whether the goal lies in the window and where a robot could walk from it ends at obstacles before the window does.
fn is_shut_in(terrain: &Terrain, ends: &PathEnds<'_>) -> bool {
    let count = terrain.weights.len();
    let mut reached = vec![false; count];
    let mut waiting: Vec<usize> = (0..count)
        .filter(|&cell| ends.holds(cell) && terrain.weights[cell].is_finite())
        .collect();
    let cells = Cells::new(&terrain.weights, terrain.cols);
    while let Some(cell) = waiting.pop() {
        if std::mem::replace(&mut reached[cell], true) {
            continue;
        }
        if terrain.on_border(cell) {
            return false;
        }
        cells.for_each_neighbour((cell, ANYWHERE), |next, _, _| {
            if !reached[next] {
                waiting.push(next);
            }
        });
    }
    ends.inside
}

/// The way that would lead to the goal if levels were one.
fn way_over_levels(terrain: &Terrain, ends: &PathEnds<'_>, start: usize) -> Option<Route> {
    if !terrain.any_edge {
        return None;
    }
    let cells = terrain.blocked.iter().enumerate();
    let stands = cells.map(|(i, &blocked)| blocked && terrain.level_m(i).is_none());
    let open: Vec<f32> = stands
        .map(|stands| if stands { f32::INFINITY } else { 1.0 })
        .collect();
    let ending = |cell: usize| ends.cost(cell);
    let remaining = |cell: usize| ends.remaining(cell);
    Search::default().run(&open, terrain.cols, start, ending, remaining)
}

/// The first change of level on a way, m.
fn first_rise(terrain: &Terrain, route: &Route) -> Option<f64> {
    let levels = route
        .cells
        .iter()
        .filter_map(|&cell| terrain.level_m(cell as usize));
    let mut last: Option<f64> = None;
    for level_m in levels {
        if let Some(before_m) = last.replace(level_m)
            && two_levels(level_m, before_m, terrain.needs.limits.floor_m)
        {
            return Some(level_m - before_m);
        }
    }
    None
}

/// The word and sentence for a change of level at which no stair is known.
fn unjoined(words: Words<'_>, rise_m: f64) -> NoWay {
    let climbing = words.0;
    let set = climbing.set_for(rise_m);
    let limit_m = if rise_m > 0.0 {
        set.step_max_z
    } else {
        -set.step_min_z
    };
    if rise_m.abs() > limit_m + climbing.tolerance {
        return unfit(words, Unfit::TooHigh(rise_m));
    }
    let mm = (1e3 * rise_m.abs()).round();
    NoWay::new(
        Refusal::Blocked,
        format!("a step of {mm} mm is in the way, and no edge to climb it by was found"),
    )
}

struct Widest {
    /// Clearance at the narrowest place of the widest way, m; 0 where there is no way for a point either.
    clearance_m: f64,
    /// Whether the floor at the narrowest place, and where the way is as narrow to within a cell, was seen: a gap in what is known of
    /// a wall is none.
    is_seen: bool,
    /// Octile distance in cells from the goal that a point could reach by gaps wider than a crack.
    nearest_cells: f64,
}

/// The way whose narrowest place is the widest, for a point that only obstacles stop.
fn widest_way(terrain: &Terrain, ends: &PathEnds<'_>, start: usize, crack_m: f64) -> Widest {
    let stops = terrain.blocked.iter().zip(&terrain.edge);
    let open: Vec<f32> = stops
        .map(|(&blocked, &edge)| if blocked || edge { f32::INFINITY } else { 1.0 })
        .collect();
    let cells = Cells::new(&open, terrain.cols);
    let cells_of = |squared: u32| f64::from(squared).sqrt();
    let mut seen = vec![false; open.len()];
    let mut queue = BinaryHeap::from([(u32::MAX, true, Reverse(start))]);
    let mut nearest_cells = f64::INFINITY;
    while let Some((narrowest, is_seen, Reverse(cell))) = queue.pop() {
        if std::mem::replace(&mut seen[cell], true) {
            continue;
        }
        let clearance_m = f64::from(narrowest).sqrt() * terrain.lattice.cell_m;
        if 2.0 * clearance_m >= crack_m {
            nearest_cells = nearest_cells.min(ends.remaining(cell));
        }
        if ends.cost(cell).is_some() {
            return Widest {
                clearance_m,
                is_seen,
                nearest_cells,
            };
        }
        cells.for_each_neighbour((cell, ANYWHERE), |next, _, _| {
            if !seen[next] {
                // Where the robot already stands too near it may leave: that does not narrow the way.
                let leaving = terrain.weights[next].is_finite();
                let here = if leaving {
                    u32::MAX
                } else {
                    terrain.distance.squared(next)
                };
                let is_as_narrow = here < narrowest || cells_of(here) < cells_of(narrowest) + 1.0;
                let hides = is_as_narrow && terrain.unknown[next];
                let is_seen = !hides && (is_seen || here < narrowest);
                let narrowest = narrowest.min(here);
                queue.push((narrowest, is_seen, Reverse(next)));
            }
        });
    }
    Widest {
        clearance_m: 0.0,
        is_seen: false,
        nearest_cells: nearest_cells.min(ends.remaining(start)),
    }
}
