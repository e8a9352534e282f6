//! Settings of what moves.

use settings::{ANY, NOT_NEGATIVE, at_least, settings, within};

use crate::static_points::GoneConfig;
use crate::tracks::{ClustersConfig, TracksConfig};
use crate::views::ViewsConfig;

settings! {
    /// Things that move: found, followed, and kept out of maps.
    pub struct MovingConfig("navigation.moving") {
        /// Whether a robot follows what moves: keeps it out of its map, and keeps away from where it will be.
        follow: bool = false, "-", ANY;
        /// It looks at pictures in so many columns at most.
        columns: usize = 48, "1", at_least(8.0);
        /// It keeps away from where what moves will be in this time.
        ahead: f64 = 1.0, "s", within(0.0, 60.0);
        /// Predictions within that time are so far apart.
        step: f64 = 0.25, "s", within(0.01, 10.0);
        /// It keeps away from them by this beside half of their width.
        room: f64 = 0.05, "m", NOT_NEGATIVE;
        /// It gives way to what is faster than `fast` and will come near within this time; 0: to nothing.
        wait: f64 = 4.0, "s", within(0.0, 60.0);
        /// What is slower is not given way.
        fast: f64 = 0.1, "m/s", NOT_NEGATIVE;
        /// What moves and is nearer to the middle of the robot is no obstacle to it.
        own: f64 = 0.2, "m", NOT_NEGATIVE;
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
