//! Which component a name stands for: the one place where a new one is added.

use std::sync::Arc;

use behaviour::{Behaviour, Pace, StairClimbing, WalkingBehaviour};
use geometry::Pose;
use known_map::{KnownMap, KnownMapConfig};
use localization::{
    Localizer, MatchingLocalizer, MonteCarloConfig, MonteCarloLocalizer, OdometryLocalizer,
    StaticMap,
};
use mapping::{Averaging, Fog, TwoMaps, WorldModel};
use planning::{AStar, Guided, Planner};
use robot::{Body, Description, Side};
use segmentation::{Histogram, Hough, Ransac, ScanLine, ScanLine1994, ScanLineAdaptive, Segmenter};
use sensing::Intrinsics;
use serde::Serialize;
use serde::de::DeserializeOwned;
use settings::{ConfigError, Table, Tables};
use stairs::{Feet, Recognizer};
use volume::octree::Octree;
use walking::Walker;

use crate::{PilotError, Settings};

/// The five components. One that is `None` is built by its name in the settings.
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
}

/// Reads the table `[navigation.<name>]`, over the defaults.
pub(crate) fn table<T: DeserializeOwned + Serialize + Default>(
    tables: &Tables,
    name: &str,
) -> Result<T, PilotError> {
    Ok(settings::read(tables, name)?)
}

fn unknown(slot: &str, name: &str, known: &str) -> PilotError {
    ConfigError {
        key: format!("navigation.{slot}"),
        allowed: format!("one of {known}"),
        found: name.to_owned(),
    }
    .into()
}

/// The segmenter of a name, for a camera, with what `[navigation.<name>]` and `[navigation.ground]` say.
pub fn segmenter(
    name: &str,
    tables: &Tables,
    camera: Intrinsics,
) -> Result<Box<dyn Segmenter>, PilotError> {
    let ground = table(tables, "ground")?;
    match name {
        name @ "scan_line" => Ok(Box::new(ScanLine::new(
            &table(tables, name)?,
            ground,
            camera,
        )?)),
        name @ "scan_line_1994" => Ok(Box::new(ScanLine1994::new(
            &table(tables, name)?,
            ground,
            camera,
        )?)),
        name @ "scan_line_adaptive" => Ok(Box::new(ScanLineAdaptive::new(
            &table(tables, name)?,
            ground,
            camera,
        )?)),
        name @ "hough" => Ok(Box::new(Hough::new(&table(tables, name)?, ground, camera)?)),
        name @ "ransac" => Ok(Box::new(Ransac::new(
            &table(tables, name)?,
            ground,
            camera,
        )?)),
        name @ "histogram" => Ok(Box::new(Histogram::new(
            &table(tables, name)?,
            ground,
            camera,
        )?)),
        other => Err(unknown(
            "segmenter",
            other,
            "scan_line, scan_line_1994, scan_line_adaptive, hough, ransac, histogram",
        )),
    }
}

/// The map that the robot was told, if any, with what `[navigation.static_map]` says.
pub(crate) fn known_map(
    tables: &Tables,
    told: Option<&Arc<Octree>>,
) -> Result<Option<Arc<KnownMap>>, PilotError> {
    let config: KnownMapConfig = table(tables, "static_map")?;
    config.check()?;
    let made = |tree| KnownMap::new(Arc::clone(tree), config).map(Arc::new);
    Ok(told.map(made).transpose()?)
}

/// The world model of a name, with what `[navigation.<name>]` says, and the map that the robot was told, if any.
pub fn world_model(
    name: &str,
    tables: &Tables,
    static_map: Option<&KnownMap>,
) -> Result<Box<dyn WorldModel>, PilotError> {
    match name {
        "fog" => Ok(Box::new(Fog::new(table(tables, "fog")?)?)),
        "averaging" => Ok(Box::new(Averaging::new(table(tables, "averaging")?)?)),
        name @ "octree" => Ok(Box::new(TwoMaps::new(
            table(tables, name)?,
            &table(tables, "fog")?,
            static_map,
        )?)),
        other => Err(unknown("world_model", other, "fog, averaging, octree")),
    }
}

