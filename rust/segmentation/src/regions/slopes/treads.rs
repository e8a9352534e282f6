//! A slope against stairs: the flight of treads that explains the same pixels best.

use nalgebra::{Rotation2, Vector2, Vector3};

use super::tuning::{SlopeTuning, TreadTuning};
use crate::picture::SeenPicture;

/// What a plane is against the best treads.
#[derive(Debug, Clone, Copy)]
pub(super) struct TreadVerdict {
    /// How long it is where it is seen, along its slope, m.
    pub(super) length_m: f64,
    /// Pixels that tell it from treads: those that are not too far away.
    pub(super) told: usize,
    /// By how much it explains them better, in squared noise.
    pub(super) better_than_treads: f64,
}

/// Sums over the pixels of bins: what a level surface and the plane make of them.
#[derive(Debug, Clone, Copy, Default)]
struct TreadBin {
    weight: f64,
    q: f64,
    qq: f64,
    /// Squared misses of the plane.
    plane: f64,
}

impl TreadBin {
    /// Squared misses of the best level surface less those of the plane, in squared noise.
    fn tread(&self, before: &Self, alike: f64) -> f64 {
        let (weight, q) = (self.weight - before.weight, self.q - before.q);
        let level = self.qq - before.qq - q * q / weight;
        (level - (self.plane - before.plane)) / alike
    }
}

/// Whether the treads of stairs with steps of `told_step` that rise like a slope would be seen as treads at a pixel. What is further
/// away runs into one surface, which a plane explains better whatever it is.
fn is_resolved(seen: SeenPicture<'_>, at: usize, tilt: f64, rules: &TreadTuning) -> bool {
    let [x, y, g] = seen.xyg(at).map(f64::from);
    let per_row = [
        seen.view.x.per_row,
        seen.view.y.per_row,
        seen.view.g.per_row,
    ];
    let baseline_m = Vector3::from(per_row).map(f64::from).norm();
    // A level length is foreshortened by how flat the line of sight is, and a row is as high as the disparity says.
    let rows_per_m =
        f64::from(seen.picture.disparity_px[at]) / baseline_m * g / Vector3::new(x, y, g).norm();
    rows_per_m * rules.told_step / tilt >= rules.resolved
}

/// Lays treads. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct TreadFit {
    bins: Vec<TreadBin>,
    best: Vec<f64>,
    /// Pixels that tell treads.
    telling: Vec<usize>,
}

impl TreadFit {
    /// Compares a plane `(a, b, q)` with treads, over its pixels.
    pub(super) fn compare(
        &mut self,
        seen: SeenPicture<'_>,
        plane: &Vector3<f64>,
        pixels: &[usize],
        tuning: &SlopeTuning,
    ) -> TreadVerdict {
        let rules = &tuning.treads;
        let gradient = plane.xy() / plane.z;
        let tilt = gradient.norm();
        self.fill(seen, plane, pixels, &(gradient / tilt), rules);
        let length_m = self.bins.len() as f64 * rules.bin;
        let mut telling = std::mem::take(&mut self.telling);
        telling.clear();
        telling.extend((pixels.iter()).filter(|&&at| is_resolved(seen, at, tilt, rules)));
        let mut try_turn = |turn_rad: f64| {
            let across = Rotation2::new(turn_rad) * gradient / tilt;
            self.fill(seen, plane, &telling, &across, rules);
            let depth_m = (rules.step / tilt).max(rules.depth);
            (self.lay(depth_m, tuning), turn_rad)
        };
        let lower = |a: &(f64, f64), b: &(f64, f64)| a.0.total_cmp(&b.0);
        let beside = (1..=rules.turns).map(f64::from);
        let turns = beside.flat_map(|turn| [-turn * rules.turn_step, turn * rules.turn_step]);
        let turns = std::iter::once(0.0).chain(turns);
        let mut best = turns.map(&mut try_turn).min_by(lower);
        let mut step_rad = rules.turn_step;
        while step_rad > rules.last_turn
            && let Some(so_far) = best
        {
            step_rad /= 2.0;
            let beside = [-step_rad, step_rad].map(|step| try_turn(so_far.1 + step));
            best = [so_far].into_iter().chain(beside).min_by(lower);
        }
        let told = telling.len();
        self.telling = telling;
        TreadVerdict {
            better_than_treads: best.map_or(f64::INFINITY, |(worse, _)| worse),
            told,
            length_m,
        }
    }

    /// Adds up the pixels by where the plane has them in this direction, from the nearest on.
    fn fill(
        &mut self,
        seen: SeenPicture<'_>,
        plane: &Vector3<f64>,
        pixels: &[usize],
        across: &Vector2<f64>,
        rules: &TreadTuning,
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
            let bin = (((place_m(at) - nearest_m) / rules.bin) as usize).min(rules.most_bins);
            if bin >= self.bins.len() {
                self.bins.resize(bin + 1, TreadBin::default());
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
    fn lay(&mut self, depth_m: f64, tuning: &SlopeTuning) -> f64 {
        let (rules, alike) = (&tuning.treads, tuning.alike);
        let count = self.bins.len();
        let deep = (depth_m / rules.bin) as usize;
        let riser = (rules.riser / rules.bin) as usize;
        let mut sum = TreadBin::default();
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
                let tread = self.bins[end].tread(&self.bins[start], alike);
                let cost = self.best[start] + tread + rules.price;
                ends[end] = ends[end].min(cost);
            }
            let last = &ends[end.saturating_sub(riser)..=end];
            self.best[end] = last.iter().copied().fold(f64::INFINITY, f64::min);
        }
        self.best[count]
    }
}
