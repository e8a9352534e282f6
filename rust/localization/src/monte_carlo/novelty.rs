//! Beams that end on what the map does not have: the distance filter of Fox, Burgard, Thrun 1999 ("Markov localization for mobile
//! robots in dynamic environments"), by things instead of single beams.
//!
//! Equation (2) of 002 takes beams for independent. Those that end on one thing beside a wall are not: each is a little more likely
//! from a pose that makes it a part of that wall, and where little else stands in view they draw the estimate there.

use volume::LANES;

use super::config::MonteCarloConfig;
use super::gauss::splat;
use super::guesses::Guesses;
use super::observation::SeenFrame;
use super::particle::TorsoPose;
use super::static_map::StaticMap;
use super::tuning::UnmappedTuning;

/// Finds beams that end on what is not mapped. Keeps its buffer.
#[derive(Debug, Clone)]
pub(super) struct Unmapped {
    tuning: UnmappedTuning,
    /// A range fits within so many standard deviations.
    sigmas: f64,
    ends: Vec<BeamEnd>,
}

impl Unmapped {
    pub(super) fn new(config: &MonteCarloConfig) -> Self {
        Self {
            tuning: config.tuning.unmapped.clone(),
            sigmas: config.tuning.fit.sigmas,
            ends: Vec::new(),
        }
    }

    /// Leaves those beams out of the likelihood that end on things that are not mapped, as it looks from all of these guesses.
    /// They go on to count in [`SeenFrame::fit`]. Allocates nothing once its buffer has grown.
    pub(super) fn leave_out(
        &mut self,
        observation: &mut SeenFrame,
        believed: &[TorsoPose; LANES],
        map: &StaticMap,
    ) {
        let guesses = Guesses::of(believed);
        let eyes = map.ranges.in_voxels(&guesses.placed(&observation.origin_m));
        let fits = splat(self.sigmas);
        self.ends.clear();
        for ray in observation.rays.iter().filter(|ray| !ray.is_ground) {
            let along = guesses.turned(&ray.direction);
            let reach_m = splat(ray.far_m);
            let mapped_m = map.ranges.cast_side_by_side(&eyes, &along, reach_m);
            let sigmas = (mapped_m - splat(ray.range_m)) * splat(ray.per_noise);
            let is_before = sigmas.simd_gt(fits).all();
            let at_m = ray.direction.map(|along| along * ray.range_m);
            self.ends.push(BeamEnd { at_m, is_before });
        }
        observation.left_out.clear();
        let (ends, left_out) = (&self.ends, &mut observation.left_out);
        let tuning = &self.tuning;
        let mut next = 0;
        observation.rays.retain(|ray| {
            if ray.is_ground {
                return true;
            }
            next += 1;
            let unmapped = is_unmapped(&ends[next - 1], ends, tuning);
            if unmapped {
                left_out.push(*ray);
            }
            !unmapped
        });
    }
}

/// Where a beam ends, seen from the camera but in the torso's directions, m.
#[derive(Debug, Clone, Copy)]
struct BeamEnd {
    at_m: [f64; 3],
    /// Whether that is before the map's surface.
    is_before: bool,
}

/// Whether a beam ends on a thing that is not mapped.
fn is_unmapped(end: &BeamEnd, ends: &[BeamEnd], tuning: &UnmappedTuning) -> bool {
    let thing_m = tuning.thing;
    let away2 = |other: &BeamEnd| -> f64 {
        let off = |a: usize| end.at_m[a] - other.at_m[a];
        (0..3).map(|a| off(a) * off(a)).sum()
    };
    let beside = ends.iter().filter(|other| away2(other) < thing_m * thing_m);
    let (mut all, mut before) = (0.0, 0.0);
    for other in beside {
        all += 1.0;
        before += f64::from(u8::from(other.is_before));
    }
    before > tuning.share * all
}

#[cfg(test)]
mod tests {
    use super::super::beams::Beams;
    use super::super::motion::BodyReading;
    use super::super::observation::BeamRay;
    use super::super::world::{Eye, World};
    use super::*;
    use geometry::Pose;
    use nalgebra::{Isometry3, Point3, Vector3};
    use proptest::prelude::*;
    use testkit::state_at;

