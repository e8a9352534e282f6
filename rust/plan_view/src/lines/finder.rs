//! How many lines there are, and where: proposed by votes, improved by expectation maximization, counted by the Bayesian information criterion
//! (004, section 36.2.2; Sack and Burgard 2004).

use settings::{ConfigError, Table};

use super::config::LineFinderConfig;
use super::search::{FinderState, FoundLines};
use super::stretches::{LineStretch, stretches};
use super::thinned::thinned;

/// Why no lines could be found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LineError {
    /// A point with a coordinate that is no number.
    #[error("points must be finite; point {0} is not")]
    PointNotFinite(usize),
}

/// Finds the lines that points lie on; how many there are is found, too.
#[derive(Debug, Clone)]
pub struct LineFinder {
    config: LineFinderConfig,
}

impl LineFinder {
    /// With settings.
    pub fn new(config: LineFinderConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// The lines of points, m; none of none.
    ///
    /// 1. The line with the most votes of points that none holds yet is taken as long as the Bayesian information criterion falls.
    /// 2. Expectation maximization improves all of them; lines without which the criterion is less are taken out.
    ///
    /// With `held` lines are taken as long as fewer points are held, whatever the criterion says. Then each in turn is laid where it holds most
    /// of what the others do not, and those are taken out that are not needed.
    pub fn find(&self, points_m: &[[f64; 2]]) -> Result<FoundLines, LineError> {
        let finite = |at_m: &[f64; 2]| at_m.iter().all(|part| part.is_finite());
        if let Some(bad) = points_m.iter().position(|at_m| !finite(at_m)) {
            return Err(LineError::PointNotFinite(bad));
        }
        let config = &self.config;
        let points = thinned(points_m, config.cell * config.sigma);
        let mut search = FinderState::new(config, &points);
        if config.held.is_some() {
            search.add_to_hold();
            search.fit();
            search.economize();
            search.make_sure(points_m);
        } else {
            search.add_and_prune();
        }
        Ok(search.finish(points_m))
    }

    /// Where along the lines that were found their points, m, lie.
    pub fn stretches(&self, found: &FoundLines, points_m: &[[f64; 2]]) -> Vec<LineStretch> {
        stretches(found.mixture.lines(), points_m, &self.config)
    }
}
