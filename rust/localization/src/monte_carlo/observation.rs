//! How likely a frame is from where a guess stands: equation (2) of 002.
//!
//! `p(o | x) = p(r | x) p(z | x) p(phi | x) p(theta | x)`, as sums of logarithms.

use nalgebra::{Point3, Vector3};
use volume::{LANES, Lanes};

use super::MonteCarloConfig;
use super::beams::{Beam, Beams};
use super::fit::Fit;
use super::gauss::{NO_SIGMAS, gauss, splat};
use super::guesses::Guesses;
use super::motion::Reading;
use super::novelty::End;
use super::particle::TorsoPose;
use super::static_map::StaticMap;

/// Beams of which the likelihoods are multiplied before their logarithm is taken: each lies between 1e-9 and 1e9, and their
/// product is in single precision.
const FACTORS: usize = 4;
/// A torso is looked for ground below it down to so many times its height.
const GROUND_BELOW: f64 = 1.5;
/// Share of heights that have nothing to do with the map's ground: beside an edge, on what is not in it.
const ANY_HEIGHT: f64 = 0.05;

/// Logarithm of a frame's likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct LogLikelihood {
    /// Of the ranges.
    pub(super) ranges: f64,
    /// Of height, roll and pitch.
    pub(super) body: f64,
}

/// A beam with all of its likelihood that does not depend on the guess: of a range `r` where the map says `m`,
/// `p(r | m) = hit N(r; m, sigma) + [r < m] short l exp(-l r) + random / r_max`. What stands in the way and is not mapped makes
/// `r` shorter (Thrun, Burgard, Fox 2005, 6.3); its normalization over `0..m` is left out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    pub(super) direction: [f64; 3],
    pub(super) range_m: f64,
    /// From here on a surface is too far to have been measured, m.
    pub(super) far_m: f64,
    pub(super) per_noise: f64,
    hit: f64,
    short: f64,
    pub(super) is_ground: bool,
}

/// Everything that a frame says.
#[derive(Debug, Clone, Default)]
pub(super) struct Observation {
    pub(super) origin_m: [f64; 3],
    pub(super) rays: Vec<Ray>,
    /// Rays that end on what is not mapped: no part of the likelihood.
    pub(super) left_out: Vec<Ray>,
    /// Room to find them.
    pub(super) ends: Vec<End>,
    random: f64,
    reach_m: f64,
    height_m: f64,
    height_noise_m: f64,
    attitude_rad: [f64; 2],
    attitude_noise_rad: f64,
    /// The soles' middle in the torso's frame, m.
    sole_m: [f64; 3],
}

impl Observation {
    /// Takes in a frame's beams and what the body says; ranges are taken to be worse than they are by a standard deviation of
    /// `blur_m`, so that guesses that are near the truth count. Keeps its buffer.
    pub(super) fn set(
        &mut self,
        (beams, blur_m): (&Beams, f64),
        reading: &Reading,
        map: &StaticMap,
        config: &MonteCarloConfig,
    ) {
        let [hit, short, random] = config.mixture;
        self.origin_m = beams.origin_m;
        self.reach_m = config.reach[1];
        self.random = random / self.reach_m;
        self.rays.clear();
        self.left_out.clear();
        self.rays.extend(beams.drawn.iter().map(|beam: &Beam| {
            let noise_m = beam.noise_m.hypot(blur_m);
            let per_noise = 1.0 / noise_m;
            Ray {
                direction: beam.direction,
                range_m: beam.range_m,
                far_m: beam.range_m + NO_SIGMAS * noise_m,
                per_noise,
                hit: hit * per_noise / std::f64::consts::TAU.sqrt(),
                is_ground: beam.is_ground,
                short: short * config.short_rate * (-config.short_rate * beam.range_m).exp(),
            }
        }));
        self.height_m = reading.torso_height_m;
        // The map's ground is as coarse as its voxels.
        self.height_noise_m = config
            .height_noise
            .hypot(map.resolution_m() / 12.0_f64.sqrt());
        let torso = &reading.odometry_from_torso;
        self.attitude_rad = [torso.roll_rad, torso.pitch_rad];
        self.attitude_noise_rad = config.attitude_noise;
        self.sole_m = reading.torso_from_robot.translation.vector.into();
    }

    /// The frame's likelihood from each of eight guesses, in single precision. Allocates nothing.
    pub(super) fn log_likelihoods(
        &self,
        poses: &[TorsoPose; LANES],
        map: &StaticMap,
    ) -> [LogLikelihood; LANES] {
        let guesses = Guesses::of(poses);
        let eyes_m = guesses.placed(&self.origin_m);
        let ranges = match &map.distances {
            None => {
                let eyes = map.ranges.in_voxels(&eyes_m);
                self.product(|ray| {
                    let along = guesses.turned(&ray.direction);
                    // How far beyond the measured range the map's surface lies makes no difference.
                    let reach_m = splat(ray.far_m);
                    let mapped_m = map.ranges.cast_side_by_side(&eyes, &along, reach_m);
                    self.beam_likelihood(ray, mapped_m)
                })
            }
            Some(field) => self.product(|ray| {
                let along = guesses.turned(&ray.direction).map(Lanes::to_array);
                let ends_m = Lanes::from(std::array::from_fn::<_, LANES, _>(|lane| {
                    let end_m =
                        |a: usize| eyes_m[a][lane] + f64::from(along[a][lane]) * ray.range_m;
                    field.distance_m([end_m(0), end_m(1), end_m(2)]) as f32
                }));
                let near = gauss(ends_m * splat(ray.per_noise));
                splat(ray.hit) * near + splat(ray.short + self.random)
            }),
        };
        let (ranges, body) = (
            ranges.to_array(),
            self.body(poses, &guesses, map).to_array(),
        );
        std::array::from_fn(|lane| LogLikelihood {
            ranges: f64::from(ranges[lane]),
            body: f64::from(body[lane]),
        })
    }

