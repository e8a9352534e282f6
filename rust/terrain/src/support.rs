//! What lies under soles and around a place, asked of the map itself between two plans. Who asks says how much is tolerated.

use geometry::{CellArea, Map, PlanarPose, distance_m};
use mapping::{FloorView, Surface};
use stairs::{Stair, Staircase};

/// An obstacle cell: its middle and its height, m.
pub type ObstacleCell = ([f64; 2], f32);

/// Soles side by side, as a rectangle around the middle between them in which the map is asked at places of a raster.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolesOnGround {
    /// Half the length and half the width over both, with what is kept around them, m.
    pub half_m: [f64; 2],
    /// Places to each side of the middle, along and across.
    pub raster: i32,
}

impl SolesOnGround {
    /// The places under the soles of a robot, m, row by row from the heels up to this share of half their length, 1 for the toes.
    pub fn places(self, pose: &PlanarPose, front: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
        let Self { half_m, raster } = self;
        let shares = move || (-raster..=raster).map(move |k| f64::from(k) / f64::from(raster));
        let along = shares().filter(move |along| *along <= front);
        along.flat_map(move |along| {
            shares().map(move |across| {
                let (x_m, y_m) = pose.apply(along * half_m[0], across * half_m[1]);
                [x_m, y_m]
            })
        })
    }
}

/// Whether the map has floor at a place that is lower than a level by more than this, m, or beside it where it has nothing: below an edge
/// is a shadow.
pub fn is_lower(view: &FloorView, [x_m, y_m]: [f64; 2], level_m: f64, lower_m: f64) -> bool {
    let beside_m = view.lattice.cell_m;
    let lower = |dx_m: f64, dy_m: f64| match view.at(x_m + dx_m, y_m + dy_m) {
        Surface::Floor(height_m) => f64::from(height_m) < level_m - lower_m,
        _ => false,
    };
    let beside = [
        (beside_m, 0.0),
        (-beside_m, 0.0),
        (0.0, beside_m),
        (0.0, -beside_m),
    ];
    let unknown = view.at(x_m, y_m) == Surface::Unknown;
    lower(0.0, 0.0) || unknown && beside.iter().any(|&(dx_m, dy_m)| lower(dx_m, dy_m))
}

/// At how many places under the soles there is lower floor, from the heels up to this share of half their length.
pub fn lower_places(
    view: &FloorView,
    soles: SolesOnGround,
    (pose, front): (&PlanarPose, f64),
    (level_m, lower_m): (f64, f64),
) -> usize {
    let places = soles.places(pose, front);
    places
        .filter(|&place_m| is_lower(view, place_m, level_m, lower_m))
        .count()
}

/// How many cells under the soles hold something that is higher than this, m, and that `counts`.
pub fn cells_under(
    view: &FloorView,
    soles: SolesOnGround,
    pose: &PlanarPose,
    top_m: f32,
    counts: impl Fn(&ObstacleCell) -> bool,
) -> usize {
    let mut cells = Vec::new();
    for [x_m, y_m] in soles.places(pose, 1.0) {
        let Surface::Obstacle(height_m) = view.at(x_m, y_m) else {
            continue;
        };
        let cell = view.lattice.cell_at(x_m, y_m);
        let obstacle = (view.lattice.center_of(cell), height_m);
        if height_m > top_m && counts(&obstacle) && !cells.contains(&cell) {
            cells.push(cell);
        }
    }
    cells.len()
}

/// Whether a place is known floor that differs from a level by less than this, m.
pub fn is_level_floor(view: &FloorView, [x_m, y_m]: [f64; 2], level_m: f64, below_m: f64) -> bool {
    matches!(view.at(x_m, y_m), Surface::Floor(height_m) if (f64::from(height_m) - level_m).abs() < below_m)
}

/// Whether a place may be floor of a level: it differs from it by less than this, m, or was not seen.
pub fn may_be_level_floor(view: &FloorView, place_m: [f64; 2], level_m: f64, below_m: f64) -> bool {
    let unknown = view.at(place_m[0], place_m[1]) == Surface::Unknown;
    unknown || is_level_floor(view, place_m, level_m, below_m)
}

/// At how many of these distances to the side of a heading nothing was seen.
pub fn unknown_across(view: &FloorView, heading: &PlanarPose, sides_m: &[f64]) -> usize {
    let unknown = |side_m: &&f64| {
        let (x_m, y_m) = heading.apply(0.0, **side_m);
        view.at(x_m, y_m) == Surface::Unknown
    };
    sides_m.iter().filter(unknown).count()
}

/// The obstacle cells whose middle is nearer to a place than this, m.
pub fn obstacles_within(
    view: &FloorView,
    [x, y]: [f64; 2],
    radius_m: f64,
) -> impl Iterator<Item = ObstacleCell> + '_ {
    let (low, high) = (
        view.lattice.cell_at(x - radius_m, y - radius_m),
        view.lattice.cell_at(x + radius_m, y + radius_m),
    );
    let area = CellArea {
        min: low,
        max: high,
    };
    // Settings may ask for more room than the window shows: beyond it nothing is known.
    area.within(view.cells.area())
        .cells()
        .filter_map(|cell| match view.cell(cell) {
            Surface::Obstacle(top_m) => Some((view.lattice.center_of(cell), top_m)),
            _ => None,
        })
        .filter(move |([cx, cy], _)| geometry::hypot(cx - x, cy - y) < radius_m)
}

/// Whether no obstacle is known nearer to a place than this, m.
pub fn is_roomy(view: &FloorView, place_m: [f64; 2], radius_m: f64) -> bool {
    obstacles_within(view, place_m, radius_m).next().is_none()
}

