//! Moving things found among points, and followed.

mod clusters;
mod filter;
mod follower;

pub use clusters::{ClustersConfig, MovingCluster, PointOfView, moving_clusters};
pub use filter::{PredictedPlace, TrackFilter};
pub use follower::{MovingTrack, MovingTracks, TrackPoint, TracksConfig};
