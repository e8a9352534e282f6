//! Settings of the rules: one table for each, in the order in which they act.

use settings::{ANY, ConfigError, require, settings};

use crate::goal_level::GoalLevelConfig;
use crate::longer_landings::LongerLandingsConfig;
use crate::rules::RuleName;
use crate::rules::edge_costs::EdgeCostsConfig;
use crate::rules::far_levels::FarLevelsConfig;
use crate::rules::felt::FeltThingsConfig;
use crate::rules::head_room::HeadRoomConfig;
use crate::rules::laid_stairs::LaidStairsConfig;
use crate::rules::obstacles::ObstaclesConfig;
use crate::rules::platform_edges::PlatformEdgesConfig;
use crate::rules::shadows::ShadowsConfig;
use crate::rules::slopes::SlopesConfig;
use crate::rules::stair_cells::StairCellsConfig;
use crate::terrain::RoomConfig;

settings! {
    /// What a cell is: one table for each rule that has settings of its own, in the order in which the rules act.
    pub struct TerrainConfig("navigation.terrain") {
        /// A rule that does not act, to see what it is worth; none that all others build on.
        left_out: Option<RuleName> = None, "-", ANY;
        /// Which level a goal lies on that is told without a height.
        goal_level: GoalLevelConfig;
        /// Which landings are taken to go on to the goal.
        longer_landings: LongerLandingsConfig;
        /// Which cells belong to stairs.
        stair_cells: StairCellsConfig;
        /// What stands there, and what is only a riser.
        obstacles: ObstaclesConfig;
        /// What is not believed from afar.
        far_levels: FarLevelsConfig;
        /// Where stairs overwrite the heights that were seen.
        laid_stairs: LaidStairsConfig;
        /// Which cells are tilted.
        slopes: SlopesConfig;
        /// What is the shadow below an edge.
        shadows: ShadowsConfig;
        /// Where the level that the robot stands on ends.
        platform_edges: PlatformEdgesConfig;
        /// What stands where a foot met something.
        felt: FeltThingsConfig;
        /// What it costs to go where nobody has looked up.
        head_room: HeadRoomConfig;
        /// What being near to an edge costs.
        edge_costs: EdgeCostsConfig;
        /// How room along a way is measured.
        room: RoomConfig;
    }
    check TerrainConfig::can_do_without;
}

impl TerrainConfig {
    fn can_do_without(&self, key: &str) -> Result<(), ConfigError> {
        use RuleName::{Clearance, Heights, ObstacleCosts, Obstacles};
        let needed = [Obstacles, Heights, Clearance, ObstacleCosts];
        let is_needed = self.left_out.is_some_and(|rule| needed.contains(&rule));
        let key = format!("{key}.left_out");
        let found = self.left_out.map_or(String::new(), RuleName::word);
        require(
            !is_needed,
            &key,
            "a rule that not all others build on",
            found,
        )
    }
}

#[cfg(test)]
mod tests {
    use settings::Table;

    use super::*;

    #[test]
    fn what_all_others_build_on_is_not_left_out() {
        let without = |rule| TerrainConfig {
            left_out: Some(rule),
            ..TerrainConfig::default()
        };
        assert_eq!(without(RuleName::Gaps).check(), Ok(()));
        let refused = without(RuleName::Obstacles)
            .check()
            .unwrap_err()
            .to_string();
        assert!(
            refused.starts_with("navigation.terrain.left_out must be a rule"),
            "{refused}"
        );
    }
}
