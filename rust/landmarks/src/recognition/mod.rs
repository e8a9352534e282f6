//! Places are recognised by what stands there: landmarks that look alike and lie alike (004, section 36.3.6, reference 36.61: landmarks by their appearance,
//! and a metric map).

#[cfg(test)]
mod tests;

use core::f64::consts::PI;

use geometry::PlanarPose;
use nalgebra::Vector2;
use settings::{ConfigError, POSITIVE, Table, at_least, between, settings};

settings! {
    /// When a place is recognised by its landmarks.
    pub struct RecognitionConfig("landmarks.recognition") {
        /// Standard deviation of the distance from a seen landmark to its place in the map.
        place_noise: f64 = 0.1, "m", POSITIVE;
        /// Standard deviations of what landmarks look like, both views taken together: width and height.
        appearance_noise: [f64; 2] = [0.06, 0.06], "m, m", POSITIVE;
        /// What is seen is the map's where it is no further off than this, in standard deviations.
        within: f64 = 3.0, "1", POSITIVE;
        /// How many places may be recognised by mistake, of all looks where none should be.
        false_alarms: f64 = 1e-4, "1", between(0.0, 1.0);
        /// Two landmarks that say where the map lies are so far apart.
        base: f64 = 0.8, "m", POSITIVE;
        /// Places that are further apart, or turned by more, are two: the map must not have both alike.
        apart: [f64; 2] = [1.0, 0.3], "m, rad", at_least(0.0);
    }
}

/// A landmark with what it looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LookingLike {
    /// Where it is: of what is seen now in the robot's frame, m; of what is known in the map's.
    pub at_m: Vector2<f64>,
    /// Its width and its height, m.
    pub size_m: [f64; 2],
}

/// A place that was recognised.
#[derive(Debug, Clone, PartialEq)]
pub struct Recognised {
    /// Where the robot is, in the map.
    pub map_from_robot: PlanarPose,
    /// Pairs of indices: seen, known.
    pub pairs: Vec<[usize; 2]>,
    /// How many times as good a place would be found in a map like this by chance.
    pub expected_by_chance: f64,
}

/// Where the robot is, by what it sees. None where nothing is recognised, or two places look alike.
///
/// Each two pairs of a seen and a known landmark that look alike and are as far apart say where the robot would be; there the others are counted that are
/// seen where they should be. A place is recognised where so many would hardly ever agree by chance (a contrario: Desolneux, Moisan, Morel 2000, equation
/// (2)), however many places were tried.
///
/// # Errors
/// A setting cannot be used.
pub fn recognise(
    seen: &[LookingLike],
    known: &[LookingLike],
    config: &RecognitionConfig,
) -> Result<Option<Recognised>, ConfigError> {
    config.check()?;
    let search = Recogniser::new(seen, known, config);
    let mut best: Option<Recognised> = None;
    let mut other: Option<Recognised> = None;
    for found in search
        .guesses()
        .filter(|guess| search.is_likely(guess))
        .filter_map(|guess| search.verify(&guess))
    {
        let better = |than: &Option<Recognised>| {
            than.as_ref()
                .is_none_or(|than| found.expected_by_chance < than.expected_by_chance)
        };
        let is_other =
            |one: &Recognised| search.are_apart(&one.map_from_robot, &found.map_from_robot);
        if better(&best) {
            if let Some(before) = best.take_if(|before| is_other(before))
                && other
                    .as_ref()
                    .is_none_or(|than| before.expected_by_chance < than.expected_by_chance)
            {
                other = Some(before);
            }
            best = Some(found);
        } else if best.as_ref().is_some_and(is_other) && better(&other) {
            other = Some(found);
        }
    }
    let Some(best) = best else { return Ok(None) };
    let rival = other.filter(|one| search.are_apart(&one.map_from_robot, &best.map_from_robot));
    let is_alone = rival.is_none_or(|one| one.expected_by_chance > config.false_alarms);
    Ok((best.expected_by_chance <= config.false_alarms && is_alone).then_some(best))
}

/// What is compared.
struct Recogniser<'a> {
    seen: &'a [LookingLike],
    known: &'a [LookingLike],
    config: &'a RecognitionConfig,
    /// Of each that is seen, the known ones that look alike.
    alike: Vec<Vec<usize>>,
    /// Of each that is seen, the probability that one that looks alike is near anywhere in the map.
    by_chance: Vec<f64>,
    /// How many must agree for a place to be recognised.
    needed: usize,
}

