//! How far the torso moved between two frames, by leg odometry, and how wrong that may be.

use geometry::wrap_angle;
use nalgebra::{Isometry3, Rotation2, Vector2, Vector3};

use super::{config::MonteCarloConfig, particle::TorsoPose, random::Stream};
use proprioception::BodyState;

/// What the body says of itself at a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct BodyReading {
    pub(super) time_ns: u64,
    pub(super) odometry_from_robot: Isometry3<f64>,
    pub(super) odometry_from_camera: Isometry3<f64>,
    pub(super) torso_from_robot: Isometry3<f64>,
    /// The torso by leg odometry; roll and pitch are those of the attitude filter.
    pub(super) odometry_from_torso: TorsoPose,
    /// The torso above what carries the robot, m.
    pub(super) torso_height_m: f64,
    /// Whether a body feels its height and attitude: they are evidence then.
    pub(super) is_felt: bool,
}

impl BodyReading {
    pub(super) fn of(body: &BodyState, robot_from_camera: &Isometry3<f64>) -> Self {
        let robot_from_torso = body.robot_from_torso.inner;
        let mut torso = body.odometry_from_robot.inner * robot_from_torso;
        torso.rotation = body.odometry_from_torso_rotation;
        Self {
            time_ns: body.time_ns,
            odometry_from_robot: body.odometry_from_robot.inner,
            odometry_from_camera: body.odometry_from_robot.inner * robot_from_camera,
            torso_from_robot: robot_from_torso.inverse(),
            odometry_from_torso: TorsoPose::of(&torso),
            torso_height_m: robot_from_torso.translation.z,
            is_felt: true,
        }
    }

    /// How far the camera went since another reading, m, and by how much it turned, rad.
    pub(super) fn seen_since(&self, before: &Self) -> (f64, f64) {
        let moved = before.odometry_from_camera.inverse() * self.odometry_from_camera;
        (moved.translation.vector.norm(), moved.rotation.angle())
    }

    /// How far the robot's frame went since another reading, m, and by how much it turned, rad.
    fn gone_since(&self, before: &Self) -> (f64, f64) {
        let moved = before.odometry_from_robot.inverse() * self.odometry_from_robot;
        (moved.translation.vector.norm(), moved.rotation.angle())
    }

    /// Where the camera looks to by leg odometry, rad.
    pub(super) fn heading_of_camera_rad(&self) -> f64 {
        let along = self.odometry_from_camera.rotation * Vector3::z();
        libm::atan2(along.y, along.x)
    }
}

/// The Gaussian motion model: mean and standard deviations of one increment, in the heading of the torso before it.
#[derive(Debug, Clone, Copy)]
pub(super) struct TorsoMotion {
    /// Forward, sideways, up, m.
    pub(super) shift_m: [f64; 3],
    /// Roll, pitch, yaw, rad.
    pub(super) turn_rad: [f64; 3],
    /// Standard deviations of the six.
    pub(super) sd: [f64; 6],
}

impl TorsoMotion {
    /// Variances grow with the way, the turn and the time, so that it does not matter in how many increments one goes:
    /// `sigma^2 = a d + b |turn| + c t`.
    pub(super) fn between(
        before: &BodyReading,
        now: &BodyReading,
        config: &MonteCarloConfig,
    ) -> Self {
        let (travelled_m, turned_rad) = now.gone_since(before);
        let passed_s = now.time_ns.saturating_sub(before.time_ns) as f64 * 1e-9;
        let sd = |[per_m, per_rad, per_s]: [f64; 3]| {
            let way = per_m * per_m * travelled_m + per_rad * per_rad * turned_rad;
            (way + per_s * per_s * passed_s).sqrt()
        };
        let [place, height, heading, attitude] = [
            config.place_noise,
            config.height_drift,
            config.heading_noise,
            config.attitude_drift,
        ]
        .map(sd);
        let (from, to) = (&before.odometry_from_torso, &now.odometry_from_torso);
        let off: [f64; 3] = std::array::from_fn(|a| to.place_m[a] - from.place_m[a]);
        let flat = Rotation2::new(-from.yaw_rad) * Vector2::new(off[0], off[1]);
        Self {
            shift_m: [flat.x, flat.y, off[2]],
            turn_rad: [
                to.roll_rad - from.roll_rad,
                to.pitch_rad - from.pitch_rad,
                to.turned_rad(from),
            ],
            sd: [place, place, height, attitude, attitude, heading],
        }
    }

    /// Moves a guess by the increment and a draw of its error.
    pub(super) fn sample(&self, pose: &mut TorsoPose, stream: &mut Stream) {
        let normals = stream.normals::<6>();
        self.apply(pose, &std::array::from_fn(|a| self.sd[a] * normals[a]));
    }

