//! World models: what the robot knows of the ground around it.

mod model;

pub use model::{FloorView, Insertion, MapError, Surface, WorldModel};
