//! What stands out of the floor, seen from above: for each direction the distance at which something rises.

use nalgebra::{Matrix2, Vector2};
use segmentation::Planes;

use super::{config::MatchingConfig, tuning::ProfileTuning};

/// A direction in which something stands out of the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct UprightBeam {
    /// Where, in the robot's frame, m.
    pub(super) place_m: Vector2<f64>,
    /// How sure that is, m^2.
    pub(super) covariance_m2: Matrix2<f64>,
}

/// A point of the frame from above.
#[derive(Debug, Clone, Copy)]
struct UprightPoint {
    beam: i32,
    distance_m: f64,
    bearing_rad: f64,
    height_m: f64,
}

/// The beams of a frame, from right to left. None where the frame cannot be trusted.
///
/// The error of a distance `z` is that of its disparity, `z^2 / (f b) sigma_d`.
pub(super) fn beams(planes: &Planes, config: &MatchingConfig) -> Vec<UprightBeam> {
    let Some(camera) = planes.camera.filter(|_| planes.reliable) else {
        return Vec::new();
    };
    let noise_per_m = config.disparity_noise / (camera.focal_px * camera.baseline_m);
    let eye = planes.robot_from_camera.origin().inner;
    let tuning = &config.tuning.profile;
    let sightings = sightings(planes, config);
    sightings
        .chunk_by(|a, b| a.beam == b.beam)
        .filter_map(|column| {
            let surface = fullest(column, noise_per_m, tuning);
            let (low_m, high_m) = surface.iter().fold((f64::MAX, f64::MIN), |(low, high), s| {
                (low.min(s.height_m), high.max(s.height_m))
            });
            if surface.len() < config.beam_points || high_m - low_m < config.rise {
                return None;
            }
            let count = surface.len() as f64;
            let mean = |of: fn(&UprightPoint) -> f64| surface.iter().map(of).sum::<f64>() / count;
            let (distance_m, bearing_rad) = (mean(|s| s.distance_m), mean(|s| s.bearing_rad));
            let slant_m = geometry::hypot(distance_m, eye.z - mean(|s| s.height_m));
            let along_m = geometry::hypot(
                noise_per_m * slant_m * distance_m / (count / tuning.window).max(1.0).sqrt(),
                tuning.least_noise,
            );
            let across_m = (tuning.across * config.beam * distance_m).max(tuning.least_across);
            let ahead = Vector2::new(libm::cos(bearing_rad), libm::sin(bearing_rad));
            let aside = Vector2::new(-ahead.y, ahead.x);
            Some(UprightBeam {
                place_m: eye.coords.xy() + ahead * distance_m,
                covariance_m2: ahead * ahead.transpose() * along_m.powi(2)
                    + aside * aside.transpose() * across_m.powi(2),
            })
        })
        .collect()
}

/// The points that are on no level surface, by direction, then by distance.
fn sightings(planes: &Planes, config: &MatchingConfig) -> Vec<UprightPoint> {
    let tuning = &config.tuning.profile;
    let eye = planes.robot_from_camera.origin().inner;
    let mut sightings: Vec<_> = planes
        .points_in_robot_m
        .iter()
        .zip(&planes.floor_height_m)
        .filter(|(_, floor_m)| floor_m.is_nan())
        .filter_map(|(point, _)| {
            let [x_m, y_m, height_m] = point.map(f64::from);
            let (ahead_m, aside_m) = (x_m - eye.x, y_m - eye.y);
            let distance_m = geometry::hypot(ahead_m, aside_m);
            let bearing_rad = libm::atan2(aside_m, ahead_m);
            // False for what is no number, too.
            let counts = height_m > tuning.lowest
                && distance_m > tuning.nearest
                && distance_m < config.reach;
            counts.then_some(UprightPoint {
                beam: (bearing_rad / config.beam).floor() as i32,
                distance_m,
                bearing_rad,
                height_m,
            })
        })
        .collect();
    sightings
        .sort_by(|a, b| (a.beam.cmp(&b.beam)).then_with(|| a.distance_m.total_cmp(&b.distance_m)));
    sightings
}

/// The most points of a column, sorted by distance, that may be one upright surface.
fn fullest<'a>(
    column: &'a [UprightPoint],
    noise_per_m: f64,
    tuning: &ProfileTuning,
) -> &'a [UprightPoint] {
    let mut end = 0;
    let mut best = &column[..0];
    for (begin, first) in column.iter().enumerate() {
        let depth_m =
            (tuning.depth).max(tuning.depth_sigmas * noise_per_m * first.distance_m.powi(2));
        while end < column.len() && column[end].distance_m <= first.distance_m + depth_m {
            end += 1;
        }
        if end - begin > best.len() {
            best = &column[begin..end];
        }
    }
    best
}
