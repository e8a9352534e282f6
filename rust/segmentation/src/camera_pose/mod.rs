//! How the camera stands: guessed from one picture, followed from frame to frame, told by floor that is known.

pub(crate) mod correction;
pub(crate) mod horizon;
pub(crate) mod known;
pub(crate) mod levelled;

pub(crate) use correction::Correction;
pub(crate) use horizon::{HorizonSearch, SearchArea, TiltSearchTuning};
pub(crate) use known::{KnownFloorTuning, KnownLevels};
pub(crate) use levelled::Levelled;
