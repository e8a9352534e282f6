//! What the walker promises on slopes that it is told of, in a world where joints follow their targets at once.

use behaviour::{Footstep, Motion, Velocity};

use super::*;
use crate::phase::FootPose;
use crate::relief::Slopes;
use crate::test_biped::Ideal;
use crate::walker::Walker;

const BEGINS_M: f64 = 0.2;
const RISE: f64 = 0.17;

/// Ground that rises by 10 degrees from a line across the way on.
#[derive(Debug)]
struct Ahead;

impl Slopes for Ahead {
    fn gradient(&self, x_m: f64, _y_m: f64) -> Vector2<f64> {
        Vector2::new(if x_m > BEGINS_M { RISE } else { 0.0 }, 0.0)
    }
}

fn height_m(x_m: f64) -> f64 {
    RISE * (x_m - BEGINS_M).max(0.0)
}

/// After 8 s straight ahead; the walker's robot frame goes along, so that the slope is given in the plan.
fn walked(told: bool) -> (Ideal, [FootPose; 2]) {
    let mut world = Ideal::new();
    let ahead = Command {
        motion: Motion::Walk(Velocity {
            x_mps: 0.1,
            y_mps: 0.0,
            yaw_radps: 0.0,
        }),
        ..Command::default()
    };
    for _ in 0..800 {
        world.slopes = told.then(|| FromPlan::at(&world.walker));
        world.tick(&ahead);
    }
    for _ in 0..300 {
        world.slopes = told.then(|| FromPlan::at(&world.walker));
        world.tick(&Command::default());
    }
    let feet = Side::BOTH.map(|side| *world.walker.foot_in_plan(side));
    (world, feet)
}

/// The slope as seen by a robot that is somewhere in the plan.
#[derive(Debug)]
struct FromPlan {
    x_m: f64,
}

impl FromPlan {
    fn at(walker: &DcmWalker) -> &'static dyn Slopes {
        let soles = Side::BOTH.map(|side| walker.foot_in_plan(side).planar.x_m);
        Box::leak(Box::new(Self {
            x_m: 0.5 * (soles[0] + soles[1]),
        }))
    }
}

impl Slopes for FromPlan {
    fn gradient(&self, x_m: f64, y_m: f64) -> Vector2<f64> {
        Ahead.gradient(x_m + self.x_m, y_m)
    }
}

#[test]
fn told_of_a_slope_it_sets_its_soles_on_it() {
    let (world, feet) = walked(true);
    assert!(world.walker.standing());
    for foot in feet {
        let x_m = foot.planar.x_m;
        assert!(x_m > BEGINS_M + 0.2, "{x_m}");
        assert!(
            (foot.z_m - height_m(x_m)).abs() < 0.02,
            "{} at {x_m}",
            foot.z_m
        );
        assert_eq!(foot.gradient, Vector2::new(RISE, 0.0));
        let toes = foot.plan_from_sole() * nalgebra::Point3::new(0.05, 0.0, 0.0);
        assert!((toes.z - foot.z_m - 0.05 * RISE).abs() < 1e-3);
    }
    assert_eq!(world.walker.on_slope(), [true; 2]);
}

#[test]
fn told_of_nothing_its_soles_stay_level() {
    let (world, feet) = walked(false);
    assert!(feet.iter().all(|foot| foot.z_m == 0.0));
    assert_eq!(world.walker.on_slope(), [false; 2]);
}

#[test]
fn a_listed_step_onto_a_tilted_slab_sets_the_sole_on_it() {
    let mut world = Ideal::new();
    let onto = Footstep {
        slope: [0.1, -0.05],
        ..climbing_tests::step(Side::Left, 0.1, 0.0, [-0.0525, 0.0525])
    };
    climbing_tests::run(&mut world, &climbing_tests::climb(&[onto]));
    let lies = world.walker.foot_in_plan(Side::Left);
    assert!((lies.gradient - Vector2::new(0.1, -0.05)).norm() < 1e-9);
    let left = lies.plan_from_sole() * nalgebra::Point3::new(0.0, 0.03, 0.0);
    assert!((left.z - lies.z_m + 0.03 * 0.05).abs() < 1e-4);
    assert_eq!(world.walker.on_slope(), [true, false]);
}
