//! Where lines may lie: points vote for all lines through them (Duda and Hart 1972).

use super::line::{PlanarLine, WeightedPoint};

/// Votes for lines by angle of the normal and distance; votes can be taken back, so that the next best line is known without a new count.
#[derive(Debug, Clone)]
pub(crate) struct LineVotes {
    centre_m: [f64; 2],
    /// Cosine, sine and angle of each normal.
    normals: Vec<([f64; 2], f64)>,
    bins: usize,
    width_m: f64,
    votes: Vec<f32>,
}

/// Bins side by side whose votes are one line's.
const TOGETHER: usize = 4;

impl LineVotes {
    /// No votes; lines go through a box, its lower and upper corner in m, and hold points up to `reach_m` off.
    pub(crate) fn new([low_m, high_m]: [[f64; 2]; 2], reach_m: f64) -> Self {
        let centre_m = [0, 1].map(|axis| f64::midpoint(low_m[axis], high_m[axis]));
        let radius_m = geometry::distance_m(centre_m, high_m).max(reach_m);
        let width_m = 2.0 * reach_m / TOGETHER as f64;
        let bins = (2.0 * radius_m / width_m).ceil() as usize + 2 * TOGETHER;
        // The ends of a line from one side of the box to the other are no further off its neighbours' than a line is wide.
        let angles =
            ((std::f64::consts::PI * radius_m / (2.0 * reach_m)).ceil() as usize).max(TOGETHER);
        let normal = |index: usize| {
            let normal_rad = std::f64::consts::PI * index as f64 / angles as f64;
            let (sin, cos) = libm::sincos(normal_rad);
            ([cos, sin], normal_rad)
        };
        Self {
            centre_m,
            normals: (0..angles).map(normal).collect(),
            bins,
            width_m,
            votes: vec![0.0; angles * bins],
        }
    }

    /// Adds a point's votes; with a negative weight takes them back.
    pub(crate) fn vote(&mut self, point: &WeightedPoint, weight: f64) {
        let [x_m, y_m] = [0, 1].map(|axis| point.at_m[axis] - self.centre_m[axis]);
        let (per_m, middle) = (1.0 / self.width_m, self.bins as f64 / 2.0);
        for (([cos, sin], _), votes) in self
            .normals
            .iter()
            .zip(self.votes.chunks_exact_mut(self.bins))
        {
            let bin = (x_m * cos + y_m * sin) * per_m + middle;
            votes[bin as usize] += weight as f32;
        }
    }

    /// The line with the most votes; none where there are none.
    pub(crate) fn best(&self) -> Option<PlanarLine> {
        let mut best = (0.0, 0, 0);
        for (index, votes) in self.votes.chunks_exact(self.bins).enumerate() {
            let sums = votes
                .windows(TOGETHER)
                .map(|together| together.iter().sum::<f32>());
            // The largest first, which takes no branch, then where it is.
            let most = sums.clone().fold(0.0, f32::max);
            if most > best.0 {
                let first = sums.clone().position(|sum| sum >= most);
                best = (most, index, first.unwrap_or(0));
            }
        }
        let (votes, index, first) = best;
        let ([cos, sin], normal_rad) = self.normals[index];
        let middle = (first + TOGETHER / 2) as f64 - self.bins as f64 / 2.0;
        let distance_m = middle * self.width_m + self.centre_m[0] * cos + self.centre_m[1] * sin;
        (votes > 0.0).then_some(PlanarLine {
            normal_rad,
            distance_m,
        })
    }
}
