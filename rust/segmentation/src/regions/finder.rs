//! What makes one segmenter differ from the others: how it finds surfaces in a picture.

use crate::picture::{Picture, View};
use crate::regions::region::Region;

/// How often a picture was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// For the first time, under a view that is a guess.
    First,
    /// Again, under a better view.
    Again,
}

/// Finds surfaces.
pub trait Finder: Send + Sync {
    /// Whether it finds planes in any direction, not horizontal ones only.
    const ANY_DIRECTION: bool;

    /// Fills `regions` with what `picture` shows under `view`, and `labels` with their pixels (0: none, i + 1: region i).
    /// Before another look both hold what the last one left, and what was made of it since: slopes have regions of their own.
    fn find(
        &mut self,
        picture: Picture<'_>,
        view: &View,
        look: Look,
        regions: &mut Vec<Region>,
        labels: &mut [u16],
    );
}
