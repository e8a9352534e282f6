//! The body of a robot as the core knows it: links, joints, soles, camera mount; where everything is at given joint angles.
//!
//! All of it is data from the robot's folder. The harness reads the folder and hands over a [`Description`].

mod description;
mod error;
mod kinematics;
mod links;
mod size;
mod statics;

pub use description::{
    CameraMount, Description, Extent, ForceSensors, Head, ImuMount, JointDescription,
    LEAST_LEG_JOINTS, Leg, Legs, LinkDescription, MOST_LEG_JOINTS, Side, Sole, StereoDescription,
};
pub use error::BodyError;
pub use kinematics::{Body, LinkPoses};
pub use links::Follower;
