//! Which landmarks to keep where not all can be: those that tell most of where the robot is (004, section 36.3.5: natural landmarks are selected for
//! localization, reference 36.36).

use geometry::PlanarPose;
use nalgebra::{Matrix3, Vector3};
use settings::{ConfigError, POSITIVE, Table, settings};

use crate::sighting::{ExpectedReading, in_view};
use crate::{Landmark, LandmarksConfig};

settings! {
    /// The choice of the most useful landmarks.
    pub struct SelectionConfig("landmarks.selection") {
        /// How well the robot knows its place without any of them, standard deviation.
        place_noise: f64 = 0.3, "m", POSITIVE;
        /// How well it knows its heading without any of them, standard deviation.
        heading_noise: f64 = 0.2, "rad", POSITIVE;
    }
}

/// The indices of `count` landmarks that together tell most of the pose along a way, the most useful first: each next one is that which adds most to the
/// mean information, the logarithm of the determinant of the pose's inverse covariance. That grows ever less with each one more, so that no choice of as
/// many adds more than e / (e - 1) times as much (Nemhauser, Wolsey, Fisher 1978). `way`: where the robot will look from.
///
/// A landmark counts as it is seen from a place (`reach`, `view`), as often (`seen`), as precisely, and as sure as it is there; what is not known of its
/// place adds to what is not known of the reading.
///
/// # Errors
/// A setting cannot be used.
pub fn most_useful(
    landmarks: &[Landmark],
    way: &[PlanarPose],
    count: usize,
    (selection, config): (&SelectionConfig, &LandmarksConfig),
) -> Result<Vec<usize>, ConfigError> {
    selection.check()?;
    config.check()?;
    let told: Vec<Vec<(usize, Matrix3<f64>)>> = landmarks
        .iter()
        .map(|one| {
            let from = way.iter().enumerate();
            from.filter_map(|(at, robot)| Some((at, information(one, robot, config)?)))
                .collect()
        })
        .collect();
    let variances = [
        selection.place_noise,
        selection.place_noise,
        selection.heading_noise,
    ];
    let before = Matrix3::from_diagonal(&Vector3::from(variances.map(|sd| 1.0 / (sd * sd))));
    let mut known = vec![before; way.len()];
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < count.min(landmarks.len()) {
        let gain = |index: usize| {
            let each = told[index].iter();
            each.map(|(at, more)| {
                let now = known[*at];
                libm::log((now + more).determinant() / now.determinant())
            })
            .sum::<f64>()
        };
        let left = (0..landmarks.len()).filter(|index| !chosen.contains(index));
        let gains = left.map(|index| (index, gain(index)));
        let Some((best, _)) = gains.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))) else {
            break;
        };
        for (at, more) in &told[best] {
            known[*at] += more;
        }
        chosen.push(best);
    }
    Ok(chosen)
}