    /// Ends on a patch of a wall that is 2 m ahead, or on a thing that stands before it.
    fn ends(at_m: [f64; 3], count: usize, is_before: impl Fn(usize) -> bool) -> Vec<BeamEnd> {
        let place = |i: usize| {
            [
                at_m[0],
                at_m[1] + 0.03 * (i % 6) as f64,
                at_m[2] + 0.03 * (i / 6) as f64,
            ]
        };
        let end = |i| BeamEnd {
            at_m: place(i),
            is_before: is_before(i),
        };
        (0..count).map(end).collect()
    }

    fn left_out(ends: &[BeamEnd]) -> usize {
        let tuning = UnmappedTuning::default();
        let unmapped = |end: &&BeamEnd| is_unmapped(end, ends, &tuning);
        ends.iter().filter(unmapped).count()
    }

    #[test]
    fn a_thing_beside_a_wall_is_left_out_whole_though_half_of_it_could_be_the_wall() {
        let thing = ends([1.0, 0.5, 0.0], 30, |i| i % 2 == 0);
        let wall = ends([2.0, -0.5, 0.0], 20, |_| false);
        assert_eq!(left_out(&thing), 30);
        assert_eq!(left_out(&[thing, wall].concat()), 30);
    }

    #[test]
    fn a_thing_by_a_wall_is_left_out_and_the_wall_stays() {
        let mut world = World::walled(7.0, 4.4);
        world.unmapped.push([[0.07, 1.2, 0.0], [0.27, 1.4, 0.25]]);
        let config = MonteCarloConfig::default();
        let map = world.map(&config);
        let robot = Isometry3::new(Vector3::new(0.78, 0.5, 0.0), Vector3::z() * 1.8);
        let mut body = state_at(0);
        body.robot_from_torso = Pose::wrap(Isometry3::translation(0.0, 0.0, 0.33));
        body.odometry_from_torso_rotation = body.robot_from_torso.inner.rotation;
        let reading = BodyReading::of(&body, &Isometry3::identity());
        let map_from_torso = robot * body.robot_from_torso.inner;
        let truth = TorsoPose::of(&map_from_torso);
        let (mut beams, mut observation) = (Beams::default(), SeenFrame::default());
        let mut unmapped = Unmapped::new(&config);
        for number in 0..10 {
            let planes = world.frame(&robot, &Eye::ahead(), number);
            beams.draw(&planes, &reading.torso_from_robot, &config, number);
            observation.set((&beams, 0.0), &reading, &map, &config);
            unmapped.leave_out(&mut observation, &[truth; LANES], &map);
            let on_thing = |ray: &&BeamRay| {
                let end = Vector3::from(observation.origin_m)
                    + Vector3::from(ray.direction) * ray.range_m;
                let at = map_from_torso * Point3::from(end);
                at.x > 0.04 && (1.15..1.45).contains(&at.y) && !ray.is_ground
            };
            let off_ground = |rays: &[BeamRay]| rays.iter().filter(|ray| !ray.is_ground).count();
            let thing = observation.left_out.iter().filter(on_thing).count();
            assert!(thing >= 3, "{thing}");
            assert_eq!(observation.rays.iter().filter(on_thing).count(), 0);
            let (kept, left_out) = (off_ground(&observation.rays), observation.left_out.len());
            assert!(
                left_out - thing <= 3 && kept >= 10,
                "{left_out} {thing} {kept}"
            );
            assert!(observation.left_out.iter().all(|ray| !ray.is_ground));
        }
    }

    #[test]
    fn a_wall_of_which_few_beams_seem_short_stays() {
        assert_eq!(left_out(&ends([2.0, 0.0, 0.0], 24, |i| i == 9)), 0);
    }

    proptest! {
        #[test]
        fn who_ends_before_the_map_among_nothing_but_such_is_left_out(count in 1..40_usize, seed in 0..100_u32) {
            let at_m = [1.0 + f64::from(seed) * 0.01, 0.0, 0.0];
            prop_assert_eq!(left_out(&ends(at_m, count, |_| true)), count);
            prop_assert_eq!(left_out(&ends(at_m, count, |_| false)), 0);
        }
    }
}
