//! Where the soles can push, and how a wanted zero moment point is shared between them.

use nalgebra::Vector2;
use robot::{Body, Side};

use crate::phase::FootPose;

/// How the feet carry: what the torques are fed forward for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pressure {
    /// Share of the weight on each foot; sums to 1.
    pub share: [f64; 2],
    /// Point in the plan frame at which each foot pushes, m.
    pub point: [Vector2<f64>; 2],
    /// The zero moment point that results, m.
    pub zmp: Vector2<f64>,
}

/// The soles without their margins.
#[derive(Debug, Clone)]
pub struct Soles {
    margin_m: f64,
    half: [Vector2<f64>; 2],
    /// Middle of the force sensors on each sole, and half of their distances.
    sensors: [[Vector2<f64>; 2]; 2],
}

impl Soles {
    /// The soles of the body, smaller by `margin_m` all around.
    pub fn new(body: &Body, margin_m: f64) -> Self {
        Self {
            margin_m,
            half: Side::BOTH.map(|side| {
                let sole = &body.description().legs.get(side).sole;
                Vector2::new(0.5 * sole.length, 0.5 * sole.width)
            }),
            sensors: sensors(body),
        }
    }

    /// Centre of pressure on a sole, from its middle forward and to the left, m; the sensors' middle where nothing presses.
    pub fn pressed_m(&self, side: Side, forces_n: &[[f64; 4]; 2]) -> Vector2<f64> {
        let forces_n = forces_n[side.index()].map(|force| force.max(0.0));
        let [middle, half] = self.sensors[side.index()];
        let [front_left, front_right, rear_left, rear_right] = forces_n;
        let load_n: f64 = forces_n.iter().sum();
        let forward = front_left + front_right - rear_left - rear_right;
        let left = front_left + rear_left - front_right - rear_right;
        middle + Vector2::new(half.x * forward, half.y * left) / load_n.max(1e-3)
    }

    /// The point of what bears of a standing foot's sole that is nearest to `point`, axis by axis.
    pub fn nearest(&self, foot: &FootPose, side: Side, point: &Vector2<f64>) -> Vector2<f64> {
        let (x, y) = foot.planar.inverse().apply(point.x, point.y);
        let half = &self.half[side.index()];
        let [rear, front] = foot.bearing.on_sole_m(half.x, self.margin_m);
        let across = (half.y - self.margin_m).max(0.0);
        let (x, y) = foot
            .planar
            .apply(x.clamp(rear, front), y.clamp(-across, across));
        Vector2::new(x, y)
    }

    /// The zero moment point `wanted`, as nearly as one foot gives it.
    pub fn on_one(&self, feet: &[FootPose; 2], stance: Side, wanted: &Vector2<f64>) -> Pressure {
        let zmp = self.nearest(&feet[stance.index()], stance, wanted);
        let mut share = [0.0; 2];
        share[stance.index()] = 1.0;
        Pressure {
            share,
            point: Side::BOTH.map(|side| {
                if side == stance {
                    zmp
                } else {
                    center(&feet[side.index()])
                }
            }),
            zmp,
        }
    }

    /// The zero moment point `wanted`, as nearly as both feet give it: shared along the line between them, the rest within each.
    pub fn on_both(
        &self,
        feet: &[FootPose; 2],
        carry: &[Vector2<f64>; 2],
        wanted: &Vector2<f64>,
    ) -> Pressure {
        let line = carry[0] - carry[1];
        let length2 = line.norm_squared().max(1e-9);
        let left = ((wanted - carry[1]).dot(&line) / length2).clamp(0.0, 1.0);
        let rest = wanted - (carry[1] + line * left);
        let point = Side::BOTH.map(|side| {
            let index = side.index();
            self.nearest(&feet[index], side, &(carry[index] + rest))
        });
        Pressure {
            share: [left, 1.0 - left],
            point,
            zmp: point[0] * left + point[1] * (1.0 - left),
        }
    }
}

