//! Geometry of places of the map, m.

/// How far two places are apart, m.
pub(crate) fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    geometry::hypot(a[0] - b[0], a[1] - b[1])
}