impl<'a> Recogniser<'a> {
    fn new(
        seen: &'a [LookingLike],
        known: &'a [LookingLike],
        config: &'a RecognitionConfig,
    ) -> Self {
        let [width, height] = config.appearance_noise.map(|sd| config.within * sd);
        let alike: Vec<Vec<usize>> = seen
            .iter()
            .map(|one| {
                let fits = |other: &LookingLike| {
                    (one.size_m[0] - other.size_m[0]).abs() <= width
                        && (one.size_m[1] - other.size_m[1]).abs() <= height
                };
                (0..known.len())
                    .filter(|&index| fits(&known[index]))
                    .collect()
            })
            .collect();
        let near_m = config.within * config.place_noise;
        let side = |axis: usize| {
            let each = || known.iter().map(|one| one.at_m[axis]);
            let low = each().fold(f64::INFINITY, f64::min);
            each().fold(f64::NEG_INFINITY, f64::max) - low + 2.0 * near_m
        };
        let share = if known.is_empty() {
            0.0
        } else {
            (PI * near_m * near_m / (side(0) * side(1))).min(1.0)
        };
        let by_chance = alike
            .iter()
            .map(|alike| (share * alike.len() as f64).min(1.0))
            .collect();
        let mut search = Self {
            seen,
            known,
            config,
            alike,
            by_chance,
            needed: 0,
        };
        let enough = |&count: &usize| search.expected_by_chance(count) <= config.false_alarms;
        search.needed = (2..=seen.len()).find(enough).unwrap_or(seen.len() + 1);
        search
    }

    fn near_m(&self) -> f64 {
        self.config.within * self.config.place_noise
    }

    /// Where the robot would be, by two landmarks each.
    fn guesses(&self) -> impl Iterator<Item = PlanarPose> {
        let pairs: Vec<[usize; 2]> = self
            .alike
            .iter()
            .enumerate()
            .flat_map(|(seen, alike)| alike.iter().map(move |&known| [seen, known]))
            .collect();
        let off_m = core::f64::consts::SQRT_2 * self.near_m();
        let mut found = Vec::new();
        for (number, &[first, at]) in pairs.iter().enumerate() {
            for &[second, there] in &pairs[number + 1..] {
                let between = self.seen[second].at_m - self.seen[first].at_m;
                let known = self.known[there].at_m - self.known[at].at_m;
                let base_m = between.norm();
                if first != second
                    && at != there
                    && base_m >= self.config.base
                    && (known.norm() - base_m).abs() <= off_m
                {
                    found.push(turned_onto(
                        [self.seen[first].at_m, self.seen[second].at_m],
                        [self.known[at].at_m, self.known[there].at_m],
                    ));
                }
            }
        }
        found.into_iter()
    }

    /// Whether as many agree with a place as it takes, or all but one: those are worth a closer look.
    fn is_likely(&self, pose: &PlanarPose) -> bool {
        let square = self.near_m() * self.near_m();
        let most_missed = self.seen.len() + 1 - self.needed.min(self.seen.len() + 1);
        let mut missed = 0;
        for (seen, alike) in self.seen.iter().zip(&self.alike) {
            let (x, y) = pose.apply(seen.at_m.x, seen.at_m.y);
            let place = Vector2::new(x, y);
            let is_near =
                |&known: &usize| (self.known[known].at_m - place).norm_squared() <= square;
            if !alike.iter().any(is_near) {
                missed += 1;
                if missed > most_missed {
                    return false;
                }
            }
        }
        true
    }

    /// Counts what agrees with a place, moves it to where all that agrees says, and counts again.
    fn verify(&self, guess: &PlanarPose) -> Option<Recognised> {
        let pairs = self.agreeing(guess);
        let pose = self.fitted(&pairs)?;
        let pairs = self.agreeing(&pose);
        let map_from_robot = self.fitted(&pairs)?;
        Some(Recognised {
            map_from_robot,
            expected_by_chance: self.expected_by_chance(pairs.len()),
            pairs,
        })
    }

