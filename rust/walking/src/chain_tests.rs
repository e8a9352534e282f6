//! Claims about the inverse kinematics of legs in any order, against forward kinematics and against the closed form.

use nalgebra::{Translation3, UnitQuaternion};
use proptest::prelude::*;
use robot::LinkPoses;

use super::*;
use crate::leg::LegSolver;
use crate::test_biped::{biped, description};

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
/// A knee that bends the other way about, a yaw that counts the other way.
const BACK: [f64; 3] = [0.0, -1.0, 0.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

/// A hinge of a left leg: from the one before, m; its axis; its angle in the upright stance and its range, rad.
type Made = ([f64; 3], [f64; 3], f64, [f64; 2]);

/// Pitch, roll, yaw: hips in the order of a full-sized robot of others, ankles with offsets.
const PITCH_FIRST: [Made; 6] = [
    ([0.0, 0.106, -0.115], Y, -0.2, [-1.8, 1.57]),
    ([0.0, 0.0, -0.02], X, 0.0, [-0.3, 1.57]),
    ([0.0, 0.0, -0.082], Z, 0.0, [-1.0, 1.0]),
    ([-0.014, 0.0, -0.134], Y, 0.4, [0.0, 2.34]),
    ([0.0, 0.0, -0.28], Y, -0.2, [-0.87, 0.35]),
    ([0.0, 0.000_25, -0.012], X, 0.0, [-0.44, 0.44]),
];

/// Small, with axes that miss each other by millimetres and count the other way.
const OFFSET: [Made; 6] = [
    ([0.0, 0.018, -0.03], Y, -0.091, [-2.3, 1.8]),
    ([0.019, 0.019, -0.024], X, 0.0, [-0.78, 1.57]),
    ([-0.019, 0.0, -0.033], DOWN, 0.0, [-1.57, 1.57]),
    ([0.0, -0.019, -0.0445], BACK, -0.38, [-2.09, 0.0]),
    ([0.0, 0.0, -0.11], Y, -0.2895, [-1.83, 0.96]),
    ([-0.023, 0.019, 0.0], X, 0.0, [-1.2, 1.2]),
];

/// The axes of a hip tilted and skew.
const TILTED: [Made; 6] = [
    ([0.0, 0.08, -0.1], [0.1, 0.0, 0.995], 0.0, [-0.8, 0.8]),
    ([0.02, 0.0, -0.03], [0.97, 0.2, 0.1], 0.0, [-0.5, 0.5]),
    ([0.0, 0.02, -0.05], [0.05, 0.99, 0.1], -0.3, [-1.8, 1.0]),
    ([0.0, 0.0, -0.2], [0.02, 1.0, 0.0], 0.6, [0.0, 2.3]),
    ([0.0, 0.0, -0.2], [0.0, 1.0, 0.03], -0.3, [-1.2, 0.9]),
    ([0.01, 0.0, -0.02], [1.0, 0.04, 0.0], 0.0, [-0.5, 0.5]),
];

/// No yaw.
const FIVE: [Made; 5] = [
    ([0.0, 0.06, -0.05], X, 0.0, [-0.6, 0.6]),
    ([0.0, 0.0, -0.02], Y, -0.3, [-1.5, 1.0]),
    ([0.0, 0.0, -0.15], Y, 0.6, [0.0, 2.2]),
    ([0.0, 0.0, -0.15], Y, -0.3, [-1.2, 0.9]),
    ([0.0, 0.0, 0.0], X, 0.0, [-0.5, 0.5]),
];

/// Two joints that yaw.
const SEVEN: [Made; 7] = [
    ([0.0, 0.06, -0.05], Z, 0.0, [-0.6, 0.6]),
    ([0.0, 0.0, -0.02], X, 0.0, [-0.6, 0.6]),
    ([0.0, 0.0, 0.0], Y, -0.3, [-1.5, 1.0]),
    ([0.0, 0.0, -0.08], Z, 0.0, [-0.6, 0.6]),
    ([0.0, 0.0, -0.07], Y, 0.6, [0.0, 2.2]),
    ([0.0, 0.0, -0.15], Y, -0.3, [-1.2, 0.9]),
    ([0.0, 0.0, 0.0], X, 0.0, [-0.5, 0.5]),
];

/// The biped with these legs, the right one the left one's mirror image.
fn with_legs(made: &[Made]) -> Body {
    let mut body = description();
    let template = body.links[1].clone();
    let head: Vec<_> = (body.links.iter())
        .filter(|link| !link.name.contains("left") && !link.name.contains("right"))
        .cloned()
        .collect();
    body.links = vec![head[0].clone()];
    body.joints.clear();
    body.stand.clear();
    for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
        let mut names = Vec::new();
        for (slot, &([x, y, z], [a, b, c], rest_rad, [low, high])) in made.iter().enumerate() {
            let mut link = template.clone();
            link.name = format!("{side:?}_{slot}");
            link.parent = Some(if slot == 0 { 0 } else { body.links.len() - 1 });
            link.position = [x, sign * y, z];
            let joint = link.joint.as_mut().unwrap();
            joint.name.clone_from(&link.name);
            // A mirror image turns about y as the original; about x and z the other way, or about the mirrored axis.
            (joint.axis, joint.range) = ([a, b * sign, c], [low, high]);
            let mut stand_rad = rest_rad;
            if sign < 0.0 {
                (joint.range, stand_rad) = ([-high, -low], -rest_rad);
            }
            body.joints.push(link.name.clone());
            body.stand.push(stand_rad);
            names.push(link.name.clone());
            body.links.push(link);
        }
        let leg = match side {
            Side::Left => &mut body.legs.left,
            Side::Right => &mut body.legs.right,
        };
        leg.sole.link.clone_from(names.last().unwrap());
        leg.joints = names;
    }
    for link in &head[1..] {
        let mut link = link.clone();
        link.parent = Some(0);
        if let Some(joint) = &link.joint {
            body.joints.push(joint.name.clone());
            body.stand.push(0.0);
        }
        body.links.push(link);
    }
    (body.arms_rest, body.arms_raised) = Default::default();
    Body::new(body).unwrap()
}

