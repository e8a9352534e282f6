//! Stairs to build worlds from.

use geometry::{Map, Point};
use stairs::{Edge, Sides, Stair};

/// Stairs along x from `first_m` on: rise and tread of each; all of this width.
pub(crate) fn straight(first_m: f64, steps: &[(f64, f64)], width_m: f64) -> Vec<Stair<Map>> {
    let (mut x_m, mut z_m) = (first_m, 0.0);
    steps
        .iter()
        .map(|&(rise_m, tread_m)| {
            z_m += rise_m;
            let stair = stair([x_m, 0.0, 0.0], [x_m + tread_m, 0.0, 0.0], z_m, width_m);
            x_m += tread_m;
            stair
        })
        .collect()
}

/// A stair between two edges, each by middle and heading.
pub(crate) fn stair(front: [f64; 3], back: [f64; 3], z_m: f64, width_m: f64) -> Stair<Map> {
    let edge = |[x_m, y_m, heading_rad]: [f64; 3]| {
        let (sin, cos) = libm::sincos(heading_rad);
        let half_m = 0.5 * width_m;
        Edge {
            left: Point::new(x_m - sin * half_m, y_m + cos * half_m, z_m),
            right: Point::new(x_m + sin * half_m, y_m - cos * half_m, z_m),
        }
    };
    Stair {
        front: edge(front),
        back: edge(back),
        reference: Point::new(0.5 * (front[0] + back[0]), 0.5 * (front[1] + back[1]), z_m),
        left_margin_m: 0.0,
        right_margin_m: 0.0,
        support: 500,
        seen_ends: Sides::default(),
        front_fit: None,
        back_fit: None,
        seen_from_m: 0.3,
        steps_ago: 0,
    }
}
