//! Whether all that bars the way is what a foot met and nobody saw.

use geometry::distance_m;
use mapping::{FeltPlace, FloorView};
use stairs::Staircase;
use terrain::StandingAt;

use crate::{AStar, Goal, NoWay, Path, Refusal};

impl AStar {
    /// Why there is no way where there would be one had the feet met nothing; `None` where there is none then either. Looked for only
    /// where the robot has no way.
    pub(super) fn over_felt(
        &self,
        (view, stairs): (&FloorView, &Staircase),
        stand: &StandingAt,
        goal: &Goal,
    ) -> Option<NoWay> {
        let path = self.way_in((&view.without_felt()?, stairs), stand, goal)?;
        let felt = nearest(&path, &view.felt)?;
        let met = felt.told();
        Some(NoWay::new(
            Refusal::Blocked,
            format!("{met}, and no way leads around it"),
        ))
    }
}

/// What was felt nearest to a path.
fn nearest<'a>(path: &Path, places: &'a [FeltPlace]) -> Option<&'a FeltPlace> {
    let away_m = |felt: &FeltPlace| {
        let away_m = path
            .points_m
            .iter()
            .map(|&point_m| distance_m(point_m, felt.at_m));
        away_m.fold(f64::INFINITY, f64::min)
    };
    places.iter().min_by(|a, b| away_m(a).total_cmp(&away_m(b)))
}
