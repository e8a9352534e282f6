//! Why a robot cannot walk, or a tick gave no targets.

use robot::Side;

/// Why there is no walker, or no targets.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WalkError {
    /// A bad setting in `[gait]`.
    #[error(transparent)]
    Setting(#[from] settings::ConfigError),
    /// `[gait]` has not the form that it must have.
    #[error("gait: {0}")]
    Form(String),
    /// The body refused.
    #[error(transparent)]
    Body(#[from] robot::BodyError),
    /// A leg that the inverse kinematics cannot serve.
    #[error("the {side:?} leg does not fit the walker: {what}")]
    Leg {
        /// Which leg.
        side: Side,
        /// What is wrong with it.
        what: String,
    },
    /// A walker of the user's failed.
    #[error("{0}")]
    Failed(String),
}
