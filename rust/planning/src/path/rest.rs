//! What is left of the path that is being followed, where it holds: its passed part cut off, its steps as the stairs are seen now.

use geometry::same_level;
use stairs::LevelsConfig;
use terrain::{StandingAt, Terrain};

use crate::climb_links::room_at_edges::distance_m;
use crate::climb_links::{ClimbLinks, Fit, Stride};
use crate::tuning::FollowedPathTuning;
use crate::{AStarConfig, Climb, Path, PathEnd, Sidle};

/// By what an edge is the one that it was.
type Edges<'a> = (&'a FollowedPathTuning, &'a LevelsConfig);

impl Path {
    /// What is left of it where it holds.
    pub(crate) fn rest(
        &self,
        terrain: &Terrain,
        links: &ClimbLinks,
        stand: &StandingAt,
        (config, levels): (&AStarConfig, &LevelsConfig),
    ) -> Option<Self> {
        let tuning = &config.tuning.followed_path;
        let edges = (tuning, levels);
        let mut rest = rest_of(self, stand.at_m, (config.stray, tuning))?;
        let left_m = rest.points_m.len() as f64 * terrain.lattice.cell_m;
        if self.end == PathEnd::Border && left_m < tuning.horizon {
            return None;
        }
        for index in 0..rest.climbs.len() {
            let tread = rest.tread_before(index);
            let climb = &mut rest.climbs[index];
            let level_m = (climb.from_point == 0).then_some(stand.height_m);
            refresh(climb, (level_m, tread), &mut rest.points_m, (links, edges))?;
        }
        if another_lane_is_roomier(&rest, (links, edges), config.climb_cost) {
            return None;
        }
        let holds = holds(&rest, terrain) && passages_hold(&rest, terrain);
        (holds && walks_on_level(&rest, terrain, levels.same)).then_some(rest)
    }

    /// The point at which the robot stands on a tread before a climb: where it is, or where the climb before ended at these
    /// stairs.
    fn tread_before(&self, index: usize) -> Option<usize> {
        let from = self.climbs[index].from_point;
        if from == 0 {
            return Some(0);
        }
        let before = self.climbs[..index].last()?.to_point;
        let here = |span: &[usize; 2]| span[0] < before && from < span[1];
        self.spans.iter().any(here).then_some(before)
    }
}

/// Whether the robot has room everywhere: an obstacle or edge may seem half a cell nearer without a new plan.
fn holds(rest: &Path, terrain: &Terrain) -> bool {
    let half_m = 0.5 * terrain.lattice.cell_m;
    let needs = &terrain.needs;
    let least_m = (needs.body_m - half_m).max(needs.body_m - terrain.room.slack);
    let least_edge_m = needs.feet_m - half_m;
    rest.points_m.iter().enumerate().all(|(i, point)| {
        let Some(index) = terrain.index_at(*point) else {
            return false;
        };
        let at_stairs = rest.at_stairs(i) || i > 0 && rest.at_stairs(i - 1);
        let roomy = terrain.clearance_m(index) >= least_m
            && terrain.edge_clearance_m(index) >= least_edge_m
            && !terrain.edge[index];
        roomy || at_stairs || terrain.weights[index].is_finite()
    })
}

/// Whether there is room sideways where the robot is to walk so, by the same measure.
fn passages_hold(rest: &Path, terrain: &Terrain) -> bool {
    let slack_m = (0.5 * terrain.lattice.cell_m).min(terrain.room.slack);
    rest.sidles.iter().all(|sidle| {
        let mut points = rest.points_m[sidle.from_point..=sidle.to_point].iter();
        points.all(|&at_m| {
            let weight = terrain.sideways_weight(at_m, sidle.heading_rad, slack_m);
            weight.is_some()
        })
    })
}

