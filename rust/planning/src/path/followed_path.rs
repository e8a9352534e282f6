//! The path that is being followed: what the plan says of it, and what is remembered beside.

use terrain::Terrain;

use super::ends::PathEnd;
use crate::climb_links::room_at_edges::distance_m;
use crate::sideways_passages::TURNS_RAD;
use crate::{AStarConfig, Goal, Path, Sidle};

/// A path, and what is remembered of it beside what the plan says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FollowedPath {
    /// Its places and legs; the rest of it as of the last [`Self::annotate`].
    pub(crate) path: Path,
    /// Ranges of points at stairs or in passages, first and last, with what is walked close to edges.
    pub(crate) spans: Vec<[usize; 2]>,
    pub(crate) goal: Goal,
    /// Whether it leads to the goal, or only to the border of the window, or towards what was not seen yet.
    pub(crate) end: PathEnd,
    /// Whether the goal lay in the window when it was found.
    pub(crate) inside: bool,
    /// How many of its points were unknown when it was planned or held last.
    pub(crate) unknown: usize,
}

impl FollowedPath {
    /// A path that has not left its start yet.
    pub(crate) fn from(start_m: [f64; 2], goal: Goal, end: PathEnd) -> Self {
        Self {
            path: Path {
                points_m: vec![start_m],
                ..Path::default()
            },
            spans: Vec::new(),
            goal,
            end,
            inside: false,
            unknown: 0,
        }
    }

    /// Number of steps.
    pub(crate) fn steps(&self) -> usize {
        self.path.climbs.iter().map(|climb| climb.steps.len()).sum()
    }

    /// How many of its points were not seen.
    pub(crate) fn unknown_points(&self) -> usize {
        self.path.unknown.iter().filter(|&&unknown| unknown).count()
    }

    /// Whether part of it became known since it was planned or held last.
    pub(crate) fn is_revealed(&self) -> bool {
        self.unknown_points() < self.unknown
    }

    /// Whether the robot is on a leg sideways: until its end no other way is better.
    pub(crate) fn in_passage(&self) -> bool {
        let first = self.path.sidles.first();
        self.end.is_certain() && first.is_some_and(|sidle| sidle.from_point == 0)
    }

    /// Whether the piece from a point to the next lies at stairs.
    pub(crate) fn at_stairs(&self, piece: usize) -> bool {
        self.spans
            .iter()
            .any(|span| (span[0]..span[1]).contains(&piece))
    }

    /// The point at which the robot stands on a tread before a climb: where it is, or where the climb before ended at these
    /// stairs.
    pub(crate) fn tread_before(&self, index: usize) -> Option<usize> {
        let from = self.path.climbs[index].from_point;
        if from == 0 {
            return Some(0);
        }
        let before = self.path.climbs[..index].last()?.to_point;
        let here = |span: &[usize; 2]| span[0] < before && from < span[1];
        self.spans.iter().any(here).then_some(before)
    }

    /// The leg that is walked sideways to which the piece from a point to the next belongs.
    fn sidle_at(&self, piece: usize) -> Option<&Sidle> {
        let holds = |sidle: &&Sidle| (sidle.from_point..sidle.to_point).contains(&piece);
        self.path.sidles.iter().find(holds)
    }

    /// Finds clearance, unknown parts and cost under this terrain.
    pub(crate) fn annotate(&mut self, terrain: &Terrain, config: &AStarConfig) {
        let points_m = &self.path.points_m;
        let index = |point: &[f64; 2]| terrain.index_at(*point);
        let unknown = points_m
            .iter()
            .map(|p| index(p).is_none_or(|i| terrain.unknown[i]))
            .collect();
        let clearance_m = points_m
            .iter()
            .map(|p| index(p).map_or(f64::INFINITY, |i| terrain.clearance_m(i)))
            .collect();
        let pieces = points_m.windows(2).enumerate();
        let walked_m: f64 = pieces
            .map(|(i, pair)| {
                if let Some(sidle) = self.sidle_at(i) {
                    distance_m(pair[0], pair[1])
                        * terrain
                            .sideways_weight(pair[1], sidle.heading_rad, 0.0)
                            .unwrap_or(1.0 + config.sideways_cost)
                } else if self.at_stairs(i) {
                    distance_m(pair[0], pair[1])
                } else {
                    let cost = terrain.straight_cost_m(pair[0], pair[1]);
                    cost.unwrap_or(f64::INFINITY)
                }
            })
            .sum();
        let cost_m = walked_m
            + config.climb_cost * self.steps() as f64
            + config.turn_cost * TURNS_RAD * self.path.sidles.len() as f64;
        (self.path.unknown, self.path.clearance_m) = (unknown, clearance_m);
        self.path.cost_m = cost_m;
    }
}
