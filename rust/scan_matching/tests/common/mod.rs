//! Made-up rooms: walls, what a laser sees of them, and odometry that is off.

#![allow(
    dead_code,
    unreachable_pub,
    clippy::allow_attributes,
    reason = "each test uses a part"
)]

use geometry::{PlanarPose, SplitMix64, wrap_angle};
use plan_view::{PlanarBeam, PlanarScan};

/// A wall from one place to another, m.
pub type Wall = [[f64; 2]; 2];

/// The walls of a closed outline through corners, m.
pub fn outline(corners: &[[f64; 2]]) -> Vec<Wall> {
    (0..corners.len())
        .map(|at| [corners[at], corners[(at + 1) % corners.len()]])
        .collect()
}

/// The walls of a box, m.
pub fn block(low: [f64; 2], high: [f64; 2]) -> Vec<Wall> {
    outline(&[low, [high[0], low[1]], high, [low[0], high[1]]])
}

/// A room of 6 by 5 m with a cupboard, a niche and a pillar: it looks different from everywhere.
pub fn room() -> Vec<Wall> {
    let mut walls = outline(&[
        [-3.0, -2.0],
        [3.0, -2.0],
        [3.0, 1.5],
        [2.2, 1.5],
        [2.2, 3.0],
        [-1.0, 3.0],
        [-1.0, 2.4],
        [-3.0, 2.4],
    ]);
    walls.extend(block([0.9, 0.8], [1.3, 1.1]));
    walls
}

/// Distance to the first wall, m; infinite where there is none.
pub fn range_m(walls: &[Wall], pose: &PlanarPose, bearing_rad: f64) -> f64 {
    let (sin, cos) = libm::sincos(pose.yaw_rad + bearing_rad);
    let each = walls.iter().filter_map(|[from, to]| {
        let along = [to[0] - from[0], to[1] - from[1]];
        let off = [from[0] - pose.x_m, from[1] - pose.y_m];
        let across = cos * along[1] - sin * along[0];
        let range = (off[0] * along[1] - off[1] * along[0]) / across;
        let part = (off[0] * sin - off[1] * cos) / across;
        (range > 0.0 && (0.0..=1.0).contains(&part)).then_some(range)
    });
    each.fold(f64::INFINITY, f64::min)
}

/// A scan of `beams` beams over so much, rad, ranges up to 20 m, with noise of so much, m.
pub fn scan(
    walls: &[Wall],
    pose: &PlanarPose,
    (beams, over_rad): (i32, f64),
    noise_m: f64,
    numbers: &mut SplitMix64,
) -> Vec<PlanarBeam> {
    (0..beams)
        .map(|step| {
            let bearing = over_rad * ((f64::from(step) + 0.5) / f64::from(beams) - 0.5);
            let [off] = numbers.normals::<1>();
            let range = range_m(walls, pose, bearing) + noise_m * off;
            PlanarBeam::new(bearing, Some(range).filter(|range| *range < 20.0))
        })
        .collect()
}

/// Scans along a way, true poses, and the scans placed by odometry with noise: of the way, of itself (rad) and of the turn.
pub fn walk(walls: &[Wall], way: &[PlanarPose], noise: [f64; 3], seed: u64) -> Vec<PlanarScan> {
    let mut numbers = SplitMix64::new(seed);
    let mut here = way[0];
    (0..way.len())
        .map(|at| {
            if at > 0 {
                let step = way[at - 1].relative(&way[at]);
                let far = geometry::hypot(step.x_m, step.y_m);
                let [x, y, turn] = numbers.normals::<3>();
                here = here.compose(&PlanarPose::new(
                    step.x_m + noise[0] * far * x,
                    step.y_m + noise[0] * far * y,
                    step.yaw_rad + (noise[1] + noise[2] * step.yaw_rad.abs()) * turn,
                ));
            }
            PlanarScan {
                map_from_sensor: here,
                beams: scan(
                    walls,
                    &way[at],
                    (180, std::f64::consts::PI),
                    0.01,
                    &mut numbers,
                ),
            }
        })
        .collect()
}

/// A way through corners, m: a pose each `step_m`, and turns of at most 0.3 rad on the spot.
pub fn way(corners: &[[f64; 2]], step_m: f64) -> Vec<PlanarPose> {
    let mut poses: Vec<PlanarPose> = Vec::new();
    for pair in corners.windows(2) {
        let [dx, dy] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let yaw = libm::atan2(dy, dx);
        while let Some(last) = poses.last().copied() {
            let turn = wrap_angle(yaw - last.yaw_rad);
            if turn.abs() < 1e-9 {
                break;
            }
            let yaw_rad = wrap_angle(last.yaw_rad + turn.clamp(-0.3, 0.3));
            poses.push(PlanarPose { yaw_rad, ..last });
        }
        let far = geometry::hypot(dx, dy);
        let steps = libm::round(far / step_m);
        for step in 0..=steps as i32 {
            let share = f64::from(step) / steps;
            let pose = PlanarPose::new(pair[0][0] + share * dx, pair[0][1] + share * dy, yaw);
            if poses
                .last()
                .is_none_or(|last| last.distance_m(&pose) > 1e-9)
            {
                poses.push(pose);
            }
        }
    }
    poses
}

/// How far a pose is from another: m and rad.
pub fn off(one: &PlanarPose, other: &PlanarPose) -> (f64, f64) {
    (
        one.distance_m(other),
        wrap_angle(one.yaw_rad - other.yaw_rad).abs(),
    )
}
