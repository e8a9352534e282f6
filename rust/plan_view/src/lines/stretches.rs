//! From where to where along a line its points lie.

use super::config::LineFinderConfig;
use super::line::PlanarLine;

/// A part of a line with points on it, without a large gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineStretch {
    /// Index of the line.
    pub line: usize,
    /// Its ends in the map frame, m.
    pub ends_m: [[f64; 2]; 2],
    /// Points on it.
    pub points: usize,
}

/// The stretches of lines with so many points, so long and with such gaps as the settings say. A point, m, is its nearest line's, if that holds it.
pub(super) fn stretches(
    lines: &[PlanarLine],
    points_m: &[[f64; 2]],
    config: &LineFinderConfig,
) -> Vec<LineStretch> {
    let within_m = config.hold * config.sigma;
    let forms: Vec<_> = lines.iter().map(PlanarLine::normal_form).collect();
    let mut along = vec![Vec::new(); lines.len()];
    for &at_m in points_m {
        let off = forms
            .iter()
            .map(|[cos, sin, distance_m]| (at_m[0] * cos + at_m[1] * sin - distance_m).abs());
        let nearest = off
            .enumerate()
            .min_by(|(_, one), (_, other)| one.total_cmp(other));
        if let Some((index, off_m)) = nearest
            && off_m <= within_m
        {
            let [cos, sin, _] = forms[index];
            along[index].push(at_m[1] * cos - at_m[0] * sin);
        }
    }
    let mut found = Vec::new();
    for (index, along) in along.iter_mut().enumerate() {
        along.sort_by(f64::total_cmp);
        for part in along.chunk_by(|one_m, next_m| next_m - one_m <= config.gap) {
            if let (Some(&first_m), Some(&last_m)) = (part.first(), part.last())
                && part.len() >= config.least_points
                && last_m - first_m >= config.least_length
            {
                found.push(LineStretch {
                    line: index,
                    ends_m: [first_m, last_m].map(|at_m| lines[index].point_m(at_m)),
                    points: part.len(),
                });
            }
        }
    }
    found
}
