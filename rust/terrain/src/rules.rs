//! The rules in the order in which they act: the one place that says what a cell is.
//!
//! Each rule decides one thing and stands in a file of its own, with its settings and its test. A rule sees what those before it made of
//! the [`Terrain`], and changes it for those after it: a new case is a new rule here.

mod by_distance;
mod clearance;
pub mod edge_costs;
pub mod escape;
pub mod far_levels;
mod gaps;
mod height_differences;
mod heights;
pub mod laid_stairs;
mod landing_edges;
mod lone_cells;
mod obstacle_costs;
pub mod obstacles;
pub mod platform_edges;
pub mod shadows;
pub mod slopes;
pub mod stair_cells;
mod steep_slopes;
mod tall_edges;
pub mod voronoi;

use crate::{Sight, Terrain, TerrainConfig};
use voronoi::VoronoiConfig;

/// All rules, in order.
pub const RULES: [Rule; 19] = [
    Rule {
        name: "stair_cells",
        decides: "which cells belong to recognised stairs or lie beside them, and how high those are",
        apply: |rules, terrain, sight| {
            stair_cells::apply(terrain, sight, &rules.config.stair_cells);
        },
    },
    Rule {
        name: "obstacles",
        decides: "what stands there: what is seen, but a riser beside a stair; and what is unknown",
        apply: |rules, terrain, sight| obstacles::apply(terrain, sight, &rules.config.obstacles),
    },
    Rule {
        name: "far_levels",
        decides: "that what looks like a higher level from afar is unknown until it was near",
        apply: |rules, terrain, sight| {
            (rules.far_levels).apply(terrain, sight, &rules.config.far_levels);
        },
    },
    Rule {
        name: "lone_cells",
        decides: "that obstacles of a cell or two are unknown",
        apply: |rules, terrain, _| rules.lone_cells.apply(terrain),
    },
    Rule {
        name: "heights",
        decides: "that floor has a height where it was seen often enough and is not in doubt",
        apply: |_, terrain, sight| heights::apply(terrain, sight),
    },
    Rule {
        name: "laid_stairs",
        decides: "that stairs overwrite heights, but well inside the robot's own level",
        apply: |rules, terrain, sight| {
            (rules.laid_stairs).apply(terrain, sight, &rules.config.laid_stairs);
        },
    },
    Rule {
        name: "slopes",
        decides: "which cells are tilted, and which may be level strips of a slope",
        apply: |rules, terrain, sight| slopes::apply(terrain, sight, &rules.config.slopes),
    },
    Rule {
        name: "gaps",
        decides: "that a single unseen cell has the height of the ground on both sides of it",
        apply: |rules, terrain, _| rules.gaps.apply(terrain),
    },
    Rule {
        name: "landing_edges",
        decides: "that a level of stairs has an edge before unseen ground",
        apply: |rules, terrain, sight| rules.landing_edges.apply(terrain, sight),
    },
    Rule {
        name: "height_differences",
        decides: "that there is an edge between neighbours that differ by more than floor does",
        apply: |_, terrain, _| height_differences::apply(terrain),
    },
    Rule {
        name: "shadows",
        decides: "that there is an edge across a few unseen cells between two levels",
        apply: |rules, terrain, _| shadows::apply(terrain, &rules.config.shadows),
    },
    Rule {
        name: "steep_slopes",
        decides: "that slopes too steep to be walked on are edges",
        apply: |_, terrain, _| steep_slopes::apply(terrain),
    },
    Rule {
        name: "platform_edges",
        decides: "that a raised level under the robot has an edge where nothing was seen beside it",
        apply: |rules, terrain, sight| {
            (rules.platform_edges).apply(terrain, sight, &rules.config.platform_edges);
        },
    },
    Rule {
        name: "tall_edges",
        decides: "that what is higher than a step, and no staircase, is an obstacle",
        apply: |_, terrain, sight| tall_edges::apply(terrain, sight),
    },
    Rule {
        name: "clearance",
        decides: "how far each cell is from obstacles and from edges",
        apply: |_, terrain, _| clearance::apply(terrain),
    },
    Rule {
        name: "obstacle_costs",
        decides: "what a metre costs near to obstacles and in the unknown, and where there is no room",
        apply: |rules, terrain, _| rules.obstacle_costs.apply(terrain),
    },
    Rule {
        name: "voronoi",
        decides: "where users chose it, what a metre costs off the lines with most room",
        apply: |rules, terrain, _| {
            if let Some(field) = &mut rules.voronoi {
                field.apply(terrain);
            }
        },
    },
    Rule {
        name: "edge_costs",
        decides: "what a metre costs near to edges, and that nobody walks on one",
        apply: |rules, terrain, _| rules.edge_costs.apply(terrain, &rules.config.edge_costs),
    },
    Rule {
        name: "escape",
        decides: "that the robot may leave what it already stands too near to",
        apply: |_, terrain, sight| escape::apply(terrain, sight),
    },
];

/// One rule.
#[derive(Debug, Clone, Copy)]
pub struct Rule {
    /// The name of its file and of its table of settings, if it has one.
    pub name: &'static str,
    /// What it decides.
    pub decides: &'static str,
    apply: fn(&mut Rules, &mut Terrain, &Sight<'_>),
}

/// What the rules remember from one view to the next, and their buffers. Reused.
#[derive(Debug, Clone, Default)]
pub struct Rules {
    /// Their settings.
    pub config: TerrainConfig,
    far_levels: far_levels::FarLevels,
    lone_cells: lone_cells::LoneCells,
    laid_stairs: laid_stairs::LaidStairs,
    gaps: gaps::Gaps,
    landing_edges: landing_edges::LandingEdges,
    platform_edges: platform_edges::PlatformEdges,
    obstacle_costs: obstacle_costs::ObstacleCosts,
    voronoi: Option<voronoi::VoronoiField>,
    edge_costs: edge_costs::EdgeCosts,
}

impl Rules {
    /// With the rule `voronoi`.
    pub fn follow_lines(&mut self, config: VoronoiConfig) {
        self.voronoi = Some(voronoi::VoronoiField::new(config));
    }

    /// Reads what is seen into a terrain.
    pub fn read(&mut self, terrain: &mut Terrain, sight: &Sight<'_>) {
        terrain.begin(sight.view);
        for rule in &RULES {
            (rule.apply)(self, terrain, sight);
        }
    }

    /// Reads what is seen by the rules up to and with the one of this name.
    #[cfg(test)]
    pub(crate) fn read_until(&mut self, name: &str, terrain: &mut Terrain, sight: &Sight<'_>) {
        terrain.begin(sight.view);
        let last = RULES.iter().position(|rule| rule.name == name).unwrap();
        for rule in &RULES[..=last] {
            (rule.apply)(self, terrain, sight);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_has_a_name_of_its_own_and_a_file_of_that_name() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/rules");
        for (index, rule) in RULES.iter().enumerate() {
            let file = format!("{folder}/{}.rs", rule.name);
            assert!(std::path::Path::new(&file).exists(), "{file}");
            let others = RULES[index + 1..].iter();
            assert!(others.into_iter().all(|other| other.name != rule.name));
        }
    }
}
