//! The stairs as they are met from either side, and what lies before and behind their edges.

use geometry::{Map, Point, two_levels};
use stairs::{ClimbingConfig, Edge, EdgeLine, Sides, Stair, Staircase};
use terrain::Terrain;

use crate::tuning::DirectedStairsTuning;

/// Places where a level is read: as many as the settings have distances, times those to the side.
const PLACES: usize = 4 * 3;

/// A stair in one of its two directions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DirectedStair {
    pub(crate) stair: Stair<Map>,
    pub(crate) front: EdgeLine,
    pub(crate) back: EdgeLine,
}

/// What lies behind a stair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum After {
    /// A stair by its index, at this depth behind the front edge, m.
    Stair(usize, f64),
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

/// The stairs, each in both of its directions. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct DirectedStairs {
    pub(super) all: Vec<DirectedStair>,
}

impl DirectedStairs {
    pub(crate) fn read(&mut self, stairs: &Staircase) {
        self.all.clear();
        for stair in &stairs.stairs {
            for stair in [*stair, flipped(stair)] {
                self.all.push(DirectedStair {
                    stair,
                    front: stair.front.as_line(),
                    back: stair.back.as_line(),
                });
            }
        }
    }

    /// Whether a stair of another level than this begins between a place and an edge ahead of it.
    pub(crate) fn begins_between(
        &self,
        (climbing, tuning): (&ClimbingConfig, &DirectedStairsTuning),
        (at_m, level_m): ([f64; 2], f64),
        edge: &EdgeLine,
    ) -> bool {
        let ahead_m = -edge.beyond_m(at_m);
        self.all.iter().any(|face| {
            let away_m = -face.front.beyond_m(at_m);
            (0.0..ahead_m - tuning.least_depth).contains(&away_m)
                && face.front.askew_rad(edge) <= tuning.askew
                && face.front.offset_m(at_m).abs() <= face.front.half_m()
                && differs(climbing, face.stair.height_m() - level_m)
        })
    }

    /// What lies behind a stair for one who crosses its front edge at `crossing_m`. `own` is its index; ground has none.
    pub(crate) fn after(
        &self,
        terrain: &Terrain,
        (climbing, tuning): (&ClimbingConfig, &DirectedStairsTuning),
        stair: &Stair<Map>,
        own: Option<usize>,
        crossing_m: [f64; 2],
    ) -> After {
        let back = stair.back.as_line();
        let own_depth_m = -back.beyond_m(crossing_m);
        if let Some(next) = self.following((climbing, tuning), stair, own, crossing_m) {
            return next;
        }
        if own.is_none() {
            return After::Level;
        }
        match seen(terrain, tuning, (&back, back.offset_m(crossing_m)), 1.0) {
            Seen::Floor(height_m) if differs(climbing, height_m - stair.height_m()) => {
                After::Ground(height_m, own_depth_m)
            }
            Seen::Floor(_) => After::Level,
            Seen::Wall => After::Wall,
            Seen::Unknown => After::Unknown,
        }
    }

    /// The nearest stair that begins where a stair ends.
    fn following(
        &self,
        (climbing, tuning): (&ClimbingConfig, &DirectedStairsTuning),
        stair: &Stair<Map>,
        own: Option<usize>,
        crossing_m: [f64; 2],
    ) -> Option<After> {
        let back = stair.back.as_line();
        let own_depth_m = -back.beyond_m(crossing_m);
        let (askew_rad, joint_m) = (tuning.askew, tuning.joint);
        let ends_there = stair.back_fit.is_some() || stair.seen_ends.back > 0;
        let gap_m = match (own, ends_there) {
            (Some(_), true) => joint_m,
            (Some(_), false) => tuning.loose_joint,
            // Ground goes on as far as nothing follows.
            (None, _) => tuning.ground_depth,
        };
        let mut best: Option<(f64, usize)> = None;
        for (index, face) in self.all.iter().enumerate() {
            let turned_rad = back.askew_rad(&face.front);
            let depth_m =
                -face.front.beyond_m(crossing_m) / turned_rad.cos().max(tuning.least_cosine);
            let joined = own.is_none_or(|own| own / 2 != index / 2)
                && turned_rad <= askew_rad
                && depth_m > tuning.least_depth
                && depth_m - own_depth_m <= joint_m
                && own_depth_m - depth_m <= gap_m
                && face.front.offset_m(crossing_m).abs() <= face.front.half_m() + joint_m
                && differs(climbing, face.stair.height_m() - stair.height_m());
            if joined && best.is_none_or(|(least_m, _)| depth_m < least_m) {
                best = Some((depth_m, index));
            }
        }
        best.map(|(depth_m, index)| {
            let next_is_surer =
                self.all[index].stair.front_fit.is_some() || stair.back_fit.is_none();
            let trusted_m = if own.is_none() || next_is_surer {
                depth_m
            } else {
                own_depth_m
            };
            After::Stair(index, trusted_m)
        })
    }
}

