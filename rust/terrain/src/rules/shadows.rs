//! Rule: what lies between two levels across a few cells of which nothing is known is the shadow below an edge, and an edge.

use std::ops::Range;

use geometry::two_levels;
use settings::{settings, within};

use crate::Terrain;

settings! {
    /// What is the shadow below an edge.
    pub struct ShadowsConfig("navigation.terrain.shadows") {
        /// A shadow below an edge, as seen from above, is at most so many cells wide.
        widest: usize = 4, "1", within(1.0, 100.0);
    }
}

/// So many rows or columns are looked at together first.
const TOGETHER: usize = 8;

pub(super) fn apply(terrain: &mut Terrain, config: &ShadowsConfig) {
    let (cols, widest) = (terrain.cols, config.widest);
    let rows = terrain.height_m.len() / cols.max(1);
    for row in 0..rows {
        if has_two_levels(terrain, row..row + 1, 0..cols) {
            mark_line(terrain, row * cols, 1, cols, widest);
        }
    }
    for first in (0..cols).step_by(TOGETHER) {
        let together = first..(first + TOGETHER).min(cols);
        if has_two_levels(terrain, 0..rows, together.clone()) {
            for col in together {
                mark_line(terrain, col, cols, rows, widest);
            }
        }
    }
}

/// Whether there may be two levels among some cells: not where all of their heights lie within what is floor, on level ground.
fn has_two_levels(terrain: &Terrain, rows: Range<usize>, cols: Range<usize>) -> bool {
    if !terrain.slopes.near.is_empty() {
        return true;
    }
    let (mut least, mut most) = ([f32::INFINITY; TOGETHER], [f32::NEG_INFINITY; TOGETHER]);
    for row in rows {
        let first = row * terrain.cols;
        for heights_m in terrain.height_m[first + cols.start..first + cols.end].chunks(TOGETHER) {
            // Not a number: unknown, neither more nor less.
            for ((least, most), &height_m) in least.iter_mut().zip(&mut most).zip(heights_m) {
                *least = if height_m < *least { height_m } else { *least };
                *most = if height_m > *most { height_m } else { *most };
            }
        }
    }
    let [low, high] = [
        least.into_iter().fold(f32::INFINITY, f32::min),
        most.into_iter().fold(f32::NEG_INFINITY, f32::max),
    ];
    high > low && two_levels(f64::from(high - low), 0.0, terrain.needs.limits.floor_m)
}

fn mark_line(terrain: &mut Terrain, first: usize, stride: usize, count: usize, widest: usize) {
    let floor_m = terrain.needs.limits.floor_m;
    let mut last: Option<(usize, f32)> = None;
    for i in 0..count {
        let here = terrain.height_m[first + i * stride];
        if here.is_nan() {
            continue;
        }
        if let Some((known, height)) = last
            && (2..=widest + 1).contains(&(i - known))
        {
            let (from, to) = (first + known * stride, first + i * stride);
            let rise = terrain.slopes.step_m(from, to, here - height);
            let noise_m = f64::from(terrain.noise_m(from, to));
            if two_levels(f64::from(rise), 0.0, floor_m + noise_m)
                && !terrain.may_be_strips(from, to, rise)
            {
                for between in known..=i {
                    terrain.mark_step(first + between * stride, rise);
                }
            }
        }
        last = Some((i, here));
    }
}

#[cfg(test)]
mod tests {
    use mapping::Surface;

    use crate::testing::{Floor, cell};

    #[test]
    fn a_few_unseen_cells_between_two_levels_are_an_edge_and_more_are_unseen_ground() {
        let mut floor = Floor::new();
        floor.paint([0.5, -2.0], [2.0, 2.0], Surface::Floor(0.04));
        floor.paint([-2.0, -2.0], [-0.5, 2.0], Surface::Floor(0.04));
        floor.paint([0.3, -2.0], [0.5, 2.0], Surface::Unknown);
        floor.paint([-0.5, -2.0], [-0.2, 2.0], Surface::Unknown);
        let terrain = floor.after("shadows");
        let edge = |x_m: f64| terrain.edge[cell(&terrain, x_m, 0.025)];
        assert!([0.275, 0.325, 0.475, 0.525].into_iter().all(edge));
        assert!(![-0.175, -0.325, -0.525].into_iter().any(edge));
        floor.doubt([0.5, -2.0], [2.0, 2.0], 0.02);
        let terrain = floor.after("shadows");
        assert!(!terrain.any_edge, "3 cm may be noise");
    }
}
