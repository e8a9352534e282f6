//! The horizontal surfaces of one frame: picture, regions and their fits, with all buffers.

use nalgebra::{Vector2, Vector3};
use sensing::{Intrinsics, Scan};
use settings::{NOT_NEGATIVE, between, settings, within};

use crate::picture::{
    Erosion, MAX_REGIONS, Median, NearFeet, NoiseMap, Picture, View, count_labels, keep_where,
};
use crate::regions::cuts::{Cuts, TiltPrior};
use crate::regions::finder::{Finder, Look};
use crate::regions::fit::{FitTuning, RegionFit, fit_regions};
use crate::regions::region::Region;
use crate::regions::roughness::Roughness;
use crate::regions::slivers::Slivers;
use crate::regions::slopes::SlopeSearch;

settings! {
    /// How the surfaces of one frame are fitted, and which of them are level.
    pub struct SurfaceTuning("navigation.ground.tuning.surfaces") {
        /// Columns and rows to each side of a pixel that must be of its region for the pixel to take part in a fit: those that a
        /// matching window of 5 reaches, and one more row.
        border: [usize; 2] = [2, 3], "1", within(0.0, 50.0);
        /// Columns and rows to each side of a pixel that must be of its region for the pixel to take part in the check whether the
        /// region is a slice of a wall: slices are thin, and `border` leaves too little of them.
        thin_border: [usize; 2] = [1, 1], "1", within(0.0, 50.0);
        /// A pixel without a region is a hole in the region that so many of its eight neighbours or more belong to, and spoils none
        /// of the pixels around it.
        hole: usize = 5, "1", within(1.0, 8.0);
        /// Pixels that must be left of a region when its border is taken off; of one with fewer all take part in the fit.
        min_fit: u32 = 24, "1", NOT_NEGATIVE;
        /// A region that is tilted by more than this is no level surface. Blending at the borders of a tread gives less than half
        /// of it.
        steep: f64 = 0.3, "rad", between(0.0, 1.6);
        /// A region counts as steep, or as sloping near the feet, only when the squared distance of its tilt from none, in its own
        /// errors, is above this.
        steep_sure: f64 = 3.5, "1", NOT_NEGATIVE;
    }
}

/// What surfaces are found with, beside the finder.
#[derive(Debug, Clone)]
pub(crate) struct SurfaceParts {
    pub(crate) tuning: SurfaceTuning,
    pub(crate) fit_tuning: FitTuning,
    /// A surface tilted by more than this is no floor, rad.
    pub(crate) floor_tilt_rad: f64,
    pub(crate) median: Median,
    pub(crate) noise: NoiseMap,
    /// How rough the regions are, after `refit`.
    pub(crate) roughness: Roughness,
    pub(crate) slivers: Slivers,
    pub(crate) cuts: Cuts,
    pub(crate) slopes: SlopeSearch,
}

/// A frame and the view that it is read under, row by row.
#[derive(Debug, Clone)]
pub(crate) struct Images {
    width: usize,
    finer: usize,
    /// Disparities after the median, px.
    pub(crate) disparity_px: Vec<f32>,
    /// Local noise, px.
    pub(crate) sigma_px: Vec<f32>,
    g: Vec<f32>,
}

impl Images {
    /// What is seen, under a view.
    fn under(&mut self, view: &View) -> Picture<'_> {
        view.fill(self.width, &mut self.g);
        self.picture()
    }

    fn picture(&self) -> Picture<'_> {
        Picture {
            width: self.width,
            disparity_px: &self.disparity_px,
            g: &self.g,
            sigma_px: &self.sigma_px,
            finer: self.finer,
        }
    }
}

/// Finds the horizontal surfaces that a scan shows under a given view. Keeps its buffers.
#[derive(Debug, Clone)]
pub(crate) struct FrameSurfaces<F> {
    finder: F,
    /// What finds them beside it.
    pub(crate) parts: SurfaceParts,
    seen_px: Vec<f32>,
    whole_px: Vec<f32>,
    /// What is seen, pixel by pixel.
    pub(crate) images: Images,
    /// Region of each pixel plus one; 0: none.
    pub(crate) labels: Vec<u16>,
    /// The regions, with `q` from the last fit.
    pub(crate) regions: Vec<Region>,
    /// A fit for each region, away from its border.
    pub(crate) fits: Vec<RegionFit>,
    eroded: Vec<u16>,
    checks: Vec<RegionFit>,
    shown: Vec<RegionFit>,
    erosion: Erosion,
}

