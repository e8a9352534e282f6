//! How probable a scan is, given the map: what localization asks, and what a map is judged by on scans that it has not seen.

use geometry::{Cell, PlanarPose};
use settings::{ConfigError, POSITIVE, Table, between, settings, within};
use volume::VoxelWalk;

use super::OccupancyMap;
use super::odds::probability_of_log_odds;
use crate::scan::{PlanarBeam, PlanarScan};

settings! {
    /// How a laser's range comes about in a map: it ends in the first occupied cell on its way, with noise, or anywhere.
    pub struct BeamLikelihoodConfig("plan_view.beam_likelihood") {
        /// Standard deviation of a range.
        sigma: f64 = 0.03, "m", POSITIVE;
        /// Share of ranges that have nothing to do with the map: people, glass, errors.
        random: f64 = 0.05, "1", between(0.0, 1.0);
        /// Share of ranges that come back from nothing, whatever is there.
        nothing: f64 = 0.01, "1", between(0.0, 1.0);
        /// Probability that a beam ends in a cell of which nothing is known.
        unknown: f64 = 0.05, "1", within(0.0, 1.0);
        /// Ranges are no longer than this.
        max_range: f64 = 50.0, "m", POSITIVE;
        /// Standard deviations of a range beyond which a cell says nothing of it.
        reach: f64 = 4.0, "1", within(1.0, 40.0);
    }
}

/// The likelihood of beams and scans in a map.
#[derive(Debug, Clone)]
pub struct BeamLikelihood {
    config: BeamLikelihoodConfig,
}

impl BeamLikelihood {
    /// With settings.
    pub fn new(config: BeamLikelihoodConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// Logarithm of the density of a scan from its pose, and how many beams it is of: the sum over its beams, which are taken to be independent.
    /// Densities are per metre of range; a maximum range reading has a probability. Beams that cannot be used are left out.
    pub fn log_likelihood(&self, map: &OccupancyMap, scan: &PlanarScan) -> (f64, usize) {
        let usable = scan.beams.iter().filter(|beam| beam.is_usable());
        usable.fold((0.0, 0), |(sum, count), beam| {
            let density = self.density(map, &scan.map_from_sensor, beam);
            (sum + libm::log(density), count + 1)
        })
    }

    /// Density of a beam's range, 1/m, from a pose in the map frame; of a maximum range reading its probability. Over all ranges up to
    /// `max_range`, the reading that there is none among them, it is 1.
    pub fn density(
        &self,
        map: &OccupancyMap,
        map_from_sensor: &PlanarPose,
        beam: &PlanarBeam,
    ) -> f64 {
        let config = &self.config;
        let range_m = beam.range_m.map(|range_m| range_m.min(config.max_range));
        let (sin, cos) = libm::sincos(map_from_sensor.yaw_rad + beam.bearing_rad);
        let eye_m = [map_from_sensor.x_m, map_from_sensor.y_m];
        let near_m = config.reach * config.sigma;
        let cell_m = map.config().cell;
        let far_m = range_m.map_or(config.max_range, |range_m| {
            (range_m + near_m + 2.0 * cell_m).min(config.max_range)
        });
        let end_m = [eye_m[0] + far_m * cos, eye_m[1] + far_m * sin];
        let [from, to] = [eye_m, end_m].map(|at_m| map.in_cells(at_m));
        let size = [map.cells().cols() as i32, map.cells().rows() as i32, 1];
        let (mut gets_here, mut hit) = (1.0, 0.0);
        let walk = VoxelWalk::new(from, to, size).into_iter().flatten();
        for [col, row, _] in walk {
            if gets_here < GONE {
                break;
            }
            let cell = Cell::new(col, row);
            let occupied = map.cells().get(cell).map_or(config.unknown, |belief| {
                if belief.looks == 0 {
                    config.unknown
                } else {
                    probability_of_log_odds(f64::from(belief.log_odds))
                }
            });
            if let Some(range_m) = range_m {
                let [x_m, y_m] = map.lattice().center_of(cell);
                let along_m = ((x_m - eye_m[0]) * cos + (y_m - eye_m[1]) * sin).max(0.0);
                let off = (range_m - along_m) / config.sigma;
                if off.abs() <= config.reach {
                    hit += gets_here * occupied * self.bell(off) / self.not_negative(along_m);
                }
            }
            gets_here *= 1.0 - occupied;
        }
        let by_map = 1.0 - config.random - config.nothing;
        if range_m.is_some() {
            by_map.max(0.0) * hit + config.random / config.max_range
        } else {
            by_map.max(0.0) * gets_here + config.nothing
        }
    }

    /// Probability that the range of something so far away, m, is measured as more than 0: others do not exist.
    fn not_negative(&self, along_m: f64) -> f64 {
        let off = along_m / self.config.sigma;
        if off > self.config.reach {
            return 1.0;
        }
        0.5 * (1.0 + libm::erf(off * std::f64::consts::FRAC_1_SQRT_2))
    }

    /// Density of a range so many standard deviations off, 1/m.
    fn bell(&self, off: f64) -> f64 {
        libm::exp(-0.5 * off * off) / (self.config.sigma * (2.0 * std::f64::consts::PI).sqrt())
    }
}

/// Of a beam that gets on with less than this probability the rest is left out.
const GONE: f64 = 1e-9;
