//! How far found places are from true ones.

use nalgebra::Vector2;

/// Root mean square distance, m, of points from others after the best turn and shift, and the largest.
pub(crate) fn aligned(found: &[Vector2<f64>], truth: &[Vector2<f64>]) -> [f64; 2] {
    let mean = |all: &[Vector2<f64>]| all.iter().sum::<Vector2<f64>>() / all.len() as f64;
    let (a, b) = (mean(found), mean(truth));
    let (mut dot, mut cross) = (0.0, 0.0);
    for (f, t) in found.iter().zip(truth) {
        let (f, t) = (f - a, t - b);
        dot += f.dot(&t);
        cross += f.x * t.y - f.y * t.x;
    }
    let (sin, cos) = libm::sincos(libm::atan2(cross, dot));
    let errors: Vec<f64> = found
        .iter()
        .zip(truth)
        .map(|(f, t)| {
            let (f, t) = (f - a, t - b);
            (Vector2::new(cos * f.x - sin * f.y, sin * f.x + cos * f.y) - t).norm()
        })
        .collect();
    let square = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
    [square.sqrt(), errors.iter().copied().fold(0.0, f64::max)]
}
