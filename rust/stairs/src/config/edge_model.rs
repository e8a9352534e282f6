//! Settings of the step that is fitted to the disparities of a frame.

use settings::{NOT_NEGATIVE, POSITIVE, SHARE, at_least, settings, within};

settings! {
    /// How a step is fitted to the disparities of a frame, and which fits are trusted.
    pub struct EdgeModelTuning("navigation.stairs.tuning.edge_model") {
        /// Least change of height that shows.
        least_rise: f64 = 0.008, "m", POSITIVE;
        /// How far the first look goes beyond the pixels that take part in the end.
        slack: f64 = 0.03, "m", NOT_NEGATIVE;
        /// How far the camera must be in front of the riser and above both surfaces.
        camera_clear: f64 = 0.02, "m", POSITIVE;
        /// Steps of the refinement: with the first choice of pixels, and with the second.
        rounds: [usize; 2] = [3, 6], "1", within(1.0, 1000.0);
        /// Change of the place below which the refinement is at rest.
        rest_place: f64 = 0.0003, "m", POSITIVE;
        /// Change of the heading below which the refinement is at rest.
        rest_heading: f64 = 0.002, "rad", POSITIVE;
        /// Largest change of the place in the last step of a refinement that is not at rest: pixels that change surfaces keep it
        /// moving a little.
        unrest_place: f64 = 0.0015, "m", POSITIVE;
        /// Largest change of the heading in the last step of a refinement that is not at rest.
        unrest_heading: f64 = 0.015, "rad", POSITIVE;
        /// What a turn weighs against a shift where the refinement is asked whether it turns back: squared distance of the ends
        /// from the middle.
        lever: f64 = 0.01, "m^2", NOT_NEGATIVE;
        /// By how much steps become smaller each time that the refinement turns back.
        damping: f64 = 0.5, "1", SHARE;
        /// Largest change of the place and of the heights at once.
        stride_place: f64 = 0.012, "m", POSITIVE;
        /// Largest change of the heading at once.
        stride_heading: f64 = 0.12, "rad", POSITIVE;
        /// Farthest that an edge may lie from its guess.
        reach_place: f64 = 0.08, "m", POSITIVE;
        /// Farthest that an edge may be turned from its guess.
        reach_heading: f64 = 0.6, "rad", POSITIVE;
        /// Fewest pixels that a fit rests on, where all of them take part.
        fewest_pixels: usize = 150, "1", at_least(1.0);
        /// Largest mean size of the residuals, in the expected noise.
        roughest: f64 = 1.7, "1", POSITIVE;
        /// Standard deviation of the place that no noise explains: the surfaces' tilt, pixels at the border.
        model_place: f64 = 0.0015, "m", NOT_NEGATIVE;
        /// Standard deviation of the heading that no noise explains: the surfaces' tilt, pixels at the border.
        model_heading: f64 = 0.01, "rad", NOT_NEGATIVE;
        /// Which pixels take part.
        excerpt: ExcerptTuning;
        /// The first look.
        coarse: CoarseTuning;
        /// The steps of the refinement.
        refine: RefineTuning;
        /// What block matching makes of a step.
        window: WindowTuning;
        /// Whether both surfaces are in view.
        visibility: VisibilityTuning;
        /// Short slopes in the place of steps.
        bevels: BevelTuning;
    }
}

settings! {
    /// How a short slope between two levels is told from a step.
    pub struct BevelTuning("navigation.stairs.tuning.edge_model.bevels") {
        /// Least change of height that is asked whether it is a slope's.
        least_rise: f64 = 0.008, "m", POSITIVE;
        /// How far before and behind an edge pixels take part, where nothing else changes there.
        around: f64 = 0.17, "m", POSITIVE;
        /// How much of both levels together must be left beside a slope.
        level_beside: f64 = 0.02, "m", NOT_NEGATIVE;
        /// Shortest slope that is tried.
        shortest: f64 = 0.06, "m", POSITIVE;
        /// By how much each slope that is tried is longer than the one before.
        run_step: f64 = 0.02, "m", POSITIVE;
        /// Slopes that are tried.
        runs: usize = 11, "1", within(1.0, 100.0);
        /// Rise per metre beyond which nothing is a slope.
        steepest: f64 = 0.3, "1", POSITIVE;
        /// Lowest step of stairs: what rises by two of them and more may be two steps with a tread between, which one frame may take for a slope.
        step: f64 = 0.012, "m", POSITIVE;
        /// Places to each side of the edge at which a slope is tried.
        places: i32 = 3, "1", within(0.0, 100.0);
        /// Distance from place to place.
        place_step: f64 = 0.02, "m", POSITIVE;
        /// Steps of the refinement.
        rounds: usize = 4, "1", within(0.0, 100.0);
        /// Shift by which the change of the picture is tried.
        trial: f64 = 0.003, "m", POSITIVE;
        /// Largest change of place and levels at once.
        stride: f64 = 0.02, "m", POSITIVE;
        /// Misses count up to this where the best place is looked for.
        largest: f64 = 0.5, "px", POSITIVE;
        /// Noise of a disparity, for what is known of the levels before.
        noise: f64 = 0.1, "px", POSITIVE;
        /// How well the levels are known before: standard deviation.
        height_sigma: f64 = 0.003, "m", POSITIVE;
        /// Pixels that tell as much as one independent one, because matching windows overlap.
        hold: f64 = 25.0, "1", POSITIVE;
        /// Half of the misses are smaller than this share of the noise, as those of a normal variable are.
        median: f64 = 0.6745, "1", POSITIVE;
        /// Noise is no less than this.
        least_noise: f64 = 0.02, "px", POSITIVE;
        /// Misses count up to so many times the noise where slope and step are compared.
        outlier: f64 = 3.0, "1", POSITIVE;
        /// Fewest pixels that tell anything.
        fewest: usize = 100, "1", at_least(1.0);
        /// Most pixels that are looked at.
        samples: usize = 400, "1", at_least(1.0);
    }
}

