//! The planners that come with the crate: A*, plain or along the lines with most room, guided by the known map where there is one.

use settings::{MakeError, Part, TableDescription, read};

use crate::part::{PlannerNeeds, PlannerPart};
use crate::{AStar, AStarConfig, GuideConfig, Guided, Planner, VoronoiConfig};

/// How `a_star` is listed and made.
pub(crate) const A_STAR: PlannerPart = Part {
    name: "a_star",
    about: "A* on the grid by clearance; levels join by climbs, unknown cells have a price",
    source: Some("002, section III.D; climbs after 003"),
    tables: &[
        TableDescription::of::<AStarConfig>(),
        TableDescription::of::<GuideConfig>(),
    ],
    make: |needs| guided(near(needs)?, needs),
};

/// How `voronoi` is listed and made.
pub(crate) const VORONOI: PlannerPart = Part {
    name: "voronoi",
    about: "A* along the lines with most room to either side",
    source: Some("Dolgov et al. 2008"),
    tables: &[TableDescription::of::<VoronoiConfig>()],
    make: |needs| {
        let along = near(needs)?.along_voronoi(read(needs.tables, "voronoi")?)?;
        guided(along, needs)
    },
};

/// A* as `[navigation.a_star]` and `[navigation.climbing]` describe it, for a body.
fn near(needs: &PlannerNeeds<'_>) -> Result<AStar, MakeError> {
    let size = &needs.body.description().body;
    let (config, climbing) = (
        read(needs.tables, "a_star")?,
        read(needs.tables, "climbing")?,
    );
    let near = AStar::new(config, climbing, needs.feet, size.radius)?;
    let sides = [size.depth, size.width].map(|m| m.unwrap_or(2.0 * size.radius));
    let near = near.with_rules(read(needs.tables, "terrain")?)?;
    Ok(near.with_rectangle(sides))
}

/// The planner that is guided by the known map, where there is one.
fn guided(near: AStar, needs: &PlannerNeeds<'_>) -> Result<Box<dyn Planner>, MakeError> {
    let Some(map) = needs.known_map else {
        return Ok(Box::new(near));
    };
    let height_m = needs.body.description().body.height;
    let config = read(needs.tables, "guide")?;
    Ok(Box::new(Guided::new(near, map, height_m, config)?))
}
