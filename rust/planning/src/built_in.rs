//! The planners that come with the crate: A*, plain or along the lines with most room, and with other searches; guided by the known map
//! where there is one.

use settings::{MakeError, Part, TableDescription, read};

use crate::part::{PlannerNeeds, PlannerPart};
use crate::search::ara_star::AraStarConfig;
use crate::search::d_star_lite::DStarLiteConfig;
use crate::search::field_d_star::FieldDStarConfig;
use crate::search::hierarchical::HierarchicalConfig;
use crate::search::voronoi_graph::VoronoiGraphPlannerConfig;
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
    tables: &[
        TableDescription::of::<VoronoiConfig>(),
        TableDescription::of::<AStarConfig>(),
        TableDescription::of::<GuideConfig>(),
    ],
    make: |needs| {
        let along = near(needs)?.along_voronoi(read(needs.tables, "voronoi")?)?;
        guided(along, needs)
    },
};

/// How `d_star_lite` is listed and made.
pub(crate) const D_STAR_LITE: PlannerPart = Part {
    name: "d_star_lite",
    about: "the way of a_star, repaired where cells change; with delayed, Delayed D*",
    source: Some("Koenig and Likhachev 2002; Ferguson and Stentz 2005 (004, refs 36.29 to 36.31)"),
    tables: &[
        TableDescription::of::<DStarLiteConfig>(),
        TableDescription::of::<AStarConfig>(),
        TableDescription::of::<GuideConfig>(),
    ],
    make: |needs| {
        let config = read(needs.tables, "d_star_lite")?;
        guided(near(needs)?.by_d_star_lite(&config)?, needs)
    },
};

/// How `field_d_star` is listed and made.
pub(crate) const FIELD_D_STAR: PlannerPart = Part {
    name: "field_d_star",
    about: "a way that is not bound to eight directions, repaired where cells change",
    source: Some("Ferguson and Stentz 2005 (004, ref 36.30)"),
    tables: &[
        TableDescription::of::<FieldDStarConfig>(),
        TableDescription::of::<AStarConfig>(),
        TableDescription::of::<GuideConfig>(),
    ],
    make: |needs| {
        let config = read(needs.tables, "field_d_star")?;
        guided(near(needs)?.by_field_d_star(&config)?, needs)
    },
};

/// How `ara_star` is listed and made.
pub(crate) const ARA_STAR: PlannerPart = Part {
    name: "ara_star",
    about: "the best way that a budget of expansions allows, and how good it is at least",
    source: Some("Likhachev, Gordon and Thrun 2003 (004, ref 36.31)"),
    tables: &[
        TableDescription::of::<AraStarConfig>(),
        TableDescription::of::<AStarConfig>(),
        TableDescription::of::<GuideConfig>(),
    ],
    make: |needs| {
        let config = read(needs.tables, "ara_star")?;
        guided(near(needs)?.by_ara_star(config)?, needs)
    },
};

/// How `voronoi_graph` is listed and made.
pub(crate) const VORONOI_GRAPH: PlannerPart = Part {
    name: "voronoi_graph",
    about: "to the generalized Voronoi diagram, along it, and from it to the goal",
    source: Some("004, section 36.2.3; Choset and Nagatani 2001 (ref 36.7)"),
    tables: &[
        TableDescription::of::<VoronoiGraphPlannerConfig>(),
        TableDescription::of::<AStarConfig>(),
        TableDescription::of::<GuideConfig>(),
    ],
    make: |needs| {
        let config = read(needs.tables, "voronoi_graph")?;
        guided(near(needs)?.by_voronoi_graph(config)?, needs)
    },
};

/// How `hierarchical` is listed and made.
pub(crate) const HIERARCHICAL: PlannerPart = Part {
    name: "hierarchical",
    about: "coarse to fine: a graph of places over local maps, then A* over those on its way",
    source: Some("004, section 36.3.6; Botea, Müller and Schaeffer 2004"),
    tables: &[
        TableDescription::of::<HierarchicalConfig>(),
        TableDescription::of::<AStarConfig>(),
        TableDescription::of::<GuideConfig>(),
    ],
    make: |needs| {
        let config = read(needs.tables, "hierarchical")?;
        guided(near(needs)?.by_hierarchy(config)?, needs)
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
