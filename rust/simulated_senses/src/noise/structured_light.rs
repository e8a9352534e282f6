//! From what the rays met to the depth image that a Kinect or an Xtion would give.
//!
//! A projector beside the camera throws a pattern of dots; each small window of the image is found in the stored picture of the
//! pattern. Its place there is a disparity, in steps of an eighth of a pixel of the 640 pixels wide sensor: Z = f b / d, so that
//! `sigma_Z = Z^2 sigma_d / (f b)` (Khoshelham and Oude Elberink, Sensors 12, 2012). At the borders of surfaces a window may be found
//! on either of them (the lateral noise of Nguyen, Izadi and Lovell, 3DIMPVT 2012). Texture does not matter: the light brings its own.

use geometry::{GOLDEN, SplitMix64, mix};
use settings::{ConfigError, Table};

use crate::error::{SceneError, of_length};
use crate::noise::draws::bell;
use crate::noise::occlusion::hidden;
use crate::noise::structured_light_config::StructuredLightConfig;
use crate::noise::wandering::Wandering;
use crate::noise::window::{LastRows, fold_along, larger, smaller};
use crate::noise::{LARGEST, nearest};
use crate::picture::TruePicture;
use crate::pinhole::Pinhole;

/// Marks of a pixel: its surface is seen steeply enough; a neighbour is on another surface; one is within the reach of a border's
/// wandering.
const FACING: u32 = 1;
const BORDER: u32 = 2;
const RESTLESS: u32 = 4;

/// A structured-light camera's errors, all of them new in each frame.
#[derive(Debug, Clone)]
pub struct StructuredLightErrors {
    config: StructuredLightConfig,
    pinhole: Pinhole,
    stream: SplitMix64,
    wandering: Wandering,
    rows: LightRows,
}

/// LightRows that are made anew for each row of the picture.
#[derive(Debug, Clone)]
struct LightRows {
    /// The whole picture's, px.
    disparity: Vec<f32>,
    /// A row with its ends repeated as far as borders wander.
    padded: Vec<f32>,
    largest: LastRows,
    smallest: LastRows,
    high: Vec<f32>,
    low: Vec<f32>,
    /// Steps from each pixel to the next one, with the first and the last twice; to the row below; and from the row above, px.
    across: Vec<f32>,
    ahead: Vec<f32>,
    behind: Vec<f32>,
    marks: Vec<u32>,
    found: Vec<f32>,
    coarse: Vec<f32>,
    noise: Vec<f32>,
    place: Vec<f32>,
    hidden: Vec<bool>,
}

impl LightRows {
    fn new(pinhole: &Pinhole, window: usize, reach: usize) -> Self {
        let row = || vec![0.0; pinhole.width];
        let last = || LastRows::new(2 * reach + 1, pinhole.width);
        Self {
            disparity: vec![0.0; pinhole.pixels()],
            padded: vec![0.0; pinhole.width + 2 * reach],
            largest: last(),
            smallest: last(),
            high: row(),
            low: row(),
            across: vec![0.0; pinhole.width + 1],
            ahead: row(),
            behind: row(),
            marks: vec![0; pinhole.width],
            found: row(),
            coarse: vec![0.0; pinhole.width.div_ceil(window)],
            noise: row(),
            place: row(),
            hidden: vec![false; pinhole.width],
        }
    }
}

impl StructuredLightErrors {
    /// The camera's errors; `noise` seeds them.
    pub fn new(
        config: StructuredLightConfig,
        pinhole: &Pinhole,
        noise: u64,
    ) -> Result<Self, ConfigError> {
        config.check()?;
        let wandering = Wandering::new(config.lateral_noise);
        Ok(Self {
            rows: LightRows::new(pinhole, config.window, wandering.reach()),
            pinhole: *pinhole,
            stream: SplitMix64::new(noise),
            wandering,
            config,
        })
    }

