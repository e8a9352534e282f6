//! Ground that was not seen: closed, or priced and looked at once the robot is near.

use std::collections::VecDeque;

use geometry::{Cell, CellArea};

/// What is made of ground that was not seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unseen {
    /// Nobody goes there.
    Closed,
    /// The way may lead over it. A plan ends where what it knows ends, or where levels meet nobody knows just where, or so far before that, m.
    Priced {
        /// How far before, m.
        stop_before_m: f64,
        /// At its end the robot faces what was not seen at least so well, rad.
        faces_rad: f64,
    },
}

/// Gives cells of which nothing is known, NaN, the level of the nearest that has one, the lowest of several: behind what stands there, more
/// of that is expected, and behind floor, floor.
pub(super) fn guess_levels(levels_m: &mut [f32], cols: i32) {
    let rows = (levels_m.len() as i32).checked_div(cols).unwrap_or(0);
    let mut ring: VecDeque<u32> = (0..levels_m.len() as u32)
        .filter(|&node| levels_m[node as usize].is_finite())
        .collect();
    ring.make_contiguous().sort_by(|a, b| {
        levels_m[*a as usize]
            .total_cmp(&levels_m[*b as usize])
            .then(a.cmp(b))
    });
    while let Some(from) = ring.pop_front() {
        let at = Cell::new(from as i32 % cols, from as i32 / cols);
        for cell in CellArea::of(at).grown(1).cells() {
            if !(0..cols).contains(&cell.col) || !(0..rows).contains(&cell.row) {
                continue;
            }
            let to = (cell.row * cols + cell.col) as usize;
            if levels_m[to].is_nan() {
                levels_m[to] = levels_m[from as usize];
                ring.push_back(to as u32);
            }
        }
    }
}

/// Lets what was guessed rise evenly from level to level: nobody knows where between them it does.
pub(super) fn smooth_levels(levels_m: &mut [f32], guessed: &[bool], cols: i32, rounds: usize) {
    let rows = (levels_m.len() as i32).checked_div(cols).unwrap_or(0);
    let mean_m = |levels_m: &[f32], at: Cell| {
        let beside = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(|[right, up]| {
            let cell = Cell::new(at.col + right, at.row + up);
            let inside = (0..cols).contains(&cell.col) && (0..rows).contains(&cell.row);
            inside.then(|| levels_m[(cell.row * cols + cell.col) as usize])
        });
        let finite = beside
            .into_iter()
            .flatten()
            .filter(|level_m| level_m.is_finite());
        let (count, sum_m) = finite.fold((0.0, 0.0), |(count, sum_m), level_m| {
            (count + 1.0, sum_m + level_m)
        });
        (count > 0.0).then_some(sum_m / count)
    };
    let mut even_out = |node: usize| {
        if guessed[node] && levels_m[node].is_finite() {
            let at = Cell::new(node as i32 % cols, node as i32 / cols);
            if let Some(mean_m) = mean_m(levels_m, at) {
                levels_m[node] = mean_m;
            }
        }
    };
    let nodes = 0..guessed.len();
    for _ in 0..rounds {
        nodes.clone().for_each(&mut even_out);
        nodes.clone().rev().for_each(&mut even_out);
    }
}

#[cfg(test)]
mod tests {
    use geometry::PlanarPose;

    use super::*;
    use crate::footsteps::tests::{LIMITS, flight, goal, map};
    use crate::footsteps::{FootstepLayer, FootstepsConfig};

    #[test]
    fn what_was_not_seen_is_as_high_as_what_is_nearest_and_low_where_that_is_as_near() {
        let unseen = f32::NAN;
        let mut levels_m = [0.0, unseen, unseen, unseen, 0.5, f32::INFINITY, unseen];
        guess_levels(&mut levels_m, 7);
        assert_eq!(levels_m[..5], [0.0, 0.0, 0.0, 0.5, 0.5]);
        // Where the body has no room nothing is guessed from.
        assert!(levels_m[6].is_nan());
        let mut nothing = [unseen; 4];
        guess_levels(&mut nothing, 2);
        assert!(nothing.iter().all(|level_m| level_m.is_nan()));
        guess_levels(&mut [], 0);
    }

    #[test]
    fn what_was_guessed_rises_evenly_and_what_is_known_stays() {
        let unseen = f32::NAN;
        let mut levels_m = [0.0, unseen, unseen, unseen, unseen, unseen, 0.12];
        let guessed = levels_m.map(f32::is_nan);
        guess_levels(&mut levels_m, 7);
        smooth_levels(&mut levels_m, &guessed, 7, 8);
        assert_eq!((levels_m[0], levels_m[6]), (0.0, 0.12));
        for pair in levels_m.windows(2) {
            assert!((pair[1] - pair[0] - 0.02).abs() < 5e-3, "{levels_m:?}");
        }
        smooth_levels(&mut [], &[], 0, 8);
    }

    #[test]
    fn of_two_ways_feet_take_the_one_beside_which_the_ground_is_known() {
        // A flight of 0.8 m, of which nothing is known to its left; the goal is there, behind it.
        let flight = map(|x_m, y_m| {
            if (0.4..0.8).contains(&x_m) && y_m > 0.2 {
                return f64::NAN;
            }
            flight(x_m, 0.4, (0.03, 0.13, 4))
        });
        let farthest_m = |margin_cost: f64| {
            let config = FootstepsConfig {
                margin_cost,
                ..FootstepsConfig::default()
            };
            let mut layer = FootstepLayer::new(config, LIMITS).unwrap();
            let feet = layer.feet_around(&PlanarPose::new(0.1, 0.1, 0.0));
            let plan = layer.plan(&flight, feet, &goal(1.3, 0.2)).unwrap();
            let on_it = (plan.steps.iter()).filter(|step| (0.4..0.8).contains(&step.pose.x_m));
            on_it
                .map(|step| step.pose.y_m)
                .fold(f64::NEG_INFINITY, f64::max)
        };
        let (any_m, known_m) = (farthest_m(0.0), farthest_m(1.5));
        assert!(known_m < any_m - 0.03, "{any_m} {known_m}");
    }
}
