//! The search for lines: what each step of [`super::LineFinder`] does.

use super::accumulator::Accumulator;
use super::finder::{FoundLines, LineFinderConfig};
use super::line::{Line, LineSums, WeightedPoint};
use super::mixture::LineMixture;

/// What is known on the way.
pub(super) struct Search<'a> {
    config: &'a LineFinderConfig,
    points: &'a [WeightedPoint],
    weight: f64,
    pub(super) mixture: LineMixture,
    /// How many lines hold each point.
    holders: Vec<u16>,
    votes: Accumulator,
}

impl<'a> Search<'a> {
    pub(super) fn new(config: &'a LineFinderConfig, points: &'a [WeightedPoint]) -> Self {
        let bounds = box_of(points);
        let mut votes = Accumulator::new(bounds, config.hold * config.sigma);
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

    pub(super) fn is_enough(&self) -> bool {
        self.held() >= self.config.held * self.weight
    }

    /// Adds lines as long as each makes the criterion less.
    pub(super) fn add(&mut self) {
        let (mut densities, per_line) = (self.densities(), self.cost_of_a_line());
        while self.mixture.lines().len() < self.config.most_lines && !self.is_enough() {
            let Some(line) = self.proposed() else {
                return;
            };
            let held: f64 = self
                .points_within(&line, |holders| holders == 0)
                .map(|point| point.weight)
                .sum();
            let share = held / self.weight;
            let Some(gain) = self
                .gain(&densities, &line, share)
                .filter(|gain| *gain > per_line)
            else {
                return;
            };
            debug_assert!(gain.is_finite());
            self.mixture.add(line, share);
            self.hold(&line, true);
            densities = self.densities();
        }
    }

    /// By how much the logarithm of the likelihood must grow for a line to be worth its parameters.
    fn cost_of_a_line(&self) -> f64 {
        let of = |mixture: &LineMixture| mixture.information_criterion(0.0, self.weight) / 2.0;
        let mut more = self.mixture.clone();
        more.add(
            Line {
                normal_rad: 0.0,
                distance_m: 0.0,
            },
            0.0,
        );
        of(&more) - of(&self.mixture)
    }

    fn densities(&self) -> Vec<f64> {
        self.mixture.densities(self.points)
    }

    /// By how much the logarithm of the likelihood grows with a line that has this share of the points.
    fn gain(&self, densities: &[f64], line: &Line, share: f64) -> Option<f64> {
        let [cos, sin, distance_m] = line.normal_form();
        let each = self.points.iter().zip(densities).map(|(point, before)| {
            let off_m = point.at_m[0] * cos + point.at_m[1] * sin - distance_m;
            let density = self.mixture.density_on_line(off_m);
            point.weight * libm::log((1.0 - share) + share * density / before)
        });
        (share > 0.0).then(|| each.sum())
    }

    /// The line that holds most of what none does, fitted to it.
    fn proposed(&self) -> Option<Line> {
        let mut line = self.votes.best()?;
        let mut best = (0.0, line);
        for _ in 0..=self.config.refits {
            let mut sums = LineSums::default();
            for point in self.points_within(&line, |holders| holders == 0) {
                sums.add(point.at_m, point.weight);
            }
            if sums.weight() > best.0 {
                best = (sums.weight(), line);
            }
            let Some(fitted) = sums.line() else {
                break;
            };
            line = fitted;
        }
        (best.0 > 0.0).then_some(best.1)
    }

    fn points_within(
        &self,
        line: &Line,
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
    fn hold(&mut self, line: &Line, more: bool) {
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

    pub(super) fn fit(&mut self) -> f64 {
        (self.mixture).fit(self.points, self.config.iterations, self.config.least_gain)
    }

    /// Counts anew which points are held.
    pub(super) fn reset(&mut self) {
        let lines = self.mixture.lines().to_vec();
        let forms: Vec<_> = lines.iter().map(Line::normal_form).collect();
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
    pub(super) fn prune(&mut self) -> usize {
        let mut gone = 0;
        while let Some((index, loss)) = self.least_useful() {
            if loss > self.cost_of_a_line() {
                break;
            }
            let _line = self.mixture.remove(index);
            let _log_likelihood = self.fit();
            gone += 1;
        }
        self.reset();
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
            if !better && self.mixture.lines().len() == had {
                break;
            }
        }
    }

    /// Takes a line out and lays it where it holds most; whether it holds more there.
    fn lay_anew(&mut self, index: usize) -> bool {
        let line = self.mixture.lines()[index];
        self.hold(&line, false);
        let alone = |search: &Self, line: &Line| {
            search
                .points_within(line, |holders| holders == 0)
                .map(|point| point.weight)
                .sum::<f64>()
        };
        let had = alone(self, &line);
        let other = self.proposed().filter(|other| alone(self, other) > had);
        self.hold(&other.unwrap_or(line), true);
        if let Some(other) = other {
            self.mixture.replace(index, other);
        }
        other.is_some()
    }

    /// Takes out the line that alone holds fewest points, where enough stay held; whether it did.
    fn drop_spare(&mut self) -> bool {
        let lines = self.mixture.lines();
        let alone = |line: &Line| {
            self.points_within(line, |holders| holders == 1)
                .map(|point| point.weight)
                .sum::<f64>()
        };
        let least = lines.iter().map(alone).enumerate();
        let Some((index, weight)) = least.min_by(|(_, one), (_, other)| one.total_cmp(other))
        else {
            return false;
        };
        let spare = self.held() - weight >= self.config.held * self.weight;
        if spare {
            let line = self.mixture.remove(index);
            self.hold(&line, false);
        }
        spare
    }

    /// The lines in order, and what they are worth, counted on all points.
    pub(super) fn finish(mut self, points_m: &[[f64; 2]]) -> FoundLines {
        self.mixture.sort();
        let log_likelihood = self.mixture.log_likelihood(self.points);
        let forms: Vec<_> = self.mixture.lines().iter().map(Line::normal_form).collect();
        let reach_m = self.reach_m();
        let is_held = |at_m: &&[f64; 2]| {
            forms.iter().any(|[cos, sin, distance_m]| {
                (at_m[0] * cos + at_m[1] * sin - distance_m).abs() <= reach_m
            })
        };
        let held = points_m.iter().filter(is_held).count();
        FoundLines {
            held: held as f64 / points_m.len().max(1) as f64,
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
