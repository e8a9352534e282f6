//! From patches to pixels: which plane each belongs to, and what hangs together of the rest.

use nalgebra::Vector3;

use super::picture::DepthPicture;

/// Of no group.
pub(crate) const NONE: u16 = 0;

/// The inverse depths over the noise, without those that stand alone among their neighbours: gross mismatches. NaN for none.
pub(crate) fn without_lone(picture: &DepthPicture, gate: f64) -> Vec<f64> {
    let scaled: Vec<f64> = (picture.inverse_depths_per_m.iter())
        .map(|&value| f64::from(value) / picture.sigma_per_m)
        .collect();
    let is_lone = |at: usize| {
        let near = picture.beside(at);
        let apart = near
            .iter()
            .flatten()
            .map(|&other| (scaled[other] - scaled[at]).abs());
        apart
            .filter(|apart| !apart.is_nan())
            .all(|apart| apart > gate)
    };
    (0..scaled.len())
        .map(|at| {
            let good = scaled[at].is_finite() && scaled[at] > 0.0;
            if good && !is_lone(at) {
                scaled[at]
            } else {
                f64::NAN
            }
        })
        .collect()
}

/// Pixels as parts of planes.
pub(crate) struct Assignment<'a> {
    /// Where they are.
    pub(crate) picture: &'a DepthPicture,
    /// Inverse depths over the noise.
    pub(crate) values: &'a [f64],
    /// The planes, over the noise.
    pub(crate) planes: Vec<Vector3<f64>>,
    /// Noises by which a pixel may lie off its plane.
    pub(crate) reach: f64,
}

impl Assignment<'_> {
    /// How far a pixel lies off a plane, counted from 1, in noises; infinite where it was not seen.
    fn off(&self, at: usize, plane: u16) -> f64 {
        let there = self.planes[usize::from(plane) - 1].dot(&self.picture.ray(at));
        let off = (self.values[at] - there).abs();
        if off.is_nan() { f64::INFINITY } else { off }
    }

    /// Gives each pixel the plane that it lies nearest to, of those that `near` says, where it lies on one.
    pub(crate) fn nearest(&self, near: impl Fn(usize) -> Vec<u16>) -> Vec<u16> {
        let of = |at: usize| {
            let within = |plane: &u16| self.off(at, *plane) <= self.reach;
            let better = |a: u16, b: u16| {
                if self.off(at, b) < self.off(at, a) {
                    b
                } else {
                    a
                }
            };
            near(at)
                .into_iter()
                .filter(within)
                .reduce(better)
                .unwrap_or(NONE)
        };
        (0..self.values.len()).map(of).collect()
    }

    /// Lets the planes grow into pixels beside them that lie on them.
    pub(crate) fn grow(&self, labels: &mut [u16]) {
        let mut edge: Vec<usize> = (0..labels.len()).filter(|&at| labels[at] != NONE).collect();
        while !edge.is_empty() {
            let mut next = Vec::new();
            for at in edge {
                for other in self.picture.beside(at).into_iter().flatten() {
                    if labels[other] == NONE && self.off(other, labels[at]) <= self.reach {
                        labels[other] = labels[at];
                        next.push(other);
                    }
                }
            }
            edge = next;
        }
    }

    /// Gives each pixel the plane that most of the nine around it belong to, where it lies on that.
    pub(crate) fn smooth(&self, labels: &mut [u16]) {
        let cols = self.picture.cols;
        let before = labels.to_vec();
        for (at, own) in labels.iter_mut().enumerate() {
            let (col, row) = (at % cols, at / cols);
            let mut counts: Vec<(u16, usize)> = Vec::new();
            for r in row.saturating_sub(1)..(row + 2).min(self.picture.rows()) {
                for label in
                    &before[r * cols + col.saturating_sub(1)..r * cols + (col + 2).min(cols)]
                {
                    match counts.iter_mut().find(|(one, _)| one == label) {
                        Some((_, count)) => *count += 1,
                        None => counts.push((*label, 1)),
                    }
                }
            }
            let most = counts
                .iter()
                .max_by_key(|(label, count)| (*count, u16::MAX - *label));
            if let Some(&(label, _)) = most.filter(|(label, _)| *label != NONE)
                && self.off(at, label) <= self.reach
            {
                *own = label;
            }
        }
    }
}

/// Numbers what hangs together by `joined`, from 1 on; pixels that `counts` leaves out, and pieces with fewer than `least` pixels, get 0.
pub(crate) fn pieces(
    picture: &DepthPicture,
    counts: impl Fn(usize) -> bool,
    joined: impl Fn(usize, usize) -> bool,
    least: usize,
) -> (Vec<u16>, u16) {
    let pixels = picture.inverse_depths_per_m.len();
    let mut numbers = vec![NONE; pixels];
    let mut seen = vec![false; pixels];
    let mut count = NONE;
    for start in 0..pixels {
        if seen[start] || !counts(start) {
            continue;
        }
        seen[start] = true;
        let mut piece = vec![start];
        let mut next = 0;
        while let Some(&at) = piece.get(next) {
            next += 1;
            for other in picture.beside(at).into_iter().flatten() {
                if !seen[other] && counts(other) && joined(at, other) {
                    seen[other] = true;
                    piece.push(other);
                }
            }
        }
        if piece.len() >= least && count < u16::MAX {
            count += 1;
            for at in piece {
                numbers[at] = count;
            }
        }
    }
    (numbers, count)
}
