//! What the joints of a leg do, found by geometry: which is the knee, where hip and ankle are, and which turn of the sole five joints
//! leave open. Nothing here asks in which order the joints are, or how they are called.

use nalgebra::{Isometry3, Matrix3, Point3, SMatrix, Vector3};
use robot::{Body, LinkPoses, MOST_LEG_JOINTS, Side};

use crate::error::WalkError;
use crate::leg_sizes::LegSizes;

/// How far a joint is bent to see whether it is the knee, rad.
const BENT_RAD: f64 = 0.5;
/// Weight of the middle of the knee's range against the stance in telling which way it bends.
const STRAIGHT: f64 = 0.1;
/// Weight of a place that is likely, where the axes leave a direction open.
const LIKELY: f64 = 1e-6;

/// A hinge in the torso's frame, at some angles: the unit vector along its axis, and a point of that, m.
pub(crate) type HingeAxis = (Vector3<f64>, Vector3<f64>);

/// A hinge of a chain, in the torso's frame at joint angles zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LegHinge {
    /// Unit vector along its axis.
    pub(crate) axis: Vector3<f64>,
    /// A point of it, m.
    pub(crate) anchor: Vector3<f64>,
    /// Smallest and largest angle, rad.
    pub(crate) range_rad: [f64; 2],
}

impl LegHinge {
    /// What it turns, turned by an angle.
    pub(crate) fn turned(&self, angle_rad: f64) -> Isometry3<f64> {
        let (sin, cos) = libm::sincos(0.5 * angle_rad);
        let turn = nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::from_parts(
            cos,
            self.axis * sin,
        ));
        let shift = self.anchor - turn * self.anchor;
        Isometry3::from_parts(shift.into(), turn)
    }

    /// The point of the axis that is nearest to `point`.
    fn nearest(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.anchor + self.axis * self.axis.dot(&(point - self.anchor))
    }
}

/// The hinges of a leg, and the sole behind them at joint angles zero; all other joints as in the upright stance.
#[derive(Debug, Clone)]
pub(crate) struct LegHinges {
    all: [LegHinge; MOST_LEG_JOINTS],
    count: usize,
    torso_from_sole_at_zero: Isometry3<f64>,
}

impl LegHinges {
    /// Reads them; fails where the joints are no chain that ends at the sole.
    pub(crate) fn read(body: &Body, side: Side) -> Result<Self, WalkError> {
        let refuse = |what: String| WalkError::Leg { side, what };
        let joints = body.leg_joints(side);
        let mut angles_rad = body.description().stand.clone();
        for &joint in joints {
            angles_rad[joint] = 0.0;
        }
        let mut poses = LinkPoses::default();
        body.pose_links(&angles_rad, &mut poses)?;
        let mut above = above(body, body.sole_link(side));
        let unused = LegHinge {
            axis: Vector3::z(),
            anchor: Vector3::zeros(),
            range_rad: [0.0; 2],
        };
        let mut all = [unused; MOST_LEG_JOINTS];
        for (slot, &joint) in joints.iter().enumerate().rev() {
            let (link, hinge) = body
                .hinge(joint)
                .ok_or_else(|| refuse(format!("its joint {} turns no link", slot + 1)))?;
            if !above.any(|at| at == link) {
                let behind = joints.get(slot + 1).and_then(|&next| body.hinge(next));
                let behind = behind.map_or("the sole".to_owned(), |(_, next)| {
                    format!("`{}`", next.name)
                });
                return Err(refuse(format!(
                    "`{}` does not carry {behind}: its joints must be a chain from the hip down",
                    hinge.name
                )));
            }
            let pose = &poses.torso_from_link[link];
            all[slot] = LegHinge {
                axis: pose.rotation * Vector3::from(hinge.axis).normalize(),
                anchor: (pose * Point3::from(hinge.anchor)).coords,
                range_rad: hinge.range,
            };
        }
        Ok(Self {
            all,
            count: joints.len(),
            torso_from_sole_at_zero: body.torso_from_sole(&poses, side),
        })
    }