/// The level before an edge, m, where one is known.
pub(crate) fn level_before(
    terrain: &Terrain,
    tuning: &DirectedStairsTuning,
    line: &EdgeLine,
    offset_m: f64,
) -> Option<f64> {
    match seen(terrain, tuning, (line, offset_m), -1.0) {
        Seen::Floor(height_m) => Some(height_m),
        Seen::Wall | Seen::Unknown => None,
    }
}

/// Whether a difference in height is no floor.
pub(crate) fn differs(climbing: &ClimbingConfig, rise_m: f64) -> bool {
    two_levels(rise_m, 0.0, climbing.floor_max)
}

/// The median of the levels on one side of an edge: `side` is 1 behind it and -1 before it.
fn seen(
    terrain: &Terrain,
    tuning: &DirectedStairsTuning,
    (line, offset_m): (&EdgeLine, f64),
    side: f64,
) -> Seen {
    let mut heights = [0.0; PLACES];
    let (mut known, mut walls) = (0, 0);
    for away_m in tuning.away {
        for aside_m in tuning.aside {
            let Some(cell) = terrain.index_at(line.at(offset_m + aside_m, side * away_m)) else {
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
    if known >= tuning.enough {
        let heights = &mut heights[..known];
        heights.sort_by(f64::total_cmp);
        Seen::Floor(heights[known / 2])
    } else if tuning.walls * walls >= PLACES {
        Seen::Wall
    } else {
        Seen::Unknown
    }
}

/// The stair for one who comes from its back.
fn flipped(stair: &Stair<Map>) -> Stair<Map> {
    let turned = |edge: Edge<Map>| Edge {
        left: edge.right,
        right: edge.left,
    };
    Stair {
        front: turned(stair.back),
        back: turned(stair.front),
        seen_ends: Sides {
            front: stair.seen_ends.back,
            back: stair.seen_ends.front,
            left: stair.seen_ends.right,
            right: stair.seen_ends.left,
        },
        left_margin_m: stair.right_margin_m,
        right_margin_m: stair.left_margin_m,
        front_fit: stair.back_fit,
        back_fit: stair.front_fit,
        ..*stair
    }
}

/// The floor behind a stair's back edge as a stair of its own, `depth_m` deep.
pub(crate) fn ground_behind(stair: &Stair<Map>, height_m: f64, depth_m: f64) -> Stair<Map> {
    let heading_rad = stair.back.heading_rad();
    let moved = |point: Point<Map>, by_m: f64| {
        Point::new(
            point.inner.x + by_m * heading_rad.cos(),
            point.inner.y + by_m * heading_rad.sin(),
            height_m,
        )
    };
    let edge = |by_m: f64| Edge {
        left: moved(stair.back.left, by_m),
        right: moved(stair.back.right, by_m),
    };
    Stair {
        front: edge(0.0),
        back: edge(depth_m),
        reference: moved(stair.back.middle(), 0.5 * depth_m),
        seen_ends: Sides {
            front: stair.seen_ends.back,
            back: 0,
            ..stair.seen_ends
        },
        front_fit: stair.back_fit,
        back_fit: None,
        ..*stair
    }
}
