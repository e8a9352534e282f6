//! What a metre costs by the shape of the ground, against what the robot can do.

use classification::SlopeStatisticsConfig;
use geometry::Grid;
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, settings};

use crate::limits::RobotLimits;
use crate::shape::{GroundShape, Shapes};

settings! {
    /// What the shape of the ground costs: each part grows with the square of what it is of the robot's limit.
    pub struct TraversabilityConfig("costs.traversability") {
        /// What a metre costs more on the steepest slope.
        slope: f64 = 1.0, "1", NOT_NEGATIVE, "004, section 36.3.4";
        /// What a metre costs more on the roughest ground.
        roughness: f64 = 1.0, "1", NOT_NEGATIVE, "004, section 36.3.4";
        /// What a metre costs more over the highest step.
        step: f64 = 1.0, "1", NOT_NEGATIVE;
        /// What a metre costs more with the least room to the side; it falls to nothing over `soft_range`.
        clearance: f64 = 1.5, "1", NOT_NEGATIVE;
        /// Up to this far beyond the least room, being near to what stands costs.
        soft_range: f64 = 0.16, "m", POSITIVE;
        /// What a metre costs more where nothing is known.
        unknown: f64 = 1.0, "1", NOT_NEGATIVE;
        /// How the shape is measured; its limits play no part here.
        shape: SlopeStatisticsConfig;
    }
}

/// Costs of a metre: 1 on level ground, more where it is harder, infinite where the robot cannot go. Handbook, section 36.3.4: "comparing the
/// local terrain shape with a kinematic model of the robot".
#[derive(Debug, Clone)]
pub struct Traversability {
    config: TraversabilityConfig,
    limits: RobotLimits,
    shapes: Shapes,
}

impl Traversability {
    /// For a robot.
    pub fn new(config: TraversabilityConfig, limits: RobotLimits) -> Result<Self, ConfigError> {
        config.check()?;
        let shapes = Shapes::new(config.shape.clone())?;
        Ok(Self {
            config,
            limits,
            shapes,
        })
    }

    /// What a metre costs on ground of this shape: 1 or more, infinite beyond a limit of the robot's. It never falls where a part gets worse.
    pub fn cost(&self, shape: &GroundShape) -> f64 {
        self.parts(shape).map_or(f64::INFINITY, |parts| {
            let weights = [
                self.config.slope,
                self.config.roughness,
                self.config.step,
                self.config.clearance,
            ];
            let dear = parts.iter().zip(weights);
            1.0 + dear.map(|(part, weight)| weight * part * part).sum::<f64>()
        })
    }

    /// How much of the robot's limits a shape asks: slope, roughness, step and closeness, each from 0 to 1; `None` where one is exceeded.
    pub fn parts(&self, shape: &GroundShape) -> Option<[f64; 4]> {
        let limits = &self.limits;
        let fits = shape.slope <= limits.slope
            && shape.roughness_m <= limits.roughness_m
            && shape.step_m <= limits.step_m
            && shape.clearance_m >= limits.radius_m
            && shape.head_room_m >= limits.height_m;
        let spare_m = shape.clearance_m - limits.radius_m;
        fits.then(|| {
            [
                shape.slope / limits.slope,
                shape.roughness_m / limits.roughness_m,
                shape.step_m / limits.step_m,
                (1.0 - spare_m / self.config.soft_range).max(0.0),
            ]
        })
    }

    /// The shape around each cell of a grid of heights, m, with cells of `cell_m`: see [`Shapes::measure`].
    pub fn shapes(
        &self,
        heights_m: &Grid<Option<f64>>,
        head_room_m: Option<&Grid<f64>>,
        cell_m: f64,
    ) -> Grid<Option<GroundShape>> {
        (self.shapes).measure(heights_m, head_room_m, cell_m, self.limits.step_m)
    }

