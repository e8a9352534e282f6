//! A part that a name in `[navigation]` stands for: how it is listed, its settings, how it is made.

use crate::{ConfigError, Description};

/// A component: one of the core's own, or of a crate of the user's. `M` is the type of the function that makes it.
#[derive(Debug, Clone, Copy)]
pub struct Part<M> {
    /// What `[navigation]` calls it, and its table of settings.
    pub name: &'static str,
    /// One line for `treadwell list components`.
    pub about: &'static str,
    /// The paper that it is of, where there is one.
    pub source: Option<&'static str>,
    /// Its tables of settings.
    pub tables: &'static [Description],
    /// Makes it.
    pub make: M,
}

/// Why a part could not be made of what the user wrote.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MakeError {
    /// A setting that cannot be used.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A table that cannot be read, or something that is missing; says where.
    #[error("{0}")]
    Text(String),
}