    /// Moves a guess by the increment and its error.
    pub(super) fn apply(&self, pose: &mut TorsoPose, draw: &[f64; 6]) {
        let shift: [f64; 3] = std::array::from_fn(|a| self.shift_m[a] + draw[a]);
        let (sin, cos) = libm::sincos(pose.yaw_rad);
        pose.place_m[0] += cos * shift[0] - sin * shift[1];
        pose.place_m[1] += sin * shift[0] + cos * shift[1];
        pose.place_m[2] += shift[2];
        pose.roll_rad += self.turn_rad[0] + draw[3];
        pose.pitch_rad += self.turn_rad[1] + draw[4];
        pose.yaw_rad = wrap_angle(pose.yaw_rad + self.turn_rad[2] + draw[5]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Purpose;
    use super::*;
    use geometry::Pose;
    use nalgebra::{SMatrix, SVector};
    use proptest::prelude::*;
    use testkit::state_at;

    fn reading(time_ns: u64, [x_m, y_m, z_m, yaw_rad]: [f64; 4]) -> BodyReading {
        let mut body = state_at(time_ns);
        body.odometry_from_robot = Pose::from_yaw(x_m, y_m, z_m, yaw_rad);
        body.robot_from_torso = Pose::from_yaw(0.02, 0.0, 0.33, 0.0);
        let torso = body.odometry_from_robot * body.robot_from_torso;
        body.odometry_from_torso_rotation = torso.inner.rotation;
        BodyReading::of(&body, &Isometry3::identity())
    }

    #[test]
    fn draws_have_the_mean_and_the_covariance_of_the_model() {
        let config = MonteCarloConfig::default();
        let (before, now) = (
            reading(0, [0.3, -0.2, 0.1, 0.4]),
            reading(160_000_000, [0.33, -0.18, 0.12, 0.5]),
        );
        let motion = TorsoMotion::between(&before, &now, &config);
        let start = TorsoPose {
            place_m: [1.0, 2.0, 0.4],
            roll_rad: 0.02,
            pitch_rad: -0.03,
            yaw_rad: 1.2,
        };
        let (sin, cos) = libm::sincos(start.yaw_rad);
        let draws = 100_000;
        let (mut mean, mut square) = (SVector::<f64, 6>::zeros(), SMatrix::<f64, 6, 6>::zeros());
        for index in 0..draws {
            let mut pose = start;
            motion.sample(&mut pose, &mut Stream::new(11, 0, Purpose::Motion, index));
            let off: [f64; 3] = std::array::from_fn(|a| pose.place_m[a] - start.place_m[a]);
            let moved = SVector::from([
                cos * off[0] + sin * off[1],
                -sin * off[0] + cos * off[1],
                off[2],
                pose.roll_rad - start.roll_rad,
                pose.pitch_rad - start.pitch_rad,
                pose.turned_rad(&start),
            ]);
            mean += moved / f64::from(draws as u32);
            square += moved * moved.transpose() / f64::from(draws as u32);
        }
        let covariance = square - mean * mean.transpose();
        let expected = [motion.shift_m, motion.turn_rad].concat();
        for a in 0..6 {
            assert!((mean[a] - expected[a]).abs() < 0.02 * motion.sd[a], "{a}");
            for b in 0..6 {
                let scale = motion.sd[a] * motion.sd[b];
                let share = covariance[(a, b)] / scale - f64::from(u8::from(a == b));
                assert!(share.abs() < 0.02, "{a} {b}: {share}");
            }
        }
    }

    proptest! {
        #[test]
        fn without_noise_a_guess_moves_like_the_torso(at in prop::array::uniform4(-2.0..2.0f64), by in prop::array::uniform4(-0.3..0.3f64), yaw in -3.0..3.0f64) {
            let before = reading(0, at);
            let now = reading(1, std::array::from_fn(|a| at[a] + by[a]));
            let mut motion = TorsoMotion::between(&before, &now, &MonteCarloConfig::default());
            motion.sd = [0.0; 6];
            let map_from_odometry = Pose::<geometry::Map, geometry::Odometry>::from_yaw(0.7, -0.3, 0.2, yaw).inner;
            let mut pose = TorsoPose::of(&(map_from_odometry * before.odometry_from_torso.isometry()));
            motion.sample(&mut pose, &mut Stream::new(0, 0, Purpose::Motion, 0));
            let off = pose.isometry().inverse() * map_from_odometry * now.odometry_from_torso.isometry();
            prop_assert!(off.translation.vector.norm() < 1e-9 && off.rotation.angle() < 1e-6);
        }

        #[test]
        fn the_error_of_a_way_does_not_depend_on_its_pieces(pieces in 1..20_u32, way in 0.1..1.0f64) {
            let config = MonteCarloConfig::default();
            let whole = TorsoMotion::between(&reading(0, [0.0; 4]), &reading(1_000_000_000, [way, 0.0, 0.0, 0.0]), &config);
            let mut squares = [0.0; 6];
            for piece in 0..pieces {
                let at = |n: u32| reading(1_000_000_000 * u64::from(n) / u64::from(pieces), [way * f64::from(n) / f64::from(pieces), 0.0, 0.0, 0.0]);
                let motion = TorsoMotion::between(&at(piece), &at(piece + 1), &config);
                for (square, sd) in squares.iter_mut().zip(motion.sd) { *square += sd * sd; }
            }
            for (square, sd) in squares.iter().zip(whole.sd) { prop_assert!((f64::sqrt(*square) / sd - 1.0).abs() < 1e-6); }
        }
    }
}
