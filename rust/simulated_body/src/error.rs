//! Why a body cannot be made, or cannot sense.

/// Why a body cannot be made, or cannot sense.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulatedBodyError {
    /// A setting is out of its bounds.
    #[error(transparent)]
    Setting(#[from] settings::ConfigError),
    /// An index lies outside of the model's arrays.
    #[error("{array} has {length} numbers, {end} are needed")]
    OutOfModel {
        /// Name of the array.
        array: &'static str,
        /// How many numbers it has.
        length: usize,
        /// How many the senses read of it.
        end: usize,
    },
    /// Arrays over joints have different lengths.
    #[error("{what} has {length} values, the robot has {joints} joints")]
    Length {
        /// Name of the array.
        what: &'static str,
        /// How many values it has.
        length: usize,
        /// How many joints there are.
        joints: usize,
    },
}

/// Whether an array has a value for each joint.
pub(crate) const fn check_length(
    what: &'static str,
    length: usize,
    joints: usize,
) -> Result<(), SimulatedBodyError> {
    if length == joints {
        return Ok(());
    }
    Err(SimulatedBodyError::Length {
        what,
        length,
        joints,
    })
}
