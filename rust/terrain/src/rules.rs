//! The rules in the order in which they act: the one place that says what a cell is.
//!
//! Each rule decides one thing and stands in a file of its own, with its settings and its test. A rule sees what those before it made of
//! the [`Terrain`], and changes it for those after it: a new case is a new rule here.

mod by_distance;
mod clearance;
pub(crate) mod config;
pub mod edge_costs;
pub mod escape;
pub mod far_levels;
pub mod felt;
mod gaps;
pub mod head_room;
mod height_differences;
mod heights;
pub mod laid_stairs;
mod landing_edges;
mod lone_cells;
mod name;
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
pub use name::RuleName;
use voronoi::VoronoiConfig;

/// All rules, in order.
pub const RULES: [Rule; 21] = [
    // Decides which cells belong to recognised stairs or lie beside them, and how high those are.
    Rule {
        name: RuleName::StairCells,
        apply: |rules, terrain, sight| {
            stair_cells::apply(terrain, sight, &rules.config.stair_cells);
        },
    },
    // Decides what stands there: what is seen, but a riser beside a stair; and what is unknown.
    Rule {
        name: RuleName::Obstacles,
        apply: |rules, terrain, sight| obstacles::apply(terrain, sight, &rules.config.obstacles),
    },
    // Decides which cells are tilted, and which may be level strips of a slope.
    Rule {
        name: RuleName::Slopes,
        apply: |rules, terrain, sight| slopes::apply(terrain, sight, &rules.config.slopes),
    },
    // Decides that what looks like a higher level from afar is unknown until it was near.
    Rule {
        name: RuleName::FarLevels,
        apply: |rules, terrain, sight| {
            (rules.far_levels).apply(terrain, sight, &rules.config.far_levels);
        },
    },
    // Decides that obstacles of a cell or two are unknown.
    Rule {
        name: RuleName::LoneCells,
        apply: |rules, terrain, _| rules.lone_cells.apply(terrain),
    },
    // Decides that floor has a height where it was seen often enough and is not in doubt.
    Rule {
        name: RuleName::Heights,
        apply: |_, terrain, sight| heights::apply(terrain, sight),
    },
    // Decides that stairs overwrite heights, but well inside the robot's own level.
    Rule {
        name: RuleName::LaidStairs,
        apply: |rules, terrain, sight| {
            (rules.laid_stairs).apply(terrain, sight, &rules.config.laid_stairs);
        },
    },
    // Decides that a single unseen cell has the height of the ground on both sides of it.
    Rule {
        name: RuleName::Gaps,
        apply: |rules, terrain, _| rules.gaps.apply(terrain),
    },
    // Decides that a level of stairs has an edge before unseen ground.
    Rule {
        name: RuleName::LandingEdges,
        apply: |rules, terrain, sight| rules.landing_edges.apply(terrain, sight),
    },
    // Decides that there is an edge between neighbours that differ by more than floor does.
    Rule {
        name: RuleName::HeightDifferences,
        apply: |_, terrain, _| height_differences::apply(terrain),
    },
    // Decides that there is an edge across a few unseen cells between two levels.
    Rule {
        name: RuleName::Shadows,
        apply: |rules, terrain, _| shadows::apply(terrain, &rules.config.shadows),
    },
    // Decides that slopes too steep to be walked on are edges.
    Rule {
        name: RuleName::SteepSlopes,
        apply: |_, terrain, _| steep_slopes::apply(terrain),
    },
    // Decides that a raised level under the robot has an edge where nothing was seen beside it.
    Rule {
        name: RuleName::PlatformEdges,
        apply: |rules, terrain, sight| {
            (rules.platform_edges).apply(terrain, sight, &rules.config.platform_edges);
        },
    },
    // Decides that what is higher than a step, and no staircase, is an obstacle.
    Rule {
        name: RuleName::TallEdges,
        apply: |_, terrain, sight| tall_edges::apply(terrain, sight),
    },
    // Decides that what a foot met stands there, until something as high is seen there.
    Rule {
        name: RuleName::Felt,
        apply: |rules, terrain, sight| rules.felt.apply(terrain, sight, &rules.config.felt),
    },
    // Decides how far each cell is from obstacles and from edges.
    Rule {
        name: RuleName::Clearance,
        apply: |rules, terrain, _| clearance::apply(terrain, &rules.config.edge_costs),
    },
    // Decides what a metre costs near to obstacles and in the unknown, and where there is no room.
    Rule {
        name: RuleName::ObstacleCosts,
        apply: |rules, terrain, _| rules.obstacle_costs.apply(terrain),
    },
    // Decides what a metre costs where the room for the head was not seen.
    Rule {
        name: RuleName::HeadRoom,
        apply: |rules, terrain, sight| head_room::apply(terrain, sight, &rules.config.head_room),
    },
    // Decides where users chose it, what a metre costs off the lines with most room.
    Rule {
        name: RuleName::Voronoi,
        apply: |rules, terrain, _| {
            if let Some(field) = &mut rules.voronoi {
                field.apply(terrain);
            }
        },
    },
    // Decides what a metre costs near to edges, and that nobody walks on one.
    Rule {
        name: RuleName::EdgeCosts,
        apply: |rules, terrain, _| rules.edge_costs.apply(terrain, &rules.config.edge_costs),
    },
    // Decides that the robot may leave what it already stands too near to.
    Rule {
        name: RuleName::Escape,
        apply: |_, terrain, sight| escape::apply(terrain, sight),
    },
];

/// One rule.
#[derive(Debug, Clone, Copy)]
pub struct Rule {
    /// The name of its file and of its table of settings, if it has one.
    pub name: RuleName,
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
    felt: felt::FeltThings,
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
        let left_out = self.config.left_out;
        for rule in RULES.iter().filter(|rule| Some(rule.name) != left_out) {
            (rule.apply)(self, terrain, sight);
        }
    }

    /// Reads what is seen by the rules up to and with the one of this name.
    #[cfg(test)]
    pub(crate) fn read_until(&mut self, name: &str, terrain: &mut Terrain, sight: &Sight<'_>) {
        terrain.begin(sight.view);
        let last = RULES
            .iter()
            .position(|rule| rule.name.word() == name)
            .unwrap();
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
            let file = format!("{folder}/{}.rs", rule.name.word());
            assert!(std::path::Path::new(&file).exists(), "{file}");
            let others = RULES[index + 1..].iter();
            assert!(others.into_iter().all(|other| other.name != rule.name));
        }
    }
}
