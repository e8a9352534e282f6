//! A grid as ARA* searches it.

use super::Space;
use crate::search::Graph;
use crate::search::neighbours::Cells;
use crate::search::steps::ANYWHERE;

/// The cells of a grid, and links between them, as a space.
pub(super) struct GridSpace<'a, O, E, H> {
    pub(super) graph: Graph<'a>,
    pub(super) cells: Cells<'a>,
    pub(super) open: O,
    pub(super) ending: E,
    pub(super) heuristic: H,
}

impl<O, E, H> Space for GridSpace<'_, O, E, H>
where
    O: Fn(usize) -> bool,
    E: Fn(usize) -> Option<f64>,
    H: Fn(usize) -> f64,
{
    fn for_each_step(&mut self, node: u32, _: Option<u32>, mut reach: impl FnMut(u32, f64)) {
        let here = node as usize;
        if here >= self.graph.weights.len() {
            return; // no cell: nothing leads on
        }
        let weight = self.cells.weight_to_leave(here);
        self.cells
            .for_each_neighbour((here, ANYWHERE), |next, half_length, _| {
                let step = half_length * f64::from(weight + self.graph.weights[next]);
                reach(next as u32, step);
            });
        for (index, link) in (self.graph.links)
            .into_iter()
            .flat_map(|links| links.from(here))
        {
            if (self.open)(index) {
                reach(link.to, link.cost);
            }
        }
    }

    fn ending(&mut self, node: u32, _: Option<u32>) -> Option<f64> {
        (self.ending)(node as usize)
    }

    fn remaining(&self, node: u32) -> f64 {
        (self.heuristic)(node as usize)
    }
}
