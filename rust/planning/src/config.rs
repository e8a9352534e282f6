//! Parameters of the planner, checked once.

use serde::{Deserialize, Serialize};
use settings::{ConfigError, require};

/// Lengths may be no greater, m: a window is not much larger.
const FARTHEST_M: f64 = 10.0;
/// Nor may a price: a search sorts what it finds by cost, in steps of half a cell.
const DEAREST: f64 = 1000.0;
/// Crossings of an edge are considered no nearer to each other, m.
const FINEST_LANE_M: f64 = 0.005;

/// What has to stay clear of obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Footprint {
    /// The upright cylinder around the robot, whichever way it faces (002, III.D).
    #[default]
    Circle,
    /// The same, and where there is no room for it the rectangle that holds the robot's body while it walks sideways.
    Oriented,
}

/// Parameters of A* on the floor and obstacle grid: `[navigation.a_star]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AStarConfig {
    /// Radius of the upright cylinder that must stay clear of obstacles, m; default: the robot's own.
    pub radius: Option<f64>,
    /// `circle`, or `oriented`: sideways through what is narrower than the circle.
    pub footprint: Footprint,
    /// What a metre sideways costs more.
    pub sideways_cost: f64,
    /// Distance kept beyond the radius, m: sway, and what the map and the pose are wrong by.
    pub margin: f64,
    /// Up to this far beyond radius and margin, being near to an obstacle costs, m.
    pub soft_range: f64,
    /// What a metre costs more at the edge of what is allowed; falls to nothing over `soft_range`.
    pub soft_cost: f64,
    /// What a metre costs more where nothing was seen yet.
    pub unknown_cost: f64,
    /// What a metre costs more that is too near to an obstacle, where the robot already stands too near.
    pub escape_cost: f64,
    /// How far from the robot it may leave a place that is too near to an obstacle, m.
    pub escape_range: f64,
    /// Largest difference in height between neighbouring cells that is walked over, m.
    pub max_step: f64,
    /// The same on and beside a slope, of which the camera may have made level strips before it told it from them, m.
    pub slope_step: f64,
    /// Steepest slope that is walked on: rise per metre.
    pub max_slope: f64,
    /// Sightings from which on a cell's height may make it a step.
    pub step_sightings: u16,
    /// How far the robot may leave the path before it is planned anew, m.
    pub stray: f64,
    /// A path through what became known is given up for one that costs less than this part of it.
    pub better: f64,
    /// What a turn on the spot towards a path costs where two are compared, m/rad.
    pub turn_cost: f64,
    /// Obstacles of at most so many cells, with none beside them, are specks: unsure, priced like the unknown.
    pub speck_cells: usize,
    /// Distance kept between feet and the edge of a level beyond half the feet's width, m: only feet come near to edges.
    pub foot_margin: f64,
    /// Around itself the robot sees no ground: so far unseen ground is of its own level, m.
    pub blind: f64,
    /// What a step up or down costs, m of walking; more beside what stands near, as a metre does.
    pub climb_cost: f64,
    /// A tread deeper than this is not crossed in one stride, but stepped onto and walked on, m.
    pub stride: f64,
    /// Higher levels than the robot's own are believed once it has been this near to them, m.
    pub judge_range: f64,
    /// What a stair is like is a reason to refuse once its edge was measured, or the robot has been this near to it, m: from
    /// further away steps run into each other.
    pub limit_range: f64,
    /// Distance between the places where the crossing of a wide edge is considered, m.
    pub lane: f64,
}

impl Default for AStarConfig {
    fn default() -> Self {
        Self {
            radius: None,
            footprint: Footprint::Circle,
            sideways_cost: 1.5,
            margin: 0.03,
            soft_range: 0.16,
            soft_cost: 1.5,
            unknown_cost: 1.0,
            escape_cost: 20.0,
            escape_range: 0.3,
            max_step: 0.01,
            slope_step: 0.02,
            max_slope: 0.2,
            step_sightings: 3,
            stray: 0.15,
            better: 0.8,
            turn_cost: 0.25,
            speck_cells: 2,
            foot_margin: 0.02,
            blind: 0.2,
            climb_cost: 0.4,
            stride: 0.15,
            judge_range: 0.8,
            limit_range: 0.5,
            lane: 0.08,
        }
    }
}

