//! What a robot gives way to.

use geometry::distance_m;

/// Something that moves, or may.
#[derive(Debug, Clone, PartialEq)]
pub struct Mover {
    /// Where it will be from now on, m in the map frame, at times that are `step_s` apart; not empty.
    pub places_m: Vec<[f64; 2]>,
    /// Time between two places, s.
    pub step_s: f64,
    /// Half of its width, m.
    pub radius_m: f64,
    /// Room that the robot's body keeps from it, m.
    pub room_m: f64,
    /// Whether it moves for sure, and so fast that it is given way.
    pub is_sure: bool,
}

impl Mover {
    /// Whether it gets nearer to a place, m.
    pub(super) fn comes(&self, place_m: [f64; 2]) -> bool {
        match self.places_m[..] {
            [now_m, then_m, ..] => distance_m(then_m, place_m) < distance_m(now_m, place_m),
            _ => false,
        }
    }

    /// Room between its rim, with what is kept from it, and a place that is `at` somewhere at each time from now on, s: the least, m; less than 0 where
    /// it comes over that place.
    pub(super) fn clearance_m(&self, at: impl Fn(f64) -> [f64; 2]) -> f64 {
        let times = self.places_m.iter().enumerate();
        times
            .map(|(step, place_m)| distance_m(*place_m, at(step as f64 * self.step_s)))
            .fold(f64::INFINITY, f64::min)
            - self.radius_m
            - self.room_m
    }
}
