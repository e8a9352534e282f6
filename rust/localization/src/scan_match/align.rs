//! How far a frame's beams have to be turned to lie on a keyframe's surfaces.
//!
//! Gauss-Newton on the distances from beams to walls (point to line), for the heading and for a small shift that nobody asks
//! for: leg odometry knows the place better than the camera does, whose own place on the head is wrong by a centimetre.

use geometry::PlanarPose;
use nalgebra::{Matrix3, Rotation2, Vector2, Vector3};

use super::{profile::UprightBeam, surfaces::UprightSurfaces, tuning::AlignmentTuning};

/// What is believed before.
#[derive(Debug, Clone, Copy)]
pub(super) struct TurnGuess {
    /// The robot as seen from the keyframe.
    pub(super) keyframe_from_robot: PlanarPose,
    /// Standard deviation of its heading, rad.
    pub(super) heading_sd_rad: f64,
    /// Standard deviation of the shift in each direction, m.
    pub(super) offset_sd_m: f64,
    /// Beams that must lie on surfaces.
    pub(super) least_beams: usize,
}

/// What a frame says about the heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turn {
    /// By how much the robot is turned further than guessed, rad: of the frame alone, whatever was guessed.
    pub(super) beyond_rad: f64,
    /// Variance of that angle, rad^2.
    pub(super) variance_rad2: f64,
    /// Whether the surfaces seem to be where they were.
    pub(super) in_place: bool,
}

/// The sums of least squares over shift and heading.
#[derive(Debug, Clone, Copy)]
struct LeastSquares {
    information: Matrix3<f64>,
    gradient: Vector3<f64>,
    beams: usize,
}

/// Compares beams with surfaces; nothing where too few of them meet, or where they say nothing about the heading.
pub(super) fn align(
    beams: &[UprightBeam],
    surfaces: &UprightSurfaces,
    guess: &TurnGuess,
    tuning: &AlignmentTuning,
) -> Option<Turn> {
    let prior = Matrix3::from_diagonal(&Vector3::new(
        guess.offset_sd_m.powi(-2),
        guess.offset_sd_m.powi(-2),
        guess.heading_sd_rad.powi(-2),
    ));
    let mut found = Vector3::zeros();
    let sums_at =
        |found: &Vector3<f64>| sums(beams, surfaces, &guess.keyframe_from_robot, found, tuning);
    let mut sums = sums_at(&found);
    for _ in 0..tuning.iterations {
        if sums.beams < guess.least_beams {
            return None;
        }
        let step = (sums.information + prior)
            .cholesky()?
            .solve(&(sums.gradient + prior * found));
        found -= step;
        sums = sums_at(&found);
        if step.amax() < tuning.small_step {
            break;
        }
    }
    let variance_rad2 = heading_variance(&sums.information, guess.offset_sd_m)?;
    if sums.beams < guess.least_beams {
        return None;
    }
    // The guess drew the solution towards itself: by as much as it was sure.
    let pull = 1.0 + variance_rad2 * guess.heading_sd_rad.powi(-2);
    Some(Turn {
        beyond_rad: found.z * pull,
        variance_rad2,
        in_place: found.xy().norm() < tuning.far_sigmas * guess.offset_sd_m,
    })
}

/// Variance of the heading when the shift may be anything that `offset_sd_m` allows: the Schur complement.
fn heading_variance(information: &Matrix3<f64>, offset_sd_m: f64) -> Option<f64> {
    let shifts = information.fixed_view::<2, 2>(0, 0).into_owned()
        + nalgebra::Matrix2::identity() * offset_sd_m.powi(-2);
    let both = Vector2::new(information.m13, information.m23);
    let own = information.m33 - both.dot(&(shifts.cholesky()?.solve(&both)));
    (own > 0.0).then(|| 1.0 / own)
}

fn sums(
    beams: &[UprightBeam],
    surfaces: &UprightSurfaces,
    keyframe_from_robot: &PlanarPose,
    found: &Vector3<f64>,
    tuning: &AlignmentTuning,
) -> LeastSquares {
    let turn = Rotation2::new(keyframe_from_robot.yaw_rad + found.z);
    let origin_m = Vector2::new(keyframe_from_robot.x_m, keyframe_from_robot.y_m) + found.xy();
    let mut sums = LeastSquares {
        information: Matrix3::zeros(),
        gradient: Vector3::zeros(),
        beams: 0,
    };
    for beam in beams {
        let arm_m = turn * beam.place_m;
        let place_m = origin_m + arm_m;
        let Some(wall) = surfaces.wall_at(place_m) else {
            continue;
        };
        let normal_in_robot = turn.inverse() * wall.normal;
        let noise_m2 = normal_in_robot.dot(&(beam.covariance_m2 * normal_in_robot));
        let variance_m2 = wall.variance_m2 + noise_m2 + tuning.roughness;
        let distance_m = wall.normal.dot(&(place_m - wall.middle_m));
        let trust =
            (1.0 + distance_m * distance_m / variance_m2 / tuning.robust_sigmas.powi(2)).powi(-2);
        let row = Vector3::new(wall.normal.x, wall.normal.y, arm_m.perp(&wall.normal));
        let weight = tuning.independent * trust / variance_m2;
        sums.information += row * row.transpose() * weight;
        sums.gradient += row * (distance_m * weight);
        sums.beams += usize::from(trust > tuning.least_trust);
    }
    sums
}
