//! A step fitted to the disparities: the place and heading of an edge between two level surfaces, good enough to step by.
//!
//! Beyond 003, whose convex boundaries are off by one to three centimetres. The step is the near surface, an upright face
//! and the far surface; going down the face is hidden and the near surface's border hides the start of the far one. All
//! three planes are linear in disparity, so a ray's first hit is a few comparisons. Block matching blends over its window
//! what it sees, and so does the model.

mod coarse;
mod excerpt;
mod product;
mod refine;
mod sight;
#[cfg(test)]
mod tests;
mod visible;
mod window;

use geometry::{Point, Robot};
use nalgebra::{Matrix4, Vector4};
use segmentation::Planes;
use sensing::{Intrinsics, Scan};

use crate::Edge;
use coarse::Coarse;
use excerpt::{Excerpt, Stretch, area_of, pixel_m, stretch_in_view};
pub use product::{FittedEdge, Untrusted};
use refine::Equations;
use sight::{Sight, Step};

/// Least change of height that shows, m.
const LEAST_RISE_M: f64 = 0.008;
/// How far the first look goes beyond the pixels that take part in the end, m.
const SLACK_M: f64 = 0.03;
/// Steps of the refinement, with another choice of pixels after the first few.
const ROUNDS: [usize; 2] = [3, 6];
/// The refinement is at rest below these changes of place (m) and heading (rad).
const REST: (f64, f64) = (0.0003, 0.002);
/// What its last step may change at most: pixels that change surfaces keep it moving a little.
const UNREST: (f64, f64) = (0.0015, 0.015);
/// Weighs turns (rad) against shifts (m): squared distance of the ends from the middle, m2.
const LEVER_M2: f64 = 0.01;
/// Largest change at once.
const STRIDE: (f64, f64) = (0.012, 0.12);
/// Farthest that an edge may lie from its guess, m and rad.
const REACH: (f64, f64) = (0.08, 0.6);
/// Fewest pixels that a fit rests on.
const FEWEST: usize = 150;
/// Largest residuals, in the expected noise.
const ROUGHEST: f64 = 1.7;
/// What no noise explains, m and rad: the surfaces' tilt, pixels at the border. Joined to every sigma.
const MODEL_SIGMA: (f64, f64) = (0.0015, 0.01);

/// Fits edges. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct EdgeModel {
    camera: Intrinsics,
    excerpt: Excerpt,
    coarse: Coarse,
}

impl EdgeModel {
    /// For images of this camera.
    pub fn new(camera: Intrinsics) -> Self {
        Self {
            camera,
            excerpt: Excerpt::with_room(camera.width * camera.height),
            coarse: Coarse::with_room(),
        }
    }

    /// Fits the edge near `guess` between a surface at `near_height_m` in front of it and one at `far_height_m` behind it
    /// (robot frame, m), seen from `planes.robot_from_camera`. The scan must be the camera's. Allocates nothing.
    pub fn fit(
        &mut self,
        scan: &Scan,
        planes: &Planes,
        guess: &Edge<Robot>,
        near_height_m: f64,
        far_height_m: f64,
    ) -> Result<FittedEdge, Untrusted> {
        let sight = Sight::new(&self.camera, &planes.robot_from_camera);
        self.check_input(scan, &sight, guess, [near_height_m, far_height_m])?;
        let stretch =
            stretch_in_view(&self.camera, planes, guess, near_height_m.max(far_height_m))?;
        let start = Step {
            anchor_m: stretch.middle_m,
            place_m: 0.0,
            heading_rad: guess.heading_rad(),
            near_height_m,
            far_height_m,
        };
        let half_m = stretch.half_m;
        let area = area_of(&self.camera, planes, &start, half_m, SLACK_M)?;
        self.excerpt.cut(scan, &area);
        self.excerpt.choose(&sight, &start, half_m, &area);
        let found = self
            .coarse
            .search(&self.excerpt, &sight, &start)
            .ok_or(Untrusted::OutOfView)?;
        let mut step = found;
        let mut equations = None;
        for round in ROUNDS {
            self.excerpt.choose(&sight, &step, half_m, &area);
            equations = self.refine(&sight, &start, &mut step, round)?;
        }
        let equations = equations.ok_or(Untrusted::NotSettled)?;
        let middle = (step.anchor_m + step.normal() * step.place_m).push(near_height_m);
        let pixel_m = pixel_m(&self.camera, planes, &middle);
        visible::check(&self.excerpt, &area, &sight, &step, (half_m, pixel_m))?;
        if equations.roughness > ROUGHEST {
            return Err(Untrusted::Rough(equations.roughness));
        }
        let covariance = equations.covariance().ok_or(Untrusted::NotSettled)?;
        Ok(product_of(
            guess,
            &stretch,
            &step,
            &covariance,
            equations.roughness,
        ))
    }

