//! How the camera stands: guessed from one picture, followed from frame to frame, told by floor that is known.

pub(crate) mod correction;
pub(crate) mod horizon;
pub(crate) mod known;
pub(crate) mod levelled;
