//! The search for lines: what each step of [`super::LineFinder`] does.

use super::config::LineFinderConfig;
use super::line::{PlanarLine, WeightedPoint};
use super::line_votes::LineVotes;
use super::mixture::LineMixture;
use super::widest::widest;

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

/// What is known on the way.
pub(super) struct FinderState<'a> {
    config: &'a LineFinderConfig,
    points: &'a [WeightedPoint],
    weight: f64,
    pub(super) mixture: LineMixture,
    /// How many lines hold each point.
    holders: Vec<u16>,
    votes: LineVotes,
    /// Share of the points to hold.
    wanted: f64,
}

impl<'a> FinderState<'a> {
    pub(super) fn new(config: &'a LineFinderConfig, points: &'a [WeightedPoint]) -> Self {
        let bounds = box_of(points);
        let mut votes = LineVotes::new(bounds, config.hold * config.sigma);
        for point in points {
            votes.vote(point, point.weight);
        }
        Self {
            config,
            points,
            weight: points.iter().map(|point| point.weight).sum(),
            mixture: LineMixture::new(Vec::new(), config.sigma, config.random, bounds),
            holders: vec![0; points.len()],
            votes,
            wanted: config.held.unwrap_or(1.0),
        }
    }

    fn reach_m(&self) -> f64 {
        self.config.hold * self.config.sigma
    }

    /// Weight of the points that some line holds.
    fn held(&self) -> f64 {
        let held = self
            .points
            .iter()
            .zip(&self.holders)
            .filter(|(_, holders)| **holders > 0);
        held.map(|(point, _)| point.weight).sum()
    }

    /// Whether as many points are held as are asked for, `spare` fewer than now.
    fn is_enough(&self, spare: f64) -> bool {
        self.held() - spare >= self.wanted * self.weight
    }

    fn is_full(&self) -> bool {
        self.mixture.lines().len() >= self.config.most_lines
    }

    /// Adds lines until as many points are held as are asked for.
    pub(super) fn add_to_hold(&mut self) {
        while !self.is_full() && !self.is_enough(0.0) {
            let Some(line) = self.proposed() else {
                return;
            };
            self.mixture.add(line, self.share_alone(&line, 0));
            self.hold(&line, true);
        }
    }

    /// Adds lines, improves all, and takes out those that are worth nothing, until nothing changes.
    pub(super) fn add_and_prune(&mut self) {
        for _ in 0..=self.config.rounds {
            let had = self.mixture.lines().len();
            self.add();
            self.fit();
            let gone = self.prune();
            if gone == 0 && self.mixture.lines().len() == had {
                break;
            }
        }
    }

    /// Adds lines as long as each makes the criterion less.
    fn add(&mut self) {
        let per_line = self.cost_of_a_line();
        while !self.is_full() {
            let Some(line) = self.proposed() else {
                return;
            };
            let share = self.share_alone(&line, 0);
            if self.gain(&line, share) <= per_line {
                return;
            }
            self.mixture.add(line, share);
            self.hold(&line, true);
        }
    }

    /// Share of the points that a line holds and just so many others.
    fn share_alone(&self, line: &PlanarLine, others: u16) -> f64 {
        let alone = self.points_within(line, |holders| holders == others);
        alone.map(|point| point.weight).sum::<f64>() / self.weight
    }

    /// By how much the logarithm of the likelihood must grow for a line to be worth its parameters.
    fn cost_of_a_line(&self) -> f64 {
        let of = |mixture: &LineMixture| mixture.information_criterion(0.0, self.weight) / 2.0;
        let mut more = self.mixture.clone();
        more.add(
            PlanarLine {
                normal_rad: 0.0,
                distance_m: 0.0,
            },
            0.0,
        );
        of(&more) - of(&self.mixture)
    }

    /// By how much the logarithm of the likelihood grows with a line that has this share of the points.
    fn gain(&self, line: &PlanarLine, share: f64) -> f64 {
        let [cos, sin, distance_m] = line.normal_form();
        let densities = self.mixture.densities(self.points);
        let each = self.points.iter().zip(densities).map(|(point, before)| {
            let off_m = point.at_m[0] * cos + point.at_m[1] * sin - distance_m;
            let density = self.mixture.density_on_line(off_m);
            point.weight * libm::log((1.0 - share) + share * density / before)
        });
        each.sum()
    }

    /// The line that holds most of what none does.
    fn proposed(&self) -> Option<PlanarLine> {
        let line = self.votes.best()?;
        let open = self
            .points
            .iter()
            .zip(&self.holders)
            .filter(|(_, holders)| **holders == 0);
        let open = open.map(|(point, _)| point);
        Some(widest(&line, open, self.reach_m(), self.config.slopes))
    }

    fn points_within(
        &self,
        line: &PlanarLine,
        counts: impl Fn(u16) -> bool,
    ) -> impl Iterator<Item = &WeightedPoint> {
        let ([cos, sin, distance_m], reach_m) = (line.normal_form(), self.reach_m());
        let each = self.points.iter().zip(&self.holders);
        each.filter(move |(point, holders)| {
            let off_m = point.at_m[0] * cos + point.at_m[1] * sin - distance_m;
            off_m.abs() <= reach_m && counts(**holders)
        })
        .map(|(point, _)| point)
    }

    /// Marks the points of a line as held, or as held by one line less.
    fn hold(&mut self, line: &PlanarLine, more: bool) {
        let ([cos, sin, distance_m], reach_m) = (line.normal_form(), self.reach_m());
        for (point, holders) in self.points.iter().zip(&mut self.holders) {
            let off_m = point.at_m[0] * cos + point.at_m[1] * sin - distance_m;
            if off_m.abs() > reach_m {
                continue;
            }
            if more {
                *holders += 1;
                if *holders == 1 {
                    self.votes.vote(point, -point.weight);
                }
            } else {
                *holders -= 1;
                if *holders == 0 {
                    self.votes.vote(point, point.weight);
                }
            }
        }
    }