    fn check_input(
        &self,
        scan: &Scan,
        sight: &Sight,
        guess: &Edge<Robot>,
        heights_m: [f64; 2],
    ) -> Result<(), Untrusted> {
        let numbers = [guess.left.inner, guess.right.inner, sight.position_m.into()];
        let finite = numbers.iter().all(|p| p.iter().all(|v| v.is_finite()))
            && heights_m.iter().all(|v| v.is_finite())
            && guess.length_m() > 0.0
            && scan.disparity_px.len() == self.camera.width * self.camera.height;
        if !finite {
            return Err(Untrusted::BadGuess);
        }
        let rise_m = heights_m[1] - heights_m[0];
        if rise_m.abs() < LEAST_RISE_M {
            return Err(Untrusted::NoContrast(rise_m));
        }
        Ok(())
    }

    /// Improves `step` until it rests; the equations are those where it does, `None` when it does not.
    fn refine(
        &self,
        sight: &Sight,
        start: &Step,
        step: &mut Step,
        rounds: usize,
    ) -> Result<Option<Equations>, Untrusted> {
        if self.excerpt.chosen.len() < FEWEST / self.excerpt.thinned as usize {
            return Err(Untrusted::OutOfView);
        }
        let (mut before, mut share) = (Vector4::zeros(), 1.0);
        let mut last = None;
        for _ in 0..rounds {
            let mut equations =
                Equations::sum(&self.excerpt, sight, step).ok_or(Untrusted::WrongSide)?;
            equations.hold_heights([
                start.near_height_m - step.near_height_m,
                start.far_height_m - step.far_height_m,
            ]);
            let wanted = equations.change().ok_or(Untrusted::NotSettled)?;
            // Pixels that change surfaces can throw it from side to side.
            if wanted[0] * before[0] + LEVER_M2 * wanted[1] * before[1] < 0.0 {
                share *= 0.5;
            }
            let change = wanted * share;
            before = change;
            step.place_m += change[0].clamp(-STRIDE.0, STRIDE.0);
            step.heading_rad += change[1].clamp(-STRIDE.1, STRIDE.1);
            step.near_height_m += change[2].clamp(-STRIDE.0, STRIDE.0);
            step.far_height_m += change[3].clamp(-STRIDE.0, STRIDE.0);
            if (step.place_m - start.place_m).abs() > REACH.0
                || (step.heading_rad - start.heading_rad).abs() > REACH.1
            {
                return Err(Untrusted::NotSettled);
            }
            last = Some(equations);
            if smaller(&change, REST) {
                break;
            }
        }
        Ok(last.filter(|_| smaller(&before, UNREST)))
    }
}

fn smaller(change: &Vector4<f64>, than: (f64, f64)) -> bool {
    change[0].abs() < than.0 && change[1].abs() < than.1
}

fn product_of(
    guess: &Edge<Robot>,
    stretch: &Stretch,
    step: &Step,
    covariance: &Matrix4<f64>,
    roughness: f64,
) -> FittedEdge {
    let scale = roughness.max(1.0);
    let sigma = |i: usize, model: f64| (scale * covariance[(i, i)].sqrt()).hypot(model);
    let (normal, along) = (step.normal(), step.along());
    // The ends of the guess, moved square to the edge onto it, at the refined height of the surface they belong to.
    let place = |end: &Point<Robot>| {
        let aside_m = along.dot(&(end.inner.coords.xy() - stretch.middle_m));
        let on_edge = stretch.middle_m + normal * step.place_m + along * aside_m;
        let heights_m = [step.near_height_m, step.far_height_m];
        let [near, far] = heights_m.map(|height_m| (end.inner.z - height_m).abs());
        Point::wrap(on_edge.push(heights_m[usize::from(far < near)]).into())
    };
    FittedEdge {
        edge: Edge {
            left: place(&guess.left),
            right: place(&guess.right),
        },
        place_sigma_m: sigma(0, MODEL_SIGMA.0),
        heading_sigma_rad: sigma(1, MODEL_SIGMA.1),
        near_height_m: step.near_height_m,
        far_height_m: step.far_height_m,
    }
}
