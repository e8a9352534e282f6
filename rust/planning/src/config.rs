//! Settings of the planner.

use serde::{Deserialize, Serialize};
use settings::{ANY, Bounds, above_to, settings, within};
use terrain::CellSettings;

use crate::tuning::PlanningTuning;

/// Lengths in metres may be no greater: a window is not much larger.
const LENGTH: Bounds = within(0.0, 10.0);
/// Nor may a price: a search sorts what it finds by cost, in steps of half a cell.
const PRICE: Bounds = within(0.0, 1000.0);

/// What has to stay clear of obstacles.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Default,
    Serialize,
    Deserialize,
    settings::schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[schemars(crate = "settings::schemars")]
pub enum Footprint {
    /// The upright cylinder around the robot, whichever way it faces (002, III.D).
    #[default]
    Circle,
    /// The upright cylinder, and where there is no room for it the rectangle that holds the robot's body while it walks sideways.
    Oriented,
}

settings::choices!(Footprint);

settings! {
    /// A* on the floor and obstacle grid, and over the stairs that join its levels.
    pub struct AStarConfig("navigation.a_star") {
        /// Radius of the upright cylinder that must stay clear of obstacles; by default the robot's own.
        radius: Option<f64> = None, "m", above_to(0.0, 10.0), "002, section III.D";
        /// What must stay clear of obstacles: `circle`, or `oriented` to go sideways through what is narrower than the circle.
        footprint: Footprint = Footprint::Circle, "-", ANY;
        /// What a metre sideways costs more.
        sideways_cost: f64 = 1.5, "1", PRICE;
        /// Distance kept beyond the radius: sway, and what the map and the pose are wrong by.
        margin: f64 = 0.03, "m", LENGTH;
        /// Up to this far beyond radius and margin, being near to an obstacle costs.
        soft_range: f64 = 0.16, "m", LENGTH;
        /// What a metre costs more at the edge of what is allowed; it falls to nothing over `soft_range`.
        soft_cost: f64 = 1.5, "1", PRICE;
        /// What a metre costs more where nothing was seen yet.
        unknown_cost: f64 = 1.0, "1", PRICE;
        /// What a metre costs more that is too near to an obstacle, where the robot already stands too near.
        escape_cost: f64 = 20.0, "1", PRICE;
        /// How far from the robot it may leave a place that is too near to an obstacle.
        escape_range: f64 = 0.3, "m", LENGTH;
        /// Largest difference in height between neighbouring cells that is walked over.
        max_step: f64 = 0.01, "m", LENGTH;
        /// Where the world model says how sure its heights are, a difference counts as a step from so many standard deviations of both
        /// heights above what is walked over.
        step_sigmas: f64 = 2.0, "1", within(0.0, 100.0);
        /// Largest difference in height between neighbouring cells on and beside a slope that is walked over: the camera may have made
        /// level strips of the slope before it told it from them.
        slope_step: f64 = 0.02, "m", LENGTH;
        /// Steepest slope that is walked on: rise per metre.
        max_slope: f64 = 0.2, "1", PRICE;
        /// Sightings from which on a cell's height may make it a step.
        step_sightings: u16 = 3, "1", ANY;
        /// How far the robot may leave the path before it is planned anew.
        stray: f64 = 0.15, "m", LENGTH;
        /// A path through what became known is given up for one that costs less than this part of it.
        better: f64 = 0.8, "1", above_to(0.0, 1.0);
        /// What a turn on the spot towards a path costs where two are compared.
        turn_cost: f64 = 0.25, "m/rad", PRICE;
        /// Obstacles of at most so many cells, with none beside them, are unsure, and priced like the unknown.
        speck_cells: usize = 2, "1", ANY;
        /// Distance kept between feet and the edge of a level beyond half the feet's width: only feet come near to edges.
        foot_margin: f64 = 0.02, "m", LENGTH;
        /// Around itself the robot sees no ground: so far unseen ground is taken to be of its own level.
        blind: f64 = 0.2, "m", LENGTH;
        /// What a step up or down costs, in metres of walking; more beside what stands near, as a metre does.
        climb_cost: f64 = 0.4, "m", PRICE;
        /// A tread deeper than this is not crossed in one stride, but stepped onto and walked on.
        stride: f64 = 0.15, "m", LENGTH;
        /// Higher levels than the robot's own are believed once it has been this near to them.
        judge_range: f64 = 0.8, "m", LENGTH;
        /// What a stair is like is a reason to refuse once its edge was measured, or the robot has been this near to it: from further away
        /// steps run into each other.
        limit_range: f64 = 0.5, "m", LENGTH;
        /// Distance between the places where the crossing of a wide edge is considered.
        lane: f64 = 0.08, "m", within(0.005, 10.0);
        /// Numbers that decide something, but that few will want to turn.
        tuning: PlanningTuning;
    }
}

impl AStarConfig {
    /// What users set of cells.
    pub(crate) const fn cells(&self) -> CellSettings {
        CellSettings {
            judge_range: self.judge_range,
            lone_cells: self.speck_cells,
            step_sightings: self.step_sightings,
            max_step: self.max_step,
            step_sigmas: self.step_sigmas,
            slope_step: self.slope_step,
            max_slope: self.max_slope,
            blind: self.blind,
            soft_range: self.soft_range,
            soft_cost: self.soft_cost,
            unknown_cost: self.unknown_cost,
            escape_cost: self.escape_cost,
            escape_range: self.escape_range,
            sideways_cost: self.sideways_cost,
        }
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

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
            "navigation.a_star.margin must be from 0 to 10, got -0.1"
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
