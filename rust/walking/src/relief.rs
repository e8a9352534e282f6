//! How the ground slopes where the feet land. A step between levels that nobody slopes into each other is a climb's, not a walk's.

use geometry::{CellArea, Map, PlanarPose, Pose, Robot};
use mapping::FloorView;
use nalgebra::Vector2;

use crate::tuning::ReliefTuning;

/// What is known of how the ground slopes around the robot.
pub trait Slopes: std::fmt::Debug {
    /// Rise of the ground per metre along both axes of the robot's frame, at a place of it; nothing where it is level or not known.
    fn gradient(&self, x_m: f64, y_m: f64) -> Vector2<f64>;
}

/// The slopes in the walker's own plan.
#[derive(Debug, Clone, Copy)]
pub struct Relief<'a> {
    slopes: Option<&'a dyn Slopes>,
    plan_from_robot: PlanarPose,
    /// Places along a sole, and along a way, at which the slope is asked for.
    places: usize,
}

impl<'a> Relief<'a> {
    /// Level ground.
    pub const LEVEL: Self = Self {
        slopes: None,
        plan_from_robot: PlanarPose {
            x_m: 0.0,
            y_m: 0.0,
            yaw_rad: 0.0,
        },
        places: 1,
    };

    /// Slopes around a robot that is at this place of the plan.
    pub const fn new(
        slopes: Option<&'a dyn Slopes>,
        plan_from_robot: PlanarPose,
        tuning: &ReliefTuning,
    ) -> Self {
        Self {
            slopes,
            plan_from_robot,
            places: tuning.places,
        }
    }

    /// Mean gradient under a sole of this length, from heel to toes, along the plan's axes.
    pub(crate) fn under(&self, sole: &PlanarPose, length_m: f64) -> Vector2<f64> {
        let ends = [-0.5, 0.5].map(|share| sole.apply(share * length_m, 0.0));
        self.mean(ends[0], ends[1])
    }

    /// How much higher the ground is at one place than at another: its gradient along the straight way, m.
    pub(crate) fn rise_m(&self, from: &PlanarPose, to: &PlanarPose) -> f64 {
        let way = Vector2::new(to.x_m - from.x_m, to.y_m - from.y_m);
        self.mean((from.x_m, from.y_m), (to.x_m, to.y_m)).dot(&way)
    }

    /// The mean gradient between two places.
    fn mean(&self, from: (f64, f64), to: (f64, f64)) -> Vector2<f64> {
        let Some(slopes) = self.slopes else {
            return Vector2::zeros();
        };
        let robot = self.plan_from_robot.inverse();
        let mut sum = Vector2::zeros();
        let places = self.places;
        for place in 0..places {
            let share = (place as f64 + 0.5) / places as f64;
            let (x_m, y_m) = robot.apply(
                from.0 + (to.0 - from.0) * share,
                from.1 + (to.1 - from.1) * share,
            );
            sum += slopes.gradient(x_m, y_m);
        }
        let mean = sum / places as f64;
        let (x, y) = PlanarPose::new(0.0, 0.0, self.plan_from_robot.yaw_rad).apply(mean.x, mean.y);
        Vector2::new(x, y)
    }
}

/// The slopes of the map around a robot.
#[derive(Debug, Clone, Copy)]
pub struct Mapped<'a> {
    view: &'a FloorView,
    map_from_robot: PlanarPose,
}

impl<'a> Mapped<'a> {
    /// The map around a robot that is here; none where there is no slope near it.
    pub fn around(
        view: &'a FloorView,
        map_from_robot: &Pose<Map, Robot>,
        tuning: &ReliefTuning,
    ) -> Option<Self> {
        let around_m = tuning.around;
        let at = map_from_robot.origin().inner;
        let area = CellArea {
            min: view.lattice.cell_at(at.x - around_m, at.y - around_m),
            max: view.lattice.cell_at(at.x + around_m, at.y + around_m),
        };
        let sloped = area
            .within(view.gradients.area())
            .cells()
            .any(|cell| view.gradients.get(cell).is_some_and(|g| *g != [0.0; 2]));
        sloped.then(|| Self {
            view,
            map_from_robot: PlanarPose::new(at.x, at.y, map_from_robot.yaw_rad()),
        })
    }
}

impl Slopes for Mapped<'_> {
    fn gradient(&self, x_m: f64, y_m: f64) -> Vector2<f64> {
        let (x, y) = self.map_from_robot.apply(x_m, y_m);
        let gradient = Vector2::from(self.view.gradient_at(x, y));
        let (sin, cos) = libm::sincos(self.map_from_robot.yaw_rad);
        Vector2::new(
            cos * gradient.x + sin * gradient.y,
            cos * gradient.y - sin * gradient.x,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Level up to a line across x, and as steep as this behind it.
    #[derive(Debug)]
    struct Bend(f64, f64);

    impl Slopes for Bend {
        fn gradient(&self, x_m: f64, _y_m: f64) -> Vector2<f64> {
            Vector2::new(if x_m > self.0 { self.1 } else { 0.0 }, 0.0)
        }
    }

    #[test]
    fn a_rise_is_that_of_the_part_of_the_way_that_slopes() {
        let bend = Bend(0.03, 0.1);
        let relief = Relief::new(Some(&bend), PlanarPose::default(), &ReliefTuning::default());
        let at = |x_m: f64| PlanarPose::new(x_m, 0.0, 0.0);
        assert!((relief.rise_m(&at(0.0), &at(0.06)) - 0.003).abs() < 1e-12);
        assert!((relief.rise_m(&at(0.06), &at(0.0)) + 0.003).abs() < 1e-12);
        assert_eq!(relief.rise_m(&at(-0.06), &at(0.0)), 0.0);
        assert_eq!(Relief::LEVEL.rise_m(&at(0.0), &at(0.06)), 0.0);
    }

    #[test]
    fn a_sole_across_a_bend_is_half_as_steep() {
        let bend = Bend(0.2, 0.1);
        let relief = Relief::new(Some(&bend), PlanarPose::default(), &ReliefTuning::default());
        let under = |x_m: f64| relief.under(&PlanarPose::new(x_m, 0.0, 0.0), 0.1);
        assert_eq!(under(0.1), Vector2::zeros());
        assert!((under(0.2) - Vector2::new(0.05, 0.0)).norm() < 1e-12);
        assert!((under(0.3) - Vector2::new(0.1, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn slopes_turn_with_the_robot() {
        let bend = Bend(0.0, 0.1);
        // The robot faces along the plan's y: what rises ahead of it rises along y.
        let place = PlanarPose::new(1.0, 2.0, std::f64::consts::FRAC_PI_2);
        let relief = Relief::new(Some(&bend), place, &ReliefTuning::default());
        let under = relief.under(&PlanarPose::new(1.0, 2.2, 0.0), 0.1);
        assert!((under - Vector2::new(0.0, 0.1)).norm() < 1e-12, "{under}");
    }
}