    /// The hinges, from the hip down.
    pub(crate) fn all(&self) -> &[LegHinge] {
        &self.all[..self.count]
    }

    /// Leaves of a hinge's range what lies between two angles, if anything does.
    pub(crate) fn narrow(&mut self, slot: usize, [least, most]: [f64; 2]) {
        let [low, high] = &mut self.all[slot].range_rad;
        if least.max(*low) < most.min(*high) {
            (*low, *high) = (least.max(*low), most.min(*high));
        }
    }

    /// Each hinge's axis and anchor in the torso at these angles, and the sole's pose.
    pub(crate) fn posed(
        &self,
        angles_rad: &[f64; MOST_LEG_JOINTS],
    ) -> ([HingeAxis; MOST_LEG_JOINTS], Isometry3<f64>) {
        let mut posed = [(Vector3::zeros(), Vector3::zeros()); MOST_LEG_JOINTS];
        let mut turned = Isometry3::identity();
        for (slot, hinge) in self.all().iter().enumerate() {
            posed[slot] = (
                turned.rotation * hinge.axis,
                turned.rotation * hinge.anchor + turned.translation.vector,
            );
            turned *= hinge.turned(angles_rad[slot]);
        }
        (posed, turned * self.torso_from_sole_at_zero)
    }
}

/// A link and those that carry it, one after the other.
fn above(body: &Body, link: usize) -> impl Iterator<Item = usize> {
    let links = &body.description().links;
    std::iter::successors(Some(link), move |&at| links[at].parent)
}

/// What the joints of a leg do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LegAnatomy {
    /// The joint that bends the leg.
    pub(crate) knee: usize,
    /// The knee's angle at which the leg is straight, rad.
    straight_rad: f64,
    /// Which way the knee bends: to greater angles (1) or to smaller ones (-1).
    bends: f64,
    /// Where its parts are.
    pub(crate) sizes: LegSizes,
    /// Longest distance from hip to ankle that the knee's range allows, m.
    pub(crate) longest_m: f64,
    /// The axis of the sole about which five joints cannot turn it on its own: 0 for x, 1 for y, 2 for z.
    pub(crate) left_open: Option<usize>,
}

impl LegAnatomy {
    /// Looks at the hinges in the upright stance.
    pub(crate) fn read(hinges: &LegHinges, rest_rad: &[f64; MOST_LEG_JOINTS]) -> Option<Self> {
        let count = hinges.all().len();
        let knee = knee(hinges, rest_rad)?;
        let (posed, sole) = hinges.posed(rest_rad);
        let at = |slot: usize| LegHinge {
            axis: posed[slot].0,
            anchor: posed[slot].1,
            ..hinges.all()[slot]
        };
        let likely = at(0).nearest(&at(1).anchor);
        let hip = meeting((0..knee).map(at), &likely)?;
        let likely = at(knee + 1).nearest(&sole.translation.vector);
        let ankle = meeting((knee + 1..count).map(at), &likely)?;
        let bend = at(knee);
        let from_axis = |point: &Vector3<f64>| (point - bend.nearest(point)).norm();
        let (thigh_m, shank_m) = (from_axis(&hip), from_axis(&ankle));
        let along_m = bend.axis.dot(&(ankle - hip));
        let straight_m = geometry::hypot(thigh_m + shank_m, along_m);
        // The angle at which the knee lies between both, from where it is now.
        let arm = |point: &Vector3<f64>| point - bend.nearest(point);
        let (up, down) = (-arm(&hip), arm(&ankle));
        let straight_rad =
            rest_rad[knee] - libm::atan2(up.cross(&down).dot(&bend.axis), up.dot(&down));
        let [low, high] = bend.range_rad;
        let over_rad = (straight_rad.clamp(low, high) - straight_rad).abs();
        let within_m = (thigh_m * thigh_m
            + shank_m * shank_m
            + 2.0 * thigh_m * shank_m * libm::cos(over_rad)
            + along_m * along_m)
            .sqrt();
        // It bends the way that the stance bends it, or, where that is straight, the way that it can.
        let bends =
            (rest_rad[knee] - straight_rad) + STRAIGHT * (0.5 * (low + high) - straight_rad);
        Some(Self {
            knee,
            straight_rad,
            bends: bends.signum(),
            sizes: LegSizes {
                hip,
                thigh_m,
                shank_m,
                ankle_in_sole: sole.inverse() * Point3::from(ankle) - Point3::origin(),
            },
            longest_m: straight_m.min(within_m),
            left_open: (count < 6).then(|| left_open(hinges, rest_rad, thigh_m + shank_m)),
        })
    }
}

