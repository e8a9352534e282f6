//! Settings of the localizer `monte_carlo`.

use serde::{Deserialize, Serialize};

/// How measured ranges are compared with the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RangeModel {
    /// Each with the range that a ray through the map has: 002, III.C.
    RayCast,
    /// Each by how far its end lies from the nearest surface of the map.
    LikelihoodField,
}

/// Settings of [`super::MonteCarloLocalizer`]: `[navigation.monte_carlo]`. Noise that grows is given per square root of a metre of
/// way, of a radian of turn, and of a second.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MonteCarloConfig {
    /// Guesses that are kept while the robot knows where it is,
    pub particles: usize,
    /// and at most, where it has to find out.
    pub most_particles: usize,
    /// Seed of all that is drawn.
    pub seed: u64,
    /// Growth of the odometry's error along x and y, m,
    pub place_noise: [f64; 3],
    /// of its height, m,
    pub height_drift: [f64; 3],
    /// of its heading, rad,
    pub heading_noise: [f64; 3],
    /// and of roll and pitch between two frames, rad.
    pub attitude_drift: [f64; 3],
    /// Standard deviation of a start that is told: x and y, m; heading, rad.
    pub start_noise: [f64; 2],
    /// Beams that are drawn from a frame.
    pub beams: usize,
    /// Share of them that end on the ground, where both kinds are seen.
    pub ground_share: f64,
    /// Shortest and longest range that is used, m.
    pub reach: [f64; 2],
    /// Points of the ground lie at most so far above or below the robot's soles, m, and by `ground_tilt` more per metre ahead,
    pub ground_band: f64,
    /// where the robot's attitude may be wrong by this, rad.
    pub ground_tilt: f64,
    /// Points lie on the ground's plane within this, m, and within as much more as their range is uncertain.
    pub ground_tolerance: f64,
    /// Planes that are tried.
    pub ground_samples: usize,
    /// How ranges are compared.
    pub range_model: RangeModel,
    /// Standard deviation of a range, m: what is left near by, voxels among it,
    pub range_noise: f64,
    /// and what is added at a metre; it grows with the square.
    pub range_noise_growth: f64,
    /// Shares of beams that meet what the map says, what stands before it, and anything.
    pub mixture: [f64; 3],
    /// How fast it becomes rarer with the distance that something unmapped is met first, 1/m.
    pub short_rate: f64,
    /// Share of the beams that err independently: the exponent of their likelihood.
    pub independence: f64,
    /// Standard deviation of the torso's height over the map's ground, m,
    pub height_noise: f64,
    /// and of roll and pitch by the attitude filter, rad.
    pub attitude_noise: f64,
    /// Drawn anew when the effective number of particles falls below this share, which is above `least_effective`.
    pub resample_below: f64,
    /// Likelihoods are flattened until the effective number is at least this share: no frame decides alone.
    pub least_effective: f64,
    /// Cells for counting how many particles are needed: side, m, and heading, rad.
    pub bins: [f64; 2],
    /// How far what is sampled may be from the distribution over those cells (Kullback-Leibler), and the quantile that holds with.
    pub kld: [f64; 2],
    /// Guesses nearer to each other than this are one cluster: m, rad.
    pub cluster: [f64; 2],
    /// Jitter of drawn guesses while the robot is searching: m, rad.
    pub search_jitter: [f64; 2],
    /// A frame is used once the robot went so far, m, or turned so far, rad, or waited so long, s, since the last one used.
    pub update_after: [f64; 3],
    /// Rates of the slow and the fast mean of how well frames fit (Thrun, Burgard, Fox: augmented MCL).
    pub recovery_rates: [f64; 2],
    /// The robot is lost when the fast mean falls below this share of the slow one.
    pub recovery_below: f64,
    /// Other places are searched beside the tracking while the place explains less than this share of what stands on the ground,
    pub search_below: f64,
    /// and one that explains so much more of it is taken.
    pub search_better: f64,
    /// Share of the guesses of a search that is drawn anywhere each time.
    pub search_anew: f64,
    /// Standard deviation of ranges, m, by which a search blurs what it sees: few guesses are near the truth at first.
    pub search_blur: f64,
    /// Directions out of twelve in which a place that was searched has to hold before it is taken.
    pub confirm_directions: usize,
    /// Way of the camera, m, or turn, rad, after which all of a frame is news to a search.
    pub news_after: [f64; 2],
    /// The estimate counts as lost while its cluster holds less than this share,
    pub least_share: f64,
    /// or its place is worse than this, m (standard deviation).
    pub most_spread: f64,
    /// The estimate follows what the frames say by this share of what it is off, each,
    pub follow_share: f64,
    /// beyond these: in the plane, m, in height, m, in heading, rad; in height by less than what is climbed as a step, or level floor
    /// becomes one,
    pub follow_bands: [f64; 3],
    /// and all at once where it is off by more than this: m, rad.
    pub follow_within: [f64; 2],
    /// Radius and height of what the robot needs to stand somewhere, m.
    pub body: [f64; 2],
}

impl Default for MonteCarloConfig {
    fn default() -> Self {
        Self {
            particles: 500,
            most_particles: 8000,
            seed: 0,
            place_noise: [0.05, 0.02, 0.004],
            height_drift: [0.01, 0.004, 0.003],
            heading_noise: [0.06, 0.06, 0.004],
            attitude_drift: [0.02, 0.01, 0.01],
            start_noise: [0.03, 0.03],
            beams: 100,
            ground_share: 0.5,
            reach: [0.3, 4.0],
            ground_band: 0.06,
            ground_tilt: 0.12,
            ground_tolerance: 0.012,
            ground_samples: 60,
            range_model: RangeModel::RayCast,
            range_noise: 0.03,
            range_noise_growth: 0.01,
            mixture: [0.8, 0.1, 0.1],
            short_rate: 0.5,
            independence: 0.1,
            height_noise: 0.02,
            attitude_noise: 0.02,
            resample_below: 0.5,
            least_effective: 0.3,
            bins: [0.2, 0.26],
            kld: [0.05, 2.33],
            cluster: [0.3, 0.35],
            search_jitter: [0.03, 0.04],
            update_after: [0.02, 0.03, 0.5],
            recovery_rates: [0.01, 0.2],
            recovery_below: 0.65,
            search_below: 0.45,
            search_better: 0.2,
            search_anew: 0.1,
            search_blur: 0.1,
            confirm_directions: 7,
            news_after: [0.1, 0.1],
            least_share: 0.75,
            most_spread: 0.4,
            follow_share: 0.1,
            follow_bands: [0.02, 0.004, 0.02],
            follow_within: [0.3, 0.35],
            body: [0.1, 0.55],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_and_unknown_keys_are_not() {
        let read = |text| serde_json::from_str::<MonteCarloConfig>(text);
        let config = read(r#"{"range_model": "likelihood_field", "beams": 60}"#).unwrap();
        assert_eq!(
            (config.range_model, config.beams),
            (RangeModel::LikelihoodField, 60)
        );
        assert!(read(r#"{"beam": 60}"#).is_err());
        assert!(read(r#"{"range_model": "ray"}"#).is_err());
    }
}
