//! What a range sensor that sweeps a plane measures.

use geometry::PlanarPose;

/// One range of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarBeam {
    /// Direction in the sensor's frame, counter-clockwise from its x, rad.
    pub bearing_rad: f64,
    /// Distance to what was seen, m; none of a maximum range reading, which says only that nothing came back.
    pub range_m: Option<f64>,
}

impl PlanarBeam {
    /// A beam from its direction, rad, and its range, m.
    pub const fn new(bearing_rad: f64, range_m: Option<f64>) -> Self {
        Self {
            bearing_rad,
            range_m,
        }
    }

    /// Whether it can be used: ranges are positive, and all numbers finite.
    pub fn is_usable(&self) -> bool {
        self.bearing_rad.is_finite()
            && self
                .range_m
                .is_none_or(|range_m| range_m.is_finite() && range_m > 0.0)
    }
}

/// What a sensor saw in one direction, of which it looked into a part alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweptBeam {
    /// Direction in the sensor's frame, counter-clockwise from its x, rad.
    pub bearing_rad: f64,
    /// Nothing is known of what is nearer, m.
    pub from_m: f64,
    /// Where the beam ended, m; up to there it is free.
    pub range_m: f64,
    /// Whether it ended in something, or is only known so far.
    pub hit: bool,
}

/// The beams of one sweep, all from one place.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanarScan {
    /// Where the sensor was, in the map frame.
    pub map_from_sensor: PlanarPose,
    /// The beams, in any order.
    pub beams: Vec<PlanarBeam>,
}

impl PlanarScan {
    /// Where the beams ended that saw something, m in the map frame; those that cannot be used are left out.
    pub fn ends_m(&self) -> impl Iterator<Item = [f64; 2]> {
        let pose = self.map_from_sensor;
        let usable = self.beams.iter().filter(|beam| beam.is_usable());
        usable.filter_map(move |beam| {
            let range_m = beam.range_m?;
            let (sin, cos) = libm::sincos(pose.yaw_rad + beam.bearing_rad);
            Some([pose.x_m + range_m * cos, pose.y_m + range_m * sin])
        })
    }
}
