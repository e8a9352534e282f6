//! A part that a name in `[navigation]` stands for: how it is listed, its settings, how it is made.

use crate::TableDescription;

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
    pub tables: &'static [TableDescription],
    /// Makes it.
    pub make: M,
}
