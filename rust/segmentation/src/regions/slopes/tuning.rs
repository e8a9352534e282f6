//! Settings of the search for slopes.

use nalgebra::Vector3;
use settings::{NOT_NEGATIVE, POSITIVE, SHARE, at_least, settings, within};

settings! {
    /// How slopes are found among the level strips that they were cut into.
    pub struct SlopeTuning("navigation.ground.tuning.slopes") {
        /// Fewest pixels of a slope, as a share of the image.
        least_share: f64 = 0.1, "1", SHARE;
        /// A slope is longer than this along its gradient, where it is seen. What is shorter is told where an edge is fitted.
        least_length: f64 = 0.15, "m", NOT_NEGATIVE;
        /// Pixels that tell as much as one independent one, because matching windows overlap: as many as a window of 5x5 has.
        alike: f64 = 25.0, "1", at_least(1.0);
        /// Which gradients a slope may have.
        gradients: SlopeGradients;
        /// Where the search for slopes begins.
        seeds: SeedTuning;
        /// How a slope is grown from there.
        growth: SlopeGrowthTuning;
        /// How a slope is told from a flight of treads.
        treads: TreadTuning;
        /// How the frames together make a slope sure.
        memory: SlopeMemoryTuning;
        /// Where a surface ends that meets a slope.
        doubts: SlopeDoubtTuning;
    }
}

settings! {
    /// Which gradients a slope may have. Whether one may be walked on is the planner's to say.
    pub struct SlopeGradients("navigation.ground.tuning.slopes.gradients") {
        /// Least gradient of a slope: 2 degrees, for what is measured of one of 3 degrees.
        least: f64 = 0.035, "1", NOT_NEGATIVE;
        /// A slope's gradient is less than this: 22 degrees, for what is measured of one of 20 degrees.
        most: f64 = 0.4, "1", POSITIVE;
    }
    require (most) > (least);
}

impl SlopeGradients {
    /// Whether a plane `(a, b, q)` is tilted like a slope.
    pub(super) fn hold(&self, plane: &Vector3<f64>) -> bool {
        let tilt = plane.xy().norm() / plane.z;
        plane.z > 0.0 && (self.least..self.most).contains(&tilt)
    }
}

settings! {
    /// Where the search for slopes begins: windows of the image that a tilted plane explains better than a level surface does.
    pub struct SeedTuning("navigation.ground.tuning.slopes.seeds") {
        /// Windows across the image, without those that overlap two of them by half.
        across: usize = 4, "1", within(1.0, 100.0);
        /// Every so many rows and columns of a window one pixel is looked at.
        stride: usize = 2, "1", within(1.0, 100.0);
        /// By how much a tilted plane must explain a window better than a level surface does, in squared noise.
        sure: f64 = 8.0, "1", NOT_NEGATIVE;
        /// By how much the plane with the gradient of a slope that is remembered must explain a window better than a level surface
        /// does, in squared noise.
        remembered_sure: f64 = 4.0, "1", NOT_NEGATIVE;
        /// Most windows that slopes are grown from, the surest first.
        most: usize = 4, "1", within(1.0, 100.0);
    }
}

settings! {
    /// How a slope is grown: over the pixels that its plane explains better than the level surfaces do.
    pub struct SlopeGrowthTuning("navigation.ground.tuning.slopes.growth") {
        /// How often a slope's plane is fitted to what was grown, and grown anew.
        rounds: usize = 5, "1", within(1.0, 100.0);
        /// A pixel that is further off the plane than so many times its noise does not belong to it.
        accept: f32 = 3.0, "1", POSITIVE;
        /// Most that the squared distance of a pixel from a surface counts, in squared noise: a mismatch says no more than that it does
        /// not fit.
        most_off: f32 = 9.0, "1", POSITIVE;
        /// By how much the plane may explain the pixels around a place worse than a level surface does, in squared noise: between
        /// treads and in the middle of a level strip both explain them alike.
        worse: f32 = 0.3, "1", NOT_NEGATIVE;
        /// Columns and rows to each side of a pixel over which it is averaged by how much the plane explains it better.
        around: usize = 4, "1", within(0.0, 100.0);
        /// Columns and rows from the border of a slope in which its plane is not fitted.
        border: usize = 2, "1", within(0.0, 50.0);
        /// Each side of the line where the plane meets a level surface is judged as if one more pixel of it were explained worse by
        /// this, in squared noise: a side of which hardly anything is seen tells nothing.
        doubt: f32 = 1.0, "1", NOT_NEGATIVE;
    }
}