/// Where the force sensors are on each sole: front left, front right, rear left, rear right, m.
pub(crate) fn sole_corners(body: &Body) -> [[Vector2<f64>; 4]; 2] {
    sensors(body).map(|[middle, half]| {
        let (x, y) = (half.x, half.y);
        [(x, y), (x, -y), (-x, y), (-x, -y)].map(|(x, y)| middle + Vector2::new(x, y))
    })
}

/// Middle of the force sensors on each sole, and half of their distances, m.
fn sensors(body: &Body) -> [[Vector2<f64>; 2]; 2] {
    Side::BOTH.map(|side| {
        let (middle, size) = body.description().legs.get(side).sensors_on_sole_m();
        [Vector2::from(middle), Vector2::from(size) * 0.5]
    })
}

fn center(foot: &FootPose) -> Vector2<f64> {
    Vector2::new(foot.planar.x_m, foot.planar.y_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_biped::biped;
    use geometry::PlanarPose;
    use proptest::prelude::*;

    const MARGIN_M: f64 = 0.006;

    fn feet() -> impl Strategy<Value = [FootPose; 2]> {
        let at = |y: f64| {
            (-0.1..0.1f64, y - 0.02..y + 0.02f64, -0.3..0.3f64).prop_map(|(x, y, yaw)| FootPose {
                planar: PlanarPose::new(x, y, yaw),
                ..FootPose::default()
            })
        };
        (at(0.07), at(-0.07)).prop_map(|(left, right)| [left, right])
    }

    proptest! {
        #[test]
        fn every_point_lies_on_its_sole_and_the_shares_make_a_whole(
            feet in feet(), x in -0.5..0.5f64, y in -0.5..0.5f64,
        ) {
            let soles = Soles::new(&biped(), MARGIN_M);
            let wanted = Vector2::new(x, y);
            let carry = feet.map(|foot| Vector2::new(foot.planar.x_m, foot.planar.y_m));
            for pressure in [
                soles.on_both(&feet, &carry, &wanted),
                soles.on_one(&feet, Side::Left, &wanted),
                soles.on_one(&feet, Side::Right, &wanted),
            ] {
                prop_assert!((pressure.share[0] + pressure.share[1] - 1.0).abs() < 1e-12);
                let mut zmp = Vector2::zeros();
                for (foot, (point, share)) in feet.iter().zip(pressure.point.iter().zip(pressure.share)) {
                    let (x, y) = foot.planar.inverse().apply(point.x, point.y);
                    prop_assert!(x.abs() < 0.0525 - MARGIN_M + 1e-9 && y.abs() < 0.0375 - MARGIN_M + 1e-9);
                    zmp += point * share;
                }
                prop_assert!((zmp - pressure.zmp).norm() < 1e-9);
            }
        }

        #[test]
        fn a_point_between_the_feet_is_given_exactly(feet in feet(), share in 0.0..1.0f64) {
            let soles = Soles::new(&biped(), MARGIN_M);
            let carry = feet.map(|foot| Vector2::new(foot.planar.x_m, foot.planar.y_m));
            let wanted = carry[0] * share + carry[1] * (1.0 - share);
            prop_assert!((soles.on_both(&feet, &carry, &wanted).zmp - wanted).norm() < 1e-9);
        }
    }

    #[test]
    fn the_pressure_is_told_from_where_the_sensors_are() {
        let mut inside = crate::test_biped::description();
        inside.legs.left.sensors = Some(robot::ForceSensors {
            position: [0.01, 0.0, -0.045],
            length: 0.06,
            width: 0.04,
        });
        let soles = Soles::new(&Body::new(inside).unwrap(), MARGIN_M);
        let heel = [[0.0, 0.0, 10.0, 10.0]; 2];
        let [left, right] = Side::BOTH.map(|side| soles.pressed_m(side, &heel));
        assert!(
            (left - Vector2::new(0.01 - 0.03, 0.0)).norm() < 1e-12,
            "{left}"
        );
        assert!(
            (right - Vector2::new(-0.0525, 0.0)).norm() < 1e-12,
            "{right}"
        );
    }
}
