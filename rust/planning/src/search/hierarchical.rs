//! From coarse to fine: a graph of places over metric local maps, and a way over the cells of those local maps alone through which the
//! graph's leads (004, section 36.3.6).
//!
//! The places are gates between local maps, as in a doorway, and both ends of what joins cells that are no neighbours: the stairs between
//! storeys. What a way within a local map costs is found when it is asked for, and known until that map changes (after Botea, Müller and
//! Schaeffer 2004).

mod local_maps;
mod places;
#[cfg(test)]
mod tests;

use settings::{at_least, settings};

use super::links::Links;
use super::{Graph, Route, Search};
use local_maps::LocalMaps;
use places::{PlaceGraph, WayAsked};

settings! {
    /// The planner `hierarchical`, on the grid of `a_star`, whose settings count as well: coarse to fine over local maps.
    pub struct HierarchicalConfig("navigation.hierarchical") {
        /// Side of a local map, in cells.
        local_map: usize = 40, "1", at_least(4.0);
        /// A border between two local maps has a gate in every free stretch, and another for every so many cells of it.
        gate: usize = 10, "1", at_least(1.0);
    }
}

/// Arrays of the search, and what is known of the local maps.
#[derive(Debug, Clone, Default)]
pub struct HierarchicalSearch {
    config: HierarchicalConfig,
    maps: LocalMaps,
    places: PlaceGraph,
    /// The grid where the way may lead, infinite elsewhere.
    laid: Vec<f32>,
    laid_maps: Vec<usize>,
}

impl HierarchicalSearch {
    /// With settings.
    pub fn new(config: HierarchicalConfig) -> Self {
        Self {
            config,
            ..Self::default()
        }
    }

    /// Reads a grid: forgets what was known of the local maps that have changed since, and the gates around them.
    pub fn read(&mut self, weights: &[f32], cols: usize) {
        if !self.maps.read(&self.config, weights, cols) {
            self.laid.clear();
            self.laid_maps.clear();
        }
    }

    /// Finds all that is found by itself when it is asked for: what the ways between the gates of each local map cost.
    pub fn build(&mut self) {
        for map in 0..self.maps.size[0] * self.maps.size[1] {
            if let Some(gate) = self.maps.gates_of(map).next() {
                let _ = self.maps.between_gates(gate);
            }
        }
    }

    /// A way over the grid that was read last, from `start` to a node where `ending` gives a cost of ending there; of the cells those are
    /// `ends`. There is one exactly where [`Search::run_linked`] finds one.
    ///
    /// The other arguments are those of [`Search::run_linked`], which looks for the fine way with the arrays of `plain`.
    pub fn run(
        &mut self,
        (plain, links): (&mut Search, Option<&Links>),
        open: impl Fn(usize) -> bool,
        start: usize,
        ends: &[(u32, f64)],
        (ending, heuristic): (impl Fn(usize) -> Option<f64>, impl Fn(usize) -> f64),
    ) -> Option<Route> {
        let question = WayAsked { links, start, ends };
        (self.places).read(&mut self.maps, &question, (&open, &ending));
        let maps = (self.places).way(&mut self.maps, &heuristic)?;
        self.lay(maps);
        let fine = Graph {
            weights: &self.laid,
            cols: self.maps.cols,
            links,
        };
        plain.run_linked(fine, open, start, ending, heuristic)
    }

    /// Number of local maps through which the last way led.
    pub fn maps_on_way(&self) -> usize {
        self.laid_maps.len()
    }

    /// Lays the cells of local maps, and nothing else.
    fn lay(&mut self, maps: Vec<usize>) {
        let weights = &self.maps.weights;
        if self.laid.len() == weights.len() {
            for cells in self
                .laid_maps
                .iter()
                .flat_map(|&map| self.maps.rows_of(map))
            {
                self.laid[cells].fill(f32::INFINITY);
            }
        } else {
            self.laid = vec![f32::INFINITY; weights.len()];
        }
        for cells in maps.iter().flat_map(|&map| self.maps.rows_of(map)) {
            self.laid[cells.clone()].copy_from_slice(&weights[cells]);
        }
        self.laid_maps = maps;
    }
}
