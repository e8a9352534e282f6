//! Numbers that decide how the ground is found and surfaces are described, and that few will want to turn:
//! `[navigation.ground.tuning]`.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, settings, within};

use crate::camera_pose::correction::tuning::CorrectionTuning;
use crate::camera_pose::{KnownFloorTuning, TiltSearchTuning};
use crate::picture::{MedianTuning, NoiseTuning};
use crate::regions::cuts::tuning::CutTuning;
use crate::regions::slopes::tuning::SlopeTuning;
use crate::regions::{
    FitTuning, RoughnessTuning, SliverTuning, StepTuning, SurfaceTuning, TiltedTuning, WallTuning,
};

settings! {
    /// Numbers behind the ground and the surfaces of a frame that few will want to turn.
    pub struct GroundTuning("navigation.ground.tuning") {
        /// Pixels of an image that are enough, as many as the camera of the small humanoid has. Of a finer image rows or columns are
        /// left out where pixels tell of whole surfaces.
        enough_pixels: usize = 88 * 72, "1", POSITIVE;
        /// How the median takes single mismatches out of the picture.
        median: MedianTuning;
        /// How the noise of the disparities is measured.
        noise: NoiseTuning;
        /// How the camera's tilt is guessed at the beginning of each frame.
        tilt_search: TiltSearchTuning;
        /// How the camera of a frame is levelled.
        tilt: TiltTuning;
        /// How the camera's pose is corrected from frame to frame.
        correction: CorrectionTuning;
        /// Which region of a frame is the ground.
        reference: ReferenceTuning;
        /// How the camera's height is told by floor that is known from before.
        known_floor: KnownFloorTuning;
        /// How the surfaces of a frame are fitted, and which of them are level.
        surfaces: SurfaceTuning;
        /// How each region is fitted.
        fits: FitTuning;
        /// How regions that hold two levels are cut apart.
        cuts: CutTuning;
        /// When a thin surface at the edge of a step is none.
        slivers: SliverTuning;
        /// How the roughness of level surfaces is measured.
        roughness: RoughnessTuning;
        /// How slopes are found.
        slopes: SlopeTuning;
        /// How planes in any direction are found among what is left.
        walls: WallTuning;
        /// How planes in any direction are described.
        tilted: TiltedTuning;
        /// Which pixels lie at the edge of a step.
        steps: StepTuning;
    }
}

settings! {
    /// How the camera of a frame is levelled: by the tilt that the level surfaces share.
    pub struct TiltTuning("navigation.ground.tuning.tilt") {
        /// Standard deviation of the tilt against the predicted one while the ground is tracked.
        tracked: f64 = 0.008, "rad", POSITIVE;
        /// Standard deviation of the tilt against the predicted one while the ground is searched.
        searched: f64 = 0.1, "rad", POSITIVE;
        /// Standard deviation of the tilt against the one that was found by what is near the feet.
        near: f64 = 0.015, "rad", POSITIVE;
        /// A surface that is tilted by more than this does not tell of the tilt of a seasoned track: treads that are taken for one
        /// surface would turn the track into the slope of the stairs, by a bit each frame. Until the track is seasoned, a surface may
        /// be tilted by `floor_tilt`: the first finds may be bad ones, and a track that takes in nothing else is never put right.
        tracked_level: f64 = 0.015, "rad", POSITIVE;
        /// A surface that is tilted by more than this does not tell of the tilt while the ground is searched.
        searched_level: f64 = 0.09, "rad", POSITIVE;
        /// How often the regions of a frame are cut: one may hold three levels.
        cuts: usize = 2, "1", within(0.0, 20.0);
    }
}

settings! {
    /// Which region of a frame is the ground.
    pub struct ReferenceTuning("navigation.ground.tuning.reference") {
        /// A region that scatters by so many times the noise or more is no ground in a search, and no level surface that confirms a
        /// track: a plane laid through several steps is rougher.
        smooth: f64 = 1.35, "1", POSITIVE;
        /// A region that scatters by fewer times the noise than this is one plane, however little of what is near the feet belongs to it: a
        /// plane laid through low steps scatters by 0.95 and more.
        even: f64 = 0.76, "1", POSITIVE;
        /// A region is no ground when fewer than `min_ground` over this many pixels of it are left without its border.
        core_part: usize = 3, "1", within(1.0, 100.0);
        /// Every so many columns and rows a pixel tells how near to the feet its region is; of finer images as many as of coarse ones.
        stride: usize = 2, "1", within(1.0, 100.0);
        /// A region is as near to the feet as so many of its pixels are, of a picture of `enough_pixels`.
        nearest: usize = 40, "1", POSITIVE;
        /// Share of what is seen near the feet that must belong to a ground that is searched and is not seen right before them.
        underfoot: f64 = 0.5, "1", SHARE;
        /// While the ground is searched, a level that lies less than this above or below another one could be taken for it.
        rival: f64 = 0.06, "m", POSITIVE;
        /// Such a level counts where it is seen as near to the feet as this, and is `as_large`: what is further away errs by as much.
        rival_reach: f64 = 0.6, "m", POSITIVE;
        /// A region could be taken for another one when they are less than so many times `track_height` apart.
        beside: f64 = 2.0, "1", NOT_NEGATIVE;
        /// A region that lies farther from where the joints have the ground than the ground can be may be a part of it all the same
        /// when it has more than this share of the pixels of the other one: in a view that is off by degrees. So large must a level be that
        /// keeps another from being the ground.
        as_large: f64 = 0.5, "1", NOT_NEGATIVE;
    }
}
