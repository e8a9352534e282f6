//! What the legs have to do at a tick.

use behaviour::{Footstep, Velocity};

use crate::relief::Relief;

/// The motion of a tick.
#[derive(Debug, Clone, Copy)]
pub enum Task<'a> {
    /// Come to stand on this ground.
    Stand(Relief<'a>),
    /// Walk on it.
    Walk(Velocity, Relief<'a>),
    /// Take these steps, from where the gait's list is on.
    Steps(&'a [Footstep]),
}
