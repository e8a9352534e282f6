//! Which points of a frame lie on the ground.

use nalgebra::{Matrix3, Vector3};
use segmentation::Planes;

use super::{config::MonteCarloConfig, random::Stream};

/// A cross product of neighbours' distances that is shorter than this has no direction, m^2: a guard against division by nothing.
const NO_NORMAL_M2: f64 = 1e-12;
/// Three points of which the cross product is shorter than this lie on a line, m^2: no plane is known by them.
const ON_A_LINE_M2: f64 = 1e-6;

/// A point of the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct FramePoint {
    /// Robot frame, m.
    pub(super) point_m: Vector3<f64>,
    /// Distance from the camera, m.
    pub(super) range_m: f64,
    /// Unit vector from the camera.
    pub(super) along: Vector3<f64>,
    /// By how much the range's noise moves the point, m: along the line of sight, which is flat far away.
    spread_m: Vector3<f64>,
    /// Normal of the surface, towards the camera; none where it is not smooth.
    normal: Option<Vector3<f64>>,
    pub(super) is_ground: bool,
}

/// Reads frames and finds the ground in them. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct GroundFinder {
    pub(super) sightings: Vec<FramePoint>,
    candidates: Vec<u32>,
    kept: Vec<u32>,
    /// Points and spreads of the candidates that are asked whether they lie on a plane, side by side.
    asked: Vec<[Vector3<f64>; 2]>,
}

impl GroundFinder {
    /// Reads a frame's points within reach and labels them: those at about the height of the soles of which the neighbourhood is
    /// level are candidates, and those of them are ground that lie on planes that many lie on (002, III.C).
    pub(super) fn find(&mut self, planes: &Planes, config: &MonteCarloConfig, draws: &mut Stream) {
        let tuning = &config.tuning.ground;
        self.read(planes, config);
        self.candidates.clear();
        for (index, sighting) in self.sightings.iter().enumerate() {
            let point = &sighting.point_m;
            let band_m = config.ground_band + config.ground_tilt * point.xy().norm();
            let level = (sighting.normal).is_some_and(|normal| normal.z > tuning.upright);
            if point.z.abs() < band_m && level {
                self.candidates.push(index as u32);
            }
        }
        let enough = (tuning.dominant * self.candidates.len() as f64) as usize;
        for _ in 0..tuning.planes {
            if self.candidates.len() < enough.max(tuning.least_candidates) {
                break;
            }
            let Some(plane) = self.dominant(config, draws) else {
                break;
            };
            if self.take(&plane, config) < enough {
                break;
            }
        }
    }

    fn read(&mut self, planes: &Planes, config: &MonteCarloConfig) {
        self.sightings.clear();
        let Some([width, height]) = planes.pinhole().map(|camera| camera.size_px) else {
            return;
        };
        let eye = planes.robot_from_camera.origin().inner.coords;
        let tuning = &config.tuning.ground;
        let stride = width.div_ceil(tuning.columns);
        let window = ((width as f64 * tuning.normal_share) as usize).max(tuning.least_window);
        let at = |col: usize, row: usize| {
            let point = planes.points_in_robot_m.get(row * width + col)?;
            let point = Vector3::from(point.map(f64::from));
            point.iter().all(|v| v.is_finite()).then_some(point)
        };
        for row in (0..height).step_by(stride) {
            for col in (0..width).step_by(stride) {
                let Some(point_m) = at(col, row) else {
                    continue;
                };
                let range_m = (point_m - eye).norm();
                if !(config.reach[0]..config.reach[1]).contains(&range_m) {
                    continue;
                }
                let (left, right) = (col.saturating_sub(window), (col + window).min(width - 1));
                let (top, bottom) = (row.saturating_sub(window), (row + window).min(height - 1));
                let about = [at(left, row), at(right, row), at(col, top), at(col, bottom)];
                let normal = match about {
                    [Some(left), Some(right), Some(top), Some(bottom)] => {
                        normal(&point_m, [left, right], [top, bottom], &eye, tuning.jump)
                    }
                    _ => None,
                };
                self.sightings.push(FramePoint {
                    point_m,
                    range_m,
                    along: (point_m - eye) / range_m,
                    spread_m: (point_m - eye) * (config.range_noise_growth * range_m),
                    normal,
                    is_ground: false,
                });
            }
        }
    }

