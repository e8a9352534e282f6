//! A body that stands at the origin.

use nalgebra::Isometry3;
use proprioception::{BodyState, Proprioception, ProprioceptionConfig};

use crate::biped::biped;

/// A body state at the origin.
pub fn state_at(time_ns: u64) -> BodyState {
    let mut state = Proprioception::new(&biped(), ProprioceptionConfig::default())
        .unwrap()
        .state()
        .clone();
    state.time_ns = time_ns;
    state.links.torso_from_link = vec![Isometry3::identity(); 4];
    state
}
