//! The graph of local maps and scans: their poses by least squares (Gauss and Newton, damped).

use geometry::{PlanarPose, wrap_angle};
use nalgebra::{Cholesky, DMatrix, DVector, Matrix3, Vector3};

use crate::config::PoseGraphConfig;

/// Numbers of a pose.
const OF_POSE: usize = 3;
/// Damping to begin with, and where it is given up.
const DAMPED: [f64; 2] = [1e-6, 1e6];

/// A scan that was matched to a local map.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseLink {
    /// Number of the local map.
    pub map: usize,
    /// Number of the scan.
    pub scan: usize,
    /// Where the scan was taken in the local map.
    pub local_from_sensor: PlanarPose,
    /// Inverse covariance of that, in the local map's axes: 1/m², 1/(m rad), 1/rad².
    pub information: Matrix3<f64>,
    /// Whether it closes a loop: such may be wrong, and those that are far off count little.
    pub is_loop: bool,
}

/// Poses of local maps and of scans, and what ties them. The first local map stays where it is.
#[derive(Debug, Clone, Default)]
pub struct PoseGraph {
    /// Local maps in the map of all.
    pub maps: Vec<PlanarPose>,
    /// Scans in the map of all.
    pub scans: Vec<PlanarPose>,
    /// What ties scans to local maps.
    pub links: Vec<PoseLink>,
}

/// A link's residual, and how it changes with the local map's pose and with the scan's.
struct LinearLink {
    off: Vector3<f64>,
    by_map: Matrix3<f64>,
    by_scan: Matrix3<f64>,
}

impl PoseGraph {
    /// How many standard deviations a link is off, squared.
    pub fn squared_distance(&self, link: &PoseLink) -> f64 {
        let off = self.residual(link);
        off.dot(&(link.information * off))
    }

    /// Solves for all poses; how the sum of squares was before and is after.
    pub fn solve(&mut self, config: &PoseGraphConfig) -> [f64; 2] {
        let before = self.cost(config);
        let (mut cost, mut damping) = (before, DAMPED[0]);
        let of_scan = self.links_of_scans();
        for _ in 0..config.iterations {
            let Some([maps, scans]) = self.step(config, damping, &of_scan) else {
                damping *= 10.0;
                if damping > DAMPED[1] {
                    break;
                }
                continue;
            };
            let had = (self.maps.clone(), self.scans.clone());
            apply(&mut self.maps[1..], &maps);
            apply(&mut self.scans, &scans);
            let now = self.cost(config);
            if now > cost {
                (self.maps, self.scans) = had;
                damping *= 10.0;
                if damping > DAMPED[1] {
                    break;
                }
                continue;
            }
            let gained = cost - now;
            cost = now;
            damping = (damping / 10.0).max(DAMPED[0]);
            if gained <= config.least_gain * cost {
                break;
            }
        }
        [before, cost]
    }

    fn links_of_scans(&self) -> Vec<Vec<usize>> {
        let mut of_scan = vec![Vec::new(); self.scans.len()];
        for (number, link) in self.links.iter().enumerate() {
            of_scan[link.scan].push(number);
        }
        of_scan
    }

    fn residual(&self, link: &PoseLink) -> Vector3<f64> {
        let seen = self.maps[link.map].relative(&self.scans[link.scan]);
        let said = link.local_from_sensor;
        Vector3::new(
            seen.x_m - said.x_m,
            seen.y_m - said.y_m,
            wrap_angle(seen.yaw_rad - said.yaw_rad),
        )
    }

    /// Half of the sum of squares; of loops what Cauchy's density makes of them.
    fn cost(&self, config: &PoseGraphConfig) -> f64 {
        let of = |link: &PoseLink| {
            let squared = self.squared_distance(link);
            if link.is_loop {
                let far2 = config.far * config.far;
                far2 * libm::log1p(squared / far2)
            } else {
                squared
            }
        };
        0.5 * self.links.iter().map(of).sum::<f64>()
    }