/// Whether an obstacle is only the riser of a stair, or what the depth image makes of its edge: no higher above the stair than this, m, and
/// no further from its edge than that, m.
pub fn is_riser(
    stairs: &Staircase,
    (place_m, top_m): &ObstacleCell,
    (higher_m, beside_m): (f64, f64),
) -> bool {
    stairs.stairs.iter().any(|stair| {
        let low = f64::from(*top_m) < stair.height_m() + higher_m;
        low && [&stair.front, &stair.back].into_iter().any(|edge| {
            let along_m = distance_m(*place_m, edge.middle_m());
            edge.beyond_m(*place_m).abs() < beside_m && along_m < 0.5 * edge.length_m() + beside_m
        })
    })
}

/// The stairs between whose edges a place lies, and whose height differs from a level by less than this, m.
pub fn stairs_under(
    stairs: &Staircase,
    at_m: [f64; 2],
    (level_m, below_m): (f64, f64),
) -> impl Iterator<Item = &Stair<Map>> {
    stairs.stairs.iter().filter(move |stair| {
        (stair.height_m() - level_m).abs() < below_m
            && stair.front.beyond_m(at_m) > 0.0
            && stair.back.beyond_m(at_m) < 0.0
    })
}

/// Height of the stair that a robot stands on whose own height, m, is no further from it than `told_m`; else its own. By its legs alone
/// its height drifts from step to step, and the rise of the next stair with it.
pub fn stood_on_m(stairs: &Staircase, at_m: [f64; 2], height_m: f64, told_m: f64) -> f64 {
    let drift_m = |stair: &&Stair<Map>| (stair.height_m() - height_m).abs();
    stairs_under(stairs, at_m, (height_m, told_m))
        .filter(|stair| 2.0 * stair.front.aside_m(at_m).abs() < stair.front.length_m())
        .min_by(|a, b| drift_m(a).total_cmp(&drift_m(b)))
        .map_or(height_m, Stair::height_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Floor, stair};

    const SOLES: SolesOnGround = SolesOnGround {
        half_m: [0.05, 0.08],
        raster: 5,
    };

    #[test]
    fn lower_floor_is_found_under_the_soles_and_in_the_shadow_below_an_edge() {
        let mut floor = Floor::new();
        floor.paint([0.5, -2.0], [0.55, 2.0], Surface::Unknown);
        floor.paint([0.55, -2.0], [2.0, 2.0], Surface::Floor(-0.1));
        let places = |x_m: f64, front: f64| {
            let pose = PlanarPose::new(x_m, 0.0, 0.0);
            lower_places(&floor.view, SOLES, (&pose, front), (0.0, 0.02))
        };
        assert_eq!((places(0.4, 1.0), places(0.48, 0.0)), (0, 0));
        assert!(places(0.48, 1.0) > 0 && places(0.53, 0.0) > 0);
    }

    #[test]
    fn what_stands_under_the_soles_is_counted_by_cells_unless_it_is_a_riser() {
        let mut floor = Floor::new();
        floor.paint([0.0, -0.05], [0.05, 0.05], Surface::Obstacle(0.3));
        let count = |stairs: &Staircase| {
            let counts = |cell: &ObstacleCell| !is_riser(stairs, cell, (0.06, 0.06));
            cells_under(&floor.view, SOLES, &PlanarPose::default(), 0.04, counts)
        };
        assert_eq!(count(&floor.stairs), 2);
        let stairs = Staircase {
            stairs: vec![stair(0.0, 0.3, 0.26, 0.6)],
            ..Staircase::default()
        };
        assert_eq!(count(&stairs), 0);
        assert!(!is_roomy(&floor.view, [0.0; 2], 0.1) && is_roomy(&floor.view, [0.5, 0.0], 0.1));
        assert!(is_roomy(&floor.view, [1e12, 0.0], 1e9), "beyond the window");
    }

    #[test]
    fn who_stands_on_a_stair_is_as_high_as_it_is_and_who_stands_beside_or_much_lower_is_not() {
        let stairs = Staircase {
            stairs: vec![stair(0.0, 0.3, 0.26, 0.6)],
            ..Staircase::default()
        };
        let height_m = |at_m: [f64; 2], by_legs_m: f64| stood_on_m(&stairs, at_m, by_legs_m, 0.02);
        assert_eq!(height_m([0.1, 0.0], 0.273), 0.26);
        for (at_m, by_legs_m) in [([0.1, 0.0], 0.23), ([-0.1, 0.0], 0.27), ([0.1, 0.5], 0.27)] {
            assert_eq!(height_m(at_m, by_legs_m), by_legs_m, "{at_m:?}");
        }
    }

    #[test]
    fn what_was_not_seen_may_be_level_floor_and_is_none() {
        let mut floor = Floor::new();
        floor.paint([0.5, -0.5], [0.6, 0.5], Surface::Unknown);
        floor.paint([0.7, -0.5], [0.8, 0.5], Surface::Floor(0.03));
        let at = |x_m: f64| {
            let place_m = [x_m, 0.0];
            let is = is_level_floor(&floor.view, place_m, 0.0, 0.012);
            (is, may_be_level_floor(&floor.view, place_m, 0.0, 0.012))
        };
        assert_eq!(at(0.2), (true, true));
        assert_eq!(at(0.55), (false, true));
        assert_eq!(at(0.75), (false, false));
        let heading = PlanarPose::new(0.55, 0.0, 0.0);
        assert_eq!(
            unknown_across(&floor.view, &heading, &[-0.06, 0.0, 0.06]),
            3
        );
        assert_eq!(
            stairs_under(&floor.stairs, [0.1, 0.0], (0.0, 0.01)).count(),
            0
        );
    }
}
