//! Parameters of finding lines, checked once.

use settings::{NOT_NEGATIVE, POSITIVE, above_to, at_least, between, settings, within};

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
