//! A scan matched to a local map: the pose at which it fits best, and how sure that is.

use geometry::{PlanarPose, wrap_angle};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use plan_view::{PlanarBeam, PoseStep};
use settings::{ConfigError, Table};

use crate::beams;
use crate::config::ScanMatchConfig;
use crate::field::LikelihoodField;
use crate::maxima::FieldMaxima;
use crate::search::{SearchWindow, search};

/// The least share of its diagonal that a step's curvature is damped by, and the largest at which steps are still tried.
const DAMPED: [f64; 2] = [1e-4, 1e4];

/// Where a scan fits best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScanMatch {
    /// The sensor in the local map.
    pub pose: PlanarPose,
    /// Mean likelihood of the scan's points there, 0..1.
    pub score: f64,
    /// What the scan alone says of x, y and heading in the map's axes: inverse covariance, 1/m², 1/(m rad), 1/rad². Of no information along a
    /// corridor that looks the same everywhere.
    pub information: Matrix3<f64>,
    /// Covariance of the pose, by the scan and by what was known before: m², m rad, rad².
    pub covariance: Matrix3<f64>,
}

/// Matches scans.
#[derive(Debug, Clone)]
pub struct ScanMatcher {
    config: ScanMatchConfig,
    /// By how much a point's likelihood, from 1 to 0, counts in logarithms of a density.
    weight: f64,
}

impl ScanMatcher {
    /// With settings.
    pub fn new(config: ScanMatchConfig) -> Result<Self, ConfigError> {
        config.check()?;
        // Near its maximum the likelihood falls by half of the squared distance over how wide it is; a range's does by that over `sigma`. It is as
        // wide as `spread`, the spline over the cells, of variance a third of their square, and the scans' own errors make it.
        let spline = config.cell * config.cell / f64::from(3_u8);
        let wide = config.spread * config.spread + spline + config.sigma * config.sigma;
        let weight = wide / (config.sigma * config.sigma * config.together);
        Ok(Self { config, weight })
    }

    /// The settings.
    pub const fn config(&self) -> &ScanMatchConfig {
        &self.config
    }

    /// What of a scan is matched: ends of its beams, m in the sensor's frame, by bearing.
    pub fn points_m(&self, beams: &[PlanarBeam]) -> Vec<[f64; 2]> {
        beams::ends_m(beams, &self.config)
    }

    /// Takes a scan into a field: its points as [`Self::points_m`] gives them, from a pose in the field's frame.
    pub fn insert(&self, field: &mut LikelihoodField, points_m: &[[f64; 2]], pose: &PlanarPose) {
        field.insert(&self.config, points_m, pose);
    }

    /// The pose at which points fit a field best, searched around what is known before within `half`: x and y, m, and heading, rad, to each
    /// side. None where the mean likelihood, less what speaks against the pose beforehand, is `least` or less.
    pub fn find(
        &self,
        (field, maxima): (&LikelihoodField, Option<&FieldMaxima>),
        points_m: &[[f64; 2]],
        (before, covariance): (&PlanarPose, &Matrix3<f64>),
        half: [f64; 3],
        least: f64,
    ) -> Option<ScanMatch> {
        let known = [0, 1, 2].map(|axis| 1.0 / (self.weight * covariance[(axis, axis)]));
        let window = SearchWindow {
            middle: *before,
            half,
            known,
        };
        let found = search(field, maxima, points_m, &window, least)?;
        self.refine(field, points_m, &found.pose, (before, covariance))
    }

    /// Where a scan fits that comes after others, searched where odometry may have led, by a pose and its covariance; further where it fits badly
    /// there, or at the rim. None where it fits nowhere: its score is below `least_score`.
    pub fn follow(
        &self,
        field: &LikelihoodField,
        points_m: &[[f64; 2]],
        before: &PlanarPose,
        spread: &Matrix3<f64>,
    ) -> Option<ScanMatch> {
        let config = &self.config;
        let within = |times: f64| {
            let spread = times * times * spread;
            let half = [0, 1, 2].map(|axis| config.window * spread[(axis, axis)].max(0.0).sqrt());
            self.find((field, None), points_m, (before, &spread), half, 0.0)
        };
        let mut found = within(1.0);
        let score = found.map_or(0.0, |found| found.score);
        let rim = config.rim * config.window;
        let at_rim = found.is_some_and(|found| {
            let off = away(&found.pose, before);
            (0..3).any(|axis| off[axis] * off[axis] > rim * rim * spread[(axis, axis)])
        });
        if score < config.sure_score || at_rim {
            let other = within(config.wider);
            found = other
                .filter(|one| one.score > score + config.better)
                .or(found);
        }
        found.filter(|found| found.score >= config.least_score)
    }

