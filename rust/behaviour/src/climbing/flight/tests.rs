//! The steps ahead as plans come and go.

use super::*;
use crate::climbing::simulation::stair;
use planning::{Climb, Path};

/// Two steps that are crossed along x at this offset to the left.
fn plan(aside_m: f64) -> Plan {
    let step = |x_m: f64, height_m: f64| Step {
        stair: stair([x_m, 0.0, 0.0], [x_m + 0.12, 0.0, 0.0], height_m, 1.0),
        rise_m: 0.03,
        crossing_m: [x_m, aside_m],
    };
    let climb = Climb {
        from_point: 0,
        to_point: 2,
        steps: vec![step(0.5, 0.03), step(0.62, 0.06)],
    };
    let path = Path {
        climbs: vec![climb],
        ..Path::default()
    };
    Plan {
        way: Ok(path),
        replanned: true,
    }
}

#[test]
fn a_plan_that_crosses_a_wide_edge_elsewhere_does_not_move_the_lane() {
    let mut flight = Flight::default();
    let first = plan(0.1);
    flight.adopt(&first.way.as_ref().unwrap().climbs[0].steps);
    let (pose, config) = (PlanarPose::default(), ClimbingConfig::default());
    for aside_m in [-0.3, 0.25, 0.1] {
        let plan = plan(aside_m);
        flight.refresh(Some(&plan), &Staircase::default(), &pose, &config);
        assert_eq!(flight.steps().len(), 2);
        for step in flight.steps() {
            assert!((step.crossing_m[1] - 0.1).abs() < 1e-9, "{step:?}");
        }
    }
}
