//! Claims about the likelihood of a frame.

use super::super::config::RangeModel;
use super::super::world::{Eye, World};
use super::*;
use geometry::Pose;
use nalgebra::Isometry3;
use proptest::prelude::*;
use std::sync::Arc;
use testkit::state_at;

/// What is seen in the room from a place, by a torso that is tilted as it is measured to be; and the truth.
fn seen(range_model: RangeModel) -> (SeenFrame, Arc<StaticMap>, TorsoPose, Beams) {
    let world = World::room();
    let config = MonteCarloConfig {
        range_model,
        ..MonteCarloConfig::default()
    };
    let map = world.map(&config);
    let robot = Isometry3::new(Vector3::new(1.1, 2.6, 0.0), Vector3::z() * 0.2);
    let mut body = state_at(0);
    body.robot_from_torso = Pose::wrap(Isometry3::new(
        Vector3::new(0.0, 0.0, 0.33),
        Vector3::new(0.03, -0.04, 0.0),
    ));
    body.odometry_from_torso_rotation = body.robot_from_torso.inner.rotation;
    let reading = BodyReading::of(&body, &Isometry3::identity());
    let mut beams = Beams::default();
    let planes = world.frame(&robot, &Eye::ahead(), 1);
    beams.draw(&planes, &reading.torso_from_robot, &config, 1);
    let mut observation = SeenFrame::default();
    observation.set((&beams, 0.0), &reading, &map, &config);
    let truth = TorsoPose::of(&(robot * body.robot_from_torso.inner));
    (observation, map, truth, beams)
}

#[test]
fn the_sum_of_logarithms_is_the_logarithm_of_the_product() {
    let (observation, map, truth, beams) = seen(RangeModel::RayCast);
    let [hit, short, random] = MonteCarloConfig::default().mixture;
    let isometry = truth.isometry();
    let eye = (isometry * Point3::from(beams.origin_m)).coords;
    let product: f64 = (beams.drawn.iter().take(40))
        .map(|beam| {
            let along = isometry.rotation * Vector3::from(beam.direction);
            let cast = map.ranges.cast(eye.into(), along.into(), 4.0);
            let (range_m, sd) = (beam.range_m, beam.noise_m);
            let off = (cast.unwrap() - range_m) / sd;
            let normal = libm::exp(-0.5 * off * off) / (sd * std::f64::consts::TAU.sqrt());
            let before = if cast.unwrap() > range_m {
                0.5 * libm::exp(-0.5 * range_m)
            } else {
                0.0
            };
            hit * normal + short * before + random / 4.0
        })
        .product();
    let mut first = observation.clone();
    first.rays.truncate(40);
    let [found, ..] = first.log_likelihoods(&[truth; LANES], &map);
    let found = found.ranges;
    assert!(
        (found - libm::log(product)).abs() < 1e-3,
        "{found} {}",
        libm::log(product)
    );
}

#[test]
fn what_stands_in_the_way_costs_little_what_is_seen_through_costs_much() {
    let (observation, map, truth, _) = seen(RangeModel::RayCast);
    let mut short = observation.clone();
    let mut long = observation.clone();
    for (short, long) in short.rays.iter_mut().zip(&mut long.rays).take(20) {
        short.range_m -= 0.4;
        long.range_m += 0.4;
        long.far_m += 0.4;
    }
    let of = |observation: &SeenFrame| observation.log_likelihoods(&[truth; LANES], &map)[0].ranges;
    assert!(of(&observation) > of(&short) && of(&short) > of(&long) + 5.0);
    let fit = observation.fit(&truth, &map).unwrap();
    assert!(fit.lenient(0.03) > 0.97 && fit.strict() > 0.97);
    let mut blocked = observation.clone();
    let upright = blocked.rays.iter_mut().filter(|ray| !ray.is_ground);
    for ray in upright.take(20) {
        ray.range_m -= 0.4;
    }
    let fit = blocked.fit(&truth, &map).unwrap();
    assert!(fit.lenient(0.03) > 0.9 && fit.strict() < 0.7, "{fit:?}");
}

/// What takes seconds: not in the fast part of the tests.
mod slow {
    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn every_factor_peaks_at_the_truth(axis in 0..6_usize, by in prop_oneof![-0.3..-0.12f64, 0.12..0.3f64], field in any::<bool>()) {
            let model = if field { RangeModel::LikelihoodField } else { RangeModel::RayCast };
            let (observation, map, truth, _) = seen(model);
            let mut wrong = truth;
            match axis {
                0..3 => wrong.place_m[axis] += by,
                3 => wrong.roll_rad += by,
                4 => wrong.pitch_rad += by,
                _ => wrong.yaw_rad += by,
            }
            let mut poses = [truth; LANES];
            poses[3] = wrong;
            let [right, _, _, wrong, ..] = observation.log_likelihoods(&poses, &map);
            prop_assert!(right.ranges > wrong.ranges + 5.0, "{right:?} {wrong:?}");
            // Height, roll and pitch are measured by themselves; the others are not.
            if (2..5).contains(&axis) { prop_assert!(right.body > wrong.body + 2.0, "{right:?} {wrong:?}"); }
        }
    }
}
