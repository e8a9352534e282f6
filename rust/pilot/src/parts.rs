//! Which part a name stands for: those of the crates below, each listed in its own crate, and what a crate of the user's adds.

use std::sync::{PoisonError, RwLock};

use behaviour::{Behaviour, BehaviourNeeds, BehaviourPart};
use localization::{Localizer, LocalizerNeeds, LocalizerPart};
use mapping::{WorldModel, WorldModelNeeds, WorldModelPart};
use planning::{Planner, PlannerNeeds, PlannerPart};
use segmentation::{Segmenter, SegmenterNeeds, SegmenterPart};
use settings::{ConfigError, Part, TableDescription};

use crate::PilotError;

/// A part of any slot.
#[derive(Clone, Copy)]
pub enum Component {
    /// What finds planes.
    Segmenter(SegmenterPart),
    /// What keeps the map.
    WorldModel(WorldModelPart),
    /// What keeps the robot's pose.
    Localizer(LocalizerPart),
    /// What finds the way.
    Planner(PlannerPart),
    /// What decides.
    Behaviour(BehaviourPart),
}

/// What lists show of a part.
#[derive(Debug, Clone, Copy)]
pub struct ListedPart {
    /// The slot's name in `[navigation]`.
    pub slot: &'static str,
    /// What `[navigation]` calls the part.
    pub name: &'static str,
    /// One line on it.
    pub about: &'static str,
    /// The paper that it is of, where there is one.
    pub source: Option<&'static str>,
    /// Its tables of settings.
    pub tables: &'static [TableDescription],
}

impl Component {
    /// What lists show of it.
    pub const fn listed(&self) -> ListedPart {
        match self {
            Self::WorldModel(part) => listed("world_model", part),
            Self::Segmenter(part) => listed("segmenter", part),
            Self::Localizer(part) => listed("localizer", part),
            Self::Planner(part) => listed("planner", part),
            Self::Behaviour(part) => listed("behaviour", part),
        }
    }
}

const fn listed<M>(slot: &'static str, part: &Part<M>) -> ListedPart {
    ListedPart {
        slot,
        name: part.name,
        about: part.about,
        source: part.source,
        tables: part.tables,
    }
}

static ADDED: RwLock<Vec<Component>> = RwLock::new(Vec::new());

/// Adds a part, for every pilot that is built from now on. It takes the place of one of its slot that has its name.
pub fn add(component: Component) {
    let key = |one: &Component| (one.listed().slot, one.listed().name);
    let mut all = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    all.retain(|other| key(other) != key(&component));
    all.push(component);
}

/// All that was added so far.
pub fn added() -> Vec<Component> {
    ADDED.read().unwrap_or_else(PoisonError::into_inner).clone()
}

/// All parts that a name can stand for, the core's own first.
pub fn components() -> Vec<Component> {
    let own = (mapping::PARTS.iter().copied().map(Component::WorldModel))
        .chain(
            segmentation::finders::PARTS
                .iter()
                .copied()
                .map(Component::Segmenter),
        )
        .chain(
            localization::PARTS
                .iter()
                .copied()
                .map(Component::Localizer),
        )
        .chain(planning::PARTS.iter().copied().map(Component::Planner))
        .chain(behaviour::PARTS.iter().copied().map(Component::Behaviour));
    let added = added();
    let key = |one: &Component| (one.listed().slot, one.listed().name);
    let kept = own.filter(|one| !added.iter().any(|other| key(other) == key(one)));
    kept.collect::<Vec<_>>()
        .into_iter()
        .chain(added.clone())
        .collect()
}

/// The part of a slot that has a name.
fn find<M>(
    slot: &str,
    name: &str,
    of: impl Fn(Component) -> Option<Part<M>>,
) -> Result<Part<M>, PilotError> {
    let parts: Vec<_> = components().into_iter().filter_map(of).collect();
    let names: Vec<_> = parts.iter().map(|part| part.name).collect();
    let allowed = format!("one of {}", names.join(", "));
    parts
        .into_iter()
        .find(|part| part.name == name)
        .ok_or_else(|| {
            ConfigError {
                key: format!("navigation.{slot}"),
                allowed,
                found: name.to_owned(),
            }
            .into()
        })
}

/// Makes the segmenter of a name.
pub fn segmenter(name: &str, needs: &SegmenterNeeds<'_>) -> Result<Box<dyn Segmenter>, PilotError> {
    let part = find("segmenter", name, |one| match one {
        Component::Segmenter(part) => Some(part),
        _ => None,
    })?;
    Ok((part.make)(needs)?)
}

/// Makes the world model of a name.
pub fn world_model(
    name: &str,
    needs: &WorldModelNeeds<'_>,
) -> Result<Box<dyn WorldModel>, PilotError> {
    let part = find("world_model", name, |one| match one {
        Component::WorldModel(part) => Some(part),
        _ => None,
    })?;
    Ok((part.make)(needs)?)
}

/// Makes the localizer of a name.
pub fn localizer(name: &str, needs: &LocalizerNeeds<'_>) -> Result<Box<dyn Localizer>, PilotError> {
    let part = find("localizer", name, |one| match one {
        Component::Localizer(part) => Some(part),
        _ => None,
    })?;
    Ok((part.make)(needs)?)
}

/// Makes the planner of a name.
pub fn planner(name: &str, needs: &PlannerNeeds<'_>) -> Result<Box<dyn Planner>, PilotError> {
    let part = find("planner", name, |one| match one {
        Component::Planner(part) => Some(part),
        _ => None,
    })?;
    Ok((part.make)(needs)?)
}

/// Makes the behaviour of a name.
pub fn behaviour(name: &str, needs: &BehaviourNeeds<'_>) -> Result<Box<dyn Behaviour>, PilotError> {
    let part = find("behaviour", name, |one| match one {
        Component::Behaviour(part) => Some(part),
        _ => None,
    })?;
    Ok((part.make)(needs)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use settings::MakeError;

    fn refusing(_: &PlannerNeeds<'_>) -> Result<Box<dyn Planner>, MakeError> {
        Err(MakeError::Text("not today".to_owned()))
    }

    #[test]
    fn what_is_added_twice_is_there_once_and_a_slot_each() {
        let component = |about| {
            Component::Planner(Part {
                name: "of_a_test",
                about,
                source: None,
                tables: &[],
                make: refusing,
            })
        };
        add(component("first"));
        add(component("second"));
        let found: Vec<_> = components()
            .iter()
            .map(Component::listed)
            .filter(|one| one.name == "of_a_test")
            .map(|one| (one.slot, one.about))
            .collect();
        assert_eq!(found, [("planner", "second")]);
    }

    #[test]
    fn a_name_that_stands_for_nothing_is_refused_with_those_that_do() {
        let camera = sensing::Intrinsics {
            width: 8,
            height: 8,
            focal_px: 10.0,
            baseline_m: 0.06,
        };
        let tables = settings::Tables::new();
        let needs = SegmenterNeeds {
            tables: &tables,
            camera,
        };
        let error = segmenter("scan_lin", &needs).err().unwrap().to_string();
        let begin = "navigation.segmenter must be one of scan_line, scan_line_1994, ";
        assert!(error.starts_with(begin), "{error}");
    }
}
