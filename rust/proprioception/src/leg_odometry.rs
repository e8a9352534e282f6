//! Where the robot has walked to: forward kinematics from the feet that hold, turned by the attitude.
//!
//! A foot that takes hold is anchored where it then is. The torso is where the anchors and the legs say, blended by load.
//! Heights are kept apart: an anchor's height is that of its level, so that small errors of tilt do not climb.

use geometry::{Odometry, Pose, Robot, angle_between};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use robot::Side;

use crate::{config::ProprioceptionConfig, contact::FootContacts};

/// The legs as they are now.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LegPosture {
    /// Orientation of the torso.
    pub(crate) odometry_from_torso_rotation: UnitQuaternion<f64>,
    /// Pose of each sole in the torso, left and right.
    pub(crate) torso_from_sole: [Isometry3<f64>; 2],
    /// Half of a sole's length, m.
    pub(crate) half_sole_m: f64,
}

impl LegPosture {
    /// From the torso's origin to the centre of the sole, in the odometry frame's axes, m.
    fn reach_m(&self, side: Side) -> Vector3<f64> {
        self.odometry_from_torso_rotation * self.torso_from_sole[side.index()].translation.vector
    }

    /// How much a sole rises from heel to toes, per metre of it.
    fn toes_up(&self, side: Side) -> f64 {
        let sole = self.torso_from_sole[side.index()].rotation;
        (self.odometry_from_torso_rotation * (sole * Vector3::x())).z
    }

    /// How high the middle of a sole is over its front edge, m, where its heel is lifted: its toes point down by more than `limit_rad`
    /// against how it lay, `toes_up`, as it carried alone. Another sole tells nothing of it: on a bevel no two lie alike.
    fn lifted_m(&self, side: Side, toes_up: f64, limit_rad: f64) -> f64 {
        let down = toes_up - self.toes_up(side);
        if down > libm::sin(limit_rad) {
            self.half_sole_m * down
        } else {
            0.0
        }
    }

    /// How far one sole is above the other along the torso's axis, m: whatever the attitude is believed to be.
    pub(crate) fn sole_above_other_m(&self) -> f64 {
        let [left, right] = self
            .torso_from_sole
            .map(|torso_from_sole| torso_from_sole.translation.vector.z);
        (left - right).abs()
    }

    /// Mean heading of the feet, rad.
    pub(crate) fn heading_rad(&self) -> f64 {
        let [left, right] = self.torso_from_sole.map(|torso_from_sole| {
            let toes =
                self.odometry_from_torso_rotation * (torso_from_sole.rotation * Vector3::x());
            libm::atan2(toes.y, toes.x)
        });
        left + 0.5 * angle_between(left, right)
    }
}

/// Torso position by leg odometry.
#[derive(Debug, Clone)]
pub(crate) struct LegOdometry {
    anchors_m: [Option<Vector3<f64>>; 2],
    /// The level on which each foot stood last, m.
    before_m: [Option<f64>; 2],
    /// Whether each foot stands on a level that was measured as it landed, and on no known one.
    is_new: [bool; 2],
    /// How each sole lay, from heel to toes, as it carried alone last, or took hold since.
    toes_up: [f64; 2],
    /// The torso's origin in the odometry frame, m.
    pub(crate) torso_m: Vector3<f64>,
    /// Feet that stand, or are to land, on a slope.
    pub(crate) on_slope: [bool; 2],
}

impl LegOdometry {
    pub(crate) const fn new() -> Self {
        Self {
            anchors_m: [None; 2],
            before_m: [None; 2],
            is_new: [false; 2],
            toes_up: [0.0; 2],
            torso_m: Vector3::new(0.0, 0.0, 0.0),
            on_slope: [false; 2],
        }
    }

    /// Whether both feet hold, on one level.
    pub(crate) fn stands_level(&self, config: &ProprioceptionConfig) -> bool {
        let [left, right] = self.anchors_m;
        left.zip(right)
            .is_some_and(|(left, right)| (left.z - right.z).abs() < config.level_band)
    }

    /// Puts the point midway between the soles at the origin, both on one level.
    pub(crate) fn start(&mut self, legs: &LegPosture) {
        let reaches = Side::BOTH.map(|side| legs.reach_m(side));
        self.torso_m = -(reaches[0] + reaches[1]) / 2.0;
        self.anchors_m = reaches.map(|reach| {
            let sole = self.torso_m + reach;
            Some(Vector3::new(sole.x, sole.y, 0.0))
        });
        self.toes_up = Side::BOTH.map(|side| legs.toes_up(side));
    }

    /// Takes in the legs and what they carry; returns the robot's frame.
    pub(crate) fn update(
        &mut self,
        legs: &LegPosture,
        contacts: &FootContacts,
        config: &ProprioceptionConfig,
    ) -> Pose<Odometry, Robot> {
        let level_m = self.place_torso(legs, contacts.weights(config));
        self.renew_anchors(legs, contacts, config);
        let middle = self.torso_m + (legs.reach_m(Side::Left) + legs.reach_m(Side::Right)) / 2.0;
        Pose::from_yaw(middle.x, middle.y, level_m, legs.heading_rad())
    }

