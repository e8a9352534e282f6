//! Which part a name stands for: those of the crates below, each listed in its own crate, and what a crate of the user's adds.

use std::sync::{PoisonError, RwLock};

use behaviour::BehaviourPart;
use localization::LocalizerPart;
use mapping::WorldModelPart;
use planning::PlannerPart;
use segmentation::SegmenterPart;
use settings::{ConfigError, Part};
use walking::WalkerPart;

/// The parts of one slot of `[navigation]`.
#[derive(Debug)]
pub struct Slot<P: 'static> {
    name: &'static str,
    own: &'static [P],
    added: RwLock<Vec<P>>,
}

/// What keeps the map.
pub static WORLD_MODELS: Slot<WorldModelPart> = Slot::new("world_model", mapping::PARTS);
/// What finds planes.
pub static SEGMENTERS: Slot<SegmenterPart> = Slot::new("segmenter", segmentation::PARTS);
/// What keeps the robot's pose.
pub static LOCALIZERS: Slot<LocalizerPart> = Slot::new("localizer", localization::PARTS);
/// What finds the way.
pub static PLANNERS: Slot<PlannerPart> = Slot::new("planner", planning::PARTS);
/// What decides.
pub static BEHAVIOURS: Slot<BehaviourPart> = Slot::new("behaviour", behaviour::PARTS);
/// What moves the legs.
pub static WALKERS: Slot<WalkerPart> = Slot::new("walker", walking::PARTS);

/// What lists show of a part, with its slot's name: all but how it is made.
pub type ListedPart = (&'static str, Part<()>);

impl<M: Copy> Slot<Part<M>> {
    const fn new(name: &'static str, own: &'static [Part<M>]) -> Self {
        Self {
            name,
            own,
            added: RwLock::new(Vec::new()),
        }
    }

    /// Adds a part, for every pilot that is built from now on. It takes the place of one that has its name.
    pub fn add(&self, part: Part<M>) {
        let mut added = self.added.write().unwrap_or_else(PoisonError::into_inner);
        added.retain(|other| other.name != part.name);
        added.push(part);
    }

    /// All parts that a name can stand for, the core's own first.
    fn parts(&self) -> Vec<Part<M>> {
        let added = self.added.read().unwrap_or_else(PoisonError::into_inner);
        let stays = |one: &&Part<M>| added.iter().all(|other| other.name != one.name);
        let own = self.own.iter().filter(stays);
        own.chain(added.iter()).copied().collect()
    }

    /// What makes the part of a name.
    pub fn find(&self, name: &str) -> Result<M, ConfigError> {
        let parts = self.parts();
        let found = parts.iter().find(|part| part.name == name);
        found.map(|part| part.make).ok_or_else(|| {
            let names: Vec<_> = parts.iter().map(|part| part.name).collect();
            ConfigError {
                key: format!("navigation.{}", self.name),
                allowed: format!("one of {}", names.join(", ")),
                found: name.to_owned(),
            }
        })
    }

    fn listed(&self) -> impl Iterator<Item = ListedPart> {
        self.parts().into_iter().map(|part| {
            let listed = Part {
                name: part.name,
                about: part.about,
                source: part.source,
                tables: part.tables,
                make: (),
            };
            (self.name, listed)
        })
    }
}

/// All parts that a name can stand for, slot by slot.
pub fn components() -> Vec<ListedPart> {
    (WORLD_MODELS.listed())
        .chain(SEGMENTERS.listed())
        .chain(LOCALIZERS.listed())
        .chain(PLANNERS.listed())
        .chain(BEHAVIOURS.listed())
        .chain(WALKERS.listed())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use planning::{Planner, PlannerNeeds};
    use settings::MakeError;

    fn refusing(_: &PlannerNeeds<'_>) -> Result<Box<dyn Planner>, MakeError> {
        Err(MakeError::Text("not today".to_owned()))
    }

    #[test]
    fn what_is_added_twice_is_there_once_and_a_slot_each() {
        let part = |about| PlannerPart {
            name: "of_a_test",
            about,
            source: None,
            tables: &[],
            make: refusing,
        };
        PLANNERS.add(part("first"));
        PLANNERS.add(part("second"));
        let found: Vec<_> = components()
            .iter()
            .filter(|(_, one)| one.name == "of_a_test")
            .map(|(slot, one)| (*slot, one.about))
            .collect();
        assert_eq!(found, [("planner", "second")]);
    }

    #[test]
    fn a_name_that_stands_for_nothing_is_refused_with_those_that_do() {
        let error = SEGMENTERS.find("scan_lin").err().unwrap().to_string();
        let begin = "navigation.segmenter must be one of scan_line, scan_line_1994, ";
        assert!(error.starts_with(begin), "{error}");
    }
}
