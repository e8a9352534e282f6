//! Parts of a map that take on few states, such as doors: learned from visits, and used to localize (004, section 36.4; ref. 36.65, Stachniss and
//! Burgard 2005).

mod clustering;
mod learning;
mod stateful_map;

pub use learning::{StatesConfig, learn_states};
pub use stateful_map::{ChangingPart, StatefulMap};
