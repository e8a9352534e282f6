//! Settings of the localizer `monte_carlo`.

use serde::{Deserialize, Serialize};
use settings::{
    ANY, Bounds, ConfigError, POSITIVE, SHARE, above_to, at_least, choices, require, settings,
    within,
};

use super::tuning::MonteCarloTuning;

/// Least likelihood of a beam, 1/m. Those of four beams are multiplied in single precision, which ends at 1e-38.
const LEAST_DENSITY: f64 = 1e-9;
/// Bounds of the noise of ranges, m: no likelihood is far above 1e9 1/m, where the product of four in single precision ends, too.
const RANGE_NOISE: Bounds = at_least(1e-6);
/// Bounds of the rate at which something is met before the map's surface, 1/m: no likelihood is far above 1e9 1/m.
const SHORT_RATE: Bounds = above_to(0.0, 1e6);
/// Most particles that memory has room for: so many take 150 MB, and as much again in a search.
const MOST_PARTICLES: f64 = 1e6;

/// How measured ranges are compared with the map.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, settings::schemars::JsonSchema,
)]
#[schemars(crate = "settings::schemars")]
#[serde(rename_all = "snake_case")]
pub enum RangeModel {
    /// Each with the range that a ray through the map has: 002, III.C.
    RayCast,
    /// Each by how far its end lies from the nearest surface of the map.
    LikelihoodField,
}

choices!(RangeModel);

settings! {
    /// The localizer `monte_carlo`: the torso's pose in six dimensions, in a map that is known beforehand. Noise that grows is given
    /// per square root of a metre of way, of a radian of turn, and of a second.
    pub struct MonteCarloConfig("navigation.monte_carlo") {
        /// Guesses that are kept while the robot knows where it is.
        particles: usize = 500, "1", within(1.0, MOST_PARTICLES), "002, section III.C";
        /// Guesses that are kept at most, where the robot has to find out where it is.
        most_particles: usize = 8000, "1", within(1.0, MOST_PARTICLES);
        /// Seed of all that is drawn.
        seed: u64 = 0, "1", within(0.0, 9_007_199_254_740_992.0);
        /// Growth of the odometry's error along x and y: per way, turn and time.
        place_noise: [f64; 3] = [0.05, 0.02, 0.004], "m/sqrt(m), m/sqrt(rad), m/sqrt(s)", POSITIVE;
        /// Growth of the error of the odometry's height: per way, turn and time.
        height_drift: [f64; 3] = [0.01, 0.004, 0.003], "m/sqrt(m), m/sqrt(rad), m/sqrt(s)", POSITIVE;
        /// Growth of the error of the odometry's heading: per way, turn and time.
        heading_noise: [f64; 3] = [0.06, 0.06, 0.004], "rad/sqrt(m), rad/sqrt(rad), rad/sqrt(s)", POSITIVE;
        /// Growth of the error of roll and pitch between two frames: per way, turn and time.
        attitude_drift: [f64; 3] = [0.02, 0.01, 0.01], "rad/sqrt(m), rad/sqrt(rad), rad/sqrt(s)", POSITIVE;
        /// Standard deviation of a start that is told: x and y, m; heading, rad.
        start_noise: [f64; 2] = [0.03, 0.03], "m, rad", POSITIVE;
        /// Beams that are drawn from a frame.
        beams: usize = 100, "1", at_least(1.0), "002, section III.C";
        /// Share of the beams that end on the ground, where both kinds are seen.
        ground_share: f64 = 0.5, "1", SHARE;
        /// Shortest and longest range that is used.
        reach: [f64; 2] = [0.3, 4.0], "m" of camera, POSITIVE;
        /// Points of the ground lie at most so far above or below the robot's soles, where its attitude is right.
        ground_band: f64 = 0.06, "m", POSITIVE;
        /// Error of the robot's attitude that points of the ground are looked for with: so much more above or below per metre ahead.
        ground_tilt: f64 = 0.12, "rad", POSITIVE;
        /// Points lie on the ground's plane within this, and within as much more as their range is uncertain.
        ground_tolerance: f64 = 0.012, "m", POSITIVE;
        /// Planes through three points that are tried to find one of the ground.
        ground_samples: usize = 60, "1", at_least(1.0);
        /// How measured ranges are compared with the map.
        range_model: RangeModel = RangeModel::RayCast, "-", ANY, "002, section III.C";
        /// Standard deviation of a range that is left near by, voxels among it.
        range_noise: f64 = 0.03, "m", RANGE_NOISE;
        /// Standard deviation that is added to a range at a metre; it grows with the square of the range.
        range_noise_growth: f64 = 0.01, "1/m" of camera, POSITIVE;
        /// Shares of beams that meet what the map says, what stands before it, and anything.
        mixture: [f64; 3] = [0.8, 0.1, 0.1], "1", POSITIVE;
        /// How fast it becomes rarer with the distance that something unmapped is met first.
        short_rate: f64 = 0.5, "1/m", SHORT_RATE;
        /// Share of the beams that err independently: the exponent of their likelihood.
        independence: f64 = 0.1, "1", SHARE;
        /// Standard deviation of the torso's height over the map's ground.
        height_noise: f64 = 0.02, "m", POSITIVE, "002, equation (2)";
        /// Standard deviation of roll and pitch by the attitude filter.
        attitude_noise: f64 = 0.02, "rad", POSITIVE, "002, equation (2)";
        /// Guesses are drawn anew when their effective number falls below this share, which is above `least_effective`.
        resample_below: f64 = 0.5, "1", SHARE;
        /// Likelihoods are flattened until the effective number of guesses is at least this share: no frame decides alone.
        least_effective: f64 = 0.3, "1", SHARE;
        /// Cells for counting how many particles are needed: side, m, and heading, rad.
        bins: [f64; 2] = [0.2, 0.26], "m, rad", POSITIVE;
        /// How far what is sampled may be from the distribution over those cells (Kullback-Leibler), and the quantile that holds with.
        kld: [f64; 2] = [0.05, 2.33], "1", POSITIVE, "Fox 2003, equation (7)";
        /// Guesses nearer to each other than this are one place: a cluster, a belief that goes on, an estimate that follows: m, rad.
        cluster: [f64; 2] = [0.3, 0.35], "m, rad", POSITIVE;
        /// Jitter of drawn guesses while the robot is searching: m, rad.
        search_jitter: [f64; 2] = [0.03, 0.04], "m, rad", POSITIVE;
        /// A frame is used once the robot went so far, m, or turned so far, rad, or waited so long, s, since the last one used.
        update_after: [f64; 3] = [0.02, 0.03, 0.5], "m, rad, s", POSITIVE;
        /// Rates of the slow and the fast mean of how well frames fit.
        recovery_rates: [f64; 2] = [0.01, 0.2], "1", above_to(0.0, 1.0), "Thrun, Burgard, Fox 2005, table 8.3";
        /// The robot is lost when the fast mean of how well frames fit falls below this share of the slow one.
        recovery_below: f64 = 0.65, "1", SHARE;
        /// Other places are searched beside the tracking while the place explains less than this share of what stands on the ground.
        search_below: f64 = 0.45, "1", SHARE;
        /// A place that was searched is taken where it explains so much more of what stands on the ground.
        search_better: f64 = 0.2, "1", SHARE;
        /// Share of the guesses of a search that is drawn anywhere each time.
        search_anew: f64 = 0.1, "1", SHARE;
        /// Standard deviation of ranges by which a search blurs what it sees: few guesses are near the truth at first.
        search_blur: f64 = 0.1, "m", POSITIVE;
        /// Directions, of those that are told apart, in which a place that was searched has to hold before it is taken.
        confirm_directions: usize = 7, "1", at_least(1.0);
        /// Way of the camera, m, or turn, rad, after which all of a frame is news to a search.
        news_after: [f64; 2] = [0.1, 0.1], "m, rad", POSITIVE;
        /// The estimate counts as lost while its cluster holds less than this share of the guesses' weight.
        least_share: f64 = 0.75, "1", SHARE;
        /// The estimate counts as lost while the standard deviation of its place is larger than this.
        most_spread: f64 = 0.4, "m", POSITIVE;
        /// The estimate follows what each frame says by this share of what it is off.
        follow_share: f64 = 0.1, "1", SHARE;
        /// The estimate follows only what is off by more than this: in the plane, m, in height, m, in heading, rad. In height it is less
        /// than what is climbed as a step, or level floor would become one.
        follow_bands: [f64; 3] = [0.02, 0.004, 0.02], "m, m, rad", POSITIVE;
        /// Numbers that few will want to turn.
        tuning: MonteCarloTuning;
    }
    require (resample_below) > (least_effective);
    require (confirm_directions) <= (tuning.search.directions);
    require (most_particles) >= (particles);
    require (reach[0]) < (reach[1]);
    check MonteCarloConfig::fit_together;
}

