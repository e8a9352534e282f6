//! The stairs as they are met from either side, and what lies before and behind their edges.

use geometry::Map;
use stairs::{ClimbingConfig, Stair, Staircase};

use crate::line::{Line, flipped};
use crate::terrain::Terrain;

/// Edges that belong together differ by less in heading, rad: a turn of a spiral staircase is a few degrees.
const ASKEW_RAD: f64 = 0.6;
/// A stair begins this near to where the one before it ends, m; further where that end is only where the view ended.
const JOINT_M: f64 = 0.06;
const LOOSE_JOINT_M: f64 = 0.1;
/// Least depth of ground between two edges that are told apart, m.
const LEAST_DEPTH_M: f64 = 0.03;
/// How deep the floor at the foot of an edge is taken to be, where nothing follows, m.
pub(crate) const GROUND_DEPTH_M: f64 = 0.3;
/// Places before or behind an edge where the level there is read: away from it and to the sides, m.
const AWAY_M: [f64; 4] = [0.04, 0.08, 0.12, 0.16];
const BESIDE_M: [f64; 3] = [-0.04, 0.0, 0.04];
/// Of those, so many must be known.
const ENOUGH: usize = 3;

/// A stair in one of its two directions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face {
    pub(crate) stair: Stair<Map>,
    pub(crate) front: Line,
    pub(crate) back: Line,
}

/// What lies behind a stair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum After {
    /// A face by its index, at this depth behind the front edge, m.
    Face(usize, f64),
    /// Floor of this height at this depth, m.
    Ground(f64, f64),
    /// Floor of its own height.
    Level,
    /// Something that stands there.
    Wall,
    /// Nothing was seen there.
    Unknown,
}

/// The level at places beside an edge.
enum Seen {
    Floor(f64),
    Wall,
    Unknown,
}

/// All faces. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Faces {
    faces: Vec<Face>,
}

impl Faces {
    pub(crate) fn read(&mut self, stairs: &Staircase) {
        self.faces.clear();
        for stair in &stairs.stairs {
            for stair in [*stair, flipped(stair)] {
                self.faces.push(Face {
                    stair,
                    front: Line::of(&stair.front),
                    back: Line::of(&stair.back),
                });
            }
        }
    }

    pub(crate) fn all(&self) -> &[Face] {
        &self.faces
    }

    /// Whether a stair of another level than this begins between a place and an edge ahead of it.
    pub(crate) fn begins_between(
        &self,
        climbing: &ClimbingConfig,
        (at_m, level_m): ([f64; 2], f64),
        edge: &Line,
    ) -> bool {
        let ahead_m = -edge.beyond_m(at_m);
        self.faces.iter().any(|face| {
            let away_m = -face.front.beyond_m(at_m);
            (0.0..ahead_m - LEAST_DEPTH_M).contains(&away_m)
                && face.front.askew_rad(edge) <= ASKEW_RAD
                && face.front.offset_m(at_m).abs() <= face.front.half_m()
                && differs(climbing, face.stair.height_m() - level_m)
        })
    }

    /// What lies behind a stair for one who crosses its front edge at `crossing_m`. `own` is its index; ground has none.
    pub(crate) fn after(
        &self,
        terrain: &Terrain,
        climbing: &ClimbingConfig,
        stair: &Stair<Map>,
        own: Option<usize>,
        crossing_m: [f64; 2],
    ) -> After {
        let back = Line::of(&stair.back);
        let own_depth_m = -back.beyond_m(crossing_m);
        if let Some(next) = self.following(climbing, stair, own, crossing_m) {
            return next;
        }
        if own.is_none() {
            return After::Level;
        }
        match seen(terrain, &back, back.offset_m(crossing_m), 1.0) {
            Seen::Floor(height_m) if differs(climbing, height_m - stair.height_m()) => {
                After::Ground(height_m, own_depth_m)
            }
            Seen::Floor(_) => After::Level,
            Seen::Wall => After::Wall,
            Seen::Unknown => After::Unknown,
        }
    }

    /// The nearest face that begins where a stair ends.
    fn following(
        &self,
        climbing: &ClimbingConfig,
        stair: &Stair<Map>,
        own: Option<usize>,
        crossing_m: [f64; 2],
    ) -> Option<After> {
        let back = Line::of(&stair.back);
        let own_depth_m = -back.beyond_m(crossing_m);
        let ends_there = stair.back_fit.is_some() || stair.seen_ends.back > 0;
        let joint_m = match (own, ends_there) {
            (Some(_), true) => JOINT_M,
            (Some(_), false) => LOOSE_JOINT_M,
            // Ground goes on as far as nothing follows.
            (None, _) => GROUND_DEPTH_M,
        };
        let mut best: Option<(f64, usize)> = None;
        for (index, face) in self.faces.iter().enumerate() {
            let depth_m =
                -face.front.beyond_m(crossing_m) / back.askew_rad(&face.front).cos().max(0.5);
            let joined = own.is_none_or(|own| own / 2 != index / 2)
                && back.askew_rad(&face.front) <= ASKEW_RAD
                && depth_m > LEAST_DEPTH_M
                && depth_m - own_depth_m <= JOINT_M
                && own_depth_m - depth_m <= joint_m
                && face.front.offset_m(crossing_m).abs() <= face.front.half_m() + JOINT_M
                && differs(climbing, face.stair.height_m() - stair.height_m());
            if joined && best.is_none_or(|(least_m, _)| depth_m < least_m) {
                best = Some((depth_m, index));
            }
        }
        best.map(|(depth_m, index)| {
            let next_is_surer =
                self.faces[index].stair.front_fit.is_some() || stair.back_fit.is_none();
            let trusted_m = if own.is_none() || next_is_surer {
                depth_m
            } else {
                own_depth_m
            };
            After::Face(index, trusted_m)
        })
    }
}

/// The level before an edge, m, where one is known.
pub(crate) fn level_before(terrain: &Terrain, line: &Line, offset_m: f64) -> Option<f64> {
    match seen(terrain, line, offset_m, -1.0) {
        Seen::Floor(height_m) => Some(height_m),
        Seen::Wall | Seen::Unknown => None,
    }
}

/// Whether a difference in height is no floor.
pub(crate) fn differs(climbing: &ClimbingConfig, rise_m: f64) -> bool {
    rise_m.abs() > climbing.floor_max
}

/// The median of the levels on one side of an edge: `side` is 1 behind it and -1 before it.
fn seen(terrain: &Terrain, line: &Line, offset_m: f64, side: f64) -> Seen {
    let mut heights = [0.0; AWAY_M.len() * BESIDE_M.len()];
    let (mut known, mut walls) = (0, 0);
    for away_m in AWAY_M {
        for beside_m in BESIDE_M {
            let Some(cell) = terrain.index_at(line.at(offset_m + beside_m, side * away_m)) else {
                continue;
            };
            if let Some(height_m) = terrain.level_m(cell) {
                heights[known] = height_m;
                known += 1;
            } else if terrain.blocked[cell] {
                walls += 1;
            }
        }
    }
    if known >= ENOUGH {
        let heights = &mut heights[..known];
        heights.sort_by(f64::total_cmp);
        Seen::Floor(heights[known / 2])
    } else if 2 * walls >= AWAY_M.len() * BESIDE_M.len() {
        Seen::Wall
    } else {
        Seen::Unknown
    }
}
