//! Frames and typed poses, angles, planes, outlines, lattices, grids, levels and repeatable random numbers: the words all other crates
//! speak in.
//!
//! Poses are named `target_from_source`, and the types say the same in the same order, so that adjacent words cancel:
//!
//! ```
//! use geometry::{Camera, Point, Pose, Robot, World};
//! let world_from_robot = Pose::<World, Robot>::from_yaw(1.0, 2.0, 0.0, 0.0);
//! let robot_from_camera = Pose::<Robot, Camera>::identity();
//! let point_in_camera = Point::<Camera>::new(0.0, 0.0, 1.0);
//! let point_in_world: Point<World> = world_from_robot * (robot_from_camera * point_in_camera);
//! assert_eq!(point_in_world.inner.z, 1.0);
//! ```
//!
//! ```compile_fail,E0308
//! use geometry::{Camera, Point, Pose, Robot, World};
//! let world_from_robot = Pose::<World, Robot>::identity();
//! let point_in_camera = Point::<Camera>::new(0.0, 0.0, 1.0);
//! let wrong = world_from_robot * point_in_camera; // a point in the camera is not a point in the robot
//! ```

mod angle;
mod area;
mod dijkstra;
pub mod distance;
mod frames;
mod goal;
mod gravity;
mod lattice;
mod level;
mod outline;
mod planar;
mod plane;
mod pose;
mod random;
mod storage;

pub use angle::{angle_between, wrap_angle};
pub use area::CellArea;
pub use dijkstra::Dijkstra;
pub use frames::{Camera, Map, Odometry, Robot, Torso, World};
pub use goal::Goal;
pub use gravity::GRAVITY_MPS2;
pub use lattice::{Cell, Grid, Lattice};
pub use level::{Apart, Height, same_level, two_levels};
pub use outline::{Cut, Outline, OutlineError};
pub use planar::{PlanarPose, distance_m, hypot};
pub use plane::Plane;
pub use pose::{Point, Pose, Vector};
pub use random::{GOLDEN, SplitMix64, low_variance, mix};
pub use storage::{in_step, runs};