/// Whether what is walked behind the last step at stairs lies as high as that: a further edge may be seen there by now.
fn walks_on_level(rest: &Path, terrain: &Terrain, tolerance_m: f64) -> bool {
    let lasts = rest.spans.iter().filter_map(|span| {
        let mut climbs = rest.climbs.iter();
        let climb = climbs.rfind(|climb| (span[0]..=span[1]).contains(&climb.to_point))?;
        Some((climb, span[1]))
    });
    let mut lasts =
        lasts.filter_map(|(climb, end)| Some((climb.steps.last()?, climb.to_point..=end)));
    lasts.all(|(step, walked)| {
        let level_m = step.stair.height_m();
        rest.points_m[walked].iter().all(|point| {
            let here = terrain
                .index_at(*point)
                .and_then(|cell| terrain.level_m(cell));
            here.is_none_or(|height_m| same_level(height_m, level_m, tolerance_m))
        })
    })
}

/// Takes over edges and heights as they are seen now; `None` where a step is none any more. `level_m`: the height before the
/// first step, where the robot stands there. From a tread, where the way
/// stands at the point `tread` before the first step, it leads straight on as far as the next edge allows: the feet move
/// aside a centimetre at a time there.
fn refresh(
    climb: &mut Climb,
    (mut level_m, tread): (Option<f64>, Option<usize>),
    points_m: &mut [[f64; 2]],
    (links, edges): (&ClimbLinks, Edges<'_>),
) -> Option<()> {
    let first = climb.from_point;
    for (i, step) in climb.steps.iter_mut().enumerate() {
        let now = seen_now(step, level_m, (links, edges))?;
        level_m = Some(now.step.stair.height_m());
        let line = now.step.stair.front.as_line();
        let tread = if i == 0 { tread } else { Some(first + i) };
        let offset_m = tread.map_or(line.offset_m(step.crossing_m), |from| {
            let straight_m = line.offset_m(points_m[from]);
            straight_m.clamp(-now.range_m, now.range_m)
        });
        let beside = |place_m: [f64; 2]| line.at(offset_m, line.beyond_m(place_m));
        // What is walked on the tread, up to where the first step begins.
        let walked_from = tread.map_or(first, |from| from + 1);
        for point_m in points_m.iter_mut().take(first).skip(walked_from) {
            *point_m = beside(*point_m);
        }
        if i == 0 && first > 0 {
            points_m[first] = beside(now.from_m);
        }
        points_m[first + i + 1] = beside(now.to_m);
        *step = crate::Step {
            crossing_m: line.at(offset_m, 0.0),
            ..now.step
        };
    }
    Some(())
}

/// A step as the stairs are seen now, from this level where that is known: nearest to where it was to be taken, and most like it. Ways
/// over the same edge may come from other levels, even from one that is there no more.
fn seen_now<'a>(
    step: &crate::Step,
    level_m: Option<f64>,
    (links, (tuning, levels)): (&'a ClimbLinks, Edges<'_>),
) -> Option<&'a Stride> {
    let before = step.stair.front.as_line();
    let rises_m = |stride: &Stride| (stride.step.rise_m - step.rise_m).abs();
    let same = |stride: &&Stride| {
        let now = &stride.step;
        let line = now.stair.front.as_line();
        let from_m = now.stair.height_m() - now.rise_m;
        stride.limit.is_none()
            && level_m.is_none_or(|level_m| same_level(from_m, level_m, levels.same))
            && line.askew_rad(&before) <= tuning.turned
            && line.beyond_m(step.crossing_m).abs() <= tuning.moved
            && line.offset_m(step.crossing_m).abs() <= line.half_m()
            && same_level(now.stair.height_m(), step.stair.height_m(), levels.same)
            && rises_m(stride) <= levels.same
    };
    let unlike_m =
        |stride: &Stride| distance_m(stride.step.crossing_m, step.crossing_m) + rises_m(stride);
    let strides = links.all_strides().iter().filter(same);
    strides.min_by(|a, b| unlike_m(a).total_cmp(&unlike_m(b)))
}

