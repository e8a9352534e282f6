//! The frames, each with its origin and its axes. The list is closed.

/// Where the course stands. Origin: the scenario's; z = 0 is the ground. X and y as in the scenario file, z up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum World {}

/// What the robot believes to be the world. Equal to [`World`] at the start; drifts against it as the localizer errs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Map {}

/// Where leg odometry counts from. Origin and axes: the robot's frame at the first tick; drifts against the world as feet
/// slip and the gyroscope errs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Odometry {}

/// The robot on its ground. Origin: midway between the centres of the soles, at the height of the surface that carries
/// the robot. X along the mean heading of the feet, z up against gravity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Robot {}

/// The root link of the robot's body. Origin and axes: the model's; in the upright stance x forward, y left, z up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Torso {}

/// The depth camera, optical axes. Origin: the optical centre. X right, y down, z forward along the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Camera {}
