//! Scan-line grouping: the segmenter `scan_line`.
//!
//! After Jiang and Bunke (1994) as 003, section III, uses it, in disparity instead of metres: first the floor's normal,
//! then lines of constant `q = d / g` on strips of columns, regions grown over them and over pixels, heights fitted away
//! from the regions' borders, and the ground, whose plane corrects the camera's pose.

mod config;
mod correction;
mod erosion;
mod fit;
mod grouping;
mod horizon;
mod median;
mod noise;
mod product;
mod strips;
#[cfg(test)]
mod tests;
mod view;
mod walls;

use geometry::{Camera, ConfigError, Pose, Robot};
use nalgebra::{Rotation3, Vector2};
use sensing::{Intrinsics, Scan};

use crate::{Planes, SegmentError, Segmenter};
pub use config::ScanLineConfig;
use correction::Correction;
use erosion::Erosion;
use fit::{RegionFit, fit_regions, shared_tilt};
use grouping::{Grouping, GrowthRules, Region};
use horizon::{HorizonSearch, SearchArea};
use noise::NoiseMap;
use product::ProductBuffers;
use strips::{Picture, Segment, StripRules, Strips};
use view::{View, levelling};
use walls::Walls;

/// Pixels left and right, above and below that are taken off a region before a fit: half a window of 5 and one more
/// (7x5), and half of that for regions that would vanish.
const EROSION: (usize, usize) = (2, 3);
/// Pixels that must be left for a fit; else all of the region's count.
const MIN_FIT: u32 = 24;
/// How far a tilt may be from the predicted one: sigma, rad, while tracked and while searched.
const TRACKED_RAD: f64 = 0.02;
const SEARCHED_RAD: f64 = 0.1;
/// Roughest ground that is accepted in a search, in noise: a plane laid through several steps is rougher.
const SMOOTH: f64 = 1.35;

/// The scan-line segmenter.
#[derive(Debug, Clone)]
pub struct ScanLine {
    config: ScanLineConfig,
    camera: Intrinsics,
    correction: Correction,
    noise: NoiseMap,
    sigma_px: Vec<f32>,
    disparity_px: Vec<f32>,
    g: Vec<f32>,
    labels: Vec<u16>,
    eroded: Vec<u16>,
    segments: Vec<Segment>,
    regions: Vec<Region>,
    fits: Vec<RegionFit>,
    strips: Strips,
    grouping: Grouping,
    erosion: Erosion,
    search: HorizonSearch,
    walls: Walls,
    product: ProductBuffers,
}

/// A frame's camera: where it was predicted, and the tilt found on top.
#[derive(Debug, Clone, Copy)]
struct Levelled {
    predicted: Pose<Robot, Camera>,
    tilt: Vector2<f64>,
    view: View,
}

impl Levelled {
    fn new(camera: &Intrinsics, predicted: Pose<Robot, Camera>, tilt: Vector2<f64>) -> Self {
        let rotation = levelling(tilt.x, tilt.y) * predicted.inner.rotation.to_rotation_matrix();
        Self {
            predicted,
            tilt,
            view: View::new(camera, &rotation),
        }
    }

    /// The turn from the predicted camera to the levelled one, robot's axes.
    fn turn(&self) -> Rotation3<f64> {
        levelling(self.tilt.x, self.tilt.y)
    }

    /// The tilt on top of the prediction after a further one was found in the levelled axes.
    fn further(&self, tilt: &Vector2<f64>) -> Vector2<f64> {
        let up = self.turn().inverse() * nalgebra::Vector3::new(tilt.x, tilt.y, 1.0);
        Vector2::new(up.x / up.z, up.y / up.z)
    }
}