/// Whether the edge that the path climbs first, and that the robot has not come to yet, can be crossed elsewhere with more room
/// beside the stairs: when the path was found but a piece of it may have been seen. `climb_cost` as configured.
fn another_lane_is_roomier(
    rest: &Path,
    (links, edges): (&ClimbLinks, Edges<'_>),
    climb_cost: f64,
) -> bool {
    let Some(climb) = rest.climbs.first().filter(|climb| climb.from_point > 0) else {
        return false;
    };
    let Some(kept) = (climb.steps.first()).and_then(|step| seen_now(step, None, (links, edges)))
    else {
        return false;
    };
    let crossed_m = climb.steps[0].crossing_m;
    let length_m = distance_m(
        rest.points_m[climb.from_point],
        rest.points_m[climb.to_point],
    );
    let climb_m = length_m + climb_cost * climb.steps.len() as f64;
    let mut lanes = (links.ways.iter().filter(|way| way.fit == Fit::Holds))
        .filter_map(|way| links.strides(way).first())
        .filter(|lane| lane.step.stair == kept.step.stair);
    lanes.any(|lane| {
        let aside_m = distance_m(lane.step.crossing_m, crossed_m);
        (kept.beside - lane.beside) * climb_m > aside_m + edges.0.roomier
    })
}

/// The path from where the robot is beside it onward; `None` where it strayed too far.
fn rest_of(
    whole: &Path,
    at: [f64; 2],
    (stray_m, tuning): (f64, &FollowedPathTuning),
) -> Option<Path> {
    let points = &whole.points_m;
    let mut best: Option<(f64, usize, f64, [f64; 2])> = None;
    let mut along = 0.0;
    for (i, pair) in points.windows(2).enumerate() {
        let d = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = geometry::hypot(d[0], d[1]);
        let dot = (at[0] - pair[0][0]) * d[0] + (at[1] - pair[0][1]) * d[1];
        let t = if length > 0.0 {
            (dot / (length * length)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let foot = [pair[0][0] + t * d[0], pair[0][1] + t * d[1]];
        let away = geometry::hypot(at[0] - foot[0], at[1] - foot[1]);
        if best.is_none_or(|(least, ..)| away < least) {
            best = Some((away, i, t, foot));
        }
        along += length;
        if along > tuning.progress {
            break;
        }
    }
    let (away, piece, t, foot) = best?;
    if away > stray_m {
        return None;
    }
    let climbing = whole
        .climbs
        .iter()
        .any(|climb| (climb.from_point..climb.to_point).contains(&piece));
    // A step is taken once the robot is nearer to where it ends; until then it stands where it begins.
    let passed = if climbing && t > tuning.taken {
        piece + 1
    } else {
        piece
    };
    let here = if climbing { at } else { foot };
    Some(cut(whole, passed, here))
}

/// The path from a point on, which is replaced by `here`.
fn cut(whole: &Path, passed: usize, here: [f64; 2]) -> Path {
    let mut points_m = vec![here];
    points_m.extend(whole.points_m.iter().skip(passed + 1));
    let shifted = |point: usize| point.saturating_sub(passed);
    let climbs = whole.climbs.iter().filter(|climb| climb.to_point > passed);
    let climbs = climbs.map(|climb| Climb {
        from_point: shifted(climb.from_point),
        to_point: shifted(climb.to_point),
        steps: climb.steps[passed.saturating_sub(climb.from_point)..].to_vec(),
    });
    let sidles = whole.sidles.iter().filter(|sidle| sidle.to_point > passed);
    let sidles = sidles.map(|sidle| Sidle {
        from_point: shifted(sidle.from_point),
        to_point: shifted(sidle.to_point),
        ..*sidle
    });
    let spans = whole.spans.iter().filter(|span| span[1] > passed);
    Path {
        climbs: climbs.collect(),
        sidles: sidles.collect(),
        spans: spans.map(|span| span.map(shifted)).collect(),
        end: whole.end,
        points_m,
        ..Path::default()
    }
}

#[cfg(test)]
mod tests;
