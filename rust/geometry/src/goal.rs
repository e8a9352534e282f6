//! Where a robot shall go.

/// Where to go: any place inside the disc on which the robot can stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Centre of the disc in the map frame, m.
    pub x_m: f64,
    /// Centre of the disc in the map frame, m.
    pub y_m: f64,
    /// Radius of the disc, m.
    pub radius_m: f64,
    /// Height of the level, m, where several lie above each other.
    pub height_m: Option<f64>,
}
