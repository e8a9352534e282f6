//! The ways that are no steps from a cell to its neighbour: over stairs, and sideways through what is narrow.

use stairs::{ClimbingConfig, Feet, Unfit};
use terrain::{StandingAt, Terrain};

use super::directed_stairs::DirectedStairs;
use crate::{AStarConfig, Goal, Step, search::links::Links};

/// What the ways are made from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) terrain: &'a Terrain,
    pub(crate) view: &'a mapping::FloorView,
    pub(crate) climbing: &'a ClimbingConfig,
    pub(crate) feet: &'a Feet,
    pub(crate) config: &'a AStarConfig,
    pub(crate) stand: StandingAt,
    pub(crate) goal: Goal,
    /// Places from which the robot has looked on purpose, m.
    pub(crate) looked_m: &'a [[f64; 2]],
}

/// One step of a way, with where the robot stands before and after it, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stride {
    pub(crate) step: Step,
    pub(crate) from_m: [f64; 2],
    pub(crate) to_m: [f64; 2],
    /// How far from its middle the edge may be crossed, m.
    pub(crate) range_m: f64,
    /// What a metre costs here by what stands beside it: 1 where nothing is near.
    pub(crate) beside: f64,
    /// Why it is not taken.
    pub(crate) limit: Option<Unfit>,
}

/// Whether a way can be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Fit {
    /// Every step of it is within the limits.
    Holds,
    /// One is not, as far as can be told from afar.
    Doubtful,
    /// One is not.
    Broken,
}

/// A way over stairs, or sideways through a passage.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way {
    pub(crate) first: usize,
    pub(crate) end: usize,
    /// Where it begins, in its first cell, m.
    pub(crate) enter_m: [f64; 2],
    /// Where it ends, in its last cell, m; `None` where it ends on the last stair.
    pub(crate) leave_m: Option<[f64; 2]>,
    pub(crate) fit: Fit,
    /// Whether it ends at the goal; otherwise what comes behind its last stair is not known.
    pub(crate) at_goal: bool,
    /// The heading with which it is walked sideways, rad: it leads through a passage, and over no stair.
    pub(crate) turned_rad: Option<f64>,
}

/// All ways over stairs and through passages. Reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct ClimbLinks {
    pub(crate) links: Links,
    pub(crate) ways: Vec<Way>,
    pub(crate) strides: Vec<Stride>,
    pub(crate) stairs: DirectedStairs,
}

impl ClimbLinks {
    /// Forgets all ways; there are `cells` cells.
    pub(crate) fn clear(&mut self, cells: usize) {
        self.links.clear(cells);
        self.ways.clear();
        self.strides.clear();
    }

    /// Adds a way, which costs so much, m, from a cell to another one, or to a node of its own.
    pub(crate) fn add(
        &mut self,
        terrain: &Terrain,
        (from, to): (usize, Option<usize>),
        cost_m: f64,
        way: Way,
    ) {
        let to = to.unwrap_or(terrain.weights.len() + self.ways.len());
        let cost = cost_m / terrain.lattice.cell_m;
        let _ = self.links.add(from, to, cost);
        self.ways.push(way);
    }

    /// The way of a link.
    pub(crate) fn way(&self, link: usize) -> &Way {
        &self.ways[link]
    }

    /// Whether any way fits just so.
    pub(crate) fn has(&self, fit: Fit) -> bool {
        self.ways.iter().any(|way| way.fit == fit)
    }

    /// The steps of a way.
    pub(crate) fn strides(&self, way: &Way) -> &[Stride] {
        &self.strides[way.first..way.end]
    }

    /// All steps of all ways.
    pub(crate) fn all_strides(&self) -> &[Stride] {
        &self.strides
    }

    /// The way that leads from one node of a route to the next, if they are not neighbouring cells: the cheapest of those that
    /// fit as well as `worst`.
    pub(crate) fn between(
        &self,
        terrain: &Terrain,
        from: u32,
        to: u32,
        worst: Fit,
    ) -> Option<&Way> {
        let cols = terrain.cols;
        let place = |cell: u32| (cell as usize % cols, cell as usize / cols);
        let ((a, b), (c, d)) = (place(from), place(to));
        let neighbours = a.abs_diff(c) <= 1 && b.abs_diff(d) <= 1;
        if neighbours && (to as usize) < terrain.weights.len() {
            return None;
        }
        let links = self.links.from(from as usize);
        let joining = links.filter(|&(index, link)| link.to == to && self.way(index).fit <= worst);
        let best = joining.min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        best.map(|(index, _)| self.way(index))
    }
}