fn sole_at(body: &Body, side: Side, angles: &[f64]) -> Isometry3<f64> {
    let mut all = body.description().stand.clone();
    for (&joint, &angle) in body.leg_joints(side).iter().zip(angles) {
        all[joint] = angle;
    }
    let mut poses = LinkPoses::default();
    body.pose_links(&all, &mut poses).unwrap();
    body.torso_from_sole(&poses, side)
}

fn leg(body: &Body, side: Side) -> LegSolver {
    let leg = LegSolver::new(body, side, 0.99, &LegTuning::default()).unwrap();
    assert!(leg.not_closed().is_some());
    leg
}

/// A sole that a leg reaches: where it is at some angles within the ranges, the knee bent.
fn some_sole(body: &Body, side: Side, shares: &[f64]) -> Isometry3<f64> {
    let joints = body.leg_joints(side);
    let mut angles = Vec::new();
    for (&joint, share) in joints.iter().zip(shares) {
        let [low, high] = body.hinge(joint).unwrap().1.range;
        let rest = body.description().stand[joint];
        let to = if *share < 0.0 { low } else { high };
        angles.push(rest + (to - rest) * share.abs());
    }
    sole_at(body, side, &angles)
}

/// How far a leg's angles put the sole from where it should be: m, and rad.
fn off(body: &Body, side: Side, found: &LegAngles, wanted: &Isometry3<f64>) -> (f64, f64) {
    let apart = wanted.inverse() * sole_at(body, side, &found.angles_rad);
    (apart.translation.vector.norm(), apart.rotation.angle())
}

fn some_shares() -> impl Strategy<Value = [f64; 7]> {
    prop::array::uniform7(-0.45..0.45f64)
}

