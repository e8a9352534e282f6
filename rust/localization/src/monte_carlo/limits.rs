//! Which settings of the localizer `monte_carlo` can be used.

use settings::{ConfigError, require, require_positive};

use super::MonteCarloConfig;

/// The likelihood of four beams is multiplied in single precision, which ends at 1e-38: none may be below this, 1/m,
const LEAST_DENSITY: f64 = 1e-9;
/// nor far above 1e9, 1/m, where it ends too: bounds of the noise of ranges, m, and of what is met before the map's surface, 1/m.
const LEAST_RANGE_NOISE_M: f64 = 1e-6;
const MOST_SHORT_RATE: f64 = 1e6;

/// So many particles take 150 MB, and as much again in a search.
const MOST_PARTICLES: usize = 1_000_000;
/// Where a body may stand is asked voxel by voxel of it, m.
const LARGEST_BODY_M: f64 = 5.0;

fn key(name: &str) -> String {
    format!("navigation.monte_carlo.{name}")
}

impl MonteCarloConfig {
    /// Refuses what cannot be used.
    pub(super) fn check(&self) -> Result<(), ConfigError> {
        for (name, values) in self.positive() {
            for &value in values {
                require_positive(&key(name), value)?;
            }
        }
        for rate in self.recovery_rates {
            require(rate <= 1.0, &key("recovery_rates"), "at most 1", rate)?;
        }
        for side_m in self.body {
            let allowed = format!("at most {LARGEST_BODY_M}");
            require(side_m <= LARGEST_BODY_M, &key("body"), &allowed, side_m)?;
        }
        self.check_shares()?;
        self.check_counts()?;
        let [near, far] = self.reach;
        require(
            near < far,
            &key("reach"),
            "ascending",
            format!("{near}, {far}"),
        )?;
        let sum = self.mixture.iter().sum::<f64>();
        require(
            (sum - 1.0).abs() < 1e-6,
            &key("mixture"),
            "shares that sum to 1",
            sum,
        )?;
        self.check_densities()
    }

    fn check_densities(&self) -> Result<(), ConfigError> {
        let (random, least) = (self.mixture[2], LEAST_DENSITY * self.reach[1]);
        let allowed = format!("shares of which the third is at least {least:e}");
        require(random >= least, &key("mixture"), &allowed, random)?;
        let noise_m = self.range_noise;
        let allowed = format!("at least {LEAST_RANGE_NOISE_M:e}");
        require(
            noise_m >= LEAST_RANGE_NOISE_M,
            &key("range_noise"),
            &allowed,
            noise_m,
        )?;
        let rate = self.short_rate;
        let allowed = format!("at most {MOST_SHORT_RATE:e}");
        require(rate <= MOST_SHORT_RATE, &key("short_rate"), &allowed, rate)
    }

    fn check_shares(&self) -> Result<(), ConfigError> {
        for (name, share) in [
            ("ground_share", self.ground_share),
            ("independence", self.independence),
            ("resample_below", self.resample_below),
            ("least_effective", self.least_effective),
            ("recovery_below", self.recovery_below),
            ("search_below", self.search_below),
            ("search_better", self.search_better),
            ("search_anew", self.search_anew),
            ("least_share", self.least_share),
            ("follow_share", self.follow_share),
        ] {
            let holds = (0.0..=1.0).contains(&share);
            require(holds, &key(name), "between 0 and 1", share)?;
        }
        // Likelihoods are flattened until at least `least_effective` is left: less never is.
        require(
            self.resample_below > self.least_effective,
            &key("resample_below"),
            "above least_effective",
            self.resample_below,
        )
    }

    fn check_counts(&self) -> Result<(), ConfigError> {
        for (name, count) in [
            ("particles", self.particles),
            ("beams", self.beams),
            ("ground_samples", self.ground_samples),
        ] {
            require(count > 0, &key(name), "> 0", count)?;
        }
        let directions = self.confirm_directions;
        let possible = (1..=12).contains(&directions);
        require(
            possible,
            &key("confirm_directions"),
            "between 1 and 12",
            directions,
        )?;
        let most = self.most_particles;
        let allowed = format!("between particles and {MOST_PARTICLES}");
        require(
            (self.particles..=MOST_PARTICLES).contains(&most),
            &key("most_particles"),
            &allowed,
            most,
        )
    }

    fn positive(&self) -> [(&'static str, &[f64]); 27] {
        use std::slice::from_ref;
        [
            ("place_noise", &self.place_noise),
            ("height_drift", &self.height_drift),
            ("heading_noise", &self.heading_noise),
            ("attitude_drift", &self.attitude_drift),
            ("start_noise", &self.start_noise),
            ("reach", &self.reach),
            ("ground_band", from_ref(&self.ground_band)),
            ("ground_tilt", from_ref(&self.ground_tilt)),
            ("ground_tolerance", from_ref(&self.ground_tolerance)),
            ("range_noise", from_ref(&self.range_noise)),
            ("range_noise_growth", from_ref(&self.range_noise_growth)),
            ("mixture", &self.mixture),
            ("short_rate", from_ref(&self.short_rate)),
            ("height_noise", from_ref(&self.height_noise)),
            ("attitude_noise", from_ref(&self.attitude_noise)),
            ("bins", &self.bins),
            ("kld", &self.kld),
            ("cluster", &self.cluster),
            ("search_jitter", &self.search_jitter),
            ("search_blur", from_ref(&self.search_blur)),
            ("news_after", &self.news_after),
            ("update_after", &self.update_after),
            ("recovery_rates", &self.recovery_rates),
            ("most_spread", from_ref(&self.most_spread)),
            ("follow_bands", &self.follow_bands),
            ("follow_within", &self.follow_within),
            ("body", &self.body),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            (refused(|c| c.reach = [2.0, 1.0]), "reach"),
            (refused(|c| c.place_noise[1] = f64::NAN), "place_noise"),
            (refused(|c| c.independence = 1.5), "independence"),
            (refused(|c| c.resample_below = 0.3), "resample_below"),
            (refused(|c| c.least_effective = 0.6), "resample_below"),
            (refused(|c| c.beams = 0), "beams"),
            (refused(|c| c.most_particles = 10), "most_particles"),
            (
                refused(|c| c.most_particles = 4_000_000_000),
                "most_particles",
            ),
            (refused(|c| c.recovery_rates[1] = 2.5), "recovery_rates"),
            (refused(|c| c.body[0] = 1e6), "body"),
            (refused(|c| c.mixture = [0.5, 0.1, 0.1]), "mixture"),
            (refused(|c| c.mixture = [0.9, 0.1, 1e-12]), "mixture"),
            (refused(|c| c.reach[1] = 1e9), "mixture"),
            (refused(|c| c.range_noise = 1e-12), "range_noise"),
            (refused(|c| c.short_rate = 1e12), "short_rate"),
        ] {
            let begin = format!("navigation.monte_carlo.{key} must be ");
            assert!(message.starts_with(&begin), "{message}");
        }
    }
}
