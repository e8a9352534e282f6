//! How strong gravity is.

/// Strength of gravity, m/s^2: the one that the simulation has, and on the ground to half a per cent everywhere.
pub const GRAVITY_MPS2: f64 = 9.81;
