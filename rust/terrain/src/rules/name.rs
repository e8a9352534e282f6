//! The names of the rules.

use serde::{Deserialize, Serialize};

/// A rule's name: that of its file.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, settings::schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[schemars(crate = "settings::schemars")]
#[expect(missing_docs, reason = "what each decides stands in the list of rules")]
pub enum RuleName {
    StairCells,
    Obstacles,
    FarLevels,
    LoneCells,
    Heights,
    LaidStairs,
    Slopes,
    Gaps,
    LandingEdges,
    HeightDifferences,
    Shadows,
    SteepSlopes,
    PlatformEdges,
    TallEdges,
    Felt,
    Clearance,
    ObstacleCosts,
    HeadRoom,
    Voronoi,
    EdgeCosts,
    Escape,
}

settings::choices!(RuleName);

impl RuleName {
    /// As it is written in a file of settings.
    pub(crate) fn word(self) -> String {
        let word = settings::serde_json::to_value(self);
        let word = word.ok().and_then(|word| word.as_str().map(str::to_owned));
        word.unwrap_or_default()
    }
}