/// What a landmark tells of the pose from a place, on average: the inverse covariance of x, y (m) and heading (rad). None where it is not in view.
fn information(
    landmark: &Landmark,
    robot: &PlanarPose,
    config: &LandmarksConfig,
) -> Option<Matrix3<f64>> {
    if !in_view(robot, &landmark.at_m, config) {
        return None;
    }
    let expected = ExpectedReading::of(robot, &landmark.at_m)?;
    let spread = expected.covariance(&Matrix3::zeros(), &landmark.covariance, config);
    let by = expected.by_pose;
    let often = config.seen * landmark.probability();
    Some(by.transpose() * spread.try_inverse()? * by * often)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LandmarkReading, RangeBearing};
    use geometry::{SplitMix64, wrap_angle};
    use nalgebra::{Matrix2, Vector2};

    const KEPT: usize = 5;

    fn config() -> LandmarksConfig {
        LandmarksConfig {
            range_noise: 0.1,
            bearing_noise: 0.02,
            reach: [0.5, 5.0],
            view: 1.0,
            seen: 0.9,
            ..LandmarksConfig::default()
        }
    }

    fn field(random: &mut SplitMix64) -> Vec<Landmark> {
        (0..40)
            .map(|name| {
                let [x, y] = [(); 2].map(|()| 16.0 * random.uniform() - 8.0);
                let sd = 0.02 + 0.3 * random.uniform();
                Landmark {
                    at_m: Vector2::new(x, y),
                    covariance: Matrix2::identity() * (sd * sd),
                    name: Some(name),
                    log_odds: 3.0,
                    readings: 10,
                    gone: [0.0; 2],
                }
            })
            .collect()
    }

    fn way() -> Vec<PlanarPose> {
        (0..150)
            .map(|step| {
                let angle = 0.04 * f64::from(step);
                let (sin, cos) = libm::sincos(angle);
                PlanarPose::new(5.0 * cos, 5.0 * sin, wrap_angle(angle + 1.57))
            })
            .collect()
    }

    /// Root mean square error, m, of an extended Kalman filter that knows these landmarks alone, with odometry that errs.
    fn error_m(landmarks: &[Landmark], kept: &[usize], seed: u64) -> f64 {
        let (config, way) = (config(), way());
        let mut random = SplitMix64::new(seed);
        let truth: Vec<Vector2<f64>> = landmarks
            .iter()
            .map(|one| {
                let [x, y] = random.normals();
                one.at_m + Vector2::new(x, y) * one.covariance.m11.sqrt()
            })
            .collect();
        let (mut at, mut spread, mut sum) = (way[0], Matrix3::<f64>::identity() * 1e-4, 0.0);
        for pair in way.windows(2) {
            let [x, y, yaw] = random.normals();
            let moved = pair[0].inverse().compose(&pair[1]);
            let told = PlanarPose::new(
                moved.x_m + 0.03 * x,
                moved.y_m + 0.03 * y,
                moved.yaw_rad + 0.02 * yaw,
            );
            let (sin, cos) = libm::sincos(at.yaw_rad);
            let mut by = Matrix3::identity();
            by[(0, 2)] = -sin * told.x_m - cos * told.y_m;
            by[(1, 2)] = cos * told.x_m - sin * told.y_m;
            at = at.compose(&told);
            spread = by * spread * by.transpose()
                + Matrix3::from_diagonal(&Vector3::new(9e-4, 9e-4, 4e-4));
            for &index in kept {
                let Some(seen) = look(&pair[1], &truth[index], &mut random, &config) else {
                    continue;
                };
                let one = &landmarks[index];
                let expected = ExpectedReading::of(&at, &one.at_m).unwrap();
                let innovation = expected.covariance(&spread, &one.covariance, &config);
                let gain =
                    spread * expected.by_pose.transpose() * innovation.try_inverse().unwrap();
                let off = gain * seen.at.minus(&expected.reading);
                at = PlanarPose::new(
                    at.x_m + off.x,
                    at.y_m + off.y,
                    wrap_angle(at.yaw_rad + off.z),
                );
                spread -= gain * expected.by_pose * spread;
            }
            sum += (at.x_m - pair[1].x_m).powi(2) + (at.y_m - pair[1].y_m).powi(2);
        }
        (sum / (way.len() - 1) as f64).sqrt()
    }

    fn look(
        robot: &PlanarPose,
        at: &Vector2<f64>,
        random: &mut SplitMix64,
        config: &LandmarksConfig,
    ) -> Option<LandmarkReading> {
        let [range, bearing] = random.normals();
        let is_seen = random.uniform() < config.seen && in_view(robot, at, config);
        let at = ExpectedReading::of(robot, at)?.reading;
        let at = RangeBearing {
            range_m: at.range_m + config.range_noise * range,
            bearing_rad: at.bearing_rad + config.bearing_noise * bearing,
        };
        is_seen.then_some(LandmarkReading { at, name: None })
    }

    #[test]
    fn the_chosen_ones_localize_better_than_as_many_at_random() {
        let (mut won, mut chosen_m, mut random_m) = (0, 0.0, 0.0);
        for seed in 0..20 {
            let mut random = SplitMix64::new(100 + seed);
            let landmarks = field(&mut random);
            let settings = (&SelectionConfig::default(), &config());
            let chosen = most_useful(&landmarks, &way(), KEPT, settings).unwrap();
            assert_eq!(chosen.len(), KEPT);
            let useful_m = error_m(&landmarks, &chosen, seed);
            // The mean of ten choices at random.
            let each = (0..10).map(|_| {
                let mut left: Vec<usize> = (0..landmarks.len()).collect();
                let kept: Vec<usize> = (0..KEPT)
                    .map(|_| left.swap_remove((random.uniform() * left.len() as f64) as usize))
                    .collect();
                error_m(&landmarks, &kept, seed)
            });
            let any_m = each.sum::<f64>() / 10.0;
            won += usize::from(useful_m < any_m);
            chosen_m += useful_m / 20.0;
            random_m += any_m / 20.0;
        }
        assert_eq!(won, 20);
        assert!(chosen_m < 0.5 * random_m, "{chosen_m} {random_m}");
    }

    #[test]
    fn the_first_ones_stay_the_same_however_many_are_chosen() {
        let landmarks = field(&mut SplitMix64::new(7));
        let settings = (&SelectionConfig::default(), &config());
        let choose = |count| most_useful(&landmarks, &way(), count, settings).unwrap();
        let all = choose(landmarks.len() + 3);
        assert_eq!(all.len(), landmarks.len());
        for count in [0, 1, 7] {
            assert_eq!(choose(count)[..], all[..count]);
        }
        assert!(most_useful(&[], &way(), 3, settings).unwrap().is_empty());
    }
}
