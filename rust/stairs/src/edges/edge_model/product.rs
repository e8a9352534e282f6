//! What a fit gives: the edge, or why it is not to be trusted.

use geometry::Robot;

use crate::Edge;

/// An edge between two level surfaces as the disparities of one frame show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedEdge {
    /// The edge, as long as the guess and at the height of the same of the two surfaces.
    pub edge: Edge<Robot>,
    /// Standard deviation of its place across itself, at its middle, m. The camera's own error comes on top.
    pub place_sigma_m: f64,
    /// Standard deviation of its heading, rad. The camera's own error comes on top.
    pub heading_sigma_rad: f64,
    /// Height of the surface in front of the edge, m, refined where enough of it is in view.
    pub near_height_m: f64,
    /// Height of the surface behind the edge, m, refined where enough of it is in view.
    pub far_height_m: f64,
}

/// Why an edge cannot be told from this frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Untrusted {
    /// The guess, the heights or the camera's pose are no numbers, or the edge has no length.
    BadGuess,
    /// The camera is behind the edge or below a surface.
    WrongSide,
    /// The heights differ too little for the edge to show, m.
    NoContrast(f64),
    /// The edge is outside the picture, or nothing was seen where it is.
    OutOfView,
    /// Too little of the surface in front of the edge is in view: share of the edge's columns that show enough of it.
    NearHidden(f64),
    /// Too little of the surface behind the edge is in view: share of the edge's columns that show enough of it.
    FarHidden(f64),
    /// The fit ran away from the guess or did not come to rest.
    NotSettled,
    /// What is seen is no such step: mean size of the residuals, in the expected noise.
    Rough(f64),
}
