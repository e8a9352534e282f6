//! Rooms with people in them, as a laser and as the project's stereo camera see them.
#![allow(
    dead_code,
    clippy::allow_attributes,
    clippy::struct_field_names,
    reason = "each test uses a part of it"
)]

use dynamic_scenes::{PictureShape, RangeView};
use geometry::{Camera, Map, PlanarPose, Pose, SplitMix64};
use plan_view::{PlanarBeam, PlanarScan};

/// A wall from place to place, m.
pub(crate) type Wall = [[f64; 2]; 2];

/// A picture: the view of it, its points with their heights, and which are of people.
pub(crate) type Picture = (RangeView, Vec<([f64; 3], f64)>, Vec<bool>);

/// Somebody: an upright cylinder.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Person {
    pub(crate) at_m: [f64; 2],
    pub(crate) radius_m: f64,
    pub(crate) height_m: f64,
}

impl Person {
    pub(crate) fn at(x_m: f64, y_m: f64) -> Self {
        Self {
            at_m: [x_m, y_m],
            radius_m: 0.15,
            height_m: 1.0,
        }
    }
}

/// The four walls of a rectangle.
pub(crate) fn room(low: [f64; 2], high: [f64; 2]) -> Vec<Wall> {
    let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
    (0..4)
        .map(|at| [corners[at], corners[(at + 1) % 4]])
        .collect()
}

/// How far a ray gets over the ground, m, and whether it ends in a person.
pub(crate) fn range(
    eye_m: [f64; 2],
    bearing_rad: f64,
    walls: &[Wall],
    people: &[Person],
) -> Option<(f64, bool)> {
    let (sin, cos) = libm::sincos(bearing_rad);
    let mut best: Option<(f64, bool)> = None;
    let mut meet = |range_m: f64, person: bool| {
        if range_m > 0.0 && best.is_none_or(|(least, _)| range_m < least) {
            best = Some((range_m, person));
        }
    };
    for [from, to] in walls {
        let way = [to[0] - from[0], to[1] - from[1]];
        let off = [from[0] - eye_m[0], from[1] - eye_m[1]];
        let across = cos * way[1] - sin * way[0];
        if across.abs() > 1e-9 {
            let range_m = (off[0] * way[1] - off[1] * way[0]) / across;
            let share = (off[0] * sin - off[1] * cos) / across;
            if (0.0..=1.0).contains(&share) {
                meet(range_m, false);
            }
        }
    }
    for person in people {
        let off = [person.at_m[0] - eye_m[0], person.at_m[1] - eye_m[1]];
        let along = off[0] * cos + off[1] * sin;
        let aside = off[0] * sin - off[1] * cos;
        let inside = person.radius_m * person.radius_m - aside * aside;
        if inside > 0.0 {
            meet(along - inside.sqrt(), true);
        }
    }
    best
}

/// A scan of a laser with noise, its beams `step_rad` apart within `half_rad` to each side, and which of them end in people.
pub(crate) fn scan(
    pose: [f64; 3],
    [half_rad, step_rad]: [f64; 2],
    (walls, people): (&[Wall], &[Person]),
    (sigma_m, most_m): (f64, f64),
    numbers: &mut SplitMix64,
) -> (PlanarScan, Vec<bool>) {
    let count = (2.0 * half_rad / step_rad) as usize;
    let mut beams = Vec::new();
    let mut of_people = Vec::new();
    for index in 0..count {
        let bearing_rad = (index as f64 + 0.5) * step_rad - half_rad;
        let seen = range([pose[0], pose[1]], pose[2] + bearing_rad, walls, people)
            .filter(|(range_m, _)| *range_m < most_m);
        let [noise] = numbers.normals();
        beams.push(PlanarBeam::new(
            bearing_rad,
            seen.map(|(range_m, _)| range_m + sigma_m * noise),
        ));
        of_people.push(seen.is_some_and(|(_, person)| person));
    }
    let map_from_sensor = PlanarPose::new(pose[0], pose[1], pose[2]);
    (
        PlanarScan {
            map_from_sensor,
            beams,
        },
        of_people,
    )
}

/// The stereo camera of `models/qrio/robot.toml`: its errors, in pixels.
pub(crate) struct Stereo {
    shape: PictureShape,
    scale: f64,
    /// An error for each block of the matching window, of scene and pose.
    fixed: Vec<f64>,
}