    /// Puts the torso where the anchored feet say, and returns the height of the surface that carries them. A foot that
    /// takes hold at this tick has no anchor yet: it is anchored beside a torso that has moved on with the others.
    fn place_torso(&mut self, legs: &LegPosture, weights: [f64; 2]) -> f64 {
        let (mut torso, mut level_m, mut sum) = (Vector3::zeros(), 0.0, 0.0);
        let anchored = |side: Side| self.anchors_m[side.index()].is_some();
        let counted: f64 = Side::BOTH
            .into_iter()
            .filter(|&side| anchored(side))
            .map(|side| weights[side.index()])
            .sum();
        for side in Side::BOTH {
            let Some(anchor) = self.anchors_m[side.index()] else {
                continue;
            };
            // Where the load is on a foot without an anchor, the other one has just let go: it still tells the way.
            let weight = if counted > 0.0 {
                weights[side.index()]
            } else {
                1.0
            };
            torso += (anchor - legs.reach_m(side)) * weight;
            level_m += anchor.z * weight;
            sum += weight;
        }
        if sum > 0.0 {
            self.torso_m = torso / sum;
            level_m /= sum;
        }
        level_m
    }

    fn renew_anchors(
        &mut self,
        legs: &LegPosture,
        contacts: &FootContacts,
        config: &ProprioceptionConfig,
    ) {
        // What two anchors differ by on level ground is the error of a tilt.
        let level = self.on_slope == [false; 2];
        let are_same = |a_m: f64, b_m: f64| (a_m - b_m).abs() < config.level_band && level;
        for side in Side::BOTH {
            if contacts.holds(side) && !contacts.holds(side.other()) {
                self.toes_up[side.index()] = legs.toes_up(side);
            }
            let other = self.anchors_m[side.other().index()];
            let anchor = &mut self.anchors_m[side.index()];
            if contacts.holds(side) {
                if anchor.is_none() {
                    let mut landed = self.torso_m + legs.reach_m(side);
                    // Who steps onto something as high as the band and down again would rise by it each time, were it not for the
                    // level from which the foot came.
                    let before_m = self.before_m[side.index()];
                    let levels_m = [other.map(|other| other.z), before_m].into_iter().flatten();
                    let near_m = levels_m.filter(|&level_m| are_same(level_m, landed.z));
                    let away_m = |level_m: f64| (level_m - landed.z).abs();
                    let nearest_m = near_m.min_by(|&a, &b| away_m(a).total_cmp(&away_m(b)));
                    let known_m = nearest_m.filter(|_| other.is_some());
                    landed.z = known_m.unwrap_or(landed.z);
                    self.is_new[side.index()] = known_m.is_none();
                    *anchor = Some(landed);
                    self.toes_up[side.index()] = legs.toes_up(side);
                }
            } else if let Some(other) = other.filter(|_| contacts.holds(side.other()))
                && let Some(own) = anchor.take()
            {
                self.before_m[side.index()] = Some(own.z);
                if !are_same(own.z, other.z) && self.is_new[side.other().index()] {
                    self.measure_level_again(legs, side, own.z, other.z, config.level_limit);
                }
            }
        }
    }

    /// As the foot `side` lets go of its level, that of the other foot is measured once more. When it landed, the load was on the
    /// first one, and a leg that carries is a little shorter than its encoders say: the mean of both is right.
    fn measure_level_again(
        &mut self,
        legs: &LegPosture,
        side: Side,
        own_m: f64,
        other_m: f64,
        limit_rad: f64,
    ) {
        let lifted_m = legs.lifted_m(side, self.toes_up[side.index()], limit_rad);
        let again_m = own_m + legs.reach_m(side.other()).z - legs.reach_m(side).z + lifted_m;
        if let Some(anchor) = &mut self.anchors_m[side.other().index()] {
            anchor.z = f64::midpoint(other_m, again_m);
        }
    }
}

/// Speed and acceleration of the torso by leg odometry.
#[derive(Debug, Clone, Default)]
pub(crate) struct TrunkMotion {
    torso_m: Option<Vector3<f64>>,
    velocity_mps: Vector3<f64>,
    /// Change of the smoothed speed, m/s^2, odometry frame.
    pub(crate) acceleration_mps2: Vector3<f64>,
}

impl TrunkMotion {
    /// Takes in where the torso is, its speed smoothed over a time. While the robot is being put where it starts, it does not move.
    pub(crate) fn follow(
        &mut self,
        torso_m: &Vector3<f64>,
        passed_s: f64,
        filter_s: f64,
        starting: bool,
    ) {
        let before_m = self.torso_m.replace(*torso_m);
        let (Some(before_m), true) = (before_m, passed_s > 0.0 && !starting) else {
            (self.velocity_mps, self.acceleration_mps2) = (Vector3::zeros(), Vector3::zeros());
            return;
        };
        let measured = (torso_m - before_m) / passed_s;
        let share = passed_s / (passed_s + filter_s);
        let change = (measured - self.velocity_mps) * share;
        self.velocity_mps += change;
        self.acceleration_mps2 = change / passed_s;
    }
}

/// The torso's pose from its orientation and position.
pub(crate) fn odometry_from_torso(
    rotation: UnitQuaternion<f64>,
    torso_m: Vector3<f64>,
) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(torso_m), rotation)
}

#[cfg(test)]
#[path = "leg_odometry_tests.rs"]
mod tests;
