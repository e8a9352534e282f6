//! Rocks, trunks and walls before a depth camera that errs.

use super::*;
use geometry::{PlanarPose, SplitMix64};
use nalgebra::Vector3;

const EYE_M: f64 = 0.6;
const PITCH_RAD: f64 = 0.25;
const HALF_VIEW_RAD: f64 = 0.6;
const COLUMNS: usize = 160;
const ROWS: usize = 120;
/// Standard deviation of a range of 1 m; it grows with the square, as a stereo camera's.
const NOISE_M: f64 = 0.004;
const REACH_M: [f64; 2] = [0.8, 4.5];

#[derive(Clone, Copy)]
struct Thing {
    at_m: Vector2<f64>,
    radius_m: f64,
    height_m: f64,
    shape: ThingShape,
}

/// Rocks are halves of ellipsoids, trunks cylinders; a wall stands behind.
struct Scene {
    things: Vec<Thing>,
    wall_m: f64,
}

impl Scene {
    fn new(random: &mut SplitMix64) -> Self {
        let mut things: Vec<Thing> = Vec::new();
        while things.len() < 9 {
            let [x, y, size, high] = [(); 4].map(|()| random.uniform());
            let at_m = Vector2::new(0.9 + 3.6 * x, 4.4 * y - 2.2);
            let is_rock = things.len() < 5;
            let radius_m = if is_rock {
                0.1 + 0.2 * size
            } else {
                0.04 + 0.07 * size
            };
            let thing = Thing {
                at_m,
                radius_m,
                height_m: if is_rock {
                    radius_m * (0.8 + 0.5 * high)
                } else {
                    0.9 + 0.5 * high
                },
                shape: if is_rock {
                    ThingShape::Rock
                } else {
                    ThingShape::Pole
                },
            };
            let clear =
                |other: &Thing| (other.at_m - at_m).norm() > other.radius_m + radius_m + 0.3;
            if things.iter().all(clear) {
                things.push(thing);
            }
        }
        Self {
            things,
            wall_m: 5.5,
        }
    }

    /// How far a ray from the eye gets, and what it meets: a thing by index, or none.
    fn cast(&self, eye_m: &Vector3<f64>, way: &Vector3<f64>) -> Option<(f64, Option<usize>)> {
        let mut best: Option<(f64, Option<usize>)> = None;
        let mut meet = |at_m: f64, what: Option<usize>| {
            if at_m > 0.0 && best.is_none_or(|(nearest_m, _)| at_m < nearest_m) {
                best = Some((at_m, what));
            }
        };
        if way.z < 0.0 {
            meet(-eye_m.z / way.z, None);
        }
        if way.x > 0.0 {
            meet((self.wall_m - eye_m.x) / way.x, None);
        }
        for (index, thing) in self.things.iter().enumerate() {
            if let Some(at_m) = thing.meets(eye_m, way) {
                meet(at_m, Some(index));
            }
        }
        best
    }

    /// The points of a picture in the robot's frame, and how many rays meet each thing, seen and not hidden.
    fn picture(
        &self,
        robot: &PlanarPose,
        random: &mut SplitMix64,
    ) -> (Vec<Point3<f64>>, Vec<[usize; 2]>) {
        let mut points = Vec::new();
        let mut counts = vec![[0; 2]; self.things.len()];
        let eye_m = Vector3::new(robot.x_m, robot.y_m, EYE_M);
        let (sin, cos) = libm::sincos(PITCH_RAD);
        for pixel in 0..ROWS * COLUMNS {
            let (row, col) = (pixel / COLUMNS, pixel % COLUMNS);
            let focal_px = 0.5 * COLUMNS as f64 / libm::tan(HALF_VIEW_RAD + 0.1);
            let left = (0.5 * (COLUMNS as f64 - 1.0) - col as f64) / focal_px;
            let up = (0.5 * (ROWS as f64 - 1.0) - row as f64) / focal_px;
            let ahead = Vector3::new(cos + sin * up, left, -sin + cos * up).normalize();
            let (x, y) = PlanarPose::new(0.0, 0.0, robot.yaw_rad).apply(ahead.x, ahead.y);
            let way = Vector3::new(x, y, ahead.z);
            for (thing, count) in self.things.iter().zip(&mut counts) {
                count[1] += usize::from(thing.meets(&eye_m, &way).is_some());
            }
            let Some((range_m, what)) = self.cast(&eye_m, &way) else {
                continue;
            };
            if let Some(index) = what {
                counts[index][0] += 1;
            }
            let [error] = random.normals();
            let point = ahead * (range_m + NOISE_M * range_m * range_m * error);
            if libm::atan2(point.y, point.x).abs() < HALF_VIEW_RAD {
                points.push(Point3::new(point.x, point.y, point.z + EYE_M));
            }
        }
        (points, counts)
    }
}

