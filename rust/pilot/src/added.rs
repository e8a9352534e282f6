//! Components that a crate of the user's adds: from then on they have a name, like those of the registry.

use std::sync::{Arc, PoisonError, RwLock};

use behaviour::Behaviour;
use known_map::KnownMap;
use localization::Localizer;
use mapping::WorldModel;
use planning::Planner;
use robot::Body;
use segmentation::Segmenter;
use sensing::Intrinsics;
use serde::Serialize;
use serde::de::DeserializeOwned;
use stairs::Feet;

use crate::registry::table;
use crate::{Components, PilotError, Settings};

/// What a component can be made of.
#[derive(Clone, Copy)]
pub struct Making<'a> {
    /// Everything that the core is told at the start.
    pub settings: &'a Settings,
    /// The robot's body.
    pub body: &'a Body,
    /// Its feet, side by side as the walker stands on them.
    pub feet: Feet,
    /// The camera of the scans.
    pub camera: Intrinsics,
    /// What is known of the place beforehand.
    pub static_map: Option<&'a Arc<KnownMap>>,
}

impl Making<'_> {
    /// What the table `[navigation.<name>]` says, over the defaults.
    pub fn parameters<T: DeserializeOwned + Serialize + Default>(
        &self,
        name: &str,
    ) -> Result<T, PilotError> {
        table(&self.settings.navigation.tables, name)
    }
}

/// Makes a component.
pub type Make<T> = fn(&Making<'_>) -> Result<Box<T>, PilotError>;

/// Makes a component of a slot.
#[derive(Clone, Copy)]
pub enum Maker {
    /// Of what finds planes.
    Segmenter(Make<dyn Segmenter>),
    /// Of what keeps the map.
    WorldModel(Make<dyn WorldModel>),
    /// Of what keeps the robot's pose.
    Localizer(Make<dyn Localizer>),
    /// Of what finds the way.
    Planner(Make<dyn Planner>),
    /// Of what decides.
    Behaviour(Make<dyn Behaviour>),
}

impl Maker {
    /// The slot's name in `[navigation]`.
    pub const fn slot(&self) -> &'static str {
        match self {
            Self::Segmenter(_) => "segmenter",
            Self::WorldModel(_) => "world_model",
            Self::Localizer(_) => "localizer",
            Self::Planner(_) => "planner",
            Self::Behaviour(_) => "behaviour",
        }
    }
}

/// A component that was added.
#[derive(Clone, Copy)]
pub struct Added {
    /// What `[navigation]` calls it, and its table of parameters.
    pub name: &'static str,
    /// One line for `treadwell list components`.
    pub about: &'static str,
    /// How it is made.
    pub maker: Maker,
}

static ADDED: RwLock<Vec<Added>> = RwLock::new(Vec::new());

/// Adds a component, for every pilot that is built from now on. One of the same slot and name takes the place of the one before.
pub fn add(component: Added) {
    let mut all = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    let slot = component.maker.slot();
    all.retain(|other| (other.maker.slot(), other.name) != (slot, component.name));
    all.push(component);
}

/// What was added so far.
pub fn added() -> Vec<Added> {
    ADDED.read().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Makes those added components that the settings name and that were not given.
pub(crate) fn fill(given: &mut Components, making: &Making<'_>) -> Result<(), PilotError> {
    let names = &making.settings.navigation;
    for Added { name, maker, .. } in added() {
        match maker {
            Maker::Segmenter(make) if given.segmenter.is_none() && names.segmenter == name => {
                given.segmenter = Some(make(making)?);
            }
            Maker::WorldModel(make) if given.world_model.is_none() && names.world_model == name => {
                given.world_model = Some(make(making)?);
            }
            Maker::Localizer(make) if given.localizer.is_none() && names.localizer == name => {
                given.localizer = Some(make(making)?);
            }
            Maker::Planner(make) if given.planner.is_none() && names.planner == name => {
                given.planner = Some(make(making)?);
            }
            Maker::Behaviour(make) if given.behaviour.is_none() && names.behaviour == name => {
                given.behaviour = Some(make(making)?);
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusing(_: &Making<'_>) -> Result<Box<dyn Planner>, PilotError> {
        Err(PilotError::Settings("not today".to_owned()))
    }

    #[test]
    fn what_is_added_twice_is_there_once_and_a_slot_each() {
        let component = |about| Added {
            name: "of_a_test",
            about,
            maker: Maker::Planner(refusing),
        };
        add(component("first"));
        add(component("second"));
        let found: Vec<_> = added()
            .into_iter()
            .filter(|one| one.name == "of_a_test")
            .map(|one| (one.maker.slot(), one.about))
            .collect();
        assert_eq!(found, [("planner", "second")]);
    }
}