impl LegAnatomy {
    /// The knee's angles between which hip and ankle are so far apart, rad.
    pub(crate) fn bent_between(&self, shortest_m: f64, longest_m: f64) -> [f64; 2] {
        let (a, b) = (self.sizes.thigh_m, self.sizes.shank_m);
        let bent_rad = |length_m: f64| {
            libm::acos(((length_m * length_m - a * a - b * b) / (2.0 * a * b)).clamp(-1.0, 1.0))
        };
        let ends = [longest_m, shortest_m].map(|m| self.straight_rad + self.bends * bent_rad(m));
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }
}

/// The joint that, when it is bent, brings the sole nearest to the hip.
fn knee(hinges: &LegHinges, rest_rad: &[f64; MOST_LEG_JOINTS]) -> Option<usize> {
    let all = hinges.all();
    let hip = all.first()?.nearest(&all.get(1)?.anchor);
    let nearest_m = |slot: usize| {
        [-BENT_RAD, BENT_RAD]
            .map(|bent_rad| {
                let mut angles_rad = *rest_rad;
                angles_rad[slot] += bent_rad;
                let (_, sole) = hinges.posed(&angles_rad);
                (sole.translation.vector - hip).norm()
            })
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    };
    // A knee has something above it and something below it.
    (1..all.len() - 1).min_by(|&a, &b| nearest_m(a).total_cmp(&nearest_m(b)))
}

/// Where axes meet or, if they do not, come nearest to each other; as near to `likely` as they leave it open.
fn meeting(axes: impl Iterator<Item = LegHinge>, likely: &Vector3<f64>) -> Option<Vector3<f64>> {
    let mut across = Matrix3::identity() * LIKELY;
    let mut sum = likely * LIKELY;
    for hinge in axes {
        let off = Matrix3::identity() - hinge.axis * hinge.axis.transpose();
        across += off;
        sum += off * hinge.anchor;
    }
    across.cholesky().map(|factors| factors.solve(&sum))
}

/// The axis of the sole about which it can least be turned while it stays where it is.
fn left_open(hinges: &LegHinges, rest_rad: &[f64; MOST_LEG_JOINTS], leg_m: f64) -> usize {
    let (posed, sole) = hinges.posed(rest_rad);
    let back = sole.rotation.inverse();
    let mut moves = SMatrix::<f64, 6, MOST_LEG_JOINTS>::zeros();
    for (slot, (axis, anchor)) in posed.iter().take(hinges.all().len()).enumerate() {
        let shift = axis.cross(&(sole.translation.vector - anchor));
        moves
            .fixed_view_mut::<3, 1>(0, slot)
            .copy_from(&(back * shift / leg_m));
        moves
            .fixed_view_mut::<3, 1>(3, slot)
            .copy_from(&(back * axis));
    }
    let parts = (moves * moves.transpose()).symmetric_eigen();
    let least = parts.eigenvalues.imin();
    parts
        .eigenvectors
        .fixed_view::<3, 1>(3, least)
        .iamax_full()
        .0
}
