//! Lines: the walls of a room in a few numbers, where a grid takes thousands (004, section 36.2.2).

mod alignment;
mod config;
mod finder;
mod line;
mod line_votes;
mod mixture;
mod search;
mod split_and_merge;
mod stretches;
mod thinned;
mod widest;

pub use alignment::{AlignmentConfig, LineAlignment};
pub use config::LineFinderConfig;
pub use finder::{LineError, LineFinder};
pub use line::{PlanarLine, WeightedPoint};
pub use mixture::{Assigned, LineMixture};
pub use search::FoundLines;
pub use split_and_merge::{ScanPiece, SplitAndMergeConfig, split_and_merge};
pub use stretches::LineStretch;
