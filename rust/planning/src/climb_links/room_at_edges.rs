//! Room at edges: where the robot lines up, where it may cross, where it walks on.

pub(crate) use geometry::distance_m;
use geometry::{Lattice, Map, same_level};
use mapping::Surface;
use stairs::{EdgeLine, Stair};
use terrain::Terrain;

use super::Scene;
use crate::search::octile;

/// From a place at an edge straight on (`side` 1) or back (-1) to the first cell where the robot may be; the place there.
pub(crate) fn run_to_cell(
    scene: &Scene<'_>,
    line: &EdgeLine,
    offset_m: f64,
    beyond_m: f64,
    side: f64,
    on_level: impl Fn(Option<f64>) -> bool,
) -> Option<(usize, [f64; 2])> {
    let terrain = scene.terrain;
    let run_m = scene.config.tuning.room_at_edges.run;
    let stride_m = terrain.room.stride * terrain.lattice.cell_m;
    let mut away_m = beyond_m.abs();
    while away_m <= run_m {
        let at_m = line.at(offset_m, side * away_m);
        let cell = terrain.index_at(at_m)?;
        // The cell at the edge may have either height.
        let at_edge = away_m <= terrain.lattice.cell_m;
        let on_level = on_level(terrain.level_m(cell));
        if terrain.blocked[cell] || !(on_level || at_edge) {
            return None;
        }
        if terrain.weights[cell].is_finite() && on_level {
            return Some((cell, at_m));
        }
        away_m += stride_m;
    }
    None
}

/// How far the straight way from a place in the window towards another leads within the window, m.
pub(crate) fn inside_m(terrain: &Terrain, from_m: [f64; 2], towards_m: [f64; 2]) -> f64 {
    let Lattice { origin_m, cell_m } = terrain.lattice;
    let sizes_m = [terrain.cols, terrain.rows].map(|cells| cells as f64 * cell_m);
    let share = (0..2).fold(1.0_f64, |share, axis| {
        let ahead_m = towards_m[axis] - from_m[axis];
        let end_m = if ahead_m > 0.0 {
            origin_m[axis] + sizes_m[axis]
        } else {
            origin_m[axis]
        };
        if ahead_m == 0.0 {
            share
        } else {
            share.min(((end_m - from_m[axis]) / ahead_m).max(0.0))
        }
    });
    share * distance_m(from_m, towards_m)
}

/// Whether nothing stands, and no other level lies, on the straight way between two places.
pub(crate) fn walkable(scene: &Scene<'_>, from_m: [f64; 2], to_m: [f64; 2], level_m: f64) -> bool {
    let terrain = scene.terrain;
    let tuning = &scene.config.tuning.room_at_edges;
    let tolerance_m = scene.climbing.levels.same;
    let stride_m = terrain.room.stride * terrain.lattice.cell_m;
    let pieces = (distance_m(from_m, to_m) / stride_m).ceil();
    (0..=pieces as usize).all(|piece| {
        let t = piece as f64 / pieces.max(1.0);
        let at = [
            from_m[0] + t * (to_m[0] - from_m[0]),
            from_m[1] + t * (to_m[1] - from_m[1]),
        ];
        terrain.index_at(at).is_some_and(|cell| {
            let level = terrain.level_m(cell);
            // The last pieces lie at the edge.
            let last = piece as f64 >= pieces - tuning.at_edge;
            !terrain.blocked[cell]
                && (last || level.is_none_or(|height_m| same_level(height_m, level_m, tolerance_m)))
        })
    })
}

/// What a length costs at a place on stairs by what stands beside it, as on a floor: 1 where nothing is near; `None` where the body
/// has no room. What is hardly higher than the next tread may be a riser, and is not looked at.
pub(crate) fn weight_on_stairs(scene: &Scene<'_>, at_m: [f64; 2], level_m: f64) -> Option<f64> {
    let (terrain, soft_m) = (scene.terrain, scene.config.soft_range);
    let riser_m = scene.config.tuning.room_at_edges.riser;
    let body_m = terrain.needs.body_m;
    let any_m = terrain.clearance_m(terrain.index_at(at_m)?);
    if any_m >= body_m + soft_m {
        return Some(1.0);
    }
    let standing = terrain.obstacles_near(at_m, body_m + soft_m).filter(|&place_m| {
        let cell = scene.view.lattice.cell_at(place_m[0], place_m[1]);
        matches!(scene.view.cell(cell), Surface::Obstacle(top) if f64::from(top) > level_m + riser_m)
    });
    let standing_m = standing.map(|place_m| distance_m(place_m, at_m));
    // Between the middles of cells nothing may be too near that is so from the place itself.
    let clearance_m = standing_m.fold(f64::INFINITY, f64::min).max(any_m);
    let needed_m = body_m.min(terrain.clearance_at_start_m);
    (clearance_m >= needed_m).then(|| terrain.settings.weight(clearance_m - body_m, soft_m))
}

/// How far from its middle an edge may be crossed, m.
pub(crate) fn range_m(scene: &Scene<'_>, line: &EdgeLine) -> f64 {
    let needed_m = 0.5 * scene.feet.pair_width_m + scene.climbing.side_room;
    let room_m = (line.half_m() - needed_m).max(0.0);
    let tuning = &scene.config.tuning.room_at_edges;
    if 2.0 * room_m > tuning.narrow {
        room_m
    } else {
        tuning.narrow_share * room_m
    }
}

/// Width of a stair at its front edge, m, with the room beside it where it was not seen to end: as those judge it who climb it.
pub(crate) fn width_m(line: &EdgeLine, stair: &Stair<Map>) -> f64 {
    let [left_m, right_m] = stair.room_beside_m();
    2.0 * line.half_m() + left_m.max(0.0) + right_m.max(0.0)
}

/// Where an edge is crossed: in its middle where it is no wider than `narrow_m`, or all along it.
pub(crate) fn lanes(range_m: f64, lane_m: f64, narrow_m: f64) -> impl Iterator<Item = f64> {
    let narrow = 2.0 * range_m <= narrow_m;
    let pieces = if narrow {
        0
    } else {
        2 * (range_m / lane_m).ceil() as i32
    };
    (0..=pieces).map(move |piece| {
        if pieces == 0 {
            0.0
        } else {
            range_m * (2.0 * f64::from(piece) / f64::from(pieces) - 1.0)
        }
    })
}

/// Length of a way on the grid, m: what the search's heuristic takes for the least.
pub(crate) fn walk_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    octile(a[0] - b[0], a[1] - b[1])
}
