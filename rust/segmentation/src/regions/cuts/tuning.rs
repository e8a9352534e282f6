//! Settings of the cuts through regions that hold two levels.

use settings::{POSITIVE, at_least, settings, within};

settings! {
    /// How regions that hold two levels are cut apart.
    pub struct CutTuning("navigation.ground.tuning.cuts") {
        /// Columns and rows of the blocks of pixels that lines are tried with first; finer images have as many times more.
        block: usize = 4, "1", within(1.0, 100.0);
        /// Of each row, and of each column, every so many pixels one takes part, so that they lie on the image like the fields of
        /// one colour on a chessboard.
        stride: usize = 2, "1", within(1.0, 100.0);
        /// Directions that are tried at first for a line; they share half a turn evenly.
        coarse_directions: usize = 12, "1", within(1.0, 360.0);
        /// Step in which the lines of one direction are moved at first.
        coarse_step: f64 = 0.02, "m", POSITIVE;
        /// Directions that are tried around the best one of the first search.
        fine_directions: usize = 5, "1", within(1.0, 360.0);
        /// Angle between the directions that are tried around the best one.
        fine_turn: f64 = 0.05, "rad", within(0.0, 1.6);
        /// Step in which the lines are moved in the search around the best one.
        fine_step: f64 = 0.005, "m", POSITIVE;
        /// Most places of the lines of one direction. A region that is larger reaches where a low step is not told from noise.
        most_places: f64 = 400.0, "1", within(1.0, 1e6);
        /// Two heights are there when they explain a region's disparities better than one by more than this, in squared noise. One
        /// in a thousand regions of one surface reaches 18.
        certain: f64 = 24.0, "1", POSITIVE;
        /// Steps that are not higher than this are none.
        least_step: f64 = 0.008, "m", POSITIVE;
        /// Fewest pixels to each side of a cut.
        least_side: f64 = 150.0, "1", POSITIVE;
        /// Columns and rows to each side of a pixel that it is given to one of the two heights with, by their mean.
        around: usize = 2, "1", within(0.0, 50.0);
        /// Pixels that are off a region's surface by more than so many times their noise take no part in the search.
        outlier: f32 = 6.0, "1", POSITIVE;
        /// Pixels that tell as much as one independent one, because matching windows overlap: as many as a window of 5x5 has.
        alike: f64 = 25.0, "1", at_least(1.0);
    }
}
