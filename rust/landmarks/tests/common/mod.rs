//! How far found places are from true ones.

use nalgebra::Vector2;

/// How far each point is off another, m, after the best turn and shift of all.
pub(crate) fn off_after_alignment(
    found: &[Vector2<f64>],
    truth: &[Vector2<f64>],
) -> Vec<Vector2<f64>> {
    let mean = |all: &[Vector2<f64>]| all.iter().sum::<Vector2<f64>>() / all.len() as f64;
    let (a, b) = (mean(found), mean(truth));
    let (mut dot, mut cross) = (0.0, 0.0);
    for (f, t) in found.iter().zip(truth) {
        let (f, t) = (f - a, t - b);
        dot += f.dot(&t);
        cross += f.x * t.y - f.y * t.x;
    }
    let (sin, cos) = libm::sincos(libm::atan2(cross, dot));
    found
        .iter()
        .zip(truth)
        .map(|(f, t)| {
            let (f, t) = (f - a, t - b);
            Vector2::new(cos * f.x - sin * f.y, sin * f.x + cos * f.y) - t
        })
        .collect()
}

/// Root mean square of distances, m, and the largest.
pub(crate) fn root_mean_square_and_worst(off: &[Vector2<f64>]) -> [f64; 2] {
    let square = off.iter().map(Vector2::norm_squared).sum::<f64>() / off.len() as f64;
    [
        square.sqrt(),
        off.iter().map(Vector2::norm).fold(0.0, f64::max),
    ]
}