    /// What a metre costs in each cell of a grid of heights, m, with cells of `cell_m`; the room above each, m, where the model knows it.
    pub fn map(
        &self,
        heights_m: &Grid<Option<f64>>,
        head_room_m: Option<&Grid<f64>>,
        cell_m: f64,
    ) -> Grid<f64> {
        let shapes = self.shapes(heights_m, head_room_m, cell_m);
        let mut costs = Grid::filled(shapes.cols(), shapes.rows(), 1.0 + self.config.unknown);
        for (cost, shape) in costs.values_mut().iter_mut().zip(shapes.values()) {
            if let Some(shape) = shape {
                *cost = self.cost(shape);
            }
        }
        costs
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::limits::LimitsConfig;
    use geometry::Cell;
    use proptest::prelude::*;
    use testkit::biped;

    pub(crate) fn limits() -> RobotLimits {
        RobotLimits::of(&biped(), &LimitsConfig::default()).unwrap()
    }

    fn model() -> Traversability {
        Traversability::new(TraversabilityConfig::default(), limits()).unwrap()
    }

    /// A shape from parts of the limits: 1 is just what the robot can do.
    fn shape([slope, roughness, step, room, head]: [f64; 5]) -> GroundShape {
        let limits = limits();
        GroundShape {
            slope: slope * limits.slope,
            roughness_m: roughness * limits.roughness_m,
            step_m: step * limits.step_m,
            clearance_m: limits.radius_m / room,
            head_room_m: limits.height_m / head,
        }
    }

    proptest! {
        #[test]
        fn cost_never_falls_where_any_part_of_the_ground_gets_worse(
            parts in prop::array::uniform5(0.0..1.3f64), worse in prop::array::uniform5(0.0..0.4f64),
        ) {
            let model = model();
            let after = std::array::from_fn(|at| parts[at] + worse[at]);
            prop_assert!(model.cost(&shape(after)) >= model.cost(&shape(parts)));
        }

        #[test]
        fn it_rises_with_slope_roughness_step_and_closeness_each(
            parts in prop::array::uniform5(0.3..0.9f64), at in 0..4usize, more in 0.01..0.1f64,
        ) {
            let model = model();
            let parts = if at == 3 { [parts[0], parts[1], parts[2], 0.8, parts[4]] } else { parts };
            let mut after = parts;
            after[at] += more;
            prop_assert!(model.cost(&shape(after)) > model.cost(&shape(parts)));
        }

        #[test]
        fn ground_is_infeasible_exactly_beyond_a_limit_of_the_robots(parts in prop::array::uniform5(0.01..1.3f64)) {
            let beyond = parts.iter().any(|part| *part > 1.0);
            prop_assert_eq!(model().cost(&shape(parts)).is_infinite(), beyond);
        }
    }

    #[test]
    fn at_each_limit_the_robot_still_goes_and_a_hair_beyond_it_does_not() {
        let (model, limits) = (model(), limits());
        let one = |change: &dyn Fn(&mut GroundShape, f64)| {
            [1.0, 1.0 + 1e-9].map(|of| {
                let mut shape = GroundShape::LEVEL;
                change(&mut shape, of);
                model.cost(&shape).is_finite()
            })
        };
        let can_then_cannot = [true, false];
        assert_eq!(one(&|s, of| s.slope = limits.slope * of), can_then_cannot);
        assert_eq!(
            one(&|s, of| s.roughness_m = limits.roughness_m * of),
            can_then_cannot
        );
        assert_eq!(one(&|s, of| s.step_m = limits.step_m * of), can_then_cannot);
        assert_eq!(
            one(&|s, of| s.clearance_m = limits.radius_m / of),
            can_then_cannot
        );
        assert_eq!(
            one(&|s, of| s.head_room_m = limits.height_m / of),
            can_then_cannot
        );
    }

    #[test]
    fn level_ground_costs_its_length_and_what_is_unknown_more() {
        let mut heights = Grid::filled(20, 20, Some(0.3));
        for cell in heights.area().cells().filter(|cell| cell.col > 10) {
            *heights.get_mut(cell).unwrap() = None;
        }
        let costs = model().map(&heights, None, 0.04);
        assert_eq!(costs.get(Cell::new(3, 9)).copied(), Some(1.0));
        assert_eq!(costs.get(Cell::new(17, 9)).copied(), Some(2.0));
    }

    #[test]
    fn there_is_no_way_into_a_wall_nor_under_a_low_beam() {
        let mut heights = Grid::filled(40, 40, Some(0.0));
        let mut room = Grid::filled(40, 40, f64::INFINITY);
        for cell in heights.area().cells() {
            if cell.col == 30 {
                *heights.get_mut(cell).unwrap() = Some(0.5);
            }
            if cell.row == 5 {
                *room.get_mut(cell).unwrap() = 0.5 * limits().height_m;
            }
        }
        let costs = model().map(&heights, Some(&room), 0.04);
        assert!(costs.get(Cell::new(29, 20)).unwrap().is_infinite());
        assert!(costs.get(Cell::new(10, 5)).unwrap().is_infinite());
        let from_wall = |col| *costs.get(Cell::new(col, 20)).unwrap();
        assert!(from_wall(10) == 1.0 && from_wall(25) > from_wall(23) && from_wall(23) > 1.0);
    }
}
