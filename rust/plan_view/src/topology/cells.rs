//! The diagram as cells of a grid that others index, with the ways that lead to it.

use super::nearest::NONE;
use super::skeleton::Skeleton;

/// The generalized Voronoi diagram of the free cells of a grid, row by row, and from each of them a way to it (004, section 36.2.3).
///
/// With any clearance, the free cells hang together along it as they do in the grid.
#[derive(Debug, Clone)]
pub struct VoronoiCells {
    cols: usize,
    skeleton: Skeleton,
}

impl VoronoiCells {
    /// Of a grid with so many columns; what is outside of it is not free. The diagram ends in corners where the two nearest obstacles lie
    /// less than `least_angle_rad` apart, seen from it.
    pub fn new(
        free: impl ExactSizeIterator<Item = bool>,
        cols: usize,
        least_angle_rad: f64,
    ) -> Self {
        let rows = free.len() / cols.max(1);
        let padded_cols = cols + 2;
        let mut padded = vec![false; padded_cols * (rows + 2)];
        for (at, free) in free.enumerate() {
            padded[(at / cols + 1) * padded_cols + at % cols + 1] = free;
        }
        Self {
            cols,
            skeleton: Skeleton::of(&padded, padded_cols, least_angle_rad, 0.0),
        }
    }

    /// Indices of the cells of the diagram.
    pub fn on_diagram(&self) -> impl Iterator<Item = usize> {
        let kept = self.skeleton.kept.iter().enumerate();
        kept.filter(|(_, kept)| **kept)
            .map(|(padded, _)| self.outside_in(padded))
    }

    /// Indices of the cells from one to the diagram, both ends included, never nearer to anything than the one before; of the cell alone
    /// where it is not free.
    pub fn to_diagram(&self, from: usize) -> impl Iterator<Item = usize> {
        let first = (from / self.cols + 1) * self.skeleton.cols + from % self.cols + 1;
        let next = |&at: &usize| {
            let next = self.skeleton.towards[at];
            (next != NONE).then_some(next as usize)
        };
        std::iter::successors(Some(first), next).map(|padded| self.outside_in(padded))
    }

    /// Index in the grid of a cell of the padded one.
    const fn outside_in(&self, padded: usize) -> usize {
        let cols = self.skeleton.cols;
        (padded / cols - 1) * self.cols + padded % cols - 1
    }
}
