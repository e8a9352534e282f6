//! What the walker is told to do.

use geometry::PlanarPose;
use robot::Side;

/// Walking velocity in the robot's frame; the walker keeps it within what the gait can do.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Velocity {
    /// Forward, m/s.
    pub x_mps: f64,
    /// To the left, m/s.
    pub y_mps: f64,
    /// Counter-clockwise, rad/s.
    pub yaw_radps: f64,
}

/// Where to look.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gaze {
    /// To the left of straight ahead, rad.
    pub pan_rad: f64,
    /// Below the horizon, rad.
    pub down_rad: f64,
}

/// One step of a list of footsteps, in the odometry frame's plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footstep {
    /// Foot that moves.
    pub side: Side,
    /// Where the centre of its sole is put, relative to the robot's frame when the list was given.
    pub pose: PlanarPose,
    /// Height of the surface there above the robot's ground then, m.
    pub height_m: f64,
}

/// What the feet do.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Motion {
    /// Stop in balance and stand on both soles.
    #[default]
    Stand,
    /// Walk with a velocity.
    Walk(Velocity),
    /// Take these steps, then stand. Given anew at every tick until the walker says that it stands.
    Footsteps(Vec<Footstep>),
}

/// Everything that the walker is told.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Command {
    /// What the feet do.
    pub motion: Motion,
    /// Where the head looks.
    pub gaze: Gaze,
}
