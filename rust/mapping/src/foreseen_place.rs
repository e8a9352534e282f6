//! Where something that moves will be.

/// Where something that moves will be: a disc over the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForeseenPlace {
    /// Its middle in the map frame, m.
    pub at_m: [f64; 2],
    /// Its radius, m.
    pub radius_m: f64,
    /// How high it is taken to be, m in the map frame.
    pub top_m: f64,
}
