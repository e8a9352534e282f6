//! Where a robot came by.

use std::collections::VecDeque;

use geometry::distance_m;

/// Where the robot was of late, m in the map frame: it may step back there, though it did not look at the ground before its feet.
#[derive(Debug, Clone, Default)]
pub(super) struct OwnTrail(VecDeque<[f64; 3]>);

impl OwnTrail {
    /// Takes in where the robot is, m, if that is so far from the last place; no more than the last `most` are kept.
    pub(super) fn note(&mut self, at_m: [f64; 3], apart_m: f64, most: usize) {
        let away_m = |last: &[f64; 3]| distance_m([last[0], last[1]], [at_m[0], at_m[1]]);
        if self.0.back().is_none_or(|last| away_m(last) >= apart_m) {
            self.0.push_back(at_m);
        }
        while self.0.len() > most {
            let _ = self.0.pop_front();
        }
    }

    /// Whether it was as near to a place on this level as that, m.
    pub(super) fn was_at(
        &self,
        place_m: [f64; 2],
        (level_m, same_m): (f64, f64),
        near_m: f64,
    ) -> bool {
        self.0.iter().any(|[x_m, y_m, z_m]| {
            distance_m([*x_m, *y_m], place_m) <= near_m && (z_m - level_m).abs() < same_m
        })
    }
}
