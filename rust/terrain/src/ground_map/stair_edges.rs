//! The outlines of all stairs, and which of them are near to a place.

use stairs::Staircase;

use crate::StairOutline;

/// The outlines of all stairs.
#[derive(Debug, Clone, Default)]
pub(super) struct StairEdges {
    all: Vec<Told>,
    near_m: f64,
}

/// What one stair tells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    outline: StairOutline,
    /// Its height, m.
    pub(super) height_m: f32,
    /// Whether each side is its own end, as the outline counts them; else only a view ended there.
    ends: [bool; 4],
}

impl Told {
    /// Whether a place lies within its edges.
    pub(super) fn covers(&self, at_m: [f64; 2]) -> bool {
        self.outline.outside_m(at_m) <= 0.0
    }

    /// Whether a place lies beyond an end that is its own.
    pub(super) fn ends_before(&self, at_m: [f64; 2]) -> bool {
        !self.covers(at_m) && self.ends[self.outline.nearest_side(at_m)]
    }
}

impl StairEdges {
    /// Takes in the stairs, of a map with cells of this size, m. Of two of one height, the same tread from two sides, both count.
    pub(super) fn read(&mut self, stairs: &Staircase, cell_m: f64) {
        // A cell may hold part of what begins a diagonal of it away.
        self.near_m = std::f64::consts::SQRT_2 * cell_m;
        self.all.clear();
        self.all.extend(stairs.stairs.iter().map(|stair| Told {
            outline: StairOutline::of(stair),
            height_m: stair.height_m() as f32,
            ends: [
                stair.seen_ends.right > 0,
                stair.back_fit.is_some() || stair.seen_ends.back > 0,
                stair.seen_ends.left > 0,
                stair.front_fit.is_some() || stair.seen_ends.front > 0,
            ],
        }));
    }

    /// The stairs that a cell around this place may hold an edge of, or lies on.
    pub(super) fn near(&self, middle_m: [f64; 2]) -> Vec<Told> {
        let near = |one: &&Told| one.outline.outside_m(middle_m) <= self.near_m;
        self.all.iter().filter(near).copied().collect()
    }
}