const COLS: usize = 88;
const ROWS: usize = 72;
const WINDOW: usize = 5;

impl Stereo {
    pub(crate) fn new() -> Self {
        let focal_px = [
            COLS as f64 / 2.0 / libm::tan(0.8203 / 2.0),
            ROWS as f64 / 2.0 / libm::tan(0.6807 / 2.0),
        ];
        Self {
            shape: PictureShape {
                size_px: [COLS, ROWS],
                focal_px,
                centre_px: [COLS as f64 / 2.0 - 0.5, ROWS as f64 / 2.0 - 0.5],
            },
            scale: focal_px[0] * 0.06,
            fixed: Vec::new(),
        }
    }

    /// The pattern that stays changes as the robot walks: a little of it is new in each frame.
    fn drift(&mut self, numbers: &mut SplitMix64) {
        let blocks = COLS.div_ceil(WINDOW) * ROWS.div_ceil(WINDOW);
        self.fixed.resize(blocks, 0.0);
        for error in &mut self.fixed {
            let [fresh] = numbers.normals();
            *error = 0.95 * *error + 0.1 * libm::sqrt(1.0 - 0.95 * 0.95) * fresh;
        }
    }

    /// A picture from a height of 0.5 m, looking down by 0.2 rad: the view of it, its points with their heights, and which are of people. Walls are 2 m
    /// high.
    pub(crate) fn see(
        &mut self,
        time_s: f64,
        pose: [f64; 3],
        (walls, people): (&[Wall], &[Person]),
        numbers: &mut SplitMix64,
    ) -> Picture {
        let [eye_m, tilt_rad] = [0.5, 0.2];
        let map_from_camera = Pose::<Map, Camera>::wrap(
            nalgebra::Isometry3::translation(pose[0], pose[1], eye_m)
                * nalgebra::UnitQuaternion::from_euler_angles(0.0, tilt_rad, pose[2])
                * nalgebra::UnitQuaternion::from_matrix(&nalgebra::Matrix3::new(
                    0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0,
                )),
        );
        self.drift(numbers);
        let mut depths_m = vec![f32::NAN; COLS * ROWS];
        let (mut points, mut of_people) = (Vec::new(), Vec::new());
        let camera = map_from_camera.inner;
        for row in 0..ROWS {
            for col in 0..COLS {
                let ray = nalgebra::Vector3::new(
                    (col as f64 - self.shape.centre_px[0]) / self.shape.focal_px[0],
                    (row as f64 - self.shape.centre_px[1]) / self.shape.focal_px[1],
                    1.0,
                );
                let way = camera.rotation * ray;
                let over = geometry::hypot(way.x, way.y);
                let bearing_rad = libm::atan2(way.y, way.x);
                // Depth along the axis at which it meets the floor, or what stands.
                let floor = if way.z < 0.0 {
                    -eye_m / way.z
                } else {
                    f64::INFINITY
                };
                let high = |at: f64, top_m: f64| eye_m + at * way.z < top_m;
                let eye = [pose[0], pose[1]];
                let person = range(eye, bearing_rad, &[], people)
                    .map(|(range_m, _)| range_m / over)
                    .filter(|at| high(*at, 1.0));
                let wall = range(eye, bearing_rad, walls, &[])
                    .map(|(range_m, _)| range_m / over)
                    .filter(|at| high(*at, 2.0));
                let stands = person
                    .unwrap_or(f64::INFINITY)
                    .min(wall.unwrap_or(f64::INFINITY));
                let depth = floor.min(stands);
                let block = row / WINDOW * COLS.div_ceil(WINDOW) + col / WINDOW;
                let wrong = self.fixed[block] + 0.05 * numbers.normals::<1>()[0];
                let disparity = ((self.scale / depth + wrong) / 0.125).round() * 0.125;
                let gross = numbers.uniform() < 0.007;
                let disparity = if gross { disparity + 6.0 } else { disparity };
                if !(1.5..24.0).contains(&disparity) {
                    continue;
                }
                let seen = self.scale / disparity;
                depths_m[row * COLS + col] = seen as f32;
                let at = camera * nalgebra::Point3::from(ray * seen);
                points.push(([at.x, at.y, at.z], at.z));
                of_people.push(!gross && person.is_some_and(|at| at <= depth));
            }
        }
        let view = RangeView::of_picture(time_s, &map_from_camera, self.shape, depths_m);
        (view, points, of_people)
    }
}
