//! The planner with another search for the way to the goal.

use settings::{ConfigError, Table};

use crate::AStar;
use crate::path::chosen_search::ChosenSearch;
use crate::search::ara_star::AraStarConfig;
use crate::search::d_star_lite::DStarLiteConfig;
use crate::search::field_d_star::FieldDStarConfig;
use crate::search::hierarchical::HierarchicalConfig;
use crate::search::voronoi_graph::VoronoiGraphPlannerConfig;

impl AStar {
    /// The planner whose way to the goal is repaired by D* Lite, or Delayed D*, where the ground changes.
    pub fn by_d_star_lite(mut self, config: &DStarLiteConfig) -> Result<Self, ConfigError> {
        config.check()?;
        self.chosen = ChosenSearch::d_star_lite(config);
        Ok(self)
    }

    /// The planner whose way to the goal is interpolated between cells, by Field D*.
    pub fn by_field_d_star(mut self, config: &FieldDStarConfig) -> Result<Self, ConfigError> {
        config.check()?;
        self.chosen = ChosenSearch::field_d_star(config);
        Ok(self)
    }

    /// The planner whose way to the goal leads to the generalized Voronoi diagram, along it, and from it.
    pub fn by_voronoi_graph(
        mut self,
        config: VoronoiGraphPlannerConfig,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        self.chosen = ChosenSearch::voronoi_graph(config);
        Ok(self)
    }

    /// The planner whose way to the goal is found over a graph of places first, then over the local maps on the way.
    pub fn by_hierarchy(mut self, config: HierarchicalConfig) -> Result<Self, ConfigError> {
        config.check()?;
        self.chosen = ChosenSearch::hierarchical(config);
        Ok(self)
    }

    /// The planner whose way to the goal is the best that a budget allows, by ARA*.
    pub fn by_ara_star(mut self, config: AraStarConfig) -> Result<Self, ConfigError> {
        config.check()?;
        self.chosen = ChosenSearch::ara_star(config);
        Ok(self)
    }
}
