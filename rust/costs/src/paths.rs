//! The cheapest way over a grid of costs.

use geometry::{Cell, Dijkstra, Grid};

/// No cell.
const NONE: u32 = u32::MAX;

/// Finds ways of least cost over costs of a metre, from cell to cell beside it or at its corner. Reused.
///
/// The planner has its own ground, stairs and footprint; this is for learning, which asks for many ways over plain grids.
#[derive(Debug, Clone, Default)]
pub struct CheapestPaths {
    dijkstra: Dijkstra,
    costs: Vec<f32>,
    before: Vec<u32>,
}

impl CheapestPaths {
    /// The cells from start to goal, both included; `None` where there is no way. A step costs its length times the mean of its two cells;
    /// none leads through an infinite cost, but out of the start's.
    pub fn find(&mut self, costs: &Grid<f64>, start: Cell, goal: Cell) -> Option<Vec<Cell>> {
        let (from, to) = (costs.index(start)?, costs.index(goal)?);
        let cols = costs.cols();
        let cell = |index: u32| {
            let index = index as usize;
            Cell::new((index % cols) as i32, (index / cols) as i32)
        };
        let price = |index: usize| {
            let price = costs.values()[index];
            if index == from && price.is_infinite() {
                1.0
            } else {
                price
            }
        };
        let steps = |at: u32| {
            let here = cell(at);
            let around = (-1..=1).flat_map(|row| (-1..=1).map(move |col| (col, row)));
            around.filter_map(move |(col, row)| {
                let beside = costs.index(Cell::new(here.col + col, here.row + row))?;
                let length = f64::from(col * col + row * row).sqrt();
                let step = 0.5 * length * (price(at as usize) + price(beside));
                (length > 0.0 && step.is_finite()).then_some((beside as u32, step as f32))
            })
        };
        self.costs.clear();
        self.costs.resize(costs.values().len(), f32::INFINITY);
        self.before.clear();
        self.before.resize(costs.values().len(), NONE);
        let before = &mut self.before;
        (self.dijkstra).begin_at(&mut self.costs, from as u32, 0.0);
        (self.dijkstra).run(&mut self.costs, steps, |to, from| {
            before[to as usize] = from;
        });
        if self.costs[to].is_infinite() {
            return None;
        }
        let mut path = vec![goal];
        let mut at = to as u32;
        while at != from as u32 {
            at = self.before[at as usize];
            path.push(cell(at));
        }
        path.reverse();
        Some(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_goes_around_what_is_dear_and_never_through_what_is_infinite() {
        let mut costs = Grid::filled(9, 9, 1.0);
        for row in 0..8 {
            *costs.get_mut(Cell::new(4, row)).unwrap() =
                if row == 4 { 50.0 } else { f64::INFINITY };
        }
        let mut paths = CheapestPaths::default();
        let path = paths
            .find(&costs, Cell::new(0, 4), Cell::new(8, 4))
            .unwrap();
        assert_eq!(
            (path[0], path[path.len() - 1]),
            (Cell::new(0, 4), Cell::new(8, 4))
        );
        assert!(path.contains(&Cell::new(4, 8)) && !path.contains(&Cell::new(4, 4)));
        *costs.get_mut(Cell::new(4, 8)).unwrap() = f64::INFINITY;
        let path = paths.find(&costs, Cell::new(0, 4), Cell::new(8, 4));
        assert!(path.unwrap().contains(&Cell::new(4, 4)));
        *costs.get_mut(Cell::new(4, 4)).unwrap() = f64::INFINITY;
        assert_eq!(paths.find(&costs, Cell::new(0, 4), Cell::new(8, 4)), None);
    }
}
