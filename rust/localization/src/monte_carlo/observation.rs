//! How likely a frame is from where a guess stands: equation (2) of 002.
//!
//! `p(o | x) = p(r | x) p(z | x) p(phi | x) p(theta | x)`, as sums of logarithms.

use nalgebra::{Point3, Vector3};
use volume::{LANES, Lanes};

use super::beams::{Beams, RangeBeam};
use super::config::MonteCarloConfig;
use super::fit::FrameFit;
use super::gauss::{NO_SIGMAS, gauss, splat};
use super::guesses::Guesses;
use super::motion::BodyReading;
use super::particle::TorsoPose;
use super::static_map::StaticMap;
use super::tuning::{FrameFitTuning, HeightTuning};

/// Beams of which the likelihoods are multiplied before their logarithm is taken: each lies between 1e-9 and 1e9, so that the
/// product of four of them has room in single precision.
const FACTORS: usize = 4;
/// Logarithm of a frame's likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct LogLikelihood {
    /// Part of the ranges.
    pub(super) ranges: f64,
    /// Part of height, roll and pitch.
    pub(super) body: f64,
}

/// A beam with all of its likelihood that does not depend on the guess: of a range `r` where the map says `m`,
/// `p(r | m) = hit N(r; m, sigma) + [r < m] short l exp(-l r) + random / r_max`. What stands in the way and is not mapped makes
/// `r` shorter (Thrun, Burgard, Fox 2005, 6.3); its normalization over `0..m` is left out.
#[derive(Debug, Clone, Copy)]
pub(super) struct BeamRay {
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
pub(super) struct SeenFrame {
    pub(super) origin_m: [f64; 3],
    pub(super) rays: Vec<BeamRay>,
    /// Rays that end on what is not mapped: no part of the likelihood.
    pub(super) left_out: Vec<BeamRay>,
    random: f64,
    reach_m: f64,
    is_felt: bool,
    height_m: f64,
    height_noise_m: f64,
    attitude_rad: [f64; 2],
    attitude_noise_rad: f64,
    /// The soles' middle in the torso's frame, m.
    sole_m: [f64; 3],
    height: HeightTuning,
    explains: FrameFitTuning,
}

impl SeenFrame {
    /// Takes in a frame's beams and what the body says; ranges are taken to be worse than they are by a standard deviation of
    /// `blur_m`, so that guesses that are near the truth count. Keeps its buffer.
    pub(super) fn set(
        &mut self,
        (beams, blur_m): (&Beams, f64),
        reading: &BodyReading,
        map: &StaticMap,
        config: &MonteCarloConfig,
    ) {
        let [hit, short, random] = config.mixture;
        self.origin_m = beams.origin_m;
        self.reach_m = config.reach[1];
        self.random = random / self.reach_m;
        self.rays.clear();
        self.left_out.clear();
        self.rays.extend(beams.drawn.iter().map(|beam: &RangeBeam| {
            let noise_m = geometry::hypot(beam.noise_m, blur_m);
            let per_noise = 1.0 / noise_m;
            BeamRay {
                direction: beam.direction,
                range_m: beam.range_m,
                far_m: beam.range_m + NO_SIGMAS * noise_m,
                per_noise,
                hit: hit * per_noise / std::f64::consts::TAU.sqrt(),
                is_ground: beam.is_ground,
                short: short * config.short_rate * libm::exp(-config.short_rate * beam.range_m),
            }
        }));
        self.is_felt = reading.is_felt;
        self.height_m = reading.torso_height_m;
        // The map's ground is as coarse as its voxels: an even distribution over one has a twelfth of its square as variance.
        self.height_noise_m =
            geometry::hypot(config.height_noise, map.resolution_m() / 12.0_f64.sqrt());
        let torso = &reading.odometry_from_torso;
        self.attitude_rad = [torso.roll_rad, torso.pitch_rad];
        self.attitude_noise_rad = config.attitude_noise;
        self.sole_m = reading.torso_from_robot.translation.vector.into();
        self.height = config.tuning.height.clone();
        self.explains = config.tuning.fit.clone();
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
                let turned = guesses.turned(&ray.direction).map(Lanes::to_array);
                let ends_m = Lanes::from(std::array::from_fn::<_, LANES, _>(|lane| {
                    let along = std::array::from_fn(|a| f64::from(turned[a][lane]));
                    let end_m = std::array::from_fn(|a| eyes_m[a][lane] + along[a] * ray.range_m);
                    field.distance_m(end_m, along) as f32
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
    pub(super) fn fit(&self, pose: &TorsoPose, map: &StaticMap) -> Option<FrameFit> {
        let isometry = pose.isometry();
        let eye = (isometry * Point3::from(self.origin_m)).coords.into();
        let (mut fit, within) = (FrameFit::default(), self.explains.sigmas);
        for ray in (self.rays.iter().chain(&self.left_out)).filter(|ray| !ray.is_ground) {
            let along = isometry.rotation * Vector3::from(ray.direction);
            let cast = map.ranges.cast(eye, along.into(), self.reach_m);
            let sigmas = (cast.unwrap_or(f64::INFINITY) - ray.range_m) * ray.per_noise;
            fit.count(sigmas, within);
        }
        fit.tells(self.explains.least_beams)
    }

    /// Likelihood of a beam where the map has its end at `mapped_m`.
    #[inline]
    fn beam_likelihood(&self, ray: &BeamRay, mapped_m: Lanes) -> Lanes {
        let off_m = mapped_m - splat(ray.range_m);
        let before = off_m.simd_gt(Lanes::ZERO) & splat(ray.short);
        splat(ray.hit) * gauss(off_m * splat(ray.per_noise)) + before + splat(self.random)
    }

    /// Logarithm of the product over all rays.
    #[inline]
    fn product(&self, likelihood: impl Fn(&BeamRay) -> Lanes) -> Lanes {
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

    /// Logarithm of the likelihood of height, roll and pitch; nothing where no body feels them.
    fn body(&self, poses: &[TorsoPose; LANES], guesses: &Guesses, map: &StaticMap) -> Lanes {
        if !self.is_felt {
            return Lanes::ZERO;
        }
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
        let reach_m = splat(self.height.reach * self.height_m);
        let height_m = map.ranges.cast_side_by_side(&above, &down, reach_m);
        let off_m = height_m - splat(self.height_m);
        let height = gauss(off_m * splat(1.0 / self.height_noise_m));
        let any = splat(self.height.any * self.height.any_density);
        Lanes::from(attitude) + (splat(1.0 - self.height.any) * height + any).ln()
    }
}

#[cfg(test)]
mod tests;
