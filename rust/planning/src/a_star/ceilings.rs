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
        let open = view.without_ceilings()?;
        let mut other = self.clone();
        other.look(&open, stairs, *stand, goal);
        let path = other.find(stand, goal).ok()?;
        if !path.end.is_certain() {
            return None;
        }
        let (at_m, room_m) = lowest(&path, view, self.needed_m())?;
        Some(NoWay::new(
            Refusal::TooLow,
            format!(
                "what hangs at ({:.2}, {:.2}) leaves {room_m:.2} m above the floor, too little for the robot's head",
                at_m[0], at_m[1]
            ),
        ))
    }
}

/// Where the least room above the floor is within the robot's reach of a path, and how much that is, m.
fn lowest(path: &Path, view: &FloorView, reach_m: f64) -> Option<([f64; 2], f64)> {
    let cells = view.head.area().cells();
    let low = cells.filter_map(|cell| match view.head.get(cell) {
        Some(HeadRoom::Low { room_m, .. }) => {
            Some((view.lattice.center_of(cell), f64::from(*room_m)))
        }
        _ => None,
    });
    let near = low.filter(|&(at_m, _)| {
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
