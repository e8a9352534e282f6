//! The path: where it may end, how it is searched, its legs, and when it is followed no more.

pub(crate) mod choice;
pub(crate) mod ends;
pub(crate) mod followed_path;
pub(crate) mod legs;
pub(crate) mod path_search;
pub(crate) mod rest;
pub(crate) mod shortcut;
pub(crate) mod viewpoints;
