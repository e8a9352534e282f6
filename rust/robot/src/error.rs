//! Why a description is no robot.

/// Why a description is no robot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A name that is not there.
    #[error("{role}: there is no {kind} `{name}`; there are {available}")]
    UnknownName {
        /// Who asks for it.
        role: String,
        /// Link or joint.
        kind: &'static str,
        /// The name asked for.
        name: String,
        /// The names that exist.
        available: String,
    },
    /// A number that cannot be.
    #[error("{what} must be {allowed}, got {found}")]
    BadValue {
        /// Which.
        what: String,
        /// What is allowed.
        allowed: &'static str,
        /// What was found.
        found: String,
    },
    /// Joint angles of the wrong number.
    #[error("{expected} joint angles are needed, got {found}")]
    WrongJointCount {
        /// Number of joints.
        expected: usize,
        /// Number given.
        found: usize,
    },
}
