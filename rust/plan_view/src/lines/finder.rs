//! How many lines there are, and where: proposed by votes, improved by expectation maximization, counted by the Bayesian information criterion
//! (004, section 36.2.2; Sack and Burgard 2004).

use settings::{
    ConfigError, NOT_NEGATIVE, POSITIVE, Table, above_to, at_least, between, settings, within,
};

use super::mixture::LineMixture;
use super::search::Search;
use super::stretches::{Stretch, stretches};
use super::thinned::thinned;

settings! {
    /// How lines are found among points.
    pub struct LineFinderConfig("plan_view.lines") {
        /// Standard deviation of the points off their line.
        sigma: f64 = 0.03, "m", POSITIVE, "004, equation 36.9";
        /// Share of the points that lie at random, to begin with.
        random: f64 = 0.05, "1", between(0.0, 1.0);
        /// A line holds points up to so many standard deviations off.
        hold: f64 = 2.0, "1", within(0.5, 8.0);
        /// Share of the points that the lines must hold, as few of them as may be. Left out: how many there are says the criterion.
        held: Option<f64> = None, "1", above_to(0.0, 1.0);
        /// No more lines are found.
        most_lines: usize = 400, "1", at_least(1.0);
        /// Points in a cell of this many standard deviations are one, with their number.
        cell: f64 = 1.0, "1", within(0.01, 2.0);
        /// Most iterations of expectation maximization at a time.
        iterations: usize = 60, "1", at_least(1.0);
        /// The iterations end where the logarithm of the likelihood grows by less a point.
        least_gain: f64 = 1e-5, "1", POSITIVE;
        /// Slopes that are tried for each line that is proposed.
        slopes: usize = 24, "1", at_least(2.0);
        /// Most times that all lines are gone through: taken out, or laid where they hold more.
        rounds: usize = 4, "1", at_least(0.0);
        /// A line is drawn where its points are; a gap between them that is larger ends a stretch.
        gap: f64 = 0.5, "m", POSITIVE;
        /// Stretches with fewer points are not drawn.
        least_points: usize = 20, "1", at_least(1.0);
        /// Shorter ones are not, either: there a line only crosses something.
        least_length: f64 = 0.3, "m", NOT_NEGATIVE;
    }
}

/// Why no lines could be found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LineError {
    /// A point with a coordinate that is no number.
    #[error("points must be finite; point {0} is not")]
    PointNotFinite(usize),
}

/// Lines, and what they are worth.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundLines {
    /// The lines, those with most points first, and how the points are shared among them.
    pub mixture: LineMixture,
    /// Share of the points that some line holds.
    pub held: f64,
    /// Bayesian information criterion: less is better, of the same points.
    pub criterion: f64,
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
        let mut search = Search::new(config, &points);
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
    pub fn stretches(&self, found: &FoundLines, points_m: &[[f64; 2]]) -> Vec<Stretch> {
        stretches(found.mixture.lines(), points_m, &self.config)
    }
}