    /// Of the planes through three candidates the one that most candidates lie on; of equals the first.
    fn dominant(&mut self, config: &MonteCarloConfig, draws: &mut Stream) -> Option<LevelPlane> {
        let tuning = &config.tuning.ground;
        self.asked.clear();
        for &index in self.candidates.iter().step_by(tuning.stride) {
            let sighting = &self.sightings[index as usize];
            self.asked.push([sighting.point_m, sighting.spread_m]);
        }
        let tolerance_m = config.ground_tolerance;
        let mut best: Option<(usize, LevelPlane)> = None;
        for _ in 0..config.ground_samples {
            let points: [Vector3<f64>; 3] = std::array::from_fn(|_| {
                let index = self.candidates[draws.below(self.candidates.len())];
                self.sightings[index as usize].point_m
            });
            let Some(plane) = LevelPlane::through(&points, tuning.upright) else {
                continue;
            };
            let on =
                |&&[point_m, spread_m]: &&[_; 2]| plane.holds(&point_m, &spread_m, tolerance_m);
            let count = self.asked.iter().filter(on).count();
            if best.is_none_or(|(most, _)| count > most) {
                best = Some((count, plane));
            }
        }
        let (_, plane) = best?;
        let on = (self.candidates.iter()).map(|&index| &self.sightings[index as usize]);
        let held = on.filter(|sighting| plane.has(sighting, config, 1.0));
        LevelPlane::fitted(held, tuning.upright).or(Some(plane))
    }

    /// Labels what lies on a plane and leaves the other candidates; returns how many were taken.
    fn take(&mut self, plane: &LevelPlane, config: &MonteCarloConfig) -> usize {
        let tuning = &config.tuning.ground;
        self.kept.clear();
        for &index in &self.candidates {
            if !plane.has(&self.sightings[index as usize], config, 1.0) {
                self.kept.push(index);
            }
        }
        let taken = self.candidates.len() - self.kept.len();
        std::mem::swap(&mut self.candidates, &mut self.kept);
        for sighting in &mut self.sightings {
            // Beside a wall's foot the neighbourhood is not level, nor is its foot high.
            let level = (sighting.normal).is_some_and(|normal| normal.z > tuning.upright);
            let share = if level { 1.0 } else { tuning.near };
            sighting.is_ground |= plane.has(sighting, config, share);
        }
        taken
    }
}

/// The floor in a picture's points, of a camera with a body's axes that stands in their origin: upward normal, and how far below it is, m.
/// It is the level plane that most points lie on, with hardly any below it.
pub(super) fn floor_below(
    points_m: &[[f32; 3]],
    config: &MonteCarloConfig,
    draws: &mut Stream,
) -> Option<(Vector3<f64>, f64)> {
    let tuning = &config.tuning.camera;
    let reach_m = config.reach[0]..config.reach[1];
    let seen: Vec<_> = (points_m
        .iter()
        .map(|point| Vector3::from(point.map(f64::from))))
    .filter(|point| reach_m.contains(&point.norm()))
    .collect();
    let stride = seen.len().div_ceil(tuning.points).max(1);
    let points: Vec<_> = seen.into_iter().step_by(stride).collect();
    if points.len() < 3 {
        return None;
    }
    let tolerance_m = |point: &Vector3<f64>| {
        config.ground_tolerance + config.range_noise_growth * point.norm_squared()
    };
    let share = |count: usize| count as f64 / points.len() as f64;
    let on = |plane: &LevelPlane| {
        let off_m = |point: &Vector3<f64>| plane.normal.dot(point) - plane.offset_m;
        let below =
            |point: &&Vector3<f64>| off_m(point) < -config.tuning.fit.sigmas * tolerance_m(point);
        if share(points.iter().filter(below).count()) > tuning.below_floor {
            return 0;
        }
        let near = |point: &&Vector3<f64>| off_m(point).abs() < tolerance_m(point);
        points.iter().filter(near).count()
    };
    let planes = (0..tuning.samples).filter_map(|_| {
        let three = std::array::from_fn(|_| points[draws.below(points.len())]);
        LevelPlane::through(&three, tuning.upright).filter(|plane| plane.offset_m < 0.0)
    });
    let (count, plane) =
        (planes.map(|plane| (on(&plane), plane))).max_by_key(|(count, _)| *count)?;
    (share(count) > tuning.on_floor).then_some((plane.normal, -plane.offset_m))
}