pub(crate) fn recognizer(
    settings: &Settings,
    camera: Intrinsics,
) -> Result<Recognizer, PilotError> {
    let config = table(&settings.navigation.tables, "stairs")?;
    Ok(Recognizer::new(config, camera)?)
}

pub(crate) fn localizer(
    settings: &Settings,
    static_map: Option<&KnownMap>,
) -> Result<Box<dyn Localizer>, PilotError> {
    let tables = &settings.navigation.tables;
    let start = settings.start_or_origin();
    match settings.navigation.localizer.as_str() {
        "odometry" => Ok(Box::new(OdometryLocalizer::new(
            start,
            table(tables, "odometry")?,
        )?)),
        "matching" => Ok(Box::new(MatchingLocalizer::new(
            start,
            table(tables, "odometry")?,
            table(tables, "matching")?,
        )?)),
        "monte_carlo" => {
            let config: MonteCarloConfig = table(tables, "monte_carlo")?;
            let told = static_map.ok_or_else(|| {
                PilotError::Settings(
                    "navigation.localizer: monte_carlo has to be told a static map".to_owned(),
                )
            })?;
            let map = Arc::new(StaticMap::new(told, &config)?);
            let start = settings.start.map(Pose::from);
            Ok(Box::new(MonteCarloLocalizer::new(map, start, config)?))
        }
        other => Err(unknown(
            "localizer",
            other,
            "odometry, matching, monte_carlo",
        )),
    }
}

pub(crate) fn planner(
    settings: &Settings,
    static_map: Option<&KnownMap>,
    body: &Body,
    feet: Feet,
) -> Result<Box<dyn Planner>, PilotError> {
    let tables = &settings.navigation.tables;
    let size = &body.description().body;
    let a_star = || {
        let (config, climbing) = (table(tables, "a_star")?, table(tables, "climbing")?);
        let near = AStar::new(config, climbing, feet, size.radius)?;
        let sides = [size.depth, size.width].map(|m| m.unwrap_or(2.0 * size.radius));
        Ok::<_, PilotError>(near.with_rectangle(sides))
    };
    let near = match settings.navigation.planner.as_str() {
        "a_star" => a_star()?,
        "voronoi" => a_star()?.along_voronoi(table(tables, "voronoi")?)?,
        other => return Err(unknown("planner", other, "a_star, voronoi")),
    };
    Ok(match static_map {
        Some(map) => Box::new(Guided::new(
            near,
            map,
            size.height,
            table(tables, "guide")?,
        )?),
        None => Box::new(near),
    })
}

/// The body's feet, side by side as the walker stands on them.
pub(crate) fn feet(body: &Body, walker: &Walker) -> Feet {
    let legs = &body.description().legs;
    let [left, right] = Side::BOTH.map(|side| &legs.get(side).sole);
    let stance_m = walker.stance_width_m();
    Feet {
        length_m: left.length.min(right.length),
        pair_width_m: stance_m + 0.5 * (left.width + right.width),
        stance_m,
    }
}

pub(crate) fn behaviour(
    settings: &Settings,
    body: &Description,
    feet: Feet,
) -> Result<Box<dyn Behaviour>, PilotError> {
    let tables = &settings.navigation.tables;
    let walking = || -> Result<_, PilotError> {
        Ok(WalkingBehaviour::new(
            table(tables, "walking")?,
            &body.body,
        )?)
    };
    let climbing = |name, pace| {
        StairClimbing::new(
            table(tables, name)?,
            walking()?,
            table(tables, "climbing")?,
            feet,
            &body.head,
            pace,
        )
        .map_err(PilotError::from)
    };
    match settings.navigation.behaviour.as_str() {
        name @ "stair_climbing" => Ok(Box::new(climbing(name, Pace::StepByStep)?)),
        name @ "continuous" => Ok(Box::new(climbing(name, Pace::Continuous)?)),
        "walking" => Ok(Box::new(walking()?)),
        other => Err(unknown(
            "behaviour",
            other,
            "stair_climbing, continuous, walking",
        )),
    }
}
