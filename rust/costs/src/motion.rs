//! What a metre costs at a speed and on a curve: how near the robot comes to tipping over and to slipping.

use core::f64::consts::{SQRT_2, TAU};

use geometry::GRAVITY_MPS2;
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, settings};

use crate::limits::RobotLimits;
use crate::shape::GroundShape;

settings! {
    /// What being near to tipping or slipping costs.
    pub struct MotionConfig("costs.motion") {
        /// What a metre costs more just before the robot tips or slips; it grows with the square of how near it is to that.
        unsteady: f64 = 4.0, "1", NOT_NEGATIVE, "004, section 36.3.4";
        /// Length of the waves that rough ground is taken to have, in lengths of a sole: what is shorter is bridged.
        wavelength: f64 = 2.0, "1", POSITIVE;
        /// Where costs are learned, tipping counts no further than this: whatever lies beyond is as bad.
        most_tip: f64 = 2.0, "1", POSITIVE;
    }
}

/// How a robot moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedOnCurve {
    /// Along its path, m/s.
    pub speed_mps: f64,
    /// Of its path, 1/m: one over the radius; 0 straight ahead.
    pub curvature_per_m: f64,
}

/// How much of what would tip the robot over, or make it slip, is there: 1 is just that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Torque about the edge of the support that tips, of that which holds.
    pub tip: f64,
    /// Force along the ground of what friction gives.
    pub slip: f64,
}

impl Demand {
    /// The one that comes first.
    pub const fn most(&self) -> f64 {
        self.tip.max(self.slip)
    }
}

/// Costs by speed and curvature (004, section 36.3.4: "different costs are generated for different possible robot speeds and path curvatures").
///
/// A rigid body on its soles, which lie flat on the slope while it stands upright, is carried over waves of the roughness's standard
/// deviation: at their steepest the ground leans by what no ankle expects, over their crests the weight is less, and a curve pushes
/// outwards. All three at once and all downhill: the worst that can meet.
#[derive(Debug, Clone)]
pub struct MotionCost {
    config: MotionConfig,
    limits: RobotLimits,
}