impl MonteCarloConfig {
    fn fit_together(&self, key: &str) -> Result<(), ConfigError> {
        let name = format!("{key}.mixture");
        let sum = self.mixture.iter().sum::<f64>();
        let whole = (sum - 1.0).abs() < 1e-6;
        require(whole, &name, "shares that sum to 1", sum)?;
        let (random, least) = (self.mixture[2], LEAST_DENSITY * self.reach[1]);
        let allowed = format!("shares of which the third is at least {least:e}");
        require(random >= least, &name, &allowed, random)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use settings::Table;

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

    #[test]
    fn what_cannot_be_used_is_refused_by_its_key() {
        assert_eq!(MonteCarloConfig::default().check(), Ok(()));
        let refused = |change: fn(&mut MonteCarloConfig)| {
            let mut config = MonteCarloConfig::default();
            change(&mut config);
            config.check().unwrap_err().to_string()
        };
        for (message, key) in [
            (refused(|c| c.range_noise = 0.0), "range_noise"),
            (refused(|c| c.reach = [2.0, 1.0]), "reach.0"),
            (refused(|c| c.place_noise[1] = f64::NAN), "place_noise.1"),
            (refused(|c| c.independence = 1.5), "independence"),
            (refused(|c| c.resample_below = 0.3), "resample_below"),
            (refused(|c| c.least_effective = 0.6), "resample_below"),
            (refused(|c| c.beams = 0), "beams"),
            (refused(|c| c.most_particles = 10), "most_particles"),
            (
                refused(|c| c.most_particles = 4_000_000_000),
                "most_particles",
            ),
            (refused(|c| c.confirm_directions = 13), "confirm_directions"),
            (refused(|c| c.recovery_rates[1] = 2.5), "recovery_rates.1"),
            (refused(|c| c.mixture = [0.5, 0.1, 0.1]), "mixture"),
            (refused(|c| c.mixture = [0.9, 0.1, 1e-12]), "mixture.2"),
            (refused(|c| c.reach[1] = 1e9), "mixture"),
            (refused(|c| c.range_noise = 1e-12), "range_noise"),
            (refused(|c| c.short_rate = 1e12), "short_rate"),
        ] {
            let begin = format!("navigation.monte_carlo.{key} must be ");
            assert!(message.starts_with(&begin), "{message}");
        }
    }
}
