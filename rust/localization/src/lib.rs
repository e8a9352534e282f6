//! Where the robot is: attitude from the inertial measurement unit, foot contacts, leg odometry, and the localizer.

mod body_state;
mod localizer;

pub use body_state::{BodyState, ProprioceptionError};
pub use localizer::{Estimate, Localizer, LocalizerError};
