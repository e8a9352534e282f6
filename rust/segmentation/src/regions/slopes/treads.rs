//! A slope against stairs: the flight of treads that explains the same pixels best.

use nalgebra::{Rotation2, Vector2, Vector3};

use super::sums::{Seen, independent};

/// Pixels are put together by how far up the slope they are, m.
const BIN_M: f64 = 0.01;
/// Lowest step of stairs, m: treads of a flight that rises like the slope are as deep as the slope takes to rise by it.
const STEP_M: f64 = 0.012;
/// Least depth of a tread, m.
const DEPTH_M: f64 = 0.05;
/// Most that lies between two treads in the picture, m: a riser, and what the matching window makes of its edges.
const RISER_M: f64 = 0.05;
/// What a tread costs, in squared noise: where its edge is, and its height.
const TREAD: f64 = 2.0;
/// Directions that stairs may rise in beside the slope's own, rad: a plane through stairs that are seen in part turns.
const TURNS_RAD: [f64; 5] = [
    0.0,
    -TURN_STEP_RAD,
    TURN_STEP_RAD,
    -2.0 * TURN_STEP_RAD,
    2.0 * TURN_STEP_RAD,
];
const TURN_STEP_RAD: f64 = 0.15;
/// The best direction is searched to this, rad: half a metre to the side an edge is then off by a bin.
const LAST_TURN_RAD: f64 = 0.02;
/// Most bins.
const MOST_BINS: usize = 250;

/// What a plane is against the best treads.
#[derive(Debug, Clone, Copy)]
pub(super) struct Verdict {
    /// How long it is where it is seen, along its slope, m.
    pub(super) length_m: f64,
    /// By how much it explains the pixels better, in squared noise.
    pub(super) better_than_treads: f64,
}

/// Sums over the pixels of bins: what a level surface and the plane make of them.
#[derive(Debug, Clone, Copy, Default)]
struct Bins {
    weight: f64,
    q: f64,
    qq: f64,
    /// Squared misses of the plane.
    plane: f64,
}

impl Bins {
    /// Squared misses of the best level surface less those of the plane, in squared noise.
    fn tread(&self, before: &Self) -> f64 {
        let (weight, q) = (self.weight - before.weight, self.q - before.q);
        let level = self.qq - before.qq - q * q / weight;
        independent(level - (self.plane - before.plane))
    }
}

/// Lays treads. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Treads {
    bins: Vec<Bins>,
    best: Vec<f64>,
}

impl Treads {
    /// Compares a plane `(a, b, q)` with treads, over its pixels.
    pub(super) fn compare(
        &mut self,
        seen: Seen<'_>,
        plane: &Vector3<f64>,
        pixels: &[usize],
    ) -> Verdict {
        let gradient = plane.xy() / plane.z;
        let tilt = gradient.norm();
        let mut length_m: f64 = 0.0;
        let mut try_turn = |turn_rad: f64| {
            let across = Rotation2::new(turn_rad) * gradient / tilt;
            self.fill(seen, plane, pixels, &across);
            length_m = length_m.max(self.bins.len() as f64 * BIN_M);
            (self.lay((STEP_M / tilt).max(DEPTH_M)), turn_rad)
        };
        let lower = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0);
        let mut best = TURNS_RAD.map(&mut try_turn).into_iter().min_by(lower);
        let mut step_rad = TURN_STEP_RAD;
        while step_rad > LAST_TURN_RAD
            && let Some(so_far) = best
        {
            step_rad /= 2.0;
            let beside = [-step_rad, step_rad].map(|step| try_turn(so_far.1 + step));
            best = [so_far].into_iter().chain(beside).min_by(lower);
        }
        Verdict {
            better_than_treads: best.map_or(f64::INFINITY, |(worse, _)| worse),
            length_m,
        }
    }

    /// Adds up the pixels by where the plane has them in this direction, from the nearest on.
    fn fill(
        &mut self,
        seen: Seen<'_>,
        plane: &Vector3<f64>,
        pixels: &[usize],
        across: &Vector2<f64>,
    ) {
        let abq = [plane.x, plane.y, plane.z].map(|value| value as f32);
        let place_m = |at: usize| {
            let [x, y, g] = seen.xyg(at).map(f64::from);
            let d = plane.dot(&Vector3::new(x, y, g));
            across.dot(&Vector2::new(x, y)) / d
        };
        let nearest_m = pixels
            .iter()
            .map(|&at| place_m(at))
            .fold(f64::INFINITY, f64::min);
        self.bins.clear();
        for &at in pixels {
            let bin = (((place_m(at) - nearest_m) / BIN_M) as usize).min(MOST_BINS);
            if bin >= self.bins.len() {
                self.bins.resize(bin + 1, Bins::default());
            }
            let picture = seen.picture;
            let g = f64::from(picture.g[at]);
            let weight = (g / f64::from(picture.sigma_px[at])).powi(2);
            let q = f64::from(picture.disparity_px[at]) / g;
            let sums = &mut self.bins[bin];
            sums.weight += weight;
            sums.q += weight * q;
            sums.qq += weight * q * q;
            sums.plane += f64::from(seen.miss(at, abq).powi(2));
        }
        self.bins.retain(|bin| bin.weight > 0.0);
    }

    /// By how much the cheapest treads of this depth or more are worse than the plane. Of what lies between them neither says
    /// anything.
    fn lay(&mut self, depth_m: f64) -> f64 {
        let count = self.bins.len();
        let (deep, riser) = ((depth_m / BIN_M) as usize, (RISER_M / BIN_M) as usize);
        let mut sum = Bins::default();
        self.bins.insert(0, sum);
        for bin in &mut self.bins[1..] {
            sum.weight += bin.weight;
            sum.q += bin.q;
            sum.qq += bin.qq;
            sum.plane += bin.plane;
            *bin = sum;
        }
        // The cheapest up to each bin, whether a tread ends there or not.
        self.best.clear();
        self.best.resize(count + 1, f64::INFINITY);
        self.best[..=riser.min(count)].fill(0.0);
        let mut ends = vec![f64::INFINITY; count + 1];
        ends[0] = 0.0;
        for end in 1..=count {
            // The first and the last one are seen in part.
            let in_part = end + riser >= count;
            for start in 0..end {
                if end - start < deep && !in_part && start > riser {
                    continue;
                }
                let cost = self.best[start] + self.bins[end].tread(&self.bins[start]) + TREAD;
                ends[end] = ends[end].min(cost);
            }
            let last = &ends[end.saturating_sub(riser)..=end];
            self.best[end] = last.iter().copied().fold(f64::INFINITY, f64::min);
        }
        self.best[count]
    }
}
