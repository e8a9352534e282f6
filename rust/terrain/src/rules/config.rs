//! Settings of the rules: one table for each, in the order in which they act.

use settings::{ANY, settings};

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
        /// A rule that does not act, to see what it is worth.
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
}
