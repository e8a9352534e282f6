//! What is kept of a path: its steps as the stairs are seen now.

use geometry::{Lattice, Map, Point};
use stairs::{Edge, Sides, Stair};

use super::*;
use crate::climb_links::Way;
use terrain::{HeightLimits, Needs};

/// A step down to this height over an edge across the way at x, from this level.
fn stride(x_m: f64, height_m: f64, level_m: f64) -> Stride {
    let edge = |x_m: f64| Edge::<Map> {
        left: Point::new(x_m, 0.3, height_m),
        right: Point::new(x_m, -0.3, height_m),
    };
    let stair = Stair {
        front: edge(x_m),
        back: edge(x_m + 0.4),
        reference: Point::new(x_m + 0.2, 0.0, height_m),
        left_margin_m: 0.0,
        right_margin_m: 0.0,
        support: 500,
        seen_ends: Sides::default(),
        front_fit: None,
        back_fit: None,
        seen_from_m: 0.3,
        steps_ago: 0,
    };
    Stride {
        step: crate::Step {
            stair,
            rise_m: height_m - level_m,
            crossing_m: [x_m, 0.0],
        },
        from_m: [x_m - 0.07, 0.0],
        to_m: [x_m + 0.07, 0.0],
        range_m: 0.2,
        beside: 1.0,
        limit: None,
    }
}

#[test]
fn a_step_is_taken_from_the_level_before_it_whatever_other_way_leads_over_its_edge() {
    let links = ClimbLinks {
        strides: vec![stride(1.0, 0.002, 0.029), stride(1.004, 0.002, 0.02)],
        ..ClimbLinks::default()
    };
    let step = stride(1.0, 0.0, 0.02).step;
    let rise_mm = |level_m: Option<f64>| {
        let now = seen_now(
            &step,
            level_m,
            (
                &links,
                (&FollowedPathTuning::default(), &LevelsConfig::default()),
            ),
        )?;
        Some((1e3 * now.step.rise_m).round())
    };
    assert_eq!(rise_mm(Some(0.017)), Some(-18.0));
    assert_eq!(rise_mm(None), Some(-18.0));
    assert_eq!(rise_mm(Some(0.04)), Some(-27.0));
    assert_eq!(rise_mm(Some(0.06)), None);
}

/// Floor that is higher from x = 0.6 m on.
fn terrain(higher_m: f32) -> Terrain {
    let limits = HeightLimits {
        floor_m: 0.01,
        step_m: 0.05,
    };
    let needs = Needs {
        turned: None,
        body_m: 0.1,
        feet_m: 0.08,
        limits,
    };
    let mut terrain = Terrain::new(needs, AStarConfig::default().cells());
    terrain.lattice = Lattice {
        origin_m: [0.0, 0.0],
        cell_m: 0.1,
    };
    (terrain.cols, terrain.rows) = (10, 1);
    let heights_m = (0..10).map(|col| if col < 6 { 0.015 } else { higher_m });
    terrain.height_m = heights_m.collect();
    terrain
}

/// A path over these points with one climb.
fn path(points_m: Vec<[f64; 2]>, climb: Climb) -> Path {
    Path {
        points_m,
        climbs: vec![climb],
        ..Path::default()
    }
}

#[test]
fn what_is_walked_behind_the_last_step_lies_as_high_as_that() {
    let climb = Climb {
        from_point: 0,
        to_point: 1,
        steps: vec![stride(0.2, 0.015, 0.0).step],
    };
    let mut path = path(
        vec![[0.1, 0.05], [0.3, 0.05], [0.5, 0.05], [0.8, 0.05]],
        climb,
    );
    path.spans = vec![[0, 3]];
    let tolerance_m = LevelsConfig::default().same;
    assert!(walks_on_level(&path, &terrain(0.017), tolerance_m));
    assert!(!walks_on_level(&path, &terrain(0.03), tolerance_m));
    assert!(!walks_on_level(&path, &terrain(0.0), tolerance_m));
}

/// Ways over the same edge, each at an offset to the left with what a metre costs there by what stands beside it.
fn lanes(offsets_m: &[(f64, f64)]) -> ClimbLinks {
    let mut links = ClimbLinks::default();
    for (first, &(offset_m, beside)) in offsets_m.iter().enumerate() {
        let mut lane = stride(1.0, 0.02, 0.0);
        lane.step.crossing_m[1] = offset_m;
        links.strides.push(Stride { beside, ..lane });
        links.ways.push(Way {
            first,
            end: first + 1,
            enter_m: [0.9, offset_m],
            leave_m: None,
            fit: Fit::Holds,
            at_goal: false,
            turned_rad: None,
        });
    }
    links
}

#[test]
fn a_lane_is_left_only_ahead_and_where_another_one_saves_more_than_the_way_there() {
    let mut step = stride(1.0, 0.02, 0.0).step;
    step.crossing_m[1] = -0.2;
    let climb = Climb {
        from_point: 1,
        to_point: 2,
        steps: vec![step],
    };
    let ahead = path(vec![[0.4, -0.2], [0.9, -0.2], [1.4, -0.2]], climb);
    let edges = (&FollowedPathTuning::default(), &LevelsConfig::default());
    let by_a_wall = lanes(&[(-0.2, 2.5), (0.0, 1.0)]);
    assert!(another_lane_is_roomier(&ahead, (&by_a_wall, edges), 0.0));
    let hardly_better = lanes(&[(-0.2, 1.5), (0.0, 1.0)]);
    assert!(!another_lane_is_roomier(
        &ahead,
        (&hardly_better, edges),
        0.0
    ));
    let mut begun = ahead;
    drop(begun.points_m.drain(..1));
    begun.climbs[0].from_point = 0;
    begun.climbs[0].to_point = 1;
    assert!(!another_lane_is_roomier(&begun, (&by_a_wall, edges), 0.0));
}
