//! The edges between stairs: where two are one, fitted to the disparities, and what the fits of many frames say together.

pub(crate) mod bevels;
pub(crate) mod edge_model;
pub(crate) mod felt;
pub(crate) mod fits;
pub(crate) mod fusion;
pub(crate) mod joints;
pub(crate) mod sure;
