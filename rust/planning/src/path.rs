//! The path: where it may end, its legs, what is left of it while it is followed, and from where the robot looks.

pub(crate) mod annotation;
pub(crate) mod chosen_search;
pub(crate) mod ends;
pub(crate) mod legs;
pub(crate) mod rest;
pub(crate) mod shortcut;
pub(crate) mod viewpoints;
