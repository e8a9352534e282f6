//! Where else the robot may be: guesses everywhere, until one place explains all that is seen in many directions.
//!
//! A place that looks alike (a level that is the same after half a turn) explains some frames as well as the true one. So a search
//! never settles by one view: its best cluster has to stay the best while the camera looks all around.

use super::beams::Beams;
use super::belief::Belief;
use super::config::MonteCarloConfig;
use super::directions::Directions;
use super::filter::Filter;
use super::motion::{BodyReading, TorsoMotion};
use super::observation::SeenFrame;
use super::particle::Particle;
use super::static_map::StaticMap;

/// What the seed of a search differs by from that of the tracking beside it: any bits would do.
const OTHER_SEED: u64 = 0x5EA2_C4E5;
/// How much of a frame is new since another one: what is seen again from the same place errs alike, and proves nothing.
pub(super) fn news(before: &BodyReading, now: &BodyReading, config: &MonteCarloConfig) -> f64 {
    let (travelled_m, turned_rad) = now.seen_since(before);
    let [way_m, turn_rad] = config.news_after;
    (travelled_m / way_m + turned_rad / turn_rad).clamp(config.tuning.search.least_news, 1.0)
}

/// A global localization under way.
#[derive(Debug, Clone)]
pub(super) struct PlaceSearch {
    pub(super) filter: Filter,
    config: MonteCarloConfig,
    /// The frame, blurred.
    blurred: SeenFrame,
    frames: u32,
    best: Option<Belief>,
    /// By how much more of what stands on the ground the best place explains than the one that is believed, if any is: since it
    /// became the best.
    advantage: Directions,
}

impl PlaceSearch {
    /// Begins at this step of the localizer.
    pub(super) fn anywhere(
        config: &MonteCarloConfig,
        map: &StaticMap,
        reading: &BodyReading,
        step: u64,
    ) -> Self {
        let config = MonteCarloConfig {
            seed: config.seed ^ OTHER_SEED,
            ..config.clone()
        };
        let directions = config.tuning.search.directions;
        let mut filter = Filter::new(&config);
        filter.start_anywhere(map, reading, step);
        Self {
            filter,
            config,
            blurred: SeenFrame::default(),
            frames: 0,
            best: None,
            advantage: Directions::new(directions),
        }
    }

    /// Moves and weighs the guesses, draws some of them anywhere, and compares the best place with the one that is believed.
    pub(super) fn update(
        &mut self,
        (motion, news): (Option<&TorsoMotion>, f64),
        (observation, beams, reading): (&SeenFrame, &Beams, &BodyReading),
        (map, believed): (&StaticMap, Option<&Belief>),
        step: u64,
    ) {
        self.frames += 1;
        let blur_m = self.config.search_blur;
        (self.blurred).set((beams, blur_m), reading, map, &self.config);
        let found = (self.filter).update(motion, (&self.blurred, news), map, step);
        let stays = |found: &Belief| {
            let before = self.best.as_ref();
            found.share >= self.config.least_share
                && before.is_some_and(|before| found.goes_on(before, motion, self.config.cluster))
        };
        if !found.as_ref().is_some_and(stays) {
            self.advantage = Directions::new(self.config.tuning.search.directions);
        }
        self.best = found;
        self.filter.resample_widely((map, reading), believed, step);
        let explains = |belief: &Belief| Some(observation.fit(&belief.torso, map)?.strict());
        if let Some(explained) = found.as_ref().and_then(explains) {
            let before = believed.and_then(explains).unwrap_or(0.0);
            let heading_rad = reading.heading_of_camera_rad();
            self.advantage.add(heading_rad, explained - before);
        }
    }

    /// The best place so far, however sure.
    pub(super) const fn best(&self) -> Option<&Belief> {
        self.best.as_ref()
    }

    /// The best place so far, where it is more than a guess.
    pub(super) fn likely(&self) -> Option<&Belief> {
        (self.best.as_ref()).filter(|best| best.share >= self.config.least_share)
    }

    /// Whether the best place is so much better in several directions that what is believed is not to be acted on.
    pub(super) fn is_contest(&self) -> bool {
        self.is_better() && self.advantage.count() >= self.config.tuning.search.contest
    }

    /// Whether it has gone on for so long that nothing is to be expected of it.
    pub(super) const fn is_spent(&self) -> bool {
        self.frames > self.config.tuning.search.frames
    }

    /// Whether the best place explains clearly more than the one that is believed.
    pub(super) fn is_better(&self) -> bool {
        self.likely().is_some() && self.advantage.mean() > self.config.search_better
    }

    /// Whether the best place has been compared in so many directions that nothing more is to be learned.
    pub(super) fn is_thorough(&self) -> bool {
        self.likely().is_some() && self.advantage.count() >= self.config.confirm_directions
    }

    pub(super) fn particles(&self) -> impl Iterator<Item = &Particle> {
        self.filter.particles.iter()
    }
}