proptest! {
    #[test]
    fn legs_in_any_order_put_the_sole_where_it_should_be(shares in some_shares(), kind in 0..4usize, left in any::<bool>()) {
        let side = if left { Side::Left } else { Side::Right };
        let body = match kind {
            0 => with_legs(&PITCH_FIRST),
            1 => with_legs(&OFFSET),
            2 => with_legs(&TILTED),
            _ => with_legs(&SEVEN),
        };
        let leg = leg(&body, side);
        let wanted = some_sole(&body, side, &shares);
        let found = leg.solve(&wanted, leg.rest_rad());
        // The knee may not be straighter than its setting allows.
        let straight = wanted.translation.vector - leg.hip();
        prop_assume!(found.reached || straight.norm() < 0.9 * (leg.max_length_m + leg.ankle_height_m()));
        let (off_m, off_rad) = off(&body, side, &found, &wanted);
        prop_assert!(found.reached, "{found:?}");
        prop_assert!(off_m < 1e-5 && off_rad < 1e-4, "{off_m} m, {off_rad} rad");
    }

    #[test]
    fn with_five_joints_place_and_level_are_right_and_the_heading_is_free(
        x in -0.05..0.05f64, y in -0.02..0.03f64, z in -0.30..-0.26f64, yaw in -0.3..0.3f64,
    ) {
        let body = with_legs(&FIVE);
        let leg = leg(&body, Side::Left);
        prop_assert_eq!(leg.left_open(), Some("yaw"));
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
        let wanted = Isometry3::from_parts(Translation3::new(x, 0.06 + y, z - 0.05), turn);
        let found = leg.solve(&wanted, leg.rest_rad());
        prop_assert!(found.reached, "{found:?}");
        let sole = sole_at(&body, Side::Left, &found.angles_rad);
        prop_assert!((sole.translation.vector - wanted.translation.vector).norm() < 1e-5);
        prop_assert!((sole.rotation * Vector3::z()).angle(&Vector3::z()) < 1e-4);
    }

    #[test]
    fn whatever_is_asked_for_the_angles_are_finite_and_within_their_ranges(
        xyz in prop::array::uniform3(-0.8..0.8f64), turn in prop::array::uniform3(-3.0..3.0f64), kind in 0..4usize,
    ) {
        let body = match kind {
            0 => with_legs(&PITCH_FIRST),
            1 => with_legs(&OFFSET),
            2 => with_legs(&FIVE),
            _ => with_legs(&SEVEN),
        };
        let leg = leg(&body, Side::Right);
        let rotation = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
        let found = leg.solve(&Isometry3::from_parts(Translation3::from(xyz), rotation), leg.rest_rad());
        for (&joint, angle) in leg.joints().iter().zip(&found.angles_rad) {
            let [low, high] = body.hinge(joint).unwrap().1.range;
            prop_assert!(*angle >= low && *angle <= high, "{found:?}");
        }
        prop_assert!(found.short_m.is_finite());
    }

    #[test]
    fn where_the_closed_form_holds_the_chain_finds_the_same(
        x in -0.06..0.06f64, y in -0.02..0.03f64, z in -0.23..-0.17f64, turn in prop::array::uniform3(-0.25..0.25f64),
    ) {
        let body = biped();
        let tuning = LegTuning::default();
        let closed = LegSolver::new(&body, Side::Left, 0.985, &tuning).unwrap();
        prop_assert!(closed.not_closed().is_none());
        let (chain, sizes) = LegChain::read(&body, Side::Left, 0.985, &tuning).unwrap();
        prop_assert!((sizes.hip - closed.hip()).norm() < 1e-6);
        prop_assert!((chain.longest_m() - closed.max_length_m).abs() < 1e-6);
        let rotation = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
        let wanted = Isometry3::from_parts(Translation3::new(x, 0.0425 + y, z), rotation);
        let (a, b) = (closed.solve(&wanted, closed.rest_rad()), chain.solve(&wanted, closed.rest_rad()));
        prop_assert_eq!(a.reached, b.reached);
        prop_assert!((a.short_m - b.short_m).abs() < 1e-6);
        for (a, b) in a.angles_rad.iter().zip(&b.angles_rad) {
            prop_assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
    }
}

#[test]
fn what_is_too_far_is_approached_as_far_as_the_leg_is_long() {
    let body = with_legs(&PITCH_FIRST);
    let leg = leg(&body, Side::Left);
    let far = Isometry3::translation(0.0, 0.106, -0.85);
    let found = leg.solve(&far, leg.rest_rad());
    assert!(
        !found.reached && (0.1..0.3).contains(&found.short_m),
        "{found:?}"
    );
    let sole = sole_at(&body, Side::Left, &found.angles_rad);
    assert!((sole.translation.vector.z - far.translation.vector.z - found.short_m).abs() < 2e-3);
}

#[test]
fn where_the_ankle_bends_no_further_it_gets_where_it_should_and_the_sole_tilts() {
    let body = with_legs(&PITCH_FIRST);
    let leg = leg(&body, Side::Left);
    let ahead = Isometry3::translation(leg.hip().x + 0.3, 0.106, -0.58);
    let found = leg.solve(&ahead, leg.rest_rad());
    assert!(!found.reached && found.short_m < 2e-3, "{found:?}");
    assert_eq!(found.angles_rad[4], PITCH_FIRST[4].3[1]);
    let sole = sole_at(&body, Side::Left, &found.angles_rad);
    let ankle = leg_ankle(&leg);
    assert!((sole * ankle - ahead * ankle).norm() < 2e-3, "{sole}");
}

fn leg_ankle(leg: &LegSolver) -> nalgebra::Point3<f64> {
    let over = leg.ankle_in_plan(&geometry::PlanarPose::default());
    nalgebra::Point3::new(over.x, over.y, leg.ankle_height_m())
}

#[test]
fn joints_that_are_no_chain_are_refused_by_name() {
    let mut mixed = description();
    mixed.legs.left.joints.swap(1, 4);
    let error = LegSolver::new(
        &Body::new(mixed).unwrap(),
        Side::Left,
        0.985,
        &LegTuning::default(),
    )
    .unwrap_err()
    .to_string();
    assert!(error.contains("chain from the hip down"), "{error}");
}

#[test]
fn an_ankle_that_only_pitches_leaves_the_soles_roll_open() {
    let made = [SEVEN[0], SEVEN[1], SEVEN[2], SEVEN[4], SEVEN[5]];
    assert_eq!(leg(&with_legs(&made), Side::Left).left_open(), Some("roll"));
}
