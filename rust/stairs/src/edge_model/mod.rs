//! A step fitted to the disparities: the place and heading of an edge between two level surfaces, good enough to step by.

mod product;

pub use product::{FittedEdge, Untrusted};

use geometry::Robot;
use segmentation::Planes;
use sensing::{Intrinsics, Scan};

use crate::Edge;

/// Fits edges. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct EdgeModel {
    camera: Intrinsics,
}

impl EdgeModel {
    /// For images of this camera.
    pub const fn new(camera: Intrinsics) -> Self {
        Self { camera }
    }

    /// Fits the edge near `guess` between a surface at `near_height_m` in front of it and one at `far_height_m` behind it
    /// (robot frame, m), seen from `planes.robot_from_camera`.
    pub fn fit(
        &mut self,
        _scan: &Scan,
        _planes: &Planes,
        _guess: &Edge<Robot>,
        _near_height_m: f64,
        _far_height_m: f64,
    ) -> Result<FittedEdge, Untrusted> {
        let _ = &self.camera;
        Err(Untrusted::NotSettled)
    }
}