    /// How well a pose explains the frame, by the beams off the ground. None where too few beams can tell.
    pub(super) fn fit(&self, pose: &TorsoPose, map: &StaticMap) -> Option<Fit> {
        let isometry = pose.isometry();
        let eye = (isometry * Point3::from(self.origin_m)).coords.into();
        let mut fit = Fit::default();
        for ray in (self.rays.iter().chain(&self.left_out)).filter(|ray| !ray.is_ground) {
            let along = isometry.rotation * Vector3::from(ray.direction);
            let cast = map.ranges.cast(eye, along.into(), self.reach_m);
            fit.count((cast.unwrap_or(f64::INFINITY) - ray.range_m) * ray.per_noise);
        }
        fit.tells()
    }

    /// Likelihood of a beam where the map has its end at `mapped_m`.
    #[inline]
    fn beam_likelihood(&self, ray: &Ray, mapped_m: Lanes) -> Lanes {
        let off_m = mapped_m - splat(ray.range_m);
        let before = off_m.simd_gt(Lanes::ZERO) & splat(ray.short);
        splat(ray.hit) * gauss(off_m * splat(ray.per_noise)) + before + splat(self.random)
    }

    /// Logarithm of the product over all rays.
    #[inline]
    fn product(&self, likelihood: impl Fn(&Ray) -> Lanes) -> Lanes {
        let mut sum = Lanes::ZERO;
        for rays in self.rays.chunks(FACTORS) {
            let mut product = Lanes::ONE;
            for ray in rays {
                product *= likelihood(ray);
            }
            sum += product.ln();
        }
        sum
    }

    /// Logarithm of the likelihood of height, roll and pitch.
    fn body(&self, poses: &[TorsoPose; LANES], guesses: &Guesses, map: &StaticMap) -> Lanes {
        let [measured_roll, measured_pitch] = self.attitude_rad;
        let attitude = poses.map(|pose| {
            let off = [
                pose.roll_rad - measured_roll,
                pose.pitch_rad - measured_pitch,
            ];
            let squares = off.map(|off| (off / self.attitude_noise_rad).powi(2));
            (-0.5 * (squares[0] + squares[1])) as f32
        });
        let [x, y, _] = guesses.placed(&self.sole_m);
        let above = map
            .ranges
            .in_voxels(&[x, y, poses.map(|pose| pose.place_m[2])]);
        let down = [0.0, 0.0, -1.0].map(Lanes::splat);
        let reach_m = splat(GROUND_BELOW * self.height_m);
        let height_m = map.ranges.cast_side_by_side(&above, &down, reach_m);
        let off_m = height_m - splat(self.height_m);
        let height = gauss(off_m * splat(1.0 / self.height_noise_m));
        let any = splat(ANY_HEIGHT * 1e-2);
        Lanes::from(attitude) + (splat(1.0 - ANY_HEIGHT) * height + any).ln()
    }
}

#[cfg(test)]
mod tests {
    use super::super::RangeModel;
    use super::super::world::{Eye, World};
    use super::*;
    use geometry::Pose;
    use nalgebra::Isometry3;
    use proptest::prelude::*;
    use std::sync::Arc;
    use testkit::state_at;

    /// What is seen in the room from a place, by a torso that is tilted as it is measured to be; and the truth.
    fn seen(range_model: RangeModel) -> (Observation, Arc<StaticMap>, TorsoPose, Beams) {
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
        let reading = Reading::of(&body, &Isometry3::identity());
        let mut beams = Beams::default();
        let planes = world.frame(&robot, &Eye::ahead(), 1);
        beams.draw(&planes, &reading.torso_from_robot, &config, 1);
        let mut observation = Observation::default();
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
                let normal = (-0.5 * off * off).exp() / (sd * std::f64::consts::TAU.sqrt());
                let before = if cast.unwrap() > range_m {
                    0.5 * (-0.5 * range_m).exp()
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
            (found - product.ln()).abs() < 1e-3,
            "{found} {}",
            product.ln()
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
        let of = |observation: &Observation| {
            observation.log_likelihoods(&[truth; LANES], &map)[0].ranges
        };
        assert!(of(&observation) > of(&short) && of(&short) > of(&long) + 5.0);
        let fit = observation.fit(&truth, &map).unwrap();
        assert!(fit.lenient() > 0.97 && fit.strict() > 0.97);
        let mut blocked = observation.clone();
        let upright = blocked.rays.iter_mut().filter(|ray| !ray.is_ground);
        for ray in upright.take(20) {
            ray.range_m -= 0.4;
        }
        let fit = blocked.fit(&truth, &map).unwrap();
        assert!(fit.lenient() > 0.9 && fit.strict() < 0.7, "{fit:?}");
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
}
