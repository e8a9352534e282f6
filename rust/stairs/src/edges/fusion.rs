//! One edge from the fits of many frames.
//!
//! Most of the error of disparities is a fixed pattern: frames from the same place in the same direction err alike, and
//! count little more than one. Only motion of the head averages it.

use geometry::{Camera, Map, Pose};
use nalgebra::{Matrix2, Point2, Point3, Vector2, Vector3};

use crate::{Edge, EdgeFit, FittedEdge, FusionTuning, lines::line::StraightLine};

/// What the frames from one place in one direction say.
#[derive(Debug, Clone, Copy)]
struct EdgeLook {
    direction: Vector3<f64>,
    camera: Point3<f64>,
    frames: u32,
    /// Mean middle and heading of the fits.
    middle: Point2<f64>,
    heading_rad: f64,
    /// Mean variances of one fit.
    place_variance: f64,
    heading_variance: f64,
    /// What steps have added since.
    moved_place: f64,
    moved_heading: f64,
}

impl EdgeLook {
    fn new(fitted: &Edge<Map>, sigmas: (f64, f64), map_from_camera: &Pose<Map, Camera>) -> Self {
        Self {
            direction: map_from_camera.inner.rotation * Vector3::z(),
            camera: map_from_camera.inner.translation.vector.into(),
            frames: 1,
            middle: fitted.middle().inner.xy(),
            heading_rad: fitted.heading_rad(),
            place_variance: sigmas.0.powi(2),
            heading_variance: sigmas.1.powi(2),
            moved_place: 0.0,
            moved_heading: 0.0,
        }
    }

    fn is_like(&self, other: &Self, tuning: &FusionTuning) -> bool {
        self.direction.dot(&other.direction) > tuning.other_direction
            && nalgebra::distance(&self.camera, &other.camera) < tuning.other_place
    }

    /// Takes in another frame of the same look.
    fn join(&mut self, frame: &Self) {
        self.frames = self.frames.saturating_add(1);
        let share = 1.0 / f64::from(self.frames);
        self.middle += (frame.middle - self.middle) * share;
        self.heading_rad += geometry::wrap_angle(frame.heading_rad - self.heading_rad) * share;
        self.place_variance += (frame.place_variance - self.place_variance) * share;
        self.heading_variance += (frame.heading_variance - self.heading_variance) * share;
        self.moved_place *= 1.0 - share;
        self.moved_heading *= 1.0 - share;
    }

    /// Variances of the look's means, of place and heading: this share of a frame's variance all its frames have in common.
    fn variances(&self, fixed: f64) -> (f64, f64) {
        let share = fixed + (1.0 - fixed) / f64::from(self.frames);
        (
            self.place_variance * share + self.moved_place,
            self.heading_variance * share + self.moved_heading,
        )
    }
}

/// An edge that was fitted in one frame or more. Its direction is that of the first fit.
#[derive(Debug, Clone)]
pub(crate) struct FusedEdge {
    /// Heights before and behind it, map frame, m.
    pub(crate) heights_m: [f64; 2],
    /// Steps since it was last fitted.
    pub(crate) steps_ago: u32,
    looks: Vec<EdgeLook>,
    /// The edge by all looks, as long as in the last of them.
    pub(super) edge: Edge<Map>,
    ends: Edge<Map>,
    /// From end to end of all fits.
    whole: Edge<Map>,
    /// How sure it is.
    pub(super) fit: EdgeFit,
    /// Whether it was ever sure.
    pub(super) was_sure: bool,
}

impl FusedEdge {
    pub(crate) fn new(
        fitted: &FittedEdge,
        edge: &Edge<Map>,
        heights_m: [f64; 2],
        camera: &Pose<Map, Camera>,
        tuning: &FusionTuning,
    ) -> Self {
        let sigmas = (fitted.place_sigma_m, fitted.heading_sigma_rad);
        let mut looks = Vec::with_capacity(tuning.looks);
        looks.push(EdgeLook::new(edge, sigmas, camera));
        Self {
            heights_m,
            steps_ago: 0,
            looks,
            edge: *edge,
            ends: *edge,
            whole: *edge,
            fit: EdgeFit {
                frames: 1,
                place_sigma_m: sigmas.0,
                heading_sigma_rad: sigmas.1,
            },
            was_sure: false,
        }
    }

