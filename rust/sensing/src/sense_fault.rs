//! A sense that was found wrong.

use std::fmt;

/// A sense, or a motor, that cannot be right by what the others say.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SenseFault {
    /// Which one, as in "gyroscope".
    pub which: String,
    /// What is wrong with it, as the rest of a sentence.
    pub what: String,
}

impl SenseFault {
    /// A fault of this sense.
    pub fn new(which: impl Into<String>, what: impl Into<String>) -> Self {
        Self {
            which: which.into(),
            what: what.into(),
        }
    }
}

/// The reason of a refusal: `sensor: <which and what>`.
impl fmt::Display for SenseFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sensor: {} {}", self.which, self.what)
    }
}