    /// Improves all lines together, and counts anew which points they hold.
    pub(super) fn fit(&mut self) {
        let (most, least_gain) = (self.config.iterations, self.config.least_gain);
        let _log_likelihood = self.mixture.fit(self.points, most, least_gain);
        self.reset();
    }

    /// Counts anew which points are held.
    fn reset(&mut self) {
        let lines = self.mixture.lines().to_vec();
        let forms: Vec<_> = lines.iter().map(PlanarLine::normal_form).collect();
        let reach_m = self.reach_m();
        for (point, holders) in self.points.iter().zip(&mut self.holders) {
            let holds = |[cos, sin, distance_m]: &&[f64; 3]| {
                (point.at_m[0] * cos + point.at_m[1] * sin - distance_m).abs() <= reach_m
            };
            let now = forms.iter().filter(holds).count() as u16;
            match (*holders, now) {
                (0, 1..) => self.votes.vote(point, -point.weight),
                (1.., 0) => self.votes.vote(point, point.weight),
                _ => {}
            }
            *holders = now;
        }
    }

    /// Takes out the lines without which the criterion is less, the least useful first; how many.
    fn prune(&mut self) -> usize {
        let mut gone = 0;
        while let Some((index, loss)) = self.least_useful() {
            if loss > self.cost_of_a_line() {
                break;
            }
            let _line = self.mixture.remove(index);
            self.fit();
            gone += 1;
        }
        gone
    }

    /// The line without which the logarithm of the likelihood falls least, and by how much, if all others stay as they are.
    fn least_useful(&self) -> Option<(usize, f64)> {
        let losses = self.mixture.losses(self.points);
        let least = losses.into_iter().enumerate();
        least.min_by(|(_, one), (_, other)| one.total_cmp(other))
    }

    /// Lays lines where they hold more, and takes out those that are not needed for the share that is asked for.
    pub(super) fn economize(&mut self) {
        for _ in 0..self.config.rounds {
            let mut better = false;
            for index in 0..self.mixture.lines().len() {
                better |= self.lay_anew(index);
            }
            let had = self.mixture.lines().len();
            while self.drop_spare() {}
            self.add_to_hold();
            if !better && self.mixture.lines().len() == had {
                break;
            }
        }
    }

    /// Takes a line out and lays it where it holds most; whether it holds more there.
    fn lay_anew(&mut self, index: usize) -> bool {
        let line = self.mixture.lines()[index];
        self.hold(&line, false);
        let had = self.share_alone(&line, 0);
        let other = self.proposed();
        let other = other.filter(|other| self.share_alone(other, 0) > had);
        self.hold(&other.unwrap_or(line), true);
        if let Some(other) = other {
            self.mixture.replace(index, other);
        }
        other.is_some()
    }

    /// Takes out the line that alone holds fewest points, where enough stay held; whether it did.
    fn drop_spare(&mut self) -> bool {
        let lines = self.mixture.lines().iter();
        let alone = lines.map(|line| self.share_alone(line, 1)).enumerate();
        let least = alone.min_by(|(_, one), (_, other)| one.total_cmp(other));
        let Some((index, share)) = least.filter(|(_, share)| self.is_enough(share * self.weight))
        else {
            return false;
        };
        debug_assert!(share >= 0.0);
        let line = self.mixture.remove(index);
        self.hold(&line, false);
        true
    }

    /// Adds lines until they hold as many of all points, m, as are asked for: of thinned ones a few more or less are held.
    pub(super) fn make_sure(&mut self, points_m: &[[f64; 2]]) {
        for _ in 0..self.config.rounds {
            let missing = self.config.held.unwrap_or(0.0) - self.share_held(points_m);
            if missing <= 0.0 {
                return;
            }
            self.wanted = self.held() / self.weight + missing;
            self.add_to_hold();
        }
    }

    fn share_held(&self, points_m: &[[f64; 2]]) -> f64 {
        let forms: Vec<_> = self
            .mixture
            .lines()
            .iter()
            .map(PlanarLine::normal_form)
            .collect();
        let reach_m = self.reach_m();
        let is_held = |at_m: &&[f64; 2]| {
            let off_m =
                |[cos, sin, distance_m]: &[f64; 3]| at_m[0] * cos + at_m[1] * sin - distance_m;
            forms.iter().any(|form| off_m(form).abs() <= reach_m)
        };
        points_m.iter().filter(is_held).count() as f64 / points_m.len().max(1) as f64
    }

    /// The lines in order, and what they are worth, counted on all points, m.
    pub(super) fn finish(mut self, points_m: &[[f64; 2]]) -> FoundLines {
        self.mixture.sort();
        let log_likelihood = self.mixture.log_likelihood(self.points);
        FoundLines {
            held: self.share_held(points_m),
            criterion: self
                .mixture
                .information_criterion(log_likelihood, self.weight),
            mixture: self.mixture,
        }
    }
}

/// The lower and upper corner of the box around points, m.
fn box_of(points: &[WeightedPoint]) -> [[f64; 2]; 2] {
    let Some(first) = points.first() else {
        return [[0.0; 2]; 2];
    };
    let ends = |corner: [[f64; 2]; 2], point: &WeightedPoint| {
        let (low, high) = (corner[0], corner[1]);
        [
            [0, 1].map(|axis| low[axis].min(point.at_m[axis])),
            [0, 1].map(|axis| high[axis].max(point.at_m[axis])),
        ]
    };
    points.iter().fold([first.at_m; 2], ends)
}
