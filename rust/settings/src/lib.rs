//! What a setting is: its meaning, unit, default and bounds, declared once ([`settings!`]); how a table of settings is read from what
//! a user wrote, and refused by key where it cannot be used.

#[cfg(test)]
extern crate self as settings;

mod bounds;
mod declaration;
mod error;
mod part;
mod reading;
mod scale;
mod setting;
mod table;

pub use bounds::{
    ANY, Bounds, End, LARGEST, LEAST, NOT_NEGATIVE, POSITIVE, SHARE, above, above_to, at_least,
    between, from_below, within,
};
#[doc(hidden)]
pub use error::require_fit;
pub use error::{ConfigError, MakeError, require};
pub use part::Part;
#[doc(hidden)]
pub use reading::{entries, unknown, value_of};
pub use scale::Scale;
#[doc(hidden)]
pub use setting::words_of;
pub use setting::{Owner, Parameter, Setting};
#[doc(hidden)]
pub use table::{Declared, describe, key_of, table_within};
pub use table::{Table, TableDescription, Tables, overlay, read};

#[doc(hidden)]
pub use {schemars, serde, serde_json};
