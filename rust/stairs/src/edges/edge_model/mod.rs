//! A step fitted to the disparities: the place and heading of an edge between two level surfaces, good enough to step by.
//!
//! Beyond 003, whose convex boundaries are off by one to three centimetres. The step is the near surface, an upright face
//! and the far surface; going down the face is hidden and the near surface's border hides the start of the far one. All
//! three planes are linear in disparity, so a ray's first hit is a few comparisons. Block matching blends over its window
//! what it sees, and so does the model.

pub(crate) mod bevel;
mod coarse;
mod excerpt;
mod lot;
mod product;
mod refine;
mod sight;
#[cfg(test)]
mod tests;
mod visible;
mod window;

use geometry::{Point, Robot};
use nalgebra::Vector4;
use segmentation::Planes;
use sensing::{Intrinsics, Scan};

use crate::{Edge, EdgeModelTuning};
use coarse::Coarse;
use excerpt::{Excerpt, Stretch, area_of, pixel_m, stretch_in_view};
pub use product::{FittedEdge, Untrusted};
use refine::Equations;
use sight::{CameraSight, StepModel};

/// Fits edges. Keeps its buffers.
#[derive(Debug, Clone)]
pub struct EdgeModel {
    camera: Intrinsics,
    tuning: EdgeModelTuning,
    excerpt: Excerpt,
    coarse: Coarse,
}

impl EdgeModel {
    /// For images of this camera.
    pub fn new(camera: Intrinsics, tuning: EdgeModelTuning) -> Self {
        Self {
            camera,
            excerpt: Excerpt::with_room(camera.width * camera.height),
            coarse: Coarse::with_room(&tuning.coarse),
            tuning,
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
        let clear_m = self.tuning.camera_clear;
        let sight = CameraSight::new(&self.camera, &planes.robot_from_camera, clear_m);
        self.check_input(scan, &sight, guess, [near_height_m, far_height_m])?;
        let excerpt = &self.tuning.excerpt;
        let highest_m = near_height_m.max(far_height_m);
        let stretch = stretch_in_view(&self.camera, planes, guess, highest_m, excerpt)?;
        let start = StepModel {
            anchor_m: stretch.middle_m,
            place_m: 0.0,
            heading_rad: guess.heading_rad(),
            near_height_m,
            far_height_m,
        };
        let half_m = stretch.half_m;
        let area = area_of(&self.camera, planes, &start, half_m, &self.tuning)?;
        self.excerpt.cut(scan, &area);
        self.excerpt.choose(&sight, &start, half_m, &area, excerpt);
        let found = self
            .coarse
            .search(&self.excerpt, &sight, &start, &self.tuning.coarse)
            .ok_or(Untrusted::OutOfView)?;
        let mut step = found;
        let mut equations = None;
        for round in self.tuning.rounds {
            self.excerpt.choose(&sight, &step, half_m, &area, excerpt);
            equations = self.refine(&sight, &start, &mut step, round)?;
        }
        let equations = equations.ok_or(Untrusted::NotSettled)?;
        let middle = (step.anchor_m + step.normal() * step.place_m).push(near_height_m);
        let pixel_m = pixel_m(&self.camera, planes, &middle);
        let width_m = (half_m, pixel_m);
        visible::check(&self.excerpt, &area, &sight, &step, width_m, &self.tuning)?;
        if equations.roughness > self.tuning.roughest {
            return Err(Untrusted::Rough(equations.roughness));
        }
        let covariance = equations.covariance().ok_or(Untrusted::NotSettled)?;
        let scale = equations.roughness.max(1.0);
        let sigma =
            |i: usize, model: f64| geometry::hypot(scale * covariance[(i, i)].sqrt(), model);
        Ok(FittedEdge {
            edge: onto_step(guess, &stretch, &step),
            place_sigma_m: sigma(0, self.tuning.model_place),
            heading_sigma_rad: sigma(1, self.tuning.model_heading),
            near_height_m: step.near_height_m,
            far_height_m: step.far_height_m,
        })
    }

    fn check_input(
        &self,
        scan: &Scan,
        sight: &CameraSight,
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
        if rise_m.abs() < self.tuning.least_rise {
            return Err(Untrusted::NoContrast(rise_m));
        }
        Ok(())
    }

    /// Improves `step` until it rests; the equations are those where it does, `None` when it does not.
    fn refine(
        &self,
        sight: &CameraSight,
        start: &StepModel,
        step: &mut StepModel,
        rounds: usize,
    ) -> Result<Option<Equations>, Untrusted> {
        let tuning = &self.tuning;
        if self.excerpt.chosen.len() < tuning.fewest_pixels / self.excerpt.thinned as usize {
            return Err(Untrusted::OutOfView);
        }
        let (mut before, mut share) = (Vector4::zeros(), 1.0);
        let mut last = None;
        let (far, wide) = (tuning.stride_place, tuning.stride_heading);
        let rest = (tuning.rest_place, tuning.rest_heading);
        let unrest = (tuning.unrest_place, tuning.unrest_heading);
        for _ in 0..rounds {
            let mut equations =
                Equations::sum(&self.excerpt, sight, step, tuning).ok_or(Untrusted::WrongSide)?;
            let heights_m = [
                start.near_height_m - step.near_height_m,
                start.far_height_m - step.far_height_m,
            ];
            equations.hold_heights(heights_m, tuning.refine.height_sigma);
            let wanted = equations.change().ok_or(Untrusted::NotSettled)?;
            // Pixels that change surfaces can throw it from side to side.
            if wanted[0] * before[0] + tuning.lever * wanted[1] * before[1] < 0.0 {
                share *= tuning.damping;
            }
            let change = wanted * share;
            before = change;
            step.place_m += change[0].clamp(-far, far);
            step.heading_rad += change[1].clamp(-wide, wide);
            step.near_height_m += change[2].clamp(-far, far);
            step.far_height_m += change[3].clamp(-far, far);
            if (step.place_m - start.place_m).abs() > tuning.reach_place
                || (step.heading_rad - start.heading_rad).abs() > tuning.reach_heading
            {
                return Err(Untrusted::NotSettled);
            }
            last = Some(equations);
            if smaller(&change, rest) {
                break;
            }
        }
        Ok(last.filter(|_| smaller(&before, unrest)))
    }
}

fn smaller(change: &Vector4<f64>, than: (f64, f64)) -> bool {
    change[0].abs() < than.0 && change[1].abs() < than.1
}

/// The guess, its ends moved square to the step's edge onto it, at the refined height of the surface they belong to.
fn onto_step(guess: &Edge<Robot>, stretch: &Stretch, step: &StepModel) -> Edge<Robot> {
    let (normal, along) = (step.normal(), step.along());
    let place = |end: &Point<Robot>| {
        let aside_m = along.dot(&(end.inner.coords.xy() - stretch.middle_m));
        let on_edge = stretch.middle_m + normal * step.place_m + along * aside_m;
        let heights_m = [step.near_height_m, step.far_height_m];
        let [near, far] = heights_m.map(|height_m| (end.inner.z - height_m).abs());
        Point::wrap(on_edge.push(heights_m[usize::from(far < near)]).into())
    };
    Edge {
        left: place(&guess.left),
        right: place(&guess.right),
    }
}