impl ScanLine {
    /// A segmenter for this camera that knows nothing of the camera's errors yet.
    pub fn new(config: ScanLineConfig, camera: Intrinsics) -> Result<Self, ConfigError> {
        config.check()?;
        let pixels = camera.width * camera.height;
        Ok(Self {
            noise: NoiseMap::new(
                camera.width,
                camera.height,
                config.noise_floor,
                config.noise_ceiling,
            ),
            correction: Correction::new(),
            sigma_px: vec![0.0; pixels],
            disparity_px: vec![f32::NAN; pixels],
            g: vec![0.0; pixels],
            labels: vec![0; pixels],
            eroded: vec![0; pixels],
            segments: Vec::new(),
            regions: Vec::new(),
            fits: Vec::new(),
            strips: Strips::default(),
            grouping: Grouping::default(),
            erosion: Erosion::default(),
            search: HorizonSearch::default(),
            walls: Walls::default(),
            product: ProductBuffers::default(),
            config,
            camera,
        })
    }

    /// Whether the ground is searched from nothing, as at the start and after it was lost for long.
    fn searching(&self) -> bool {
        self.correction.missed().is_none()
    }

    /// Grows regions in the view; `whole` also lets them take in pixels and join.
    fn grow_regions(&mut self, view: &View, whole: bool) {
        let config = &self.config;
        let width = self.camera.width;
        view.fill(width, &mut self.g);
        let picture = Picture {
            width,
            disparity_px: &self.disparity_px,
            g: &self.g,
            sigma_px: &self.sigma_px,
        };
        let strip_rules = StripRules {
            strip: config.strip,
            price: config.segment_price as f32,
            min_segment: config.min_segment,
            scale: (self.camera.focal_px * self.camera.baseline_m) as f32,
        };
        let rules = GrowthRules {
            strip: config.strip,
            join: config.join as f32,
            accept: config.accept as f32,
            min_region: config.min_region,
        };
        let (regions, labels) = (&mut self.regions, &mut self.labels);
        self.segments.clear();
        self.strips.cut(picture, strip_rules, &mut self.segments);
        self.grouping
            .group(picture, &self.segments, rules, regions, labels);
        if whole {
            self.grouping.grow(picture, rules, regions, labels);
            self.grouping.merge(picture, rules, regions, labels);
        }
        self.erosion.erode(
            labels,
            picture.disparity_px,
            width,
            EROSION,
            &mut self.eroded,
        );
        keep_thin_regions(&self.labels, &mut self.eroded);
        let fits = &mut self.fits;
        fit_regions(picture, view, &self.regions, &self.eroded, fits);
    }

    /// Finds the camera's tilt against the prediction and the regions that are seen with it.
    fn level(&mut self, predicted: Pose<Robot, Camera>) -> Levelled {
        let searching = self.searching();
        let (sigma, level_rad) = if searching {
            (SEARCHED_RAD, 1.3 * self.config.floor_tilt)
        } else {
            (TRACKED_RAD, self.config.floor_tilt)
        };
        let mut levelled = Levelled::new(&self.camera, predicted, Vector2::zeros());
        let guess = self.guess_tilt(&levelled);
        levelled = Levelled::new(&self.camera, predicted, guess);
        for whole in [false, true] {
            self.grow_regions(&levelled.view, whole);
            let expected = -levelled.tilt;
            let tilt = shared_tilt(&self.fits, level_rad, &expected, sigma);
            levelled = Levelled::new(&self.camera, predicted, levelled.further(&tilt));
        }
        self.refit(&levelled.view);
        levelled
    }

    /// Fits the regions anew after the last turn of the view.
    fn refit(&mut self, view: &View) {
        let width = self.camera.width;
        view.fill(width, &mut self.g);
        let picture = Picture {
            width,
            disparity_px: &self.disparity_px,
            g: &self.g,
            sigma_px: &self.sigma_px,
        };
        fit_regions(picture, view, &self.regions, &self.eroded, &mut self.fits);
        for (region, fit) in self.regions.iter_mut().zip(&self.fits) {
            region.q = fit.q(&Vector2::zeros()) as f32;
        }
        fit_regions(picture, view, &self.regions, &self.eroded, &mut self.fits);
    }

