//! Whether all that bars the way is what hangs too low for the robot's head.

use mapping::{FloorView, HeadRoom};
use stairs::Staircase;
use terrain::StandingAt;

use crate::{AStar, Goal, NoWay, Path, Refusal};

impl AStar {
    /// Why there is no known way where there would be one for a robot that needs no room for its head; `None` where there is none for it
    /// either. Looked for only where the robot has no way.
    pub(super) fn under_ceilings(
        &self,
        (view, stairs): (&FloorView, &Staircase),
        stand: &StandingAt,
        goal: &Goal,
    ) -> Option<NoWay> {
        let path = self.way_in((&view.without_ceilings()?, stairs), stand, goal)?;
        if !path.end.is_certain() {
            return None;
        }
        let reach_m = self.needed_m();
        let (at_m, room_m) = lowest(&path, view, reach_m)?;
        if leads_into_the_unseen(&path, view, reach_m) {
            return None;
        }
        Some(NoWay::new(
            Refusal::TooLow,
            format!(
                "what hangs at ({:.2}, {:.2}) leaves {room_m:.2} m above the floor, too little for the robot's head",
                at_m[0], at_m[1]
            ),
        ))
    }
}

/// Whether a path leads from beside what hangs on over unseen ground for longer than `reach_m`: of a wall the upper part alone may
/// have been seen, and what is behind it was not.
fn leads_into_the_unseen(path: &Path, view: &FloorView, reach_m: f64) -> bool {
    let is_beside = |at_m: [f64; 2]| {
        low_cells(view).any(|(low_m, _)| geometry::distance_m(low_m, at_m) <= reach_m)
    };
    let points = path.points_m.iter().zip(&path.unknown);
    let hangs = |[x_m, y_m]: [f64; 2]| matches!(view.head_at(x_m, y_m), HeadRoom::Low { .. });
    let seen = points.filter(|&(&at_m, &unknown)| !unknown || hangs(at_m));
    let ends = seen
        .map(|(&at_m, _)| at_m)
        .chain(path.points_m.last().copied());
    let mut last_m = path.points_m[0];
    ends.into_iter().any(|at_m| {
        let before_m = std::mem::replace(&mut last_m, at_m);
        geometry::distance_m(before_m, at_m) > reach_m && (is_beside(before_m) || is_beside(at_m))
    })
}

/// The middles of the cells above which something hangs too low, and the room there, m.
fn low_cells(view: &FloorView) -> impl Iterator<Item = ([f64; 2], f64)> + '_ {
    let cells = view.head.area().cells();
    cells.filter_map(|cell| match view.head.get(cell) {
        Some(HeadRoom::Low { room_m, .. }) => {
            Some((view.lattice.center_of(cell), f64::from(*room_m)))
        }
        _ => None,
    })
}

/// Where the least room above the floor is within the robot's reach of a path, and how much that is, m.
fn lowest(path: &Path, view: &FloorView, reach_m: f64) -> Option<([f64; 2], f64)> {
    let near = low_cells(view).filter(|&(at_m, _)| {
        let mut pieces = path.points_m.windows(2);
        pieces.any(|piece| piece_away_m(piece[0], piece[1], at_m) <= reach_m)
    });
    near.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Distance from a place to a straight piece, m.
fn piece_away_m(from_m: [f64; 2], to_m: [f64; 2], at_m: [f64; 2]) -> f64 {
    let along = [to_m[0] - from_m[0], to_m[1] - from_m[1]];
    let off = [at_m[0] - from_m[0], at_m[1] - from_m[1]];
    let squared = along[0] * along[0] + along[1] * along[1];
    let share = if squared > 0.0 {
        ((along[0] * off[0] + along[1] * off[1]) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    geometry::hypot(off[0] - share * along[0], off[1] - share * along[1])
}
