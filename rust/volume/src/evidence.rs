//! A dense evidence grid in three dimensions for sensors with wide beams that miss and invent things, as radars do (004, ref. 36.20).

use settings::{ConfigError, POSITIVE, Table, between, settings, within};

use crate::Size;

settings! {
    /// How a radar-like sensor sees, and the grid of evidence that is made of it.
    pub struct EvidenceConfig("evidence") {
        /// Side of a voxel.
        resolution: f64 = 0.2, "m", within(0.001, 100.0);
        /// Standard deviation of a range.
        range_sigma: f64 = 0.1, "m", POSITIVE;
        /// Standard deviation of the angle at which a beam still sees.
        beam_sigma: f64 = 0.03, "rad", within(0.0001, 0.5);
        /// Probability that something in the middle of a beam that fills it is seen.
        detection: f64 = 0.8, "1", between(0.0, 1.0);
        /// Probability of a return from where nothing is.
        false_returns: f64 = 0.1, "1", between(0.0, 1.0);
        /// No more can be seen than up to here.
        max_range: f64 = 12.0, "m", POSITIVE;
        /// Standard deviations of range and angle beyond which a measurement tells nothing.
        reach: f64 = 3.0, "1", POSITIVE;
        /// A range is no more precise than this share of a voxel's side.
        coarse: f64 = 0.3, "1", POSITIVE;
        /// Evidence, as log-odds, never goes further than this from none.
        most: f64 = 8.0, "1", POSITIVE;
    }
}

/// One measurement, in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WideBeam {
    /// Where the sensor is, m.
    pub eye_m: [f64; 3],
    /// Where it looks, of length 1.
    pub along: [f64; 3],
    /// How far away something was seen, m; none where nothing was.
    pub range_m: Option<f64>,
}

/// Log-odds of occupancy of the voxels of a box.
#[derive(Debug, Clone)]
pub struct EvidenceGrid {
    config: EvidenceConfig,
    corner_m: [f64; 3],
    size: Size,
    log_odds: Vec<f32>,
}

impl EvidenceGrid {
    /// No evidence in a box with this lowest corner, m in the map frame.
    pub fn new(
        config: EvidenceConfig,
        corner_m: [f64; 3],
        size: Size,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            log_odds: vec![0.0; size.cols * size.rows * size.layers],
            config,
            corner_m,
            size,
        })
    }

    /// Log-odds of a voxel; none outside.
    pub fn log_odds(&self, [col, row, layer]: [usize; 3]) -> Option<f32> {
        let Size { cols, rows, layers } = self.size;
        let inside = col < cols && row < rows && layer < layers;
        inside.then(|| self.log_odds[(row * cols + col) * layers + layer])
    }

    /// Takes in a measurement. Beams with a number that is none change nothing.
    pub fn insert(&mut self, beam: &WideBeam) {
        let config = &self.config;
        let [side_m, reach_m] = [config.resolution, config.max_range];
        let Size { cols, rows, layers } = self.size;
        let seen_m = beam.range_m.unwrap_or(reach_m);
        let finite = beam
            .eye_m
            .iter()
            .chain(&beam.along)
            .all(|at| at.is_finite());
        if !(finite && seen_m >= 0.0) {
            return;
        }
        let far_m = (seen_m + config.reach * config.range_sigma).min(reach_m);
        let wide_m = config.reach * config.beam_sigma * far_m + side_m;
        let bounds = [cols, rows, layers];
        let range = |axis: usize| {
            let [eye, end] = [
                beam.eye_m[axis],
                beam.eye_m[axis] + far_m * beam.along[axis],
            ];
            let voxel = |at: f64| ((at - self.corner_m[axis]) / side_m).max(0.0) as usize;
            let last = (voxel(eye.max(end) + wide_m) + 1).min(bounds[axis]);
            voxel(eye.min(end) - wide_m).min(last)..last
        };
        for row in range(1) {
            for col in range(0) {
                for layer in range(2) {
                    let place = [col, row, layer];
                    let off = [0, 1, 2].map(|axis| {
                        let centre = self.corner_m[axis] + (place[axis] as f64 + 0.5) * side_m;
                        centre - beam.eye_m[axis]
                    });
                    let along_m: f64 = (0..3).map(|axis| off[axis] * beam.along[axis]).sum();
                    let away_m = off.iter().map(|off| off * off).sum::<f64>().sqrt();
                    if along_m <= 0.0 || away_m > far_m {
                        continue;
                    }
                    let beside_m = (away_m * away_m - along_m * along_m).max(0.0).sqrt();
                    let change = evidence(config, beam.range_m, away_m, beside_m);
                    let slot = &mut self.log_odds[(row * cols + col) * layers + layer];
                    let most = config.most;
                    *slot = (f64::from(*slot) + change).clamp(-most, most) as f32;
                }
            }
        }
    }
}

/// The inverse sensor model: by how much a measurement changes the log-odds of a voxel so far away and beside the middle of the beam, m.
/// Were it occupied, the beam would return from there with the probability of a detection there, or else as if it were not.
fn evidence(config: &EvidenceConfig, range_m: Option<f64>, away_m: f64, beside_m: f64) -> f64 {
    let side_m = config.resolution;
    let sigma_m = config.range_sigma.max(config.coarse * side_m);
    let wide_m = config.beam_sigma * away_m;
    let gain = libm::exp(-0.5 * (beside_m / wide_m.max(0.5 * side_m)).powi(2));
    // The share of the beam that a voxel fills: as of a square and a Gaussian's area.
    let share = (side_m * side_m / (std::f64::consts::TAU * wide_m * wide_m)).min(1.0);
    let seen = config.detection * gain * share;
    let missed = (1.0 - seen).max(1e-6);
    let Some(range_m) = range_m else {
        return libm::log(missed);
    };
    let off = (range_m - away_m) / sigma_m;
    let at_range = libm::exp(-0.5 * off * off) / (sigma_m * std::f64::consts::TAU.sqrt());
    // From anywhere, were the voxel free: what is invented and what is elsewhere.
    let anywhere = 1.0 / config.max_range;
    let passed = 0.5 * libm::erfc(-off / std::f64::consts::SQRT_2);
    // What is invented tells nothing.
    let told = 1.0 - config.false_returns;
    told * libm::log(seen * at_range / anywhere + 1.0 - seen * passed)
}