settings! {
    /// How a slope is told from stairs: by the flight of treads that explains the same pixels best.
    pub struct TreadTuning("navigation.ground.tuning.slopes.treads") {
        /// Step in which pixels are put together by how far up the slope they are.
        bin: f64 = 0.01, "m", within(0.001, 0.1);
        /// Lowest step of stairs: the treads of a flight that rises like the slope are as deep as the slope takes to rise by it.
        step: f64 = 0.012, "m", POSITIVE;
        /// Least depth of a tread.
        depth: f64 = 0.05, "m", POSITIVE;
        /// Most that lies between two treads in the picture: a riser, and what the matching window makes of its edges.
        riser: f64 = 0.05, "m", within(0.0, 1.0);
        /// Steps of stairs that must not be taken for a slope: where their treads are seen in too few rows, nothing is told.
        told_step: f64 = 0.04, "m", POSITIVE;
        /// Rows of the image in which a tread is seen as one: those of a matching window, and as many as are blended at its ends.
        resolved: f64 = 8.0, "px", POSITIVE;
        /// Price of one more tread, in squared noise: for the place of its edge, and its height.
        price: f64 = 2.0, "1", NOT_NEGATIVE;
        /// Directions to each side of the slope's own in which stairs are tried at first: a plane through stairs of which only a part
        /// is seen is turned.
        turns: u32 = 2, "1", within(0.0, 10.0);
        /// Angle between the directions that are tried at first.
        turn_step: f64 = 0.15, "rad", POSITIVE;
        /// The best direction is searched to this: half a metre to the side an edge is then off by a bin.
        last_turn: f64 = 0.02, "rad", POSITIVE;
        /// Most bins along a slope; what is further up counts to the last one.
        most_bins: usize = 250, "1", within(1.0, 1000.0);
    }
}

settings! {
    /// How the frames together make a slope sure: one frame alone may be wrong.
    pub struct SlopeMemoryTuning("navigation.ground.tuning.slopes.memory") {
        /// A plane that explains its pixels better than treads by more than this, in squared noise, tells of a slope, by less of stairs.
        doubtful: f64 = 4.0, "1", NOT_NEGATIVE;
        /// What `doubtful` is for a plane that is steeper than `steep`: there the treads of stairs are narrow, and from afar a plane
        /// explains them better by up to 8. Slopes are told by 9 to 30.
        doubtful_steep: f64 = 9.0, "1", NOT_NEGATIVE;
        /// Gradient above which a plane must be told from stairs more clearly.
        steep: f64 = 0.2, "1", NOT_NEGATIVE;
        /// A slope is sure when what the frames told of it adds up to more than this, in squared noise.
        sure: f64 = 4.0, "1", NOT_NEGATIVE;
        /// What the frames told of a slope is kept up to this, in squared noise.
        most_sure: f64 = 16.0, "1", POSITIVE;
        /// What each frame takes from what was told of a slope, in squared noise.
        fades: f64 = 0.2, "1", NOT_NEGATIVE;
        /// Slopes of two frames whose gradients differ by less than this are one.
        same_gradient: f64 = 0.06, "1", POSITIVE;
    }
}

settings! {
    /// Where a surface ends that meets a slope: no height is told where what is seen is off it by more than noise.
    pub struct SlopeDoubtTuning("navigation.ground.tuning.slopes.doubts") {
        /// Columns and rows to each side of a pixel over which it is averaged by how much its surface is off.
        around: usize = 4, "1", within(0.0, 100.0);
        /// Most that a pixel counts, in noises: a mismatch says no more than that it does not fit.
        accept: f32 = 3.0, "1", POSITIVE;
        /// The mean around a pixel is off by no more than so many of its standard deviations, or its height is in doubt.
        sure: f32 = 2.5, "1", POSITIVE;
        /// A region of which more than this share is in doubt holds several surfaces: how far it is off its plane does not tell how rough
        /// it is.
        mixed: f32 = 0.05, "1", SHARE;
    }
}
