//! Maps of the same place on several time scales, of which the one in use is the likeliest (004, section 36.4; ref. 36.64, Biber and Duckett 2005).

use geometry::Cell;
use plan_view::{
    BeamLikelihood, BeamLikelihoodConfig, OccupancyConfig, OccupancyError, OccupancyMap,
    PlanarScan, log_odds, probability_of_log_odds,
};
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, settings};

settings! {
    /// Maps that learn and forget at different rates.
    pub struct TimescalesConfig("dynamic_scenes.timescales") {
        /// How long each map remembers: what it knows is the mean of what was seen, of which the weight falls to 1/e in this time.
        memories: [f64; 3] = [0.3, 10.0, 3600.0], "s", POSITIVE;
        /// The likelihood by which a map is chosen is that of the scans of about this time.
        choice: f64 = 0.5, "s", POSITIVE;
        /// Log likelihood of a beam by which a map that forgets sooner must be ahead of one that remembers longer.
        advantage: f64 = 0.05, "1", NOT_NEGATIVE;
    }
}

/// One map.
#[derive(Debug, Clone)]
struct Timescale {
    memory_s: f64,
    map: OccupancyMap,
    /// Log likelihood of a beam, of late, before it was taken in.
    log_likelihood: f64,
}

/// Occupancy of the same cells by means over different times. Each cell's probability is the mean over what scans said of it, 0 or 1, weighted by `exp(-age /
/// memory)` (samples replaced at a rate, in the limit of many) and by how much the settings let a scan say of what is occupied and what is free.
#[derive(Debug, Clone)]
pub struct TimescaleMaps {
    config: TimescalesConfig,
    scales: Vec<Timescale>,
    likelihood: BeamLikelihood,
    blank: OccupancyMap,
    last_s: Option<f64>,
    /// When each cell was last looked at, s; how many looks it has is in the maps.
    looked_s: Vec<f64>,
}

impl TimescaleMaps {
    /// Maps of so many columns and rows with the corner of the first cell at a place of the map frame, m. Of `occupancy` they take the cells, the prior,
    /// the limits and what is an obstacle.
    pub fn of_size(
        config: TimescalesConfig,
        occupancy: &OccupancyConfig,
        likelihood: BeamLikelihoodConfig,
        origin_m: [f64; 2],
        size: [usize; 2],
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let blank = OccupancyMap::of_size(occupancy.clone(), origin_m, size)?;
        let scale = |&memory_s: &f64| Timescale {
            memory_s,
            map: blank.clone(),
            log_likelihood: 0.0,
        };
        Ok(Self {
            scales: config.memories.iter().map(scale).collect(),
            likelihood: BeamLikelihood::new(likelihood)?,
            config,
            last_s: None,
            looked_s: vec![0.0; size[0] * size[1]],
            blank,
        })
    }

    /// The map that remembers as long as the setting of this number says.
    pub fn map(&self, number: usize) -> Option<&OccupancyMap> {
        self.scales.get(number).map(|scale| &scale.map)
    }

    /// Number of the map by which the scans of late were the likeliest, each before it was taken in; of those that are about as likely the one that remembers
    /// longest.
    pub fn in_use(&self) -> usize {
        let most = self.scales.iter().map(|scale| scale.log_likelihood);
        let near = most.fold(f64::NEG_INFINITY, f64::max) - self.config.advantage;
        let likely = self.scales.iter().enumerate();
        let likely = likely.filter(|(_, scale)| scale.log_likelihood >= near);
        let longest = likely.max_by(|(_, a), (_, b)| a.memory_s.total_cmp(&b.memory_s));
        longest.map_or(0, |(number, _)| number)
    }

    /// Log likelihood of a beam of a scan in each map.
    pub fn log_likelihoods(&self, scan: &PlanarScan) -> Vec<f64> {
        let of = |scale: &Timescale| {
            let (sum, beams) = self.likelihood.log_likelihood(&scale.map, scan);
            sum / (beams.max(1) as f64)
        };
        self.scales.iter().map(of).collect()
    }

    /// Takes in a scan of a time, s, no earlier than the last.
    pub fn insert(&mut self, time_s: f64, scan: &PlanarScan) -> Result<(), OccupancyError> {
        let mut said = self.blank.clone();
        let _counts = said.insert(scan)?;
        let since_s = self.last_s.map_or(f64::INFINITY, |last_s| time_s - last_s);
        let fresh = 1.0 - libm::exp(-since_s / self.config.choice);
        let likelihoods = self.log_likelihoods(scan);
        for (scale, now) in self.scales.iter_mut().zip(likelihoods) {
            scale.log_likelihood += fresh * (now - scale.log_likelihood);
        }
        let prior = log_odds(said.config().prior);
        for cell in said.cells().area().cells() {
            let Some(belief) = said.cells().get(cell).filter(|belief| belief.looks > 0) else {
                continue;
            };
            let occupied = f64::from(u8::from(f64::from(belief.log_odds) > prior));
            let Some(index) = said.cells().index(cell) else {
                continue;
            };
            let unseen_s = time_s - self.looked_s[index];
            self.looked_s[index] = time_s;
            for scale in &mut self.scales {
                scale.learn(cell, occupied, unseen_s, prior);
            }
        }
        self.last_s = Some(time_s);
        Ok(())
    }
}

impl Timescale {
    /// Takes in whether a cell is occupied, 0 or 1, that was looked at last so long ago.
    fn learn(&mut self, cell: Cell, occupied: f64, unseen_s: f64, prior: f64) {
        let Some(&belief) = self.map.cells().get(cell) else {
            return;
        };
        // A plain mean at first, so that the first look does not stay for as long as the memory is.
        let looks = f64::from(belief.looks) + 1.0;
        let rate = (1.0 - libm::exp(-unseen_s / self.memory_s)).max(1.0 / looks);
        let held = f64::from(belief.log_odds);
        let had = probability_of_log_odds(held);
        let config = self.map.config();
        let [hit, pass] = [config.occupied, config.free].map(|p| (log_odds(p) - prior).abs());
        let weight = 2.0 * (occupied * hit + (1.0 - occupied) * pass) / (hit + pass);
        let limits = [self.map.config().least, self.map.config().most];
        let has = (had + (rate * weight).min(1.0) * (occupied - had)).clamp(limits[0], limits[1]);
        self.map
            .update(cell, probability_of_log_odds(log_odds(has) - held + prior));
    }
}
