//! Costs that are known beforehand, for weights to be learned of.

use crate::motion::{MotionCost, SpeedOnCurve};
use crate::shape::GroundShape;
use crate::traversability::Traversability;

/// Number of costs that are known beforehand.
pub const BASIS: usize = 12;
/// Number of shades that are told apart, from dark to bright.
const SHADES: usize = 5;

/// How a cell of the ground looks from near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Appearance {
    /// Its shape.
    pub shape: GroundShape,
    /// How bright it is, 0 to 1.
    pub shade: f64,
    /// Share of the rays that end above the lowest surface, 0 to 1: grass.
    pub cover: f64,
}

/// Turns the look of a cell into costs that are known beforehand: what shape and motion ask of the robot's limits, told apart by whether
/// something covers the ground, and a constant for each shade. "Learning the best weights to combine a set of predefined costs": 004,
/// section 36.3.4.
#[derive(Debug, Clone)]
pub struct Basis {
    traversability: Traversability,
    motion: MotionCost,
    going: SpeedOnCurve,
}

impl Basis {
    /// For a robot that goes so.
    pub const fn new(
        traversability: Traversability,
        motion: MotionCost,
        going: SpeedOnCurve,
    ) -> Self {
        Self {
            traversability,
            motion,
            going,
        }
    }

    /// The costs of a metre that weights combine; `None` beyond a limit of the robot's, which no learning moves.
    pub fn of(&self, look: &Appearance) -> Option<[f64; BASIS]> {
        let [slope, roughness, step, close] = self.traversability.parts(&look.shape)?;
        let tip = self.motion.learned_tip(&look.shape, &self.going);
        let bare = 1.0 - look.cover;
        let [near, over] = [tip * tip, (2.0 * tip - 1.0).max(0.0)];
        let shape = [
            slope * slope,
            roughness * roughness,
            step * step,
            close * close,
            near * bare,
            over * bare,
            near * look.cover,
        ];
        let steps = (SHADES - 1) as f64;
        let of_shade = |at: usize| {
            let away = look.shade.clamp(0.0, 1.0) * steps - at as f64;
            (1.0 - away.abs()).max(0.0)
        };
        let mut all = [0.0; BASIS];
        let shades = (0..SHADES).map(of_shade);
        for (one, value) in all.iter_mut().zip(shape.into_iter().chain(shades)) {
            *one = value;
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::MotionConfig;
    use crate::traversability::TraversabilityConfig;
    use crate::traversability::tests::limits;
    use proptest::prelude::*;

    fn basis() -> Basis {
        let traversability = Traversability::new(TraversabilityConfig::default(), limits());
        let motion = MotionCost::new(MotionConfig::default(), limits());
        let going = SpeedOnCurve {
            speed_mps: 0.1,
            curvature_per_m: 0.0,
        };
        Basis::new(traversability.unwrap(), motion.unwrap(), going)
    }

    proptest! {
        #[test]
        fn every_cost_is_finite_and_none_is_negative(
            slope in 0.0..0.2f64, roughness_m in 0.0..0.01f64, shade in 0.0..1.0f64, cover in 0.0..1.0f64,
        ) {
            let shape = GroundShape { slope, roughness_m, ..GroundShape::LEVEL };
            let all = basis().of(&Appearance { shape, shade, cover }).unwrap();
            prop_assert!(all.iter().all(|one| one.is_finite() && *one >= 0.0));
            let shades: f64 = all[BASIS - SHADES..].iter().sum();
            prop_assert!((shades - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn beyond_a_limit_of_the_robots_there_is_none() {
        let shape = GroundShape {
            slope: 0.9,
            ..GroundShape::LEVEL
        };
        let look = Appearance {
            shape,
            shade: 0.4,
            cover: 0.0,
        };
        assert_eq!(basis().of(&look), None);
    }
}