    /// The pose near `start` at which points fit a field best, what is known before counting too: least squares, each step from where the last
    /// one led. None where what is known is none, or no number.
    pub fn refine(
        &self,
        field: &LikelihoodField,
        points_m: &[[f64; 2]],
        start: &PlanarPose,
        (before, covariance): (&PlanarPose, &Matrix3<f64>),
    ) -> Option<ScanMatch> {
        let known = covariance.try_inverse()?;
        let mut here = self.look(field, points_m, *start, (before, &known));
        let mut damping = DAMPED[0];
        for _ in 0..self.config.steps {
            let Some(next) = here.step.damped(damping).taken(&here.pose) else {
                break;
            };
            let there = self.look(field, points_m, next, (before, &known));
            if there.cost > here.cost {
                damping *= 10.0;
                if damping > DAMPED[1] {
                    break;
                }
                continue;
            }
            let moved = here.pose.relative(&there.pose);
            damping = (damping / 10.0).max(DAMPED[0]);
            here = there;
            let most = moved
                .x_m
                .abs()
                .max(moved.y_m.abs())
                .max(moved.yaw_rad.abs());
            if most < self.config.least_step {
                break;
            }
        }
        let (information, told) = self.told(here.curvature, points_m);
        // Along a plain wall the least squares found where noise fits noise: there what was known before stays.
        let away = told * away(&here.pose, before);
        Some(ScanMatch {
            pose: PlanarPose::new(
                before.x_m + away.x,
                before.y_m + away.y,
                wrap_angle(before.yaw_rad + away.z),
            ),
            score: here.score,
            information,
            covariance: (information + known).try_inverse()?,
        })
    }

    /// What a curvature tells, and what takes of a step the part of which it tells something: nothing where it is negative, or of a plain wall's
    /// direction. The heading is counted by how far its turn moves points.
    fn told(&self, curvature: Matrix3<f64>, points_m: &[[f64; 2]]) -> (Matrix3<f64>, Matrix3<f64>) {
        let squares = points_m.iter().map(|[x, y]| x * x + y * y);
        let arm_m = (squares.sum::<f64>() / points_m.len().max(1) as f64).sqrt();
        let arm_m = arm_m.max(self.config.cell);
        let from_metres = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 1.0 / arm_m));
        let to_metres = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, arm_m));
        let mut parts = SymmetricEigen::new(from_metres * curvature * from_metres);
        let noise = self.config.plain * parts.eigenvalues.max();
        for value in &mut parts.eigenvalues {
            *value = (*value - noise).max(0.0);
        }
        let information = to_metres * parts.recompose() * to_metres;
        for value in &mut parts.eigenvalues {
            *value = f64::from(u8::from(*value > 0.0));
        }
        (information, from_metres * parts.recompose() * to_metres)
    }

    fn look(
        &self,
        field: &LikelihoodField,
        points_m: &[[f64; 2]],
        pose: PlanarPose,
        (before, known): (&PlanarPose, &Matrix3<f64>),
    ) -> FitAt {
        let mut step = PoseStep::default();
        let mut raw = PoseStep::default();
        let mut sum = 0.0;
        for point in points_m {
            let (x_m, y_m) = pose.apply(point[0], point[1]);
            let here = field.at(x_m, y_m);
            if here.value <= 0.0 {
                continue;
            }
            sum += here.value;
            let (right_m, up_m) = (x_m - pose.x_m, y_m - pose.y_m);
            let along = |way: [f64; 2]| [way[0], way[1], right_m * way[1] - up_m * way[0]];
            step.pull(-self.weight, along(here.slope));
            let [xx, xy, yy] = here.curvature;
            let [middle, half] = [0.5 * (xx + yy), 0.5 * (xx - yy)];
            let root = geometry::hypot(half, xy);
            let (sin, cos) = libm::sincos(0.5 * libm::atan2(xy, half));
            for (curvature, way) in [
                (-(middle + root), along([cos, sin])),
                (-(middle - root), along([-sin, cos])),
            ] {
                raw.curve(self.weight * curvature, way);
                step.curve(self.weight * curvature.max(0.0), way);
            }
        }
        let rows: [[f64; 3]; 3] = (*known).into();
        step.hold(&pose, before, &rows);
        let count = points_m.len() as f64;
        let away = away(&pose, before);
        FitAt {
            pose,
            cost: self.weight * (count - sum) + 0.5 * away.dot(&(known * away)),
            score: if count > 0.0 { sum / count } else { 0.0 },
            step,
            curvature: Matrix3::from(*raw.information()),
        }
    }
}

/// What there is to know at a pose.
struct FitAt {
    pose: PlanarPose,
    cost: f64,
    score: f64,
    step: PoseStep,
    curvature: Matrix3<f64>,
}

/// How far a pose is from another, along the axes that both are given in.
fn away(pose: &PlanarPose, from: &PlanarPose) -> Vector3<f64> {
    Vector3::new(
        pose.x_m - from.x_m,
        pose.y_m - from.y_m,
        wrap_angle(pose.yaw_rad - from.yaw_rad),
    )
}