impl MotionCost {
    /// For a robot.
    pub fn new(config: MotionConfig, limits: RobotLimits) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config, limits })
    }

    /// How near a motion comes to tipping by the shape of the ground alone, on friction that never ends, as far as learning counts it.
    pub(crate) fn learned_tip(&self, shape: &GroundShape, going: &SpeedOnCurve) -> f64 {
        let tip = self.demand(shape, f64::INFINITY, going).tip;
        tip.min(self.config.most_tip)
    }

    /// How near a motion comes to tipping and slipping on ground of this shape and friction. Infinite where a foot leaves the ground.
    pub fn demand(&self, shape: &GroundShape, friction: f64, going: &SpeedOnCurve) -> Demand {
        let [height_m, half_m] = [self.limits.com_height_m, self.limits.half_support_m];
        let waves_per_m = TAU / (self.config.wavelength * self.limits.sole_m);
        let amplitude_m = SQRT_2 * shape.roughness_m;
        let outwards = going.speed_mps * going.speed_mps * going.curvature_per_m.abs();
        let heave = amplitude_m * waves_per_m * waves_per_m * going.speed_mps * going.speed_mps;
        let weight = GRAVITY_MPS2 - heave;
        let lean = libm::atan(amplitude_m * waves_per_m);
        let tilt = libm::atan(shape.slope + amplitude_m * waves_per_m);
        let [across, along] = [libm::cos(tilt), libm::sin(tilt)];
        let pressed = weight * across - outwards * along;
        if weight <= 0.0 || pressed <= 0.0 {
            return Demand {
                tip: f64::INFINITY,
                slip: f64::INFINITY,
            };
        }
        let tipping = outwards * (height_m * libm::cos(lean) + half_m * along)
            + weight * height_m * libm::sin(lean);
        Demand {
            tip: tipping / (weight * half_m * across),
            slip: (weight * along + outwards * across) / (friction * pressed),
        }
    }

    /// The friction that walking so asks for: that which holds the body on the ground, and that with which each step pushes it off. While a
    /// foot carries, the centre of mass runs away from it like a pendulum upside down (Kajita et al. 2001): at most by half a step along
    /// and half the stance across, of its own height.
    pub fn friction_asked(&self, shape: &GroundShape, going: &SpeedOnCurve) -> f64 {
        let half_step_m = 0.5 * going.speed_mps * self.limits.step_time_s;
        let push = geometry::hypot(half_step_m, self.limits.half_stance_m);
        self.demand(shape, 1.0, going).slip + push / self.limits.com_height_m
    }

    /// What a metre costs more by the motion; infinite where the robot tips, slips, or cannot go as fast.
    pub fn cost(&self, shape: &GroundShape, friction: f64, going: &SpeedOnCurve) -> f64 {
        let most = self.demand(shape, friction, going).most();
        if most > 1.0 || going.speed_mps > self.limits.speed_mps {
            return f64::INFINITY;
        }
        self.config.unsteady * most * most
    }

    /// The fastest that the robot goes there along a curve, m/s; `None` where it cannot even stand.
    pub fn fastest_mps(
        &self,
        shape: &GroundShape,
        friction: f64,
        curvature_per_m: f64,
    ) -> Option<f64> {
        let holds = |speed_mps: f64| {
            let going = SpeedOnCurve {
                speed_mps,
                curvature_per_m,
            };
            self.demand(shape, friction, &going).most() <= 1.0
        };
        let (mut low, mut high) = (0.0, self.limits.speed_mps);
        if !holds(low) {
            return None;
        }
        if holds(high) {
            return Some(high);
        }
        while high - low > self.limits.speed_mps * f64::EPSILON.sqrt() {
            let middle = 0.5 * (low + high);
            *(if holds(middle) { &mut low } else { &mut high }) = middle;
        }
        Some(low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traversability::tests::limits;
    use proptest::prelude::*;

    /// A robot that could run: its limits of speed do not hide what is tested.
    fn model() -> MotionCost {
        let limits = RobotLimits {
            speed_mps: 5.0,
            ..limits()
        };
        MotionCost::new(MotionConfig::default(), limits).unwrap()
    }

    fn ground(slope: f64, roughness_m: f64) -> GroundShape {
        GroundShape {
            slope,
            roughness_m,
            ..GroundShape::LEVEL
        }
    }

    fn motion(speed_mps: f64, curvature_per_m: f64) -> SpeedOnCurve {
        SpeedOnCurve {
            speed_mps,
            curvature_per_m,
        }
    }

    proptest! {
        #[test]
        fn cost_rises_with_speed_on_the_same_rough_patch(
            slope in 0.0..0.2f64, roughness_m in 0.0005..0.004f64, curvature in 0.0..3.0f64,
            speed in 0.01..1.5f64, faster in 0.01..0.5f64, friction in 0.1..1.0f64,
        ) {
            let (model, ground) = (model(), ground(slope, roughness_m));
            let [slow, fast] = [speed, speed + faster].map(|speed| model.cost(&ground, friction, &motion(speed, curvature)));
            prop_assert!(fast > slow || slow.is_infinite());
        }

        #[test]
        fn it_never_falls_with_curvature_slope_roughness_or_less_friction(
            slope in 0.0..0.2f64, roughness_m in 0.0..0.004f64, curvature in 0.0..3.0f64, speed in 0.0..1.5f64,
            friction in 0.1..1.0f64, more in prop::array::uniform4(0.0..0.3f64),
        ) {
            let model = model();
            let before = model.cost(&ground(slope, roughness_m), friction, &motion(speed, curvature));
            let worse = ground(slope + more[0], roughness_m * (1.0 + more[1]));
            let after = model.cost(&worse, friction * (1.0 - more[2]), &motion(speed, curvature + more[3]));
            prop_assert!(after >= before * (1.0 - 1e-12), "{} after {}", after, before);
        }

        #[test]
        fn at_the_fastest_speed_it_just_holds(
            slope in 0.0..0.15f64, roughness_m in 0.0..0.002f64, curvature in 0.5..10.0f64, friction in 0.2..1.0f64,
        ) {
            let (model, ground) = (model(), ground(slope, roughness_m));
            if let Some(fastest) = model.fastest_mps(&ground, friction, curvature) && fastest < 5.0 {
                let most = |speed| model.demand(&ground, friction, &motion(speed, curvature)).most();
                prop_assert!(most(fastest) <= 1.0 && most(fastest * 1.001 + 1e-6) > 1.0);
            }
        }
    }

    #[test]
    fn standing_on_a_slope_it_slips_where_the_slope_is_steeper_than_friction_and_never_tips() {
        let model = model();
        let at = |slope| model.demand(&ground(slope, 0.0), 0.2, &motion(0.0, 0.0));
        assert!(at(0.199).slip < 1.0 && at(0.201).slip > 1.0);
        assert_eq!(at(0.5).tip, 0.0);
    }

    #[test]
    fn no_cost_is_finite_beyond_the_walkers_speed() {
        let model = MotionCost::new(MotionConfig::default(), limits()).unwrap();
        let speed = limits().speed_mps;
        let at = |speed| model.cost(&GroundShape::LEVEL, 0.8, &motion(speed, 0.0));
        assert!(at(speed).is_finite() && at(speed * 1.01).is_infinite());
    }
}