    fn guess_tilt(&mut self, level: &Levelled) -> Vector2<f64> {
        level.view.fill(self.camera.width, &mut self.g);
        let picture = Picture {
            width: self.camera.width,
            disparity_px: &self.disparity_px,
            g: &self.g,
            sigma_px: &self.sigma_px,
        };
        let height_m = level.predicted.inner.translation.z;
        let area = if self.searching() {
            let slack = 2.0 * self.config.ground_height;
            SearchArea {
                tilt_rad: self.config.search_tilt,
                step_rad: self.config.search_tilt / 6.0,
                below_m: (height_m - slack, height_m + slack),
            }
        } else {
            SearchArea {
                tilt_rad: 0.014,
                step_rad: 0.014,
                below_m: (0.1, height_m + 0.1),
            }
        };
        self.search.search(picture, &level.view, area)
    }

    /// The ground among the regions: the largest level one close to where the ground is expected.
    fn find_ground(&self, levelled: &Levelled) -> Option<usize> {
        let config = &self.config;
        let pixels = self.labels.len() as f64;
        let tilt = &levelled.tilt;
        let (gate_m, least, straight) = if self.searching() {
            let least = (config.open_floor * pixels) as usize;
            let straight = tilt.amax() < config.search_tilt;
            (config.ground_height, least.max(config.min_ground), straight)
        } else {
            let straight = tilt.norm() < config.track_tilt;
            (config.track_height, config.min_ground, straight)
        };
        if !straight {
            return None;
        }
        let camera_m = levelled.predicted.inner.translation.z;
        (0..self.regions.len())
            .filter(|&i| {
                let (region, fit) = (&self.regions[i], &self.fits[i]);
                let height_m = camera_m - 1.0 / f64::from(region.q);
                let off_the_joints_m = height_m - self.correction.height_m();
                region.support >= least
                    && height_m.abs() < gate_m
                    && off_the_joints_m.abs() < config.ground_height
                    && fit.is_level(config.floor_tilt)
                    && (!self.searching() || fit.roughness() < SMOOTH)
            })
            .max_by_key(|&i| (self.regions[i].support, std::cmp::Reverse(i)))
    }
}

/// Regions of which too little is left after the erosion are fitted as a whole.
fn keep_thin_regions(labels: &[u16], eroded: &mut [u16]) {
    let mut left = [0_u32; grouping::MAX_REGIONS + 1];
    for &label in eroded.iter() {
        left[usize::from(label)] += 1;
    }
    for (eroded, &label) in eroded.iter_mut().zip(labels) {
        if label > 0 && left[usize::from(label)] < MIN_FIT {
            *eroded = label;
        }
    }
}

impl Segmenter for ScanLine {
    fn segment(&mut self, scan: &Scan, planes: &mut Planes) -> Result<(), SegmentError> {
        let expected = self.disparity_px.len();
        for found in [scan.disparity_px.len(), planes.labels.len()] {
            if found != expected {
                return Err(SegmentError::WrongSize { expected, found });
            }
        }
        median::median(
            &scan.disparity_px,
            self.camera.width,
            &mut self.disparity_px,
        );
        self.noise.measure(&self.disparity_px);
        self.noise.fill(&mut self.sigma_px);
        let predicted = self.correction.predict(&scan.robot_from_camera);
        let mut levelled = self.level(predicted);
        let ground = self.find_ground(&levelled);
        let mut rise_m = 0.0;
        if let Some(ground) = ground {
            rise_m = 1.0 / f64::from(self.regions[ground].q) - predicted.inner.translation.z;
            let turn = levelled.turn().scaled_axis();
            self.correction
                .found(&predicted, &Vector2::new(turn.x, turn.y), rise_m);
        } else {
            if self.searching() || levelled.tilt.norm() >= self.config.track_tilt {
                // Nothing to hold on to: what is seen is shown where the joints have it.
                levelled = Levelled::new(&self.camera, predicted, Vector2::zeros());
                self.grow_regions(&levelled.view, true);
                self.refit(&levelled.view);
            }
            self.correction.missed_one(self.config.forget_frames);
        }
        planes.exposure_ns = scan.exposure_ns;
        planes.ground = ground;
        planes.reliable = ground.is_some()
            || self
                .correction
                .missed()
                .is_some_and(|missed| missed <= self.config.hold_frames);
        self.fill_product(&levelled, rise_m, planes);
        Ok(())
    }
}
