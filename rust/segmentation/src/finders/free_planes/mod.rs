//! Planes in any direction: what the finders share that look for them all over the picture.

pub(crate) mod draws;
pub(crate) mod flood;
pub(crate) mod peeling;
pub(crate) mod planes;
pub(crate) mod remaining;
pub(crate) mod tuning;
