//! Ditches, holes and drops ahead: what a fan of rays skips, and the far wall below the ground.

use geometry::{distance_m, hypot};
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, SHARE, Table, at_least, settings};

use crate::cloud::Point3;

settings! {
    /// How ditches are seen from before them, in a picture of ranges.
    pub struct NegativeObstaclesConfig("classification.negative_obstacles") {
        /// Columns of the picture that are looked at together. More see shallower ditches, fewer narrower ones.
        columns: usize = 11, "1", at_least(1.0);
        /// Share of the columns' pixels in a row that must be measured.
        measured: f64 = 0.5, "1", SHARE;
        /// A ditch is at least so deep.
        depth: f64 = 0.015, "m", POSITIVE;
        /// Standard deviation of a range of 1 m; it grows with the square of the range.
        noise: f64 = 0.02, "m", NOT_NEGATIVE;
        /// What lies below the ground by so many standard deviations of its mean height is below it.
        sigmas: f64 = 4.5, "1", POSITIVE;
        /// From its edge down the ground falls at least so steeply; what falls less is a slope to walk.
        slope: f64 = 0.2, "1", NOT_NEGATIVE;
    }
}

/// What a range camera sees, in a frame whose z = 0 is the ground under the robot, z up.
#[derive(Debug, Clone, PartialEq)]
pub struct RangePicture {
    /// Width of the picture, pixels.
    pub cols: usize,
    /// Where each pixel's ray ends, row by row from the top, m; `None` where nothing was measured.
    pub hits: Vec<Option<Point3>>,
    /// Where the camera is, m.
    pub eye: Point3,
}

/// A ditch, a hole or a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NegativeObstacle {
    /// The last ground before it, m.
    pub near_m: [f64; 2],
    /// Where the ground goes on behind its far wall, m; `None` where none is seen.
    pub far_m: Option<[f64; 2]>,
    /// How far it reaches below the ground, m: the height of the far wall that is seen.
    pub depth_m: f64,
    /// Columns of the picture in which it is seen: the first, and the one behind the last.
    pub cols: [usize; 2],
}

/// Less noise is none.
const NEGLIGIBLE_M: f64 = 1e-9;

/// What some columns of a picture show in one row.
#[derive(Debug, Clone, Copy)]
struct FanStep {
    place_m: [f64; 2],
    away_m: f64,
    height_m: f64,
    variance_m2: f64,
}

/// Finds negative obstacles: handbook, section 36.3.5 (after Heckman, Lalonde, Vandapel and Hebert, IROS 2007).
///
/// Claim: on the way from near to far along a fan of rays the hits skip from the near edge to what lies below the ground, and come
/// up at the far wall; no statistics of a neighbourhood show that.
#[derive(Debug, Clone)]
pub struct NegativeObstacles {
    config: NegativeObstaclesConfig,
}

impl NegativeObstacles {
    /// With settings.
    pub fn new(config: NegativeObstaclesConfig) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// The ditches of a picture, from its left to its right; columns that lie side by side may show the same one.
    pub fn find(&self, picture: &RangePicture) -> Vec<NegativeObstacle> {
        let wide = self.config.columns.min(picture.cols);
        let stride = wide.div_ceil(2).max(1);
        (0..(picture.cols + 1).saturating_sub(wide))
            .step_by(stride)
            .flat_map(|first| {
                let steps = self.steps(picture, [first, first + wide]);
                self.along(&steps, [first, first + wide])
            })
            .collect()
    }

    /// What the columns show, row by row from near to far.
    fn steps(&self, picture: &RangePicture, [first, end]: [usize; 2]) -> Vec<FanStep> {
        let least = self.config.measured * (end - first) as f64;
        let rows = picture.hits.chunks_exact(picture.cols.max(1)).rev();
        rows.filter_map(|row| {
            let hits = || row[first..end].iter().flatten();
            let count = hits().count() as f64;
            if count == 0.0 || count < least {
                return None;
            }
            let [x, y, height_m] =
                [0, 1, 2].map(|axis| hits().map(|hit| hit[axis]).sum::<f64>() / count);
            let away_m = distance_m([x, y], [picture.eye[0], picture.eye[1]]);
            let below_eye_m = picture.eye[2] - height_m;
            let range_m = hypot(away_m, below_eye_m);
            // An error of the range moves the hit along the ray: its height by the ray's steepness.
            let sigma_m = (self.config.noise * range_m * below_eye_m).max(NEGLIGIBLE_M);
            Some(FanStep {
                place_m: [x, y],
                away_m,
                height_m,
                variance_m2: sigma_m * sigma_m / count,
            })
        })
        .collect()
    }

    /// The ditches on the way from near to far.
    fn along(&self, steps: &[FanStep], cols: [usize; 2]) -> Vec<NegativeObstacle> {
        let low = |step: &FanStep| step.height_m < -self.config.depth / 2.0;
        let mut found = Vec::new();
        let mut at = 0;
        while at < steps.len() {
            let end = at + steps[at..].iter().take_while(|step| low(step)).count();
            if end == at {
                at += 1;
                continue;
            }
            if let Some(edge) = at.checked_sub(1).map(|before| &steps[before]) {
                found.extend(self.ditch(edge, &steps[at..end], steps.get(end), cols));
            }
            at = end;
        }
        found
    }

    /// What lies between an edge and where the ground goes on, where it is a ditch.
    fn ditch(
        &self,
        edge: &FanStep,
        below: &[FanStep],
        beyond: Option<&FanStep>,
        cols: [usize; 2],
    ) -> Option<NegativeObstacle> {
        let weight: f64 = below.iter().map(|step| 1.0 / step.variance_m2).sum();
        let heights = below.iter().map(|step| step.height_m / step.variance_m2);
        let below_m = -heights.sum::<f64>() / weight;
        let sure = below_m > self.config.sigmas * (1.0 / weight).sqrt();
        let steep = below.iter().any(|step| {
            let fall_m = -step.height_m;
            fall_m >= self.config.depth && fall_m >= self.config.slope * (step.away_m - edge.away_m)
        });
        let lowest_m = (below.iter()).fold(0.0, |low: f64, step| low.min(step.height_m));
        (sure && steep).then(|| NegativeObstacle {
            near_m: edge.place_m,
            far_m: beyond.map(|step| step.place_m),
            depth_m: -lowest_m,
            cols,
        })
    }
}

#[cfg(test)]
mod tests;
