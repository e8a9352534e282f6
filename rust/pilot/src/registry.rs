//! What a pilot is made of: its parts by their names, and the stages that every pilot has.

use std::sync::Arc;

use behaviour::{Behaviour, BehaviourNeeds, GivingWay};
use geometry::Pose;
use known_map::{KnownMap, KnownMapConfig};
use localization::{Localizer, LocalizerNeeds};
use mapping::{ChangingConfig, FeltConfig, Overlay, WorldModel, WorldModelNeeds};
use planning::{Planner, PlannerNeeds};
use robot::{Body, Side};
use segmentation::{Segmenter, SegmenterNeeds};
use sensing::Intrinsics;
use settings::{Table, read};
use stairs::{ClimbingConfig, Feet, Recognizer};
use volume::octree::Octree;
use walking::{GaitConfig, Walker, WalkerNeeds};

use crate::step_limits::step_limits;
use crate::{
    BEHAVIOURS, LOCALIZERS, PLANNERS, PilotError, SEGMENTERS, Settings, WALKERS, WORLD_MODELS,
};

/// The six components. One that is `None` is built by its name in the settings.
#[derive(Default)]
pub struct Components {
    /// Finds planes.
    pub segmenter: Option<Box<dyn Segmenter>>,
    /// Keeps the map.
    pub world_model: Option<Box<dyn WorldModel>>,
    /// Keeps the robot's pose.
    pub localizer: Option<Box<dyn Localizer>>,
    /// Finds the way.
    pub planner: Option<Box<dyn Planner>>,
    /// Decides.
    pub behaviour: Option<Box<dyn Behaviour>>,
    /// Moves the legs.
    pub walker: Option<Box<dyn Walker>>,
}

/// All that the parts of a pilot are made of.
#[derive(Clone, Copy)]
pub(crate) struct Making<'a> {
    pub(crate) settings: &'a Settings,
    pub(crate) body: &'a Body,
    pub(crate) feet: Feet,
    pub(crate) camera: Intrinsics,
    pub(crate) known_map: Option<&'a KnownMap>,
}

impl Making<'_> {
    /// A world model with what the feet met and what changes over it.
    pub(crate) fn overlay(&self, model: Box<dyn WorldModel>) -> Result<Overlay, PilotError> {
        let tables = &self.settings.navigation.tables;
        let felt: FeltConfig = read(tables, "felt")?;
        felt.check()?;
        let changing: ChangingConfig = read(tables, "changing")?;
        changing.check()?;
        let height_m = self.body.description().body.height;
        Ok(Overlay::new(model, felt, (changing, height_m)))
    }

    pub(crate) fn giving_way(&self) -> Result<GivingWay, PilotError> {
        let tables = &self.settings.navigation.tables;
        let climbing: ClimbingConfig = read(tables, "climbing")?;
        let size = &self.body.description().body;
        let config = read(tables, "giving_way")?;
        Ok(GivingWay::new(config, size, climbing.levels.same)?)
    }

    pub(crate) fn segmenter(&self) -> Result<Box<dyn Segmenter>, PilotError> {
        let needs = SegmenterNeeds {
            tables: &self.settings.navigation.tables,
            camera: self.camera,
        };
        Ok(SEGMENTERS.find(&self.settings.navigation.segmenter)?(
            &needs,
        )?)
    }

    pub(crate) fn world_model(&self) -> Result<Box<dyn WorldModel>, PilotError> {
        let needs = WorldModelNeeds {
            tables: &self.settings.navigation.tables,
            known_map: self.known_map,
            headroom_m: Some(self.body.description().body.height),
        };
        Ok(WORLD_MODELS.find(&self.settings.navigation.world_model)?(
            &needs,
        )?)
    }

    pub(crate) fn localizer(&self) -> Result<Box<dyn Localizer>, PilotError> {
        let needs = LocalizerNeeds {
            tables: &self.settings.navigation.tables,
            start: self.settings.start.map(Pose::from),
            body: self.body,
            stance_m: self.feet.stance_m,
            known_map: self.known_map,
        };
        Ok(LOCALIZERS.find(&self.settings.navigation.localizer)?(
            &needs,
        )?)
    }

    pub(crate) fn planner(&self) -> Result<Box<dyn Planner>, PilotError> {
        let needs = PlannerNeeds {
            tables: &self.settings.navigation.tables,
            body: self.body,
            feet: self.feet,
            known_map: self.known_map,
        };
        Ok(PLANNERS.find(&self.settings.navigation.planner)?(&needs)?)
    }

    pub(crate) fn behaviour(&self) -> Result<Box<dyn Behaviour>, PilotError> {
        let needs = BehaviourNeeds {
            tables: &self.settings.navigation.tables,
            body: self.body,
            feet: self.feet,
            steps: step_limits(self.body)?,
        };
        Ok(BEHAVIOURS.find(&self.settings.navigation.behaviour)?(
            &needs,
        )?)
    }

    pub(crate) fn walker(&self) -> Result<Box<dyn Walker>, PilotError> {
        let needs = WalkerNeeds {
            tables: &self.settings.navigation.tables,
            body: self.body,
        };
        Ok(WALKERS.find(&self.settings.navigation.walker)?(&needs)?)
    }

    pub(crate) fn recognizer(&self) -> Result<Recognizer, PilotError> {
        let config = read(&self.settings.navigation.tables, "stairs")?;
        Ok(Recognizer::new(config, self.camera)?)
    }
}

/// The map that the robot was told, if any, with what `[navigation.static_map]` says.
pub(crate) fn known_map(
    settings: &Settings,
    told: Option<&Arc<Octree>>,
) -> Result<Option<KnownMap>, PilotError> {
    let config: KnownMapConfig = read(&settings.navigation.tables, "static_map")?;
    config.check()?;
    let made = |tree| KnownMap::new(Arc::clone(tree), config);
    Ok(told.map(made).transpose()?)
}

/// The body's feet, side by side as its gait stands on them.
pub(crate) fn feet(body: &Body, gait: &GaitConfig) -> Feet {
    let legs = &body.description().legs;
    let [left, right] = Side::BOTH.map(|side| &legs.get(side).sole);
    let stance_m = gait.stance_width;
    Feet {
        length_m: left.length.min(right.length),
        pair_width_m: stance_m + 0.5 * (left.width + right.width),
        stance_m,
    }
}
