//! What the rules are given: what was seen, where the robot stands, what it needs, and what users set.

use mapping::FloorView;
use stairs::Staircase;

/// Where the robot stands, in the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandingAt {
    /// Its place, m.
    pub at_m: [f64; 2],
    /// Height of the ground under it, m.
    pub height_m: f64,
    /// Where it faces, rad.
    pub heading_rad: f64,
    /// Rise of the ground there per metre along the map's axes.
    pub gradient: [f64; 2],
}

impl StandingAt {
    /// Height of the ground this far off along the map's axes if it goes on as where the robot stands, m.
    pub fn ground_m(&self, [dx_m, dy_m]: [f64; 2]) -> f64 {
        self.height_m + self.gradient[0] * dx_m + self.gradient[1] * dy_m
    }
}

/// Differences in height that matter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeightLimits {
    /// What is still floor, m.
    pub floor_m: f64,
    /// What may still be climbed, m.
    pub step_m: f64,
}

/// Half of the rectangle that has to stay clear while the robot walks sideways, m: from front to back, and across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// From the middle to the front, m.
    pub half_depth_m: f64,
    /// From the middle to a side, m.
    pub half_width_m: f64,
}

/// Room that the robot needs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Needs {
    /// Around its middle, to obstacles, m.
    pub body_m: f64,
    /// Around the middle between its feet, to edges of the level, m.
    pub feet_m: f64,
    /// Of the ground that it walks on.
    pub limits: HeightLimits,
    /// To obstacles while it walks sideways, where it may.
    pub turned: Option<Rectangle>,
}

/// What users set of cells in the planner's table: the rules are given the values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellSettings {
    /// Higher levels than the robot's own are believed once it has been this near to them, m.
    pub judge_range: f64,
    /// Obstacles of at most so many cells, with none beside them, are unsure.
    pub lone_cells: usize,
    /// Sightings from which on a cell's height may make it a step.
    pub step_sightings: u16,
    /// Largest difference in height between neighbouring cells that is walked over, m.
    pub max_step: f64,
    /// A difference in height is a step where it is more than that by so many standard deviations of both heights.
    pub step_sigmas: f64,
    /// What a level strip of a slope may be off it, m.
    pub slope_step: f64,
    /// Steepest slope that is walked on: rise per metre.
    pub max_slope: f64,
    /// Around itself the robot sees no ground: so far unseen ground is of its own level, m.
    pub blind: f64,
    /// Up to this far beyond the room that is needed, being near to an obstacle costs, m.
    pub soft_range: f64,
    /// What a metre costs more at the edge of what is allowed.
    pub soft_cost: f64,
    /// What a metre costs more where nothing was seen yet.
    pub unknown_cost: f64,
    /// What a metre costs more that is too near to an obstacle, where the robot already stands too near.
    pub escape_cost: f64,
    /// How far from the robot it may leave a place that is too near to an obstacle, m.
    pub escape_range: f64,
    /// What a metre sideways costs more.
    pub sideways_cost: f64,
}

impl CellSettings {
    /// What a length costs that lies `spare_m` farther from an obstacle than it has to, at most what it costs where nothing is to spare:
    /// falls to 1 over `soft_m`.
    pub fn weight(&self, spare_m: f64, soft_m: f64) -> f64 {
        let near = (1.0 - spare_m / soft_m.max(1e-9)).clamp(0.0, 1.0);
        1.0 + self.soft_cost * near * near
    }
}

/// What the rules read.
#[derive(Debug, Clone, Copy)]
pub struct Sight<'a> {
    /// The window of the map around the robot, with what the known map says laid under it.
    pub view: &'a FloorView,
    /// The stairs that were recognised.
    pub stairs: &'a Staircase,
    /// Where the robot stands.
    pub stand: StandingAt,
    /// Height of the goal, m, where it is known.
    pub goal_m: Option<f64>,
}