    /// Writes the measured depth, m along the axis, NaN for none.
    pub fn see(&mut self, picture: &TruePicture, depth_m: &mut [f32]) -> Result<(), SceneError> {
        of_length("depth", depth_m.len(), self.pinhole.pixels())?;
        of_length("picture", picture.body().len(), self.pinhole.pixels())?;
        let scale = self.pinhole.focal_px * self.config.baseline;
        for (disparity, near) in self.rows.disparity.iter_mut().zip(picture.nearness()) {
            *disparity = (scale * near) as f32;
        }
        let key = self.stream.next_bits();
        for row in 0..self.wandering.reach() {
            self.read_extremes(row);
        }
        let width = self.pinhole.width;
        for (row, depth_m) in depth_m.chunks_exact_mut(width).enumerate() {
            self.read_extremes(row + self.wandering.reach());
            self.read_steps(row);
            self.mark(row);
            self.find(row, key);
            self.make_noise(row);
            self.write_row(row, depth_m);
        }
        Ok(())
    }

    /// Folds a row's extremes as far as borders wander.
    fn read_extremes(&mut self, row: usize) {
        let (rows, reach, width) = (&mut self.rows, self.wandering.reach(), self.pinhole.width);
        // Below the last row the ones above it stay: then more is looked at than need be.
        if row >= self.pinhole.height {
            return;
        }
        let disparity = &rows.disparity[row * width..(row + 1) * width];
        rows.padded[..reach].fill(disparity[0]);
        rows.padded[reach..reach + width].copy_from_slice(disparity);
        rows.padded[reach + width..].fill(disparity[width - 1]);
        // Before the first rows there are none: the first one stands in all their places.
        let places = if row == 0 {
            0..2 * reach + 1
        } else {
            row..row + 1
        };
        for place in places {
            fold_along(
                &rows.padded,
                2 * reach + 1,
                rows.largest.place(place),
                larger,
            );
            fold_along(
                &rows.padded,
                2 * reach + 1,
                rows.smallest.place(place),
                smaller,
            );
        }
    }

    /// Makes the steps to a row's neighbours.
    fn read_steps(&mut self, row: usize) {
        let (rows, width, height) = (&mut self.rows, self.pinhole.width, self.pinhole.height);
        let disparity = &rows.disparity[row * width..];
        let steps = disparity.iter().zip(&disparity[1..width]);
        for (step, (here, next)) in rows.across[1..].iter_mut().zip(steps) {
            *step = next - here;
        }
        if width > 1 {
            rows.across[0] = rows.across[1];
            rows.across[width] = rows.across[width - 1];
        }
        std::mem::swap(&mut rows.ahead, &mut rows.behind);
        if row + 1 < height {
            let (here, next) = disparity.split_at(width);
            for (step, (here, next)) in rows.ahead.iter_mut().zip(here.iter().zip(next)) {
                *step = next - here;
            }
        } else {
            rows.ahead.copy_from_slice(&rows.behind);
        }
        if row == 0 {
            rows.behind.copy_from_slice(&rows.ahead);
        }
    }

    /// Marks what a row's pixels are. On a plane n . P = k the disparity is d = (f b / k) n . ray, so that its slopes tell n.
    fn mark(&mut self, row: usize) {
        let (config, rows, pinhole) = (&self.config, &mut self.rows, &self.pinhole);
        rows.largest.fold(&mut rows.high, larger);
        rows.smallest.fold(&mut rows.low, smaller);
        let width = pinhole.width;
        let jump = config.edge_jump as f32;
        let over_focal = (1.0 / pinhole.focal_px) as f32;
        let down = (row as f64 - pinhole.middle_row()) as f32;
        let down_square = 1.0 + (down * over_focal) * (down * over_focal);
        let middle = pinhole.middle_column() as f32;
        let least = libm::cos(config.steepest) * pinhole.focal_px;
        let least = (least * least) as f32;
        let disparity = &rows.disparity[row * width..(row + 1) * width];
        let across = rows.across.iter().zip(&rows.across[1..]);
        let downwards = rows.behind.iter().zip(&rows.ahead);
        let spread = rows.high.iter().zip(&rows.low);
        let pixels = disparity.iter().zip(spread).zip(across.zip(downwards));
        for (column, (mark, ((disparity, (high, low)), ((left, right), (up, below))))) in
            rows.marks.iter_mut().zip(pixels).enumerate()
        {
            let border = (left.abs() > jump)
                | (right.abs() > jump)
                | (up.abs() > jump)
                | (below.abs() > jump);
            let slope_x = if right.abs() < left.abs() {
                right
            } else {
                left
            };
            let slope_y = if below.abs() < up.abs() { below } else { up };
            let x = column as f32 - middle;
            let ahead = (disparity - slope_x * x - slope_y * down) * over_focal;
            let normal = slope_x * slope_x + slope_y * slope_y + ahead * ahead;
            let ray = down_square + (x * over_focal) * (x * over_focal);
            let facing = disparity * disparity >= least * ray * normal;
            let restless = high - low > jump;
            *mark = (u32::from(facing) * FACING)
                | (u32::from(border) * BORDER)
                | (u32::from(restless) * RESTLESS);
        }
    }

