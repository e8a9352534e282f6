//! Planes in any direction among the pixels that no horizontal surface took: walls, sides of boxes, slopes.
//!
//! Blocks of pixels are fitted, then grown together as long as they agree.

use nalgebra::{Point2, Vector3};
use sensing::Intrinsics;
use settings::{POSITIVE, settings, within};

use crate::picture::neighbours;
use crate::planes::{PlaneRegion, Planes};
use crate::regions::tilted::{PlaneSums, TiltedRecord};

settings! {
    /// How planes in any direction are found among the pixels that no level surface took.
    pub struct WallTuning("navigation.ground.tuning.walls") {
        /// Side of the blocks that are fitted by themselves and then joined.
        block: usize = 8, "1", within(2.0, 100.0);
        /// Fewest free pixels of a block that is fitted.
        min_block: usize = 36, "1", within(3.0, 10000.0);
        /// Fewest pixels of a plane.
        min_pixels: usize = 120, "1", within(3.0, 1e9);
        /// A block is no part of a plane when its pixels scatter by more than so many times their noise.
        smooth: f64 = 1.3, "1", POSITIVE;
        /// Blocks are joined when their planes lie closer to each other than so many times the noise at the block's corners.
        agree: f64 = 2.5, "1", POSITIVE;
        /// A pixel belongs to a plane when it is closer to it than so many times its noise.
        accept: f64 = 2.5, "1", POSITIVE;
    }
}

/// A plane with a smaller normal over distance than this lies at infinity, px.
const AT_INFINITY_PX: f64 = 1e-6;

#[derive(Debug, Clone, Copy, Default)]
struct WallBlock {
    sums: PlaneSums,
    plane: Option<Vector3<f64>>,
    taken: bool,
}

/// Finds planes in any direction. Keeps its buffers.
#[derive(Debug, Clone)]
pub(crate) struct Walls {
    tuning: WallTuning,
    // As in `TiltedTuning`.
    least_rise: f64,
    blocks: Vec<WallBlock>,
    members: Vec<usize>,
    corners: Vec<Point2<f64>>,
}

impl Walls {
    /// Empty buffers; a plane whose normal rises by more than `least_rise` gets an outline.
    pub(crate) const fn new(tuning: WallTuning, least_rise: f64) -> Self {
        Self {
            tuning,
            least_rise,
            blocks: Vec::new(),
            members: Vec::new(),
            corners: Vec::new(),
        }
    }

    /// Appends planes to `planes.regions` and writes their labels where `labels` is 0.
    pub(crate) fn find(
        &mut self,
        disparity_px: &[f32],
        camera: &Intrinsics,
        sigma_px: &[f32],
        labels: &mut [u16],
        planes: &mut Planes,
    ) {
        let block = self.tuning.block;
        let image = WallImage {
            disparity_px,
            camera,
            sigma_px,
            block,
            across: camera.width / block,
            blocks: (camera.width / block) * (camera.height / block),
        };
        self.fit_blocks(&image, labels);
        for seed in 0..self.blocks.len() {
            if self.blocks[seed].taken || self.blocks[seed].plane.is_none() {
                continue;
            }
            let Some(plane) = self.grow(&image, seed) else {
                continue;
            };
            let label = planes.regions.len() as u16 + 1;
            if let Some(region) = self.describe(&image, &plane, label, labels, planes) {
                planes.regions.push(region);
            }
        }
    }

    fn fit_blocks(&mut self, image: &WallImage<'_>, labels: &[u16]) {
        let (min_block, smooth) = (self.tuning.min_block, self.tuning.smooth);
        self.blocks.clear();
        for block in 0..image.blocks {
            let mut sums = PlaneSums::default();
            if image.free_pixels(block, labels) >= min_block {
                for (col, row) in image.pixels(block) {
                    let at = row * image.camera.width + col;
                    let d = image.disparity_px[at];
                    if labels[at] == 0 && !d.is_nan() {
                        sums.add(image.camera.ray(col, row), f64::from(d));
                    }
                }
            }
            let plane = (sums.count() >= min_block as f64)
                .then(|| sums.plane())
                .flatten()
                .filter(|plane| sums.roughness_px(plane) < smooth * image.block_sigma_px(block));
            self.blocks.push(WallBlock {
                sums,
                plane,
                taken: false,
            });
        }
    }

