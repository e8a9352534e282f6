//! Regions of one surface each: how they are fitted, cut, told apart and described.

pub(crate) mod cuts;
pub(crate) mod finder;
pub(crate) mod fit;
pub(crate) mod region;
pub(crate) mod roughness;
pub(crate) mod slivers;
pub(crate) mod slopes;
pub(crate) mod steps;
pub(crate) mod surfaces;
pub(crate) mod tilted;
pub(crate) mod walls;