impl<F: Finder> FrameSurfaces<F> {
    /// Buffers for this camera, whose image is so many times `finer` than is needed.
    pub(crate) fn new(finder: F, parts: SurfaceParts, camera: &Intrinsics, finer: usize) -> Self {
        let pixels = camera.width * camera.height;
        Self {
            finder,
            erosion: Erosion::new(parts.tuning.hole),
            parts,
            seen_px: Vec::new(),
            whole_px: Vec::new(),
            images: Images {
                width: camera.width,
                finer,
                disparity_px: vec![f32::NAN; pixels],
                sigma_px: vec![0.0; pixels],
                g: vec![0.0; pixels],
            },
            labels: vec![0; pixels],
            regions: Vec::new(),
            fits: Vec::new(),
            eroded: vec![0; pixels],
            checks: Vec::new(),
            shown: Vec::new(),
        }
    }

    /// Takes in a scan: median and local noise.
    pub(crate) fn read(&mut self, scan: &Scan) {
        self.parts.slopes.doubtful.clear();
        self.seen_px.clear();
        self.seen_px.extend(scan.disparity_px.iter().map(|&d| {
            if d > 0.0 && d < f32::INFINITY {
                d
            } else {
                f32::NAN
            }
        }));
        self.parts.median.filter(
            &self.seen_px,
            self.images.width,
            &mut self.images.disparity_px,
        );
        self.parts.noise.measure(&self.images.disparity_px);
        self.parts.noise.fill(&mut self.images.sigma_px);
    }

    /// Leaves out what is further than `reach_m` from the robot, seen from `camera_m` (robot frame), until all is shown again;
    /// says no, and leaves nothing out, where less than `least` pixels would be left.
    pub(crate) fn hide_far(
        &mut self,
        view: &View,
        camera_m: &Vector3<f64>,
        reach_m: f64,
        least: usize,
    ) -> bool {
        let near = NearFeet::new(view, camera_m, reach_m);
        let mut left = 0;
        let width = self.images.width;
        self.whole_px
            .resize(self.images.disparity_px.len(), f32::NAN);
        let lines = self.images.disparity_px.chunks_exact(width);
        let kept = self.whole_px.chunks_exact_mut(width);
        for (row, (line, kept)) in lines.zip(kept).enumerate() {
            left += near.keep(row, line, kept);
        }
        if left >= least {
            std::mem::swap(&mut self.images.disparity_px, &mut self.whole_px);
        }
        left >= least
    }

    /// Whether what is shown of a region is no floor, by its slope; after `refit`.
    pub(crate) fn shown_slopes(&mut self, index: usize, view: &View) -> bool {
        let picture = self.images.picture();
        let (tuning, shown) = (&self.parts.fit_tuning, &mut self.shown);
        fit_regions(picture, view, &self.regions, &self.eroded, tuning, shown);
        let (tilt, certainty) = shown[index].own_tilt();
        tilt.norm() > self.parts.floor_tilt_rad && certainty > self.parts.tuning.steep_sure
    }

    /// Takes back what was left out.
    pub(crate) fn show_all(&mut self) {
        std::mem::swap(&mut self.images.disparity_px, &mut self.whole_px);
    }