impl AStarConfig {
    /// What a length costs that lies `spare_m` farther from an obstacle than it has to, at most what it costs where nothing is to spare:
    /// falls to 1 over `soft_m`.
    pub(crate) fn weight(&self, spare_m: f64, soft_m: f64) -> f64 {
        let near = (1.0 - spare_m / soft_m.max(1e-9)).clamp(0.0, 1.0);
        1.0 + self.soft_cost * near * near
    }

    /// Refuses what cannot be used.
    pub fn check(&self) -> Result<(), ConfigError> {
        if let Some(radius) = self.radius {
            let holds = radius > 0.0 && radius <= FARTHEST_M;
            let allowed = format!("> 0 and <= {FARTHEST_M} m");
            require(holds, "navigation.a_star.radius", &allowed, radius)?;
        }
        let lengths = [
            ("margin", self.margin),
            ("soft_range", self.soft_range),
            ("escape_range", self.escape_range),
            ("max_step", self.max_step),
            ("slope_step", self.slope_step),
            ("stray", self.stray),
            ("foot_margin", self.foot_margin),
            ("blind", self.blind),
            ("stride", self.stride),
            ("judge_range", self.judge_range),
            ("limit_range", self.limit_range),
        ];
        for (key, value) in lengths {
            at_most(key, value, FARTHEST_M, " m")?;
        }
        let factors = [
            ("sideways_cost", self.sideways_cost),
            ("soft_cost", self.soft_cost),
            ("unknown_cost", self.unknown_cost),
            ("escape_cost", self.escape_cost),
            ("turn_cost", self.turn_cost),
            ("climb_cost", self.climb_cost),
            ("max_slope", self.max_slope),
        ];
        for (key, value) in factors {
            at_most(key, value, DEAREST, "")?;
        }
        let lane = self.lane;
        let holds = (FINEST_LANE_M..=FARTHEST_M).contains(&lane);
        let allowed = format!(">= {FINEST_LANE_M} m and <= {FARTHEST_M} m");
        require(holds, "navigation.a_star.lane", &allowed, lane)?;
        let better = self.better;
        let holds = better > 0.0 && better <= 1.0;
        require(holds, "navigation.a_star.better", "> 0 and <= 1", better)
    }
}

/// Refuses a parameter that is negative or above a bound.
fn at_most(key: &str, value: f64, most: f64, unit: &str) -> Result<(), ConfigError> {
    let key = format!("navigation.a_star.{key}");
    let allowed = format!(">= 0 and <= {most}{unit}");
    require((0.0..=most).contains(&value), &key, &allowed, value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_accepted_and_a_bad_value_is_refused_by_its_key() {
        AStarConfig::default().check().unwrap();
        let bad = AStarConfig {
            margin: -0.1,
            ..AStarConfig::default()
        };
        assert_eq!(
            bad.check().unwrap_err().to_string(),
            "navigation.a_star.margin must be >= 0 and <= 10 m, got -0.1"
        );
        let bad = AStarConfig {
            radius: Some(f64::NAN),
            ..AStarConfig::default()
        };
        assert!(bad.check().unwrap_err().key.ends_with("a_star.radius"));
        let bad = AStarConfig {
            better: 0.0,
            ..AStarConfig::default()
        };
        assert!(bad.check().is_err());
    }

    #[test]
    fn what_a_search_would_take_gigabytes_or_for_ever_for_is_refused() {
        let bad = [
            AStarConfig {
                escape_cost: 1e6,
                ..AStarConfig::default()
            },
            AStarConfig {
                judge_range: f64::NAN,
                ..AStarConfig::default()
            },
            AStarConfig {
                soft_range: 1e9,
                ..AStarConfig::default()
            },
            AStarConfig {
                lane: 1e-6,
                ..AStarConfig::default()
            },
        ];
        for bad in bad {
            assert!(bad.check().is_err(), "{bad:?}");
        }
    }
}
