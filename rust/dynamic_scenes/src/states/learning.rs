//! Where visits differ, and in which ways.

use std::collections::BTreeSet;

use geometry::Cell;
use plan_view::{OccupancyError, OccupancyMap};
use settings::{ConfigError, Table, at_least, between, settings};

use super::clustering::{VisitPatch, states};
use super::stateful_map::{ChangingPart, StatefulMap};

settings! {
    /// Parts of a map that take on one of few states.
    pub struct StatesConfig("dynamic_scenes.states") {
        /// A visit saw a cell occupied that is more probably so than this.
        occupied: f64 = 0.65, "1", between(0.0, 1.0);
        /// A visit saw a cell free that is less probably occupied than this.
        free: f64 = 0.35, "1", between(0.0, 1.0);
        /// Cells change of which so many visits saw each of both: occupied, and free with no occupied cell beside it, so that the error of ranges is no change.
        visits: usize = 2, "1", at_least(1.0);
        /// A part has at least so many cells that change and hang together.
        cells: usize = 4, "1", at_least(1.0);
        /// Cells this near to each other hang together.
        reach: i32 = 2, "cells", at_least(1.0);
        /// A part has no more states.
        most: usize = 4, "1", at_least(2.0);
        /// Most rounds in which the states of all parts are chosen, one part after the other.
        rounds: usize = 3, "1", at_least(1.0);
    }
    require (free) < (occupied);
}

/// Learns which parts of a map change between visits, and their states. The maps of the visits are of the same cells; what they agree in is in the map that is
/// returned as all of them together know it.
pub fn learn_states(
    visits: &[OccupancyMap],
    config: &StatesConfig,
) -> Result<Result<StatefulMap, OccupancyError>, ConfigError> {
    config.check()?;
    let Some((first, others)) = visits.split_first() else {
        return Ok(Err(OccupancyError::OtherLattice));
    };
    let mut base = first.clone();
    for visit in others {
        let same = visit.cells().area() == base.cells().area() && visit.lattice() == base.lattice();
        if !same {
            return Ok(Err(OccupancyError::OtherLattice));
        }
        if let Err(error) = base.join(visit) {
            return Ok(Err(error));
        }
    }
    let mut left: BTreeSet<Cell> = base
        .cells()
        .area()
        .cells()
        .filter(|cell| changes(visits, *cell, config))
        .collect();
    let mut parts = Vec::new();
    while let Some(first) = left.pop_first() {
        let cells = joined(first, &mut left, config.reach);
        if cells.len() >= config.cells {
            parts.extend(part(visits, cells, config));
        }
    }
    Ok(Ok(StatefulMap::new(base, parts, config.rounds)))
}

/// Whether a visit saw a cell occupied or free; none where it was not seen well enough.
fn seen(visit: &OccupancyMap, cell: Cell, config: &StatesConfig) -> Option<bool> {
    let p = visit.probability(cell)?;
    (p > config.occupied || p < config.free).then_some(p > config.occupied)
}

fn changes(visits: &[OccupancyMap], cell: Cell, config: &StatesConfig) -> bool {
    let occupied = |visit: &OccupancyMap, cell: Cell| seen(visit, cell, config) == Some(true);
    let clear = |visit: &OccupancyMap| {
        seen(visit, cell, config) == Some(false)
            && !around(cell, 1).any(|beside| occupied(visit, beside))
    };
    let count =
        |wanted: &dyn Fn(&OccupancyMap) -> bool| visits.iter().filter(|one| wanted(one)).count();
    count(&|visit| occupied(visit, cell)) >= config.visits && count(&clear) >= config.visits
}

fn around(cell: Cell, reach: i32) -> impl Iterator<Item = Cell> {
    let rows = move |col: i32| (-reach..=reach).map(move |by| Cell::new(col, cell.row + by));
    (-reach..=reach).flat_map(move |by| rows(cell.col + by))
}

fn joined(first: Cell, left: &mut BTreeSet<Cell>, reach: i32) -> Vec<Cell> {
    let (mut open, mut cells) = (vec![first], Vec::new());
    while let Some(cell) = open.pop() {
        cells.push(cell);
        open.extend(around(cell, reach).filter_map(|beside| left.take(&beside)));
    }
    cells.sort_unstable();
    cells
}

/// The part of these cells, where its patches are of more than one state.
fn part(visits: &[OccupancyMap], cells: Vec<Cell>, config: &StatesConfig) -> Option<ChangingPart> {
    let patch = |visit: &OccupancyMap| {
        cells
            .iter()
            .map(|&cell| seen(visit, cell, config))
            .collect()
    };
    let patches: Vec<VisitPatch> = visits.iter().map(patch).collect();
    let found = states(&patches, config.most);
    if found.len() < 2 {
        return None;
    }
    let mut of_visits = vec![0; visits.len()];
    for (number, state) in found.iter().enumerate() {
        for &visit in &state.members {
            of_visits[visit] = number;
        }
    }
    let share = |members: usize| members as f64 / visits.len() as f64;
    Some(ChangingPart {
        shares: found
            .iter()
            .map(|state| share(state.members.len()))
            .collect(),
        states: found.into_iter().map(|state| state.occupied).collect(),
        cells,
        of_visits,
    })
}
