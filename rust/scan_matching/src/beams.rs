//! A scan as what is matched: the ends of its beams, and which of them lie on one surface.

use geometry::distance_m;
use plan_view::PlanarBeam;

use crate::config::ScanMatchConfig;

/// Ends of beams in the sensor's frame, m, by their bearing; what cannot be used, is too far or too near to the one before is left out.
pub(crate) fn ends_m(beams: &[PlanarBeam], config: &ScanMatchConfig) -> Vec<[f64; 2]> {
    let seen = |beam: &PlanarBeam| {
        let range_m = beam
            .range_m
            .filter(|range_m| *range_m <= config.max_range)?;
        beam.is_usable().then_some((beam.bearing_rad, range_m))
    };
    let mut seen: Vec<_> = beams.iter().filter_map(seen).collect();
    seen.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut ends: Vec<[f64; 2]> = Vec::with_capacity(seen.len());
    for (bearing_rad, range_m) in seen {
        let (sin, cos) = libm::sincos(bearing_rad);
        let end = [range_m * cos, range_m * sin];
        if ends
            .last()
            .is_none_or(|last| distance_m(*last, end) >= config.thin)
        {
            ends.push(end);
        }
    }
    ends
}

/// The surfaces that ends lie on: each end with the next one where they are near enough, else with itself alone.
pub(crate) fn pieces(ends: &[[f64; 2]], join_m: f64) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let near = move |at: usize| at + 1 < ends.len() && distance_m(ends[at], ends[at + 1]) <= join_m;
    (0..ends.len()).filter_map(move |at| {
        if near(at) {
            Some([ends[at], ends[at + 1]])
        } else {
            // The end of a piece, too, unless it stands alone.
            (at == 0 || !near(at - 1)).then_some([ends[at]; 2])
        }
    })
}