    /// Joins blocks to the seed as long as they agree with the plane through all so far; `None` when too few did.
    fn grow(&mut self, image: &WallImage<'_>, seed: usize) -> Option<Vector3<f64>> {
        let (agree, min_pixels) = (self.tuning.agree, self.tuning.min_pixels);
        self.members.clear();
        self.members.push(seed);
        self.blocks[seed].taken = true;
        let mut sums = self.blocks[seed].sums;
        let mut plane = self.blocks[seed].plane?;
        let mut next = 0;
        while next < self.members.len() {
            let at = self.members[next];
            next += 1;
            for beside in neighbours(at, image.across, image.blocks) {
                let block = self.blocks[beside];
                let Some(other) = block.plane.filter(|_| !block.taken) else {
                    continue;
                };
                if image.apart_px(beside, &plane, &other) < agree * image.block_sigma_px(beside) {
                    self.blocks[beside].taken = true;
                    self.members.push(beside);
                    sums.join(&block.sums);
                    plane = sums.plane()?;
                }
            }
        }
        (sums.count() >= min_pixels as f64 && plane.norm() > AT_INFINITY_PX).then_some(plane)
    }

    fn describe(
        &mut self,
        image: &WallImage<'_>,
        in_camera: &Vector3<f64>,
        label: u16,
        labels: &mut [u16],
        planes: &Planes,
    ) -> Option<PlaneRegion> {
        let (pose, accept) = (planes.robot_from_camera.inner, self.tuning.accept);
        let mut record = TiltedRecord::new(image.camera, pose, *in_camera, &mut self.corners);
        for &block in &self.members {
            for (col, row) in image.pixels(block) {
                let at = row * image.camera.width + col;
                let ray = Vector3::from(image.camera.ray(col, row));
                let there = in_camera.dot(&ray);
                let miss = f64::from(image.disparity_px[at]) - there;
                let close = miss.abs() < accept * f64::from(image.sigma_px[at]);
                if labels[at] == 0 && close && there > 0.0 {
                    labels[at] = label;
                    record.add(&ray, there);
                }
            }
        }
        record.finish(self.least_rise)
    }
}

struct WallImage<'a> {
    disparity_px: &'a [f32],
    camera: &'a Intrinsics,
    sigma_px: &'a [f32],
    /// Side of a block, pixels.
    block: usize,
    across: usize,
    blocks: usize,
}

impl WallImage<'_> {
    /// First column and first row of a block.
    const fn corner(&self, block: usize) -> (usize, usize) {
        let (i, j) = (block % self.across, block / self.across);
        (i * self.block, j * self.block)
    }

    fn pixels(&self, block: usize) -> impl Iterator<Item = (usize, usize)> {
        let (left, top) = self.corner(block);
        let side = self.block;
        (top..top + side).flat_map(move |row| (left..left + side).map(move |col| (col, row)))
    }

    /// Seen pixels of a block that no region took.
    fn free_pixels(&self, block: usize, labels: &[u16]) -> usize {
        let free = |&(col, row): &(usize, usize)| {
            let at = row * self.camera.width + col;
            labels[at] == 0 && !self.disparity_px[at].is_nan()
        };
        self.pixels(block).filter(free).count()
    }

    fn block_sigma_px(&self, block: usize) -> f64 {
        let (col, row) = self.corner(block);
        f64::from(self.sigma_px[(row + self.block / 2) * self.camera.width + col + self.block / 2])
    }

    /// Largest distance of two planes at the corners of a block, px.
    fn apart_px(&self, block: usize, a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
        let (left, top) = self.corner(block);
        let last = self.block - 1;
        [(0, 0), (last, 0), (0, last), (last, last)]
            .iter()
            .map(|(col, row)| {
                let ray = Vector3::from(self.camera.ray(left + col, top + row));
                (a - b).dot(&ray).abs()
            })
            .fold(0.0, f64::max)
    }
}
