//! The beams of a frame by which guesses are judged.

use nalgebra::Isometry3;
use segmentation::Planes;

use super::config::MonteCarloConfig;
use super::ground::GroundFinder;
use super::random::{Purpose, Stream};

/// A measured range along a line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RangeBeam {
    /// Unit vector in the torso's frame.
    pub(super) direction: [f64; 3],
    pub(super) range_m: f64,
    /// Standard deviation of the range, m.
    pub(super) noise_m: f64,
    pub(super) is_ground: bool,
}

/// Draws beams from frames. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub(super) struct Beams {
    /// Where all begin, in the torso's frame, m.
    pub(super) origin_m: [f64; 3],
    pub(super) drawn: Vec<RangeBeam>,
    finder: GroundFinder,
    on_ground: Vec<u32>,
    off_ground: Vec<u32>,
}

impl Beams {
    /// Draws from a frame: as many as wanted on the ground, the rest off it, each kind uniformly; what one kind lacks, the other
    /// has more. None from a frame of which the points cannot be trusted.
    pub(super) fn draw(
        &mut self,
        planes: &Planes,
        torso_from_robot: &Isometry3<f64>,
        config: &MonteCarloConfig,
        step: u64,
    ) {
        self.drawn.clear();
        if !planes.reliable {
            return;
        }
        let mut stream = Stream::new(config.seed, step, Purpose::Ground, 0);
        self.finder.find(planes, config, &mut stream);
        self.on_ground.clear();
        self.off_ground.clear();
        for (index, sighting) in self.finder.sightings.iter().enumerate() {
            if sighting.is_ground {
                self.on_ground.push(index as u32);
            } else {
                self.off_ground.push(index as u32);
            }
        }
        let [ground, other] = shares(
            config.beams,
            config.ground_share,
            [self.on_ground.len(), self.off_ground.len()],
        );
        let mut stream = Stream::new(config.seed, step, Purpose::Beams, 0);
        shuffle(&mut self.on_ground, ground, &mut stream);
        shuffle(&mut self.off_ground, other, &mut stream);
        let torso_from_camera = torso_from_robot * planes.robot_from_camera.inner;
        self.origin_m = torso_from_camera.translation.vector.into();
        for &index in self.on_ground[..ground]
            .iter()
            .chain(&self.off_ground[..other])
        {
            let sighting = &self.finder.sightings[index as usize];
            let range_m = sighting.range_m;
            let along = torso_from_robot.rotation * sighting.along;
            let growth_m = config.range_noise_growth * range_m * range_m;
            self.drawn.push(RangeBeam {
                direction: along.into(),
                range_m,
                noise_m: geometry::hypot(config.range_noise, growth_m),
                is_ground: sighting.is_ground,
            });
        }
    }
}

/// How many of each kind, on the ground and off it, of those that there are.
fn shares(wanted: usize, ground_share: f64, there: [usize; 2]) -> [usize; 2] {
    let ground = ((wanted as f64 * ground_share).round() as usize).min(there[0]);
    let other = (wanted - ground).min(there[1]);
    [(wanted - other).min(there[0]), other]
}

/// Brings `count` drawn ones to the front, without putting any back.
fn shuffle(indices: &mut [u32], count: usize, stream: &mut Stream) {
    for place in 0..count {
        let other = place + stream.below(indices.len() - place);
        indices.swap(place, other);
    }
}

#[cfg(test)]
mod tests {
    use super::super::world::{Eye, World};
    use super::*;
    use nalgebra::{UnitQuaternion, Vector3};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn half_lie_on_the_ground_and_one_kind_fills_in_for_the_other(on in 0..200_usize, off in 0..200_usize) {
            let [ground, other] = shares(100, 0.5, [on, off]);
            prop_assert!(ground <= on && other <= off);
            prop_assert_eq!(ground + other, 100.min(on + off));
            if on >= 50 && off >= 50 { prop_assert_eq!([ground, other], [50, 50]); }
            if on < 50 { prop_assert_eq!(ground, on); }
            if off < 50 { prop_assert_eq!(other, off); }
        }

        #[test]
        fn ground_is_told_from_the_rest_though_the_pose_is_wrong_by_5_degrees(
            x in 0.8..1.6f64, y in 0.8..4.2f64, yaw in -3.0..3.0f64, tilt_about in 0.0..6.2f64, number in 0..1000_u64,
        ) {
            let world = World::room();
            let robot = Isometry3::new(Vector3::new(x, y, 0.0), Vector3::z() * yaw);
            let eye = Eye::ahead();
            let mut planes = world.frame(&robot, &eye, number);
            // What is seen is turned about the robot by an attitude that is wrong.
            let axis = Vector3::new(libm::cos(tilt_about), libm::sin(tilt_about), 0.0);
            let wrong = UnitQuaternion::new(axis * 5.0_f64.to_radians());
            let config = MonteCarloConfig::default();
            for point in &mut planes.points_in_robot_m {
                let turned = wrong * Vector3::from(point.map(f64::from));
                *point = [turned.x as f32, turned.y as f32, turned.z as f32];
            }
            planes.robot_from_camera.inner = wrong * planes.robot_from_camera.inner;
            let mut finder = GroundFinder::default();
            finder.find(&planes, &config, &mut Stream::new(number, 0, Purpose::Ground, 0));
            // By what each line of sight truly met.
            let mut pixels = planes.points_in_robot_m.iter().enumerate();
            let (mut right, all) = (0, finder.sightings.len());
            for sighting in &finder.sightings {
                let (pixel, _) = pixels.find(|(_, p)| Vector3::from(p.map(f64::from)) == sighting.point_m).unwrap();

                right += usize::from(world.meets_ground(&robot, &eye, pixel) == sighting.is_ground);
            }
            prop_assert!(all > 500, "{all}");
            prop_assert!(right as f64 >= 0.98 * all as f64, "{right} of {all}");
        }
    }

    #[test]
    fn beams_are_those_of_the_camera_seen_from_the_torso() {
        let world = World::room();
        let robot = Isometry3::new(Vector3::new(1.0, 2.5, 0.0), Vector3::zeros());
        let planes = world.frame(&robot, &Eye::ahead(), 0);
        let torso_from_robot = Isometry3::new(Vector3::new(0.01, 0.0, -0.33), Vector3::y() * 0.1);
        let mut beams = Beams::default();
        beams.draw(&planes, &torso_from_robot, &MonteCarloConfig::default(), 5);
        assert_eq!(beams.drawn.len(), 100);
        assert_eq!(beams.drawn.iter().filter(|b| b.is_ground).count(), 50);
        let robot_from_torso = torso_from_robot.inverse();
        for beam in &beams.drawn {
            let end = Vector3::from(beams.origin_m) + Vector3::from(beam.direction) * beam.range_m;
            let in_robot = robot_from_torso * nalgebra::Point3::from(end);
            let nearest = (planes.points_in_robot_m.iter())
                .map(|p| (Vector3::from(p.map(f64::from)) - in_robot.coords).norm())
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-6);
        }
        let before = beams.drawn.clone();
        beams.draw(&planes, &torso_from_robot, &MonteCarloConfig::default(), 5);
        assert_eq!(before, beams.drawn);
        beams.draw(&planes, &torso_from_robot, &MonteCarloConfig::default(), 6);
        assert_ne!(before, beams.drawn);
    }
}