settings! {
    /// Which part of an edge is looked at, and which pixels around it take part.
    pub struct ExcerptTuning("navigation.stairs.tuning.edge_model.excerpt") {
        /// How far before the edge pixels take part.
        before: f64 = 0.07, "m", POSITIVE;
        /// How far behind the edge pixels take part: less than the shortest tread is deep.
        behind: f64 = 0.075, "m", POSITIVE;
        /// How much of an edge is looked at.
        longest: f64 = 0.44, "m", POSITIVE;
        /// How much of an edge must be in view.
        shortest: f64 = 0.08, "m", POSITIVE;
        /// What is taken off at each end of the edge: half a matching window and what the ends may be wrong.
        end: f64 = 0.01, "m", NOT_NEGATIVE;
        /// Places along the guess that are looked up in the picture.
        places: usize = 41, "1", within(2.0, 10000.0);
        /// How far outside the picture the guess may be: it may be off.
        outside: f64 = 5.0, "px", NOT_NEGATIVE;
        /// Places whose depth is smaller are not in the picture.
        nearest_depth: f64 = 0.05, "m", POSITIVE;
        /// Areas with more pixels are thinned, so that only every second, third ... takes part: neighbouring windows overlap and
        /// tell nearly the same.
        many: usize = 500, "1", at_least(1.0);
        /// Least disparity of a surface: farther away nothing can be told.
        least_disparity: f32 = 1.5, "px", POSITIVE;
    }
}

settings! {
    /// The first look: a grid of places and headings around the guess, of which the best is refined.
    pub struct CoarseTuning("navigation.stairs.tuning.edge_model.coarse") {
        /// Places of the grid to each side of the guess.
        places: i32 = 5, "1", within(0.0, 1000.0);
        /// Distance from place to place.
        place_step: f64 = 0.01, "m", POSITIVE;
        /// Headings of the grid to each side of the guess.
        headings: i32 = 3, "1", within(0.0, 1000.0);
        /// Turn from heading to heading.
        heading_step: f64 = 0.11, "rad", POSITIVE;
        /// Residuals count up to this.
        largest: f32 = 0.4, "px", POSITIVE;
        /// Most pixels that are looked at.
        samples: usize = 200, "1", within(1.0, 100_000.0);
        /// Fewest pixels that tell anything.
        fewest: usize = 60, "1", at_least(1.0);
    }
}

settings! {
    /// The steps of the refinement, with large residuals weighed down.
    pub struct RefineTuning("navigation.stairs.tuning.edge_model.refine") {
        /// Calibrated noise of a disparity.
        noise: f32 = 0.125, "px", POSITIVE;
        /// Residual up to which a pixel counts fully, in the noise.
        huber: f32 = 2.0, "1", POSITIVE;
        /// Residual beyond which a pixel does not count at all, in the noise.
        outlier: f32 = 16.0, "1", POSITIVE;
        /// Shift of the edge by which its change of the picture is tried where disparities jump: about half a pixel.
        trial_place: f64 = 0.004, "m", POSITIVE;
        /// Turn of the edge by which its change of the picture is tried where disparities jump.
        trial_heading: f64 = 0.04, "rad", POSITIVE;
        /// How well the heights are known before: standard deviation.
        height_sigma: f64 = 0.006, "m", POSITIVE;
    }
}

settings! {
    /// What block matching makes of a step: where the disparities of a window lie close together it blends them, else it takes
    /// one side.
    pub struct WindowTuning("navigation.stairs.tuning.edge_model.window") {
        /// Difference of disparities below which surfaces blend: about half the width of a correlation's peak.
        bandwidth: f32 = 1.0, "px", POSITIVE;
        /// Difference of the disparities in a window beyond which it takes one side or the other before long.
        suspect: f32 = 0.75, "px", POSITIVE;
        /// Steps of the mean shift with which the nearer side is found.
        shifts: usize = 4, "1", within(1.0, 100.0);
    }
}

settings! {
    /// Whether enough of both surfaces is in view, slice by slice of the edge, to trust a fit.
    pub struct VisibilityTuning("navigation.stairs.tuning.edge_model.visibility") {
        /// Pixels of a surface that a slice must show.
        pixels: u16 = 3, "px", at_least(1.0);
        /// How far from the edge the pixels must lie that show a surface: more than a matching window reaches.
        away: f64 = 2.5, "px", NOT_NEGATIVE;
        /// How close to a surface a pixel must be to belong to it, in the noise.
        close: f32 = 3.0, "1", POSITIVE;
        /// Share of the slices that must show enough of a surface.
        most: f64 = 0.6, "1", SHARE;
        /// Fewest slices that must show anything: less of an edge says nothing of its heading.
        fewest: usize = 14, "1", at_least(1.0);
    }
}
