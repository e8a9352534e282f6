//! Shapes that stand for classified points: a mesh of the ground, a tree of balls of the vegetation, cylinders of branches and trunks
//! (handbook, section 36.3.5; Lalonde, Vandapel, Huber and Hebert, Journal of Field Robotics 23 (2006), section 5).

mod ball_tree;
mod cylinder;
mod ground_mesh;

pub use ball_tree::{Ball, BallTree, BallTreeConfig, TreeError};
pub use cylinder::{Cylinder, CylinderConfig, Cylinders};
pub use ground_mesh::{GroundMesh, GroundMeshConfig};
