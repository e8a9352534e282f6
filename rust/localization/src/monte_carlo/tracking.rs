//! Where the robot is, followed from a place that is known.

use nalgebra::Isometry3;

use super::belief::Belief;
use super::config::MonteCarloConfig;
use super::doubt::PlaceDoubt;
use super::filter::Filter;
use super::motion::TorsoMotion;
use super::novelty::Unmapped;
use super::observation::SeenFrame;
use super::particle::Particle;
use super::search::PlaceSearch;
use super::static_map::StaticMap;

/// Guesses around one place, and how well it goes on to fit.
#[derive(Debug, Clone)]
pub(super) struct Tracking {
    config: MonteCarloConfig,
    filter: Filter,
    belief: Option<Belief>,
    doubt: PlaceDoubt,
    unmapped: Unmapped,
}

impl Tracking {
    /// Begins at a pose that is told.
    pub(super) fn from(map_from_torso: &Isometry3<f64>, config: &MonteCarloConfig) -> Self {
        let mut filter = Filter::new(config);
        filter.start_at(map_from_torso);
        Self {
            config: config.clone(),
            filter,
            belief: None,
            doubt: PlaceDoubt::default(),
            unmapped: Unmapped::new(config),
        }
    }

    /// Begins where a search has found the robot.
    pub(super) fn in_place_of(search: PlaceSearch, config: &MonteCarloConfig) -> Self {
        let belief = search.likely().copied();
        let mut filter = search.filter.with(config);
        if let Some(belief) = &belief {
            filter.keep_near(belief);
        }
        Self {
            config: config.clone(),
            filter,
            belief,
            doubt: PlaceDoubt::default(),
            unmapped: Unmapped::new(config),
        }
    }

    /// Moves the guesses, weighs them by what a frame says of what is mapped, and draws anew where few weigh much.
    pub(super) fn update(
        &mut self,
        motion: Option<&TorsoMotion>,
        observation: &mut SeenFrame,
        map: &StaticMap,
        step: u64,
    ) {
        // Who may be elsewhere is to hear everything.
        if !self.is_doubted() {
            let believed = self.filter.some_moved(motion);
            self.unmapped.leave_out(observation, &believed, map);
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
    pub(super) fn outlives(&self, search: &PlaceSearch) -> bool {
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