impl Thing {
    fn meets(&self, eye_m: &Vector3<f64>, way: &Vector3<f64>) -> Option<f64> {
        let from = eye_m.xy() - self.at_m;
        let squash = match self.shape {
            ThingShape::Rock => self.radius_m / self.height_m,
            ThingShape::Pole => 0.0,
        };
        let (high, rise) = (squash * eye_m.z, squash * way.z);
        let square = way.xy().norm_squared() + rise * rise;
        let half = from.dot(&way.xy()) + high * rise;
        let rest = from.norm_squared() + high * high - self.radius_m * self.radius_m;
        let root = (half * half - square * rest).max(-1.0);
        if root < 0.0 || square == 0.0 {
            return None;
        }
        let at_m = (-half - root.sqrt()) / square;
        let z_m = eye_m.z + at_m * way.z;
        (at_m > 0.0 && (0.0..=self.height_m).contains(&z_m)).then_some(at_m)
    }
}

fn config() -> ExtractionConfig {
    ExtractionConfig {
        view: HALF_VIEW_RAD,
        ..ExtractionConfig::default()
    }
}

/// What one look should find and does.
struct Look {
    /// Of each thing, whether it is in view, whole, near enough and free of others.
    should: Vec<bool>,
    /// Of each thing, where it was found, in the world, m.
    found: Vec<Option<Vector2<f64>>>,
    /// How many were found that are none.
    made_up: usize,
}

fn look(scene: &Scene, robot: &PlanarPose, random: &mut SplitMix64) -> Look {
    let config = config();
    let (points, counts) = scene.picture(robot, random);
    let back = robot.inverse();
    let should = scene
        .things
        .iter()
        .zip(&counts)
        .map(|(thing, &[free, all])| {
            let (x, y) = back.apply(thing.at_m.x, thing.at_m.y);
            let range_m = hypot(x, y);
            let half = libm::asin((thing.radius_m / range_m).min(1.0));
            (REACH_M[0]..REACH_M[1]).contains(&range_m)
                && libm::atan2(y, x).abs() + half < HALF_VIEW_RAD - config.edge
                && all >= 30
                && free == all
        });
    let should: Vec<bool> = should.collect();
    let mut found = vec![None; scene.things.len()];
    let mut made_up = 0;
    for one in standing_things(&points, EYE_M, &config).unwrap() {
        let (x, y) = robot.apply(one.at_m.x, one.at_m.y);
        let at_m = Vector2::new(x, y);
        let is_it = |thing: &Thing| (thing.at_m - at_m).norm() < 0.15 && thing.shape == one.shape;
        match scene.things.iter().position(is_it) {
            Some(index) => found[index] = Some(at_m),
            None => made_up += 1,
        }
    }
    Look {
        should,
        found,
        made_up,
    }
}

#[test]
fn nine_of_ten_rocks_and_trunks_are_found_as_many_are_right_and_two_views_find_the_same() {
    let (mut wanted, mut hits, mut right, mut all) = (0, 0, 0, 0);
    let (mut both, mut same) = (0, 0);
    for seed in 0..10 {
        let mut random = SplitMix64::new(seed);
        let scene = Scene::new(&mut random);
        let looks = [PlanarPose::default(), PlanarPose::new(-0.3, 0.7, -0.2)]
            .map(|robot| look(&scene, &robot, &mut random));
        for one in &looks {
            for (should, found) in one.should.iter().zip(&one.found) {
                wanted += usize::from(*should);
                hits += usize::from(*should && found.is_some());
                right += usize::from(found.is_some());
            }
            all += one.found.iter().flatten().count() + one.made_up;
        }
        for index in 0..scene.things.len() {
            if looks.iter().all(|one| one.should[index]) {
                both += 1;
                let places = looks.each_ref().map(|one| one.found[index]);
                let [Some(first), Some(second)] = places else {
                    continue;
                };
                same += usize::from((first - second).norm() < 0.1);
            }
        }
    }
    let share = |part: usize, whole: usize| part as f64 / whole as f64;
    let told = [share(hits, wanted), share(right, all), share(same, both)];
    assert!(wanted > 50 && both > 15, "{wanted} {both}");
    assert!(
        told.iter().all(|share| *share >= 0.9),
        "recall, precision, repeated: {told:?} of {wanted}, {all}, {both}"
    );
}

#[test]
fn walls_ground_and_what_is_no_number_are_no_landmarks() {
    let wall =
        (0..400).map(|i| Point3::new(3.0, -2.0 + 0.01 * f64::from(i), 0.02 * f64::from(i % 50)));
    let ground = (0..400).map(|i| {
        Point3::new(
            1.0 + 0.01 * f64::from(i % 20),
            0.01 * f64::from(i / 20),
            0.01,
        )
    });
    let none = [Point3::new(f64::NAN, 0.0, 1.0); 30];
    let points: Vec<_> = wall.chain(ground).chain(none).collect();
    assert_eq!(standing_things(&points, EYE_M, &config()).unwrap(), []);
    assert_eq!(standing_things(&[], EYE_M, &config()).unwrap(), []);
}
