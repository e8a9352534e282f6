//! Lines: the walls of a room in a few numbers, where a grid takes thousands (004, section 36.2.2).

mod accumulator;
mod finder;
mod line;
mod mixture;
mod search;
mod split_and_merge;
mod stretches;
mod thinned;
mod widest;

pub use finder::{FoundLines, LineError, LineFinder, LineFinderConfig};
pub use line::{Line, WeightedPoint};
pub use mixture::{Assigned, LineMixture};
pub use split_and_merge::{Piece, SplitAndMergeConfig, split_and_merge};
pub use stretches::Stretch;