    /// The picture under a view.
    pub(crate) fn picture(&mut self, view: &View) -> Picture<'_> {
        self.images.under(view)
    }

    /// Finds the regions in the view, and fits them.
    pub(crate) fn find(&mut self, view: &View, look: Look) {
        let picture = self.images.under(view);
        let (regions, labels) = (&mut self.regions, &mut self.labels);
        self.finder.find(picture, view, look, regions, labels);
        self.fit_inside(view);
    }

    /// Makes regions of the slopes, and fits the others anew; says whether there were any.
    pub(crate) fn find_slopes(&mut self, view: &View, look: Look) -> bool {
        let picture = self.images.under(view);
        let (regions, labels) = (&mut self.regions, &mut self.labels);
        let any = self.parts.slopes.find(picture, view, look, regions, labels);
        if any {
            self.fit_inside(view);
        }
        any
    }

    /// Cuts the regions that hold two levels, and fits anew; says whether there were any.
    pub(crate) fn cut(&mut self, view: &View, tilt: TiltPrior) -> bool {
        let picture = self.images.under(view);
        let (regions, labels) = (&mut self.regions, &mut self.labels);
        let any = self.parts.cuts.cut(picture, view, tilt, regions, labels);
        if any {
            self.fit_inside(view);
        }
        any
    }

    /// Fits the regions away from their borders, in the view that `g` is of.
    fn fit_inside(&mut self, view: &View) {
        let picture = self.images.picture();
        let (border, eroded) = (self.parts.tuning.border, &mut self.eroded);
        self.erosion.erode(&self.labels, picture, border, eroded);
        let mut left = [0_u32; MAX_REGIONS + 1];
        count_labels(&self.eroded, |label, pixels| left[label] += pixels as u32);
        for (region, &left) in self.regions.iter_mut().zip(&left[1..]) {
            region.core = left as usize;
        }
        let min_fit = self.parts.tuning.min_fit;
        let small = left.map(|left| left < min_fit);
        if small[1..=self.regions.len()].contains(&true) {
            keep_where(&self.labels, &mut self.eroded, &small);
        }
        let (tuning, fits) = (&self.parts.fit_tuning, &mut self.fits);
        fit_regions(picture, view, &self.regions, &self.eroded, tuning, fits);
    }

    /// Fits the regions anew after a small turn of the view, and checks the thin ones over more of their pixels.
    pub(crate) fn refit(&mut self, view: &View) {
        let picture = self.images.under(view);
        let (tuning, fits) = (&self.parts.fit_tuning, &mut self.fits);
        fit_regions(picture, view, &self.regions, &self.eroded, tuning, fits);
        for (region, fit) in self.regions.iter_mut().zip(&self.fits) {
            region.q = fit.q(&Vector2::zeros()) as f32;
        }
        self.parts
            .roughness
            .measure(picture, &self.regions, &self.eroded);
        let (regions, labels) = (&self.regions, &self.labels);
        for mixed in self.parts.slopes.doubt(picture, view, regions, labels) {
            self.parts.roughness.forget(mixed);
        }
        self.parts.slivers.find(
            &self.labels,
            [picture.width, picture.finer],
            view,
            &self.regions,
        );
        let (border, eroded) = (self.parts.tuning.thin_border, &mut self.eroded);
        self.erosion.erode(&self.labels, picture, border, eroded);
        let (tuning, checks) = (&self.parts.fit_tuning, &mut self.checks);
        fit_regions(picture, view, &self.regions, &self.eroded, tuning, checks);
    }

    /// How many times finer the image is than is needed, each way.
    pub(crate) const fn finer(&self) -> usize {
        self.images.finer
    }

    /// Row, column and label of pixels away from the regions' borders, every `stride`-th each way; after `refit`.
    pub(crate) fn inner_pixels(&self, stride: usize) -> impl Iterator<Item = (usize, usize, u16)> {
        self.eroded
            .chunks_exact(self.images.width)
            .enumerate()
            .step_by(stride)
            .flat_map(move |(row, line)| {
                line.iter()
                    .enumerate()
                    .step_by(stride)
                    .filter(|(_, label)| **label > 0)
                    .map(move |(col, &label)| (row, col, label))
            })
    }

    /// Gives a region's pixels to another one. What is left of it has none.
    pub(crate) fn join(&mut self, index: usize, other: usize) {
        let (from, to) = (index as u16 + 1, other as u16 + 1);
        for label in self.labels.iter_mut().filter(|label| **label == from) {
            *label = to;
        }
        let support = std::mem::take(&mut self.regions[index].support);
        self.regions[other].support += support;
    }

    /// Whether a region is horizontal, as far as it tells: no slope, no slice of a wall, no sliver at an edge.
    pub(crate) fn is_level(&self, index: usize) -> bool {
        if self.regions[index].q == 0.0 {
            return false;
        }
        let (tilt, certainty) = self.checks[index].own_tilt();
        let steep =
            tilt.norm() > self.parts.tuning.steep && certainty > self.parts.tuning.steep_sure;
        self.fits[index].is_level(self.parts.floor_tilt_rad, self.parts.fit_tuning.significant)
            && !steep
            && !self.parts.slivers.contains(index)
    }
}
