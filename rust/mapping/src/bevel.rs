//! A short slope between two levels: shorter than what is told from level strips in a picture, found where an edge was looked for.

use nalgebra::Point2;

/// A short slope between two levels, in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bevel {
    /// Its middle, m.
    pub middle_m: [f64; 2],
    /// In which direction it rises, rad.
    pub heading_rad: f64,
    /// Half of its extent across that, m.
    pub half_width_m: f64,
    /// How far it takes from level to level, m.
    pub run_m: f64,
    /// Heights of the level that it rises from and of the one that it rises to, m.
    pub heights_m: [f64; 2],
}

impl Bevel {
    /// Rise per metre along the map's axes.
    pub fn gradient(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.heading_rad);
        let rise_per_m = (self.heights_m[1] - self.heights_m[0]) / self.run_m;
        [cos * rise_per_m, sin * rise_per_m]
    }

    /// A place so far along its rise and to the left of that, from its middle, m.
    pub(crate) fn at_m(&self, ahead_m: f64, left_m: f64) -> Point2<f64> {
        let (sin, cos) = libm::sincos(self.heading_rad);
        let [x_m, y_m] = self.middle_m;
        Point2::new(
            x_m + cos * ahead_m - sin * left_m,
            y_m + sin * ahead_m + cos * left_m,
        )
    }

    /// Height above a place of its line of rise, m.
    pub(crate) fn height_m(&self, at_m: [f64; 2]) -> f64 {
        let [ahead_m, _] = self.along_m(at_m);
        let share = (0.5 + ahead_m / self.run_m).clamp(0.0, 1.0);
        self.heights_m[0] + share * (self.heights_m[1] - self.heights_m[0])
    }

    /// How far a place lies beyond the nearest of its sides, m; negative within it.
    pub(crate) fn beyond_sides_m(&self, at_m: [f64; 2]) -> f64 {
        let [ahead_m, left_m] = self.along_m(at_m);
        (ahead_m.abs() - 0.5 * self.run_m).max(left_m.abs() - self.half_width_m)
    }

    /// How far a place lies along its rise and to the left of that, from its middle, m.
    fn along_m(&self, at_m: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.heading_rad);
        let [x_m, y_m] = [at_m[0] - self.middle_m[0], at_m[1] - self.middle_m[1]];
        [cos * x_m + sin * y_m, cos * y_m - sin * x_m]
    }
}
