//! Where the robot is, followed from a place that is known.

use nalgebra::Isometry3;

use super::MonteCarloConfig;
use super::belief::Belief;
use super::doubt::Doubt;
use super::filter::Filter;
use super::motion::Motion;
use super::observation::Observation;
use super::particle::Particle;
use super::search::Search;
use super::static_map::StaticMap;

/// Guesses around one place, and how well it goes on to fit.
#[derive(Debug, Clone)]
pub(super) struct Tracking {
    config: MonteCarloConfig,
    filter: Filter,
    belief: Option<Belief>,
    doubt: Doubt,
}

impl Tracking {
    /// From a pose that is told.
    pub(super) fn from(map_from_torso: &Isometry3<f64>, config: &MonteCarloConfig) -> Self {
        let mut filter = Filter::new(config);
        filter.start_at(map_from_torso);
        Self {
            config: config.clone(),
            filter,
            belief: None,
            doubt: Doubt::default(),
        }
    }

    /// From where a search has found the robot.
    pub(super) fn in_place_of(search: Search, config: &MonteCarloConfig) -> Self {
        let belief = search.likely().copied();
        let mut filter = search.filter.with(config);
        if let Some(belief) = &belief {
            filter.keep_near(belief);
        }
        Self {
            config: config.clone(),
            filter,
            belief,
            doubt: Doubt::default(),
        }
    }

    /// Moves the guesses, weighs them by what a frame says of what is mapped, and draws anew where few weigh much.
    pub(super) fn update(
        &mut self,
        motion: Option<&Motion>,
        observation: &mut Observation,
        map: &StaticMap,
        step: u64,
    ) {
        // Who may be elsewhere is to hear everything.
        if !self.is_doubted() {
            observation.leave_out_unmapped(&self.filter.some_moved(motion), map);
        }
        self.belief = (self.filter).update(motion, (observation, 1.0), map, step);
        self.filter.resample(step);
        let fit = (self.belief.as_ref()).and_then(|belief| observation.fit(&belief.torso, map));
        if let Some(fit) = fit {
            self.doubt.update(fit, &self.config);
        }
    }

    pub(super) const fn belief(&self) -> Option<&Belief> {
        self.belief.as_ref()
    }

    pub(super) fn particles(&self) -> impl Iterator<Item = &Particle> {
        self.filter.particles.iter()
    }

    /// The share of what stands on the ground that is where the map has it, lately.
    pub(super) fn explained(&self) -> f64 {
        self.doubt.explained()
    }

    /// Whether it is worth looking elsewhere.
    pub(super) fn is_doubted(&self) -> bool {
        self.is_lost() || self.explained() < self.config.search_below
    }

    /// Whether a search that is no better has nothing more to tell: it came to the same place, or has looked all around.
    pub(super) fn outlives(&self, search: &Search) -> bool {
        let same = |best: &Belief| {
            let here = self.belief.as_ref();
            here.is_some_and(|here| best.holds(&here.torso, self.config.cluster))
        };
        let agree = search.likely().is_some_and(same);
        !self.is_doubted() && (agree || search.is_thorough() || search.is_spent())
    }

    /// Whether the robot is not to act on what is believed.
    pub(super) fn is_lost(&self) -> bool {
        let vague = self.belief.as_ref().is_some_and(|belief| {
            belief.share < self.config.least_share || belief.spread_m() > self.config.most_spread
        });
        vague || self.doubt.is_lost(&self.config)
    }
}
