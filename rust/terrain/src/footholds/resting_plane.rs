//! The plane on which a sole rests: through all that is under it, or else through what is highest.

/// Where a plane is over the sole's middle, m, and how it rises forward and to the left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RestingPlane {
    pub(super) height_m: f32,
    pub(super) slope: [f32; 2],
}

/// A place under the sole, forward and to the left of its middle, its height and how far it may lie from the plane, m; and in which
/// strip across the sole it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlaceUnder {
    pub(super) at_m: [f32; 2],
    pub(super) height_m: f32,
    pub(super) strip: usize,
    pub(super) within_m: f32,
}

/// How often what bears is found anew by the plane through what bore before.
const ROUNDS: usize = 4;

impl PlaceUnder {
    /// Whether its height was seen.
    pub(super) fn is_known(&self) -> bool {
        !self.height_m.is_nan()
    }
}

impl RestingPlane {
    /// The plane on which a sole rests over this ground; `None` without any. `fit` is that of all places under the sole.
    ///
    /// Where one plane is near enough to all of it, that one. Else what lies within the tolerance of the highest bears, and step by step
    /// what lies in one plane with it.
    pub(super) fn of(ground: &[PlaceUnder], fit: &PlaneFit) -> Option<Self> {
        let all = fit.plane(ground).or_else(|| Self::through(ground.iter()))?;
        if ground.iter().all(|ground| all.is_near(ground)) {
            return Some(all);
        }
        let highest_m = ground.iter().map(|ground| ground.height_m);
        let highest_m = highest_m.reduce(f32::max)?;
        let high = |ground: &&PlaceUnder| highest_m - ground.height_m <= ground.within_m;
        let top = ground.iter().filter(high);
        let (count, sum_m) = top.fold((0.0, 0.0), |(count, sum_m), ground| {
            (count + 1.0, sum_m + ground.height_m)
        });
        let mut plane = Self {
            height_m: sum_m / count,
            slope: [0.0; 2],
        };
        for _ in 0..ROUNDS {
            let better = Self::through(ground.iter().filter(|ground| plane.is_near(ground)))?;
            if better == plane {
                break;
            }
            plane = better;
        }
        Some(plane)
    }

    /// How much higher than the plane a place is, m.
    pub(super) fn above_m(&self, ground: &PlaceUnder) -> f32 {
        let [forward, left] = ground.at_m;
        ground.height_m - (self.height_m + self.slope[0] * forward + self.slope[1] * left)
    }

    /// How much it rises a metre where it is steepest.
    pub(super) fn steepness(&self) -> f64 {
        geometry::hypot(f64::from(self.slope[0]), f64::from(self.slope[1]))
    }

    fn is_near(&self, ground: &PlaceUnder) -> bool {
        self.above_m(ground).abs() <= ground.within_m
    }

    /// The plane of least squares; level where the places do not span one. `None` without a place.
    fn through<'a>(ground: impl Iterator<Item = &'a PlaceUnder> + Clone) -> Option<Self> {
        let mut sums = [0.0_f64; 4];
        for place in ground.clone() {
            let [x, y] = place.at_m.map(f64::from);
            let terms = [1.0, x, y, f64::from(place.height_m)];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
        }
        let [count, ..] = sums;
        if count == 0.0 {
            return None;
        }
        let [_, mean_x, mean_y, mean_z] = sums.map(|sum| sum / count);
        let [mut xx, mut xy, mut yy, mut xz, mut yz] = [0.0; 5];
        for place in ground {
            let [x, y] = place.at_m.map(f64::from);
            let (x, y, z) = (x - mean_x, y - mean_y, f64::from(place.height_m) - mean_z);
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
            (xz, yz) = (xz + x * z, yz + y * z);
        }
        let determinant = xx * yy - xy * xy;
        // A single row of cells spans no plane.
        let slope = if determinant > 1e-3 * (xx + yy) * (xx + yy) {
            [xz * yy - yz * xy, yz * xx - xz * xy].map(|part| part / determinant)
        } else {
            [0.0; 2]
        };
        Some(Self {
            height_m: (mean_z - slope[0] * mean_x - slope[1] * mean_y) as f32,
            slope: slope.map(|part| part as f32),
        })
    }
}

/// The plane of least squares through places that do not change: a sum for each of its numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct PlaneFit {
    /// For each place, its part in the slope forward and to the left.
    weights: Vec<[f32; 2]>,
    mean_m: [f32; 2],
}

impl PlaneFit {
    /// For places under the sole, forward and to the left of its middle, m.
    pub(super) fn of(places_m: &[[f32; 2]]) -> Self {
        let count = places_m.len().max(1) as f64;
        let sum = |axis: usize| {
            places_m
                .iter()
                .map(|place_m| f64::from(place_m[axis]))
                .sum::<f64>()
        };
        let mean = [0, 1].map(|axis| sum(axis) / count);
        let off = |place_m: &[f32; 2]| [0, 1].map(|axis| f64::from(place_m[axis]) - mean[axis]);
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        for [x, y] in places_m.iter().map(off) {
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        }
        let determinant = xx * yy - xy * xy;
        let weights = |[x, y]: [f64; 2]| {
            let parts = [x * yy - y * xy, y * xx - x * xy];
            // A single row of cells spans no plane.
            parts.map(|part| {
                if determinant > 0.0 {
                    (part / determinant) as f32
                } else {
                    0.0
                }
            })
        };
        Self {
            weights: places_m.iter().map(off).map(weights).collect(),
            mean_m: mean.map(|place_m| place_m as f32),
        }
    }

    /// The plane through all places, if all are there.
    fn plane(&self, ground: &[PlaceUnder]) -> Option<RestingPlane> {
        let first = ground.first()?;
        if ground.len() != self.weights.len() {
            return None;
        }
        let (mut sum_m, mut slope) = (0.0, [0.0; 2]);
        for (place, [forward, left]) in ground.iter().zip(&self.weights) {
            // Small numbers, so that their sums are exact enough.
            let above_m = place.height_m - first.height_m;
            sum_m += above_m;
            slope[0] += forward * above_m;
            slope[1] += left * above_m;
        }
        let mean_m = first.height_m + sum_m / ground.len() as f32;
        Some(RestingPlane {
            height_m: mean_m - slope[0] * self.mean_m[0] - slope[1] * self.mean_m[1],
            slope,
        })
    }
}
