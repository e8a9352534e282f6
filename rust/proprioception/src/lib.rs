//! What the body feels: attitude from the inertial measurement unit, foot contacts, leg odometry.

mod attitude;
mod body_state;
mod config;
mod contact;
mod history;
mod leg_odometry;
mod levelling;
mod play;
mod proprioception;
mod trunk;
mod tuning;
mod watch;

pub use body_state::{BodyState, ProprioceptionError};
pub use config::ProprioceptionConfig;
pub use history::BodyStateHistory;
pub use proprioception::Proprioception;
pub use tuning::HistoryTuning;
pub use watch::{SenseWatch, SenseWatchConfig};
