//! Stairs over time: the sums of all that was seen of each, merged and remembered (003, section IV.C).

pub(crate) mod aspect;
pub(crate) mod border;
pub(crate) mod memory;
pub(crate) mod merge;
pub(crate) mod tread;
