//! One edge from the fits of many frames.
//!
//! Most of the error of disparities is a fixed pattern: frames from the same place in the same direction err alike, and
//! count little more than one. Only motion of the head averages it.

use geometry::{Camera, Map, Pose};
use nalgebra::{Matrix2, Point2, Point3, Vector2, Vector3};

use crate::lines::line::Line;
use crate::{Edge, EdgeFit, FittedEdge};

/// Looks that are kept of each edge.
const LOOKS: usize = 12;
/// Share of a frame's variance that all frames of a look have in common.
const FIXED: f64 = 0.8;
/// Cosine of the turn of the camera from which on a look is another: two pixels.
const OTHER_DIRECTION: f64 = 0.9998;
/// Shift of the camera from which on a look is another, m.
const OTHER_PLACE_M: f64 = 0.01;
/// What a step adds to the error of the place (m) and the heading (rad) of what was seen before it.
const STEP_SIGMA: (f64, f64) = (0.0015, 0.004);
/// What all looks have in common: error of the place (m) and of the heading (rad) that no motion of the head averages.
const COMMON_SIGMA: (f64, f64) = (0.0015, 0.01);
/// Residual in sigmas from which on a look counts less.
const ROBUST: f64 = 1.5;
/// Rounds of weighing.
const ROUNDS: usize = 4;

/// What the frames from one place in one direction say.
#[derive(Debug, Clone, Copy)]
struct Look {
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

impl Look {
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

