//! Time to find a leg's angles along a stride: in closed form; by Newton's method from the solution before, and from the upright stance.
#![expect(clippy::expect_used, reason = "a bench may stop at a bug")]

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry3, Vector3};
use robot::{Body, Side};
use testkit::biped;
use walking::GaitConfig;
use walking::leg::LegSolver;

/// Poses of the sole in one stride.
const POSES: usize = 100;

/// The biped, or one whose hip's first axis is tilted forward, for which there is no closed form.
fn leg(tilted: bool) -> LegSolver {
    let mut described = biped().description().clone();
    if tilted {
        let hip = &described.legs.left.joints[0];
        let mut joints = described
            .links
            .iter_mut()
            .filter_map(|link| link.joint.as_mut());
        let joint = joints.find(|joint| joint.name == *hip).expect("the hip");
        joint.axis = [0.1, 0.0, 0.995];
    }
    let body = Body::new(described).expect("a biped");
    let (gait, _) = GaitConfig::read(&body).expect("a gait");
    let leg = LegSolver::new(&body, Side::Left, gait.max_extension, &gait.tuning.leg);
    leg.expect("a leg")
}

/// Where the sole is in one stride: ahead and back, and up on the way.
fn stride(leg: &LegSolver) -> Vec<Isometry3<f64>> {
    let (thigh_m, shank_m) = leg.lengths_m();
    let below_m = 0.93 * (thigh_m + shank_m) + leg.ankle_height_m();
    let pose = |index: usize| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * index as f64 / POSES as f64);
        let lifted_m = 0.02 * sin.max(0.0);
        let place = leg.hip() + Vector3::new(0.04 * cos, 0.0, lifted_m - below_m);
        Isometry3::translation(place.x, place.y, place.z)
    };
    (0..POSES).map(pose).collect()
}

fn solve(criterion: &mut Criterion) {
    for (name, tilted, warm) in [
        ("closed form", false, true),
        ("Newton, from the tick before", true, true),
        ("Newton, from the stance", true, false),
    ] {
        let leg = leg(tilted);
        assert_eq!(leg.not_closed().is_some(), tilted);
        let poses = stride(&leg);
        let mut next = poses.iter().cycle();
        let mut near = *leg.rest_rad();
        let _ = criterion.bench_function(name, |bencher| {
            bencher.iter(|| {
                let found = next.next().map(|pose| leg.solve(pose, &near));
                if let (true, Some(found)) = (warm, found) {
                    near = found.angles_rad;
                }
                found
            });
        });
    }
}

criterion_group!(benches, solve);
criterion_main!(benches);
