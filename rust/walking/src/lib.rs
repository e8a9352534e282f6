//! From commands to joint targets: footsteps, centre of mass, swing foot, leg inverse kinematics, stabiliser.

mod targets;

pub use targets::JointTargets;
