//! Settings of what moves.

use settings::settings;

use crate::static_points::GoneConfig;
use crate::tracks::{ClustersConfig, TracksConfig};
use crate::views::ViewsConfig;

settings! {
    /// Things that move: found, followed, and kept out of maps.
    pub struct MovingConfig("navigation.moving") {
        /// When a point is seen through: an earlier or later look went on behind it.
        views: ViewsConfig;
        /// Which points that move are one thing.
        clusters: ClustersConfig;
        /// How things that move are followed.
        tracks: TracksConfig;
        /// When a point is of something that is there no more at the end of a recording.
        gone: GoneConfig;
    }
}
