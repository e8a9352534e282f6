//! From commands to joint targets: footsteps, centre of mass, swing foot, leg inverse kinematics, stabiliser.
//!
//! A [`Walker`] is chosen by its name; the crate's own is [`DcmWalker`], and all else here is what that is made of.
//! [`Gait`](gait::Gait) decides which foot moves where and when, [`dcm`] gives the motion of the centre of mass for it,
//! [`balance`] measures how far the robot is from it, [`support`] says where the feet have to push, [`capture`] moves a step when
//! pushing is not enough, `catching` steps at once when the robot is pushed harder than that, and [`leg`] turns all of it into joint
//! angles.

mod advance;
mod ankle_bend;
mod ankles;
mod arms;
pub mod balance;
mod buckling;
pub mod capture;
mod catching;
mod chain;
mod chain_anatomy;
mod closed_form;
mod config;
pub mod dcm;
mod dcm_walker;
pub mod descent;
mod drives;
mod error;
pub mod feet;
mod felt;
mod felt_gait;
pub mod footsteps;
pub mod gait;
mod gaze;
mod heel;
mod landing;
mod landing_search;
mod lean;
pub mod leg;
mod leg_angles;
mod leg_geometry;
mod leg_sizes;
mod listed;
mod listed_steps;
mod met;
mod newton;
mod pelvis;
pub mod phase;
mod posture;
mod preview;
pub mod relief;
mod shared_hip;
mod sole_fit;
pub mod stance;
pub mod step_list;
mod stumble;
pub mod support;
pub mod swing;
mod targets;
pub mod task;
#[cfg(test)]
mod test_biped;
mod tipping;
mod trunk;
mod tuning;
mod walker;

pub use config::GaitConfig;
pub use dcm_walker::DcmWalker;
pub use error::WalkError;
pub use felt_gait::FeltGait;
pub use gaze::HeadControl;
pub use met::Met;
pub use targets::JointTargets;
pub use tuning::ReliefTuning;
pub use walker::{Walker, WalkerNeeds, WalkerPart, WalkerSenses};

/// The walkers that come with the crate: a new one is a file or folder beside these, and its line here.
pub const PARTS: &[WalkerPart] = &[dcm_walker::PART];