/// Normal of the surface about a point, towards the camera.
fn normal(
    point: &Vector3<f64>,
    across: [Vector3<f64>; 2],
    down: [Vector3<f64>; 2],
    eye: &Vector3<f64>,
    jump: f64,
) -> Option<Vector3<f64>> {
    let range_m = (point - eye).norm();
    let torn = [across[0], across[1], down[0], down[1]]
        .iter()
        .any(|other| ((other - eye).norm() - range_m).abs() > jump * range_m);
    let normal = (across[1] - across[0]).cross(&(down[1] - down[0]));
    let normal = normal.try_normalize(NO_NORMAL_M2).filter(|_| !torn)?;
    Some(if normal.dot(&(eye - point)) < 0.0 {
        -normal
    } else {
        normal
    })
}

/// A plane that is about level: `normal . p = offset_m`.
#[derive(Debug, Clone, Copy)]
struct LevelPlane {
    normal: Vector3<f64>,
    offset_m: f64,
}

impl LevelPlane {
    /// The plane through three points, where it is about level.
    fn through([a, b, c]: &[Vector3<f64>; 3], upright: f64) -> Option<Self> {
        let normal = (b - a).cross(&(c - a)).try_normalize(ON_A_LINE_M2)?;
        let normal = normal * normal.z.signum();
        (normal.z > upright).then(|| Self {
            normal,
            offset_m: normal.dot(a),
        })
    }

    /// The plane with the least squares of vertical distances from points: `z = a x + b y + c`.
    fn fitted<'a>(sightings: impl Iterator<Item = &'a FramePoint>, upright: f64) -> Option<Self> {
        let (mut squares, mut sums) = (Matrix3::zeros(), Vector3::zeros());
        for sighting in sightings {
            let row = Vector3::new(sighting.point_m.x, sighting.point_m.y, 1.0);
            squares += row * row.transpose();
            sums += row * sighting.point_m.z;
        }
        let [a, b, c] = squares.cholesky()?.solve(&sums).into();
        let scale = 1.0 / (a * a + b * b + 1.0).sqrt();
        let normal = Vector3::new(-a, -b, 1.0) * scale;
        (normal.z > upright).then_some(Self {
            normal,
            offset_m: c * scale,
        })
    }

    /// Whether a point lies on the plane, within a share of the tolerance.
    fn has(&self, sighting: &FramePoint, config: &MonteCarloConfig, share: f64) -> bool {
        let (spread_m, tolerance_m) = (sighting.spread_m * share, config.ground_tolerance * share);
        self.holds(&sighting.point_m, &spread_m, tolerance_m)
    }

    #[inline]
    fn holds(&self, point_m: &Vector3<f64>, spread_m: &Vector3<f64>, tolerance_m: f64) -> bool {
        let noise_m = self.normal.dot(spread_m).abs();
        (self.normal.dot(point_m) - self.offset_m).abs() < tolerance_m + noise_m
    }
}