    /// The seen landmarks with the nearest known one that looks alike, no known one twice.
    fn agreeing(&self, pose: &PlanarPose) -> Vec<[usize; 2]> {
        let near_m = self.near_m();
        let mut found: Vec<(f64, [usize; 2])> = Vec::new();
        for (seen, alike) in self.alike.iter().enumerate() {
            let (x, y) = pose.apply(self.seen[seen].at_m.x, self.seen[seen].at_m.y);
            let place = Vector2::new(x, y);
            let each = alike.iter().map(|&known| {
                let off_m = (self.known[known].at_m - place).norm();
                (off_m, [seen, known])
            });
            found.extend(each.filter(|(off_m, _)| *off_m <= near_m));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for (_, pair) in found {
            if pairs
                .iter()
                .all(|other| other[0] != pair[0] && other[1] != pair[1])
            {
                pairs.push(pair);
            }
        }
        pairs
    }

    /// The pose that brings seen landmarks onto known ones with the least squares. None of fewer than two.
    fn fitted(&self, pairs: &[[usize; 2]]) -> Option<PlanarPose> {
        if pairs.len() < 2 {
            return None;
        }
        let count = pairs.len() as f64;
        let seen = |pair: &[usize; 2]| self.seen[pair[0]].at_m;
        let known = |pair: &[usize; 2]| self.known[pair[1]].at_m;
        let from: Vector2<f64> = pairs.iter().map(seen).sum::<Vector2<f64>>() / count;
        let to: Vector2<f64> = pairs.iter().map(known).sum::<Vector2<f64>>() / count;
        let (mut dot, mut cross) = (0.0, 0.0);
        for pair in pairs {
            let (a, b) = (seen(pair) - from, known(pair) - to);
            dot += a.dot(&b);
            cross += a.x * b.y - a.y * b.x;
        }
        Some(placed(from, to, libm::atan2(cross, dot)))
    }

    /// How many of all places that can be tried would have so many agree, were the map's landmarks anywhere: places times the binomial tail, of which
    /// two were needed to have a place at all.
    fn expected_by_chance(&self, agreeing: usize) -> f64 {
        let places: f64 = self.alike.iter().map(|alike| alike.len() as f64).sum();
        let places = 0.5 * places * places;
        let mean = self.by_chance.iter().sum::<f64>() / self.by_chance.len().max(1) as f64;
        let others = self.seen.len().saturating_sub(2);
        places * binomial_tail(others, agreeing.saturating_sub(2), mean)
    }

    fn are_apart(&self, one: &PlanarPose, other: &PlanarPose) -> bool {
        let off = one.inverse().compose(other);
        let [way_m, turn_rad] = self.config.apart;
        geometry::hypot(off.x_m, off.y_m) > way_m || off.yaw_rad.abs() > turn_rad
    }
}

/// The pose of a frame in which two points lie in another where they lie, as nearly as can be.
fn turned_onto(from: [Vector2<f64>; 2], to: [Vector2<f64>; 2]) -> PlanarPose {
    let (a, b) = (from[1] - from[0], to[1] - to[0]);
    let angle = libm::atan2(b.y, b.x) - libm::atan2(a.y, a.x);
    placed(0.5 * (from[0] + from[1]), 0.5 * (to[0] + to[1]), angle)
}

/// The pose with a heading at which a point comes to lie on another.
fn placed(from: Vector2<f64>, to: Vector2<f64>, yaw_rad: f64) -> PlanarPose {
    let (x, y) = PlanarPose::new(0.0, 0.0, yaw_rad).apply(from.x, from.y);
    PlanarPose::new(to.x - x, to.y - y, geometry::wrap_angle(yaw_rad))
}

/// The probability of at least so many successes in so many tries.
fn binomial_tail(tries: usize, least: usize, probability: f64) -> f64 {
    if least == 0 {
        return 1.0;
    }
    if least > tries || probability <= 0.0 {
        return 0.0;
    }
    if probability >= 1.0 {
        return 1.0;
    }
    let odds = probability / (1.0 - probability);
    let mut term = libm::pow(1.0 - probability, tries as f64);
    let mut tail = 0.0;
    for successes in 0..=tries {
        if successes >= least {
            tail += term;
        }
        term *= odds * (tries - successes) as f64 / (successes + 1) as f64;
    }
    tail
}