    /// Takes in the fit of another frame.
    pub(crate) fn add(
        &mut self,
        fitted: &FittedEdge,
        edge: &Edge<Map>,
        camera: &Pose<Map, Camera>,
        tuning: &FusionTuning,
    ) {
        let sigmas = (fitted.place_sigma_m, fitted.heading_sigma_rad);
        let frame = EdgeLook::new(edge, sigmas, camera);
        self.steps_ago = 0;
        self.ends = *edge;
        self.whole = self.whole.and(edge);
        let mut looks = self.looks.iter_mut();
        if let Some(look) = looks.find(|look| look.is_like(&frame, tuning)) {
            look.join(&frame);
        } else {
            if self.looks.len() == tuning.looks {
                // The oldest.
                let _ = self.looks.remove(0);
            }
            self.looks.push(frame);
        }
        self.solve(tuning);
    }

    /// All of it, as far as it was ever fitted.
    pub(crate) fn whole(&self) -> Edge<Map> {
        self.edge
            .line()
            .map_or(self.whole, |line| self.whole.onto(&line))
    }

    /// The robot stepped.
    pub(crate) fn step(&mut self, tuning: &FusionTuning) {
        self.steps_ago = self.steps_ago.saturating_add(1);
        for look in &mut self.looks {
            look.moved_place += tuning.step_place.powi(2);
            look.moved_heading += tuning.step_heading.powi(2);
        }
        self.solve(tuning);
    }

    /// Least squares over the looks for the place at their common middle and the heading; looks that do not fit count less.
    fn solve(&mut self, tuning: &FusionTuning) {
        let robust = tuning.robust;
        let count = self.looks.len() as f64;
        let middle: Vector2<f64> = self
            .looks
            .iter()
            .map(|look| look.middle.coords)
            .sum::<Vector2<f64>>()
            / count;
        let heading_rad = self.edge.heading_rad();
        let Some(StraightLine { along, .. }) = self.edge.line() else {
            return;
        };
        let across = self.edge.across();
        let mut found = Vector2::zeros();
        let mut information = Matrix2::zeros();
        for _ in 0..tuning.rounds {
            information = Matrix2::zeros();
            let mut sum = Vector2::zeros();
            for look in &self.looks {
                let (place_variance, heading_variance) = look.variances(tuning.fixed);
                let off = look.middle.coords - middle;
                // Farther left by `t` a line that is turned lies `t * turn` farther to the front.
                let rows = Matrix2::new(1.0, -along.dot(&off), 0.0, 1.0);
                let measured = Vector2::new(
                    across.dot(&off),
                    geometry::wrap_angle(look.heading_rad - heading_rad),
                );
                let weights = Matrix2::from_diagonal(&Vector2::new(
                    1.0 / place_variance,
                    1.0 / heading_variance,
                ));
                let residual = measured - rows * found;
                let size = (residual.dot(&(weights * residual)) / 2.0).sqrt();
                let trust = if size > robust { robust / size } else { 1.0 };
                information += rows.transpose() * weights * rows * trust;
                sum += rows.transpose() * weights * measured * trust;
            }
            let Some(inverse) = information.try_inverse() else {
                return;
            };
            found = inverse * sum;
        }
        let Some(covariance) = information.try_inverse() else {
            return;
        };
        let turned = nalgebra::Rotation2::new(found[1]) * along;
        let line = StraightLine {
            at: (middle + across * found[0]).into(),
            along: turned,
        };
        self.edge = self.ends.onto(&line);
        self.fit = EdgeFit {
            frames: self.looks.iter().map(|look| look.frames).sum(),
            place_sigma_m: geometry::hypot(covariance[(0, 0)].sqrt(), tuning.common_place),
            heading_sigma_rad: geometry::hypot(covariance[(1, 1)].sqrt(), tuning.common_heading),
        };
    }
}

#[cfg(test)]
mod tests;