    fn linear(&self, link: &PoseLink) -> LinearLink {
        let (map, scan) = (&self.maps[link.map], &self.scans[link.scan]);
        let (sin, cos) = libm::sincos(map.yaw_rad);
        let local = map.relative(scan);
        LinearLink {
            off: self.residual(link),
            by_map: Matrix3::new(-cos, -sin, local.y_m, sin, -cos, -local.x_m, 0.0, 0.0, -1.0),
            by_scan: Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0),
        }
    }

    /// A step: what is to be added to the local maps from the second on, and to the scans. Scans are tied to local maps alone, so each is taken
    /// out of the equations by itself (Schur's complement), and what is left is of the few local maps.
    fn step(
        &self,
        config: &PoseGraphConfig,
        damping: f64,
        of_scan: &[Vec<usize>],
    ) -> Option<[Vec<Vector3<f64>>; 2]> {
        let free = self.maps.len() - 1;
        let mut left = Reduced {
            normal: DMatrix::zeros(OF_POSE * free, OF_POSE * free),
            slope: DVector::zeros(OF_POSE * free),
        };
        let taken_out = of_scan
            .iter()
            .map(|links| self.take_out(config, damping, links, &mut left))
            .collect::<Option<Vec<_>>>()?;
        let maps = if free == 0 {
            Vec::new()
        } else {
            let solved = Cholesky::new(left.normal)?.solve(&left.slope);
            let step = |map: usize| -> Vector3<f64> {
                -solved.fixed_rows::<OF_POSE>(OF_POSE * map).into_owned()
            };
            (0..free).map(step).collect()
        };
        let scan = |part: TakenOut| {
            let moved =
                |sum, (map, cross): &(usize, Matrix3<f64>)| sum + cross.transpose() * maps[*map];
            -part.inverse * part.crosses.iter().fold(part.slope, moved)
        };
        let scans = taken_out.into_iter().map(scan).collect();
        Some([maps, scans])
    }

    /// Takes a scan out of the equations, of which it leaves its part for the local maps that it is tied to. None where it is not held.
    fn take_out(
        &self,
        config: &PoseGraphConfig,
        damping: f64,
        links: &[usize],
        left: &mut Reduced,
    ) -> Option<TakenOut> {
        let mut own = Matrix3::zeros();
        let mut slope = Vector3::zeros();
        let mut crosses = Vec::with_capacity(links.len());
        for &number in links {
            let link = &self.links[number];
            let linear = self.linear(link);
            let weight = if link.is_loop {
                let far2 = config.far * config.far;
                1.0 / (1.0 + linear.off.dot(&(link.information * linear.off)) / far2)
            } else {
                1.0
            };
            let of_scan = weight * linear.by_scan.transpose() * link.information;
            own += of_scan * linear.by_scan;
            slope += of_scan * linear.off;
            if let Some(map) = link.map.checked_sub(1) {
                let of_map = weight * linear.by_map.transpose() * link.information;
                left.add(map, map, &damped(of_map * linear.by_map, damping));
                left.pull(map, &(of_map * linear.off));
                crosses.push((map, of_map * linear.by_scan));
            }
        }
        let inverse = damped(own, damping).try_inverse()?;
        for (map, cross) in &crosses {
            let through = -cross * inverse;
            left.pull(*map, &(through * slope));
            for (other, cross) in &crosses {
                left.add(*map, *other, &(through * cross.transpose()));
            }
        }
        Some(TakenOut {
            inverse,
            slope,
            crosses,
        })
    }
}

/// The equations of the local maps from the second on.
struct Reduced {
    normal: DMatrix<f64>,
    slope: DVector<f64>,
}

impl Reduced {
    fn add(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        let (row, column) = (OF_POSE * row, OF_POSE * column);
        let mut part = self.normal.fixed_view_mut::<OF_POSE, OF_POSE>(row, column);
        part += block;
    }

    fn pull(&mut self, row: usize, by: &Vector3<f64>) {
        let mut part = self.slope.fixed_rows_mut::<OF_POSE>(OF_POSE * row);
        part += by;
    }
}

/// What a scan's step follows from, once the local maps' is known.
struct TakenOut {
    inverse: Matrix3<f64>,
    slope: Vector3<f64>,
    crosses: Vec<(usize, Matrix3<f64>)>,
}

fn damped(mut block: Matrix3<f64>, by: f64) -> Matrix3<f64> {
    for axis in 0..OF_POSE {
        block[(axis, axis)] *= 1.0 + by;
    }
    block
}

fn apply(poses: &mut [PlanarPose], steps: &[Vector3<f64>]) {
    for (pose, step) in poses.iter_mut().zip(steps) {
        pose.x_m += step.x;
        pose.y_m += step.y;
        pose.yaw_rad = wrap_angle(pose.yaw_rad + step.z);
    }
}