    fn is_like(&self, other: &Self) -> bool {
        self.direction.dot(&other.direction) > OTHER_DIRECTION
            && nalgebra::distance(&self.camera, &other.camera) < OTHER_PLACE_M
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

    /// Variances of the look's means: of place and heading.
    fn variances(&self) -> (f64, f64) {
        let share = FIXED + (1.0 - FIXED) / f64::from(self.frames);
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
    looks: Vec<Look>,
    edge: Edge<Map>,
    ends: Edge<Map>,
    fit: EdgeFit,
}

impl FusedEdge {
    pub(crate) fn new(
        fitted: &FittedEdge,
        edge: &Edge<Map>,
        heights_m: [f64; 2],
        camera: &Pose<Map, Camera>,
    ) -> Self {
        let sigmas = (fitted.place_sigma_m, fitted.heading_sigma_rad);
        let mut looks = Vec::with_capacity(LOOKS);
        looks.push(Look::new(edge, sigmas, camera));
        Self {
            heights_m,
            steps_ago: 0,
            looks,
            edge: *edge,
            ends: *edge,
            fit: EdgeFit {
                frames: 1,
                place_sigma_m: sigmas.0,
                heading_sigma_rad: sigmas.1,
            },
        }
    }

    /// Takes in the fit of another frame.
    pub(crate) fn add(
        &mut self,
        fitted: &FittedEdge,
        edge: &Edge<Map>,
        camera: &Pose<Map, Camera>,
    ) {
        let sigmas = (fitted.place_sigma_m, fitted.heading_sigma_rad);
        let frame = Look::new(edge, sigmas, camera);
        self.steps_ago = 0;
        self.ends = *edge;
        if let Some(look) = self.looks.iter_mut().find(|look| look.is_like(&frame)) {
            look.join(&frame);
        } else {
            if self.looks.len() == LOOKS {
                // The oldest.
                let _ = self.looks.remove(0);
            }
            self.looks.push(frame);
        }
        self.solve();
    }

    /// The robot stepped.
    pub(crate) fn step(&mut self) {
        self.steps_ago = self.steps_ago.saturating_add(1);
        for look in &mut self.looks {
            look.moved_place += STEP_SIGMA.0.powi(2);
            look.moved_heading += STEP_SIGMA.1.powi(2);
        }
        self.solve();
    }

    /// The edge by all looks, as long as in the last of them.
    pub(crate) const fn edge(&self) -> &Edge<Map> {
        &self.edge
    }

    /// How sure it is.
    pub(crate) const fn fit(&self) -> EdgeFit {
        self.fit
    }

    /// Least squares over the looks for the place at their common middle and the heading; looks that do not fit count less.
    fn solve(&mut self) {
        let count = self.looks.len() as f64;
        let middle: Vector2<f64> = self
            .looks
            .iter()
            .map(|look| look.middle.coords)
            .sum::<Vector2<f64>>()
            / count;
        let heading_rad = self.edge.heading_rad();
        let Some(Line { along, .. }) = Line::along(&self.edge) else {
            return;
        };
        let across = self.edge.across();
        let mut found = Vector2::zeros();
        let mut information = Matrix2::zeros();
        for _ in 0..ROUNDS {
            information = Matrix2::zeros();
            let mut sum = Vector2::zeros();
            for look in &self.looks {
                let (place_variance, heading_variance) = look.variances();
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
                let trust = if size > ROBUST { ROBUST / size } else { 1.0 };
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
        let line = Line {
            at: (middle + across * found[0]).into(),
            along: turned,
        };
        self.edge = self.ends.onto(&line);
        self.fit = EdgeFit {
            frames: self.looks.iter().map(|look| look.frames).sum(),
            place_sigma_m: covariance[(0, 0)].sqrt().hypot(COMMON_SIGMA.0),
            heading_sigma_rad: covariance[(1, 1)].sqrt().hypot(COMMON_SIGMA.1),
        };
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Point, Robot};
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};

    use super::*;
    use crate::synthetic::Noise;

    fn camera(pan_rad: f64) -> Pose<Map, Camera> {
        let turn = UnitQuaternion::from_euler_angles(0.0, pan_rad, 0.0);
        Pose::wrap(Isometry3::from_parts(
            Translation3::new(0.0, 0.0, 0.5),
            turn,
        ))
    }

    /// An edge across the way at 1 m, off by this, as one frame shows it.
    fn fitted(off_m: f64, turn_rad: f64, aside_m: f64) -> FittedEdge {
        let (sin, cos) = turn_rad.sin_cos();
        let at = |t: f64| Point::<Robot>::new(1.0 + off_m - t * sin, aside_m + t * cos, 0.03);
        FittedEdge {
            edge: Edge {
                left: at(0.15),
                right: at(-0.15),
            },
            place_sigma_m: 0.005,
            heading_sigma_rad: 0.03,
            near_height_m: 0.0,
            far_height_m: 0.03,
        }
    }

    fn fuse(fits: impl Iterator<Item = (FittedEdge, f64)>) -> FusedEdge {
        let mut fused: Option<FusedEdge> = None;
        for (fit, pan_rad) in fits {
            let edge = fit.edge.transformed(&Pose::<Map, Robot>::identity());
            if let Some(fused) = &mut fused {
                fused.add(&fit, &edge, &camera(pan_rad));
            } else {
                fused = Some(FusedEdge::new(&fit, &edge, [0.0, 0.03], &camera(pan_rad)));
            }
        }
        fused.unwrap()
    }

    #[test]
    fn frames_from_one_head_pose_count_little_more_than_one() {
        let fused = fuse((0..40).map(|_| (fitted(0.004, 0.02, 0.0), 0.0)));
        assert_eq!(fused.fit().frames, 40);
        assert!(fused.fit().place_sigma_m > 0.8 * 0.005);
        let swung = fuse((0..8).map(|i| (fitted(0.004, 0.02, 0.0), 0.05 * f64::from(i))));
        assert!(swung.fit().place_sigma_m < 0.5 * 0.005);
        assert!((swung.edge().beyond_m([1.004, 0.0])).abs() < 1e-9);
        assert!((swung.edge().heading_rad() - 0.02).abs() < 1e-9);
    }

    #[test]
    fn the_sigma_that_is_told_holds_over_many_edges() {
        let (mut places, mut headings, mut sigmas) = (0.0, 0.0, (0.0, 0.0));
        let mut noise = Noise::new(3);
        for _ in 0..200 {
            let fused = fuse((0..8).map(|i| {
                let (off_m, turn_rad) = (0.005 * noise.normal(), 0.03 * noise.normal());
                (fitted(off_m, turn_rad, 0.0), 0.05 * f64::from(i))
            }));
            places += fused.edge().beyond_m([1.0, 0.0]).powi(2) / 200.0;
            headings += fused.edge().heading_rad().powi(2) / 200.0;
            sigmas = (fused.fit().place_sigma_m, fused.fit().heading_sigma_rad);
        }
        assert!(
            places.sqrt() < 1.3 * sigmas.0 && places.sqrt() > 0.5 * sigmas.0,
            "{places} {sigmas:?}"
        );
        assert!(headings.sqrt() < 1.3 * sigmas.1 && headings.sqrt() > 0.5 * sigmas.1);
    }

    #[test]
    fn one_wild_look_moves_the_edge_by_less_than_a_tenth_of_its_error() {
        let off_m = |i| if i == 3 { 0.05 } else { 0.0 };
        let fused = fuse((0..8).map(|i| (fitted(off_m(i), 0.0, 0.0), 0.05 * f64::from(i))));
        assert!(fused.edge().beyond_m([1.0, 0.0]).abs() < 0.005);
    }

    #[test]
    fn looks_at_different_stretches_give_the_heading_by_their_places() {
        // Each says straight across, but those to the left lie farther back: the places tell the turn.
        let fits = (-2..=2).map(|i| {
            let aside_m = 0.4 * f64::from(i);
            (fitted(0.02 * aside_m, 0.0, aside_m), 0.2 * f64::from(i))
        });
        let heading_rad = fuse(fits).edge().heading_rad();
        assert!((-0.02..-0.012).contains(&heading_rad), "{heading_rad}");
    }

    #[test]
    fn steps_make_what_was_seen_before_them_less_sure() {
        let mut fused = fuse((0..8).map(|i| (fitted(0.0, 0.0, 0.0), 0.05 * f64::from(i))));
        let before = fused.fit();
        for _ in 0..4 {
            fused.step();
        }
        assert!(fused.fit().place_sigma_m > before.place_sigma_m);
        assert!(fused.fit().heading_sigma_rad > before.heading_sigma_rad);
        assert_eq!(fused.steps_ago, 4);
    }
}
