//! What one scan says of a cell.

/// What a scan says of a cell: that something is in it, whatever its other beams say, or that one passed it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Said {
    Nothing,
    Free,
    Occupied,
}