    /// Finds a row's disparities, with borders off their places, and leaves out some pixels at borders. Within one surface the noise
    /// in depth is all that was measured, so that a pixel takes the place of one beside it only where that is on another surface.
    fn find(&mut self, row: usize, key: u64) {
        let (config, rows, width) = (&self.config, &mut self.rows, self.pinhole.width);
        let jump = config.edge_jump as f32;
        let begin = row * width;
        rows.found
            .copy_from_slice(&rows.disparity[begin..begin + width]);
        for (column, (found, mark)) in rows.found.iter_mut().zip(&mut rows.marks).enumerate() {
            if *mark < BORDER {
                continue;
            }
            let draw = |which: usize| {
                let place = 2 * (begin + column) + which;
                mix(key.wrapping_add((place as u64).wrapping_mul(GOLDEN)))
            };
            let bits = draw(1);
            let at_row = self.wandering.seen(row, bits as u32, self.pinhole.height);
            let at_column = self.wandering.seen(column, (bits >> 32) as u32, width);
            let beside = rows.disparity[at_row * width + at_column];
            if (beside - *found).abs() > jump {
                *found = beside;
            }
            if *mark & BORDER != 0 && SplitMix64::new(draw(2)).uniform() < config.edge_dropout {
                *mark = 0;
            }
        }
    }

    /// Makes a row's noise, the same over windows.
    fn make_noise(&mut self, row: usize) {
        let (rows, window) = (&mut self.rows, self.config.window);
        if !row.is_multiple_of(window) {
            return;
        }
        bell(&mut self.stream, &mut rows.coarse);
        let deviation = self.config.unrounded_px() as f32;
        for (wide, value) in rows.noise.chunks_mut(window).zip(&rows.coarse) {
            wide.fill(value * deviation);
        }
    }

    /// Writes a row's depths.
    fn write_row(&mut self, row: usize, depth_m: &mut [f32]) {
        let (config, rows, width) = (&self.config, &mut self.rows, self.pinhole.width);
        let disparity = &rows.disparity[row * width..(row + 1) * width];
        hidden(disparity, &mut rows.place, &mut rows.hidden);
        let scale = self.pinhole.focal_px * config.baseline;
        let (least, most) = (scale / config.farthest, scale / config.nearest);
        for (found, noise) in rows.found.iter_mut().zip(&rows.noise) {
            // What nothing was found for stays so.
            *found = if *found > 0.0 { *found + noise } else { 0.0 };
        }
        // A finer step than single precision tells is none.
        if most / config.quantum < f64::from(LARGEST) {
            let (quantum, steps) = (config.quantum as f32, (1.0 / config.quantum) as f32);
            for found in &mut rows.found {
                *found = nearest(*found * steps) * quantum;
            }
        }
        let (scale, least, most) = (scale as f32, least as f32, most as f32);
        let known = rows.found.iter().zip(rows.marks.iter().zip(&rows.hidden));
        for (depth, (found, (mark, hidden))) in depth_m.iter_mut().zip(known) {
            let seen = mark & FACING != 0 && !hidden && *found >= least && *found <= most;
            *depth = if seen { scale / found } else { f32::NAN };
        }
    }
}
