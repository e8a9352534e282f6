//! Steps from cell to cell of the goal's field, and what they cost.

use super::config::FootstepsConfig;
use super::limits::StepLimits;

/// What a step from cell to cell costs.
pub(super) struct Prices {
    /// Of a step straight on and of a diagonal one, s.
    way_s: [f32; 2],
    /// Up to this, m, ground is walked on.
    walk_m: f32,
    /// Beyond this, m, there is no step.
    rise_m: f32,
    /// Nor beyond this, m, where one of both was not seen: stairs there are no steeper than the highest step by the shortest tread, and one
    /// unseen cell may hide one step.
    unseen_rise_m: f32,
    /// What a metre of climbing costs beside the way, s: over what was seen, and over what was not.
    climb_s: [f32; 2],
    /// So many times as dear is a way over what carries no sole.
    poor: f32,
    /// So many times as dear is a way over what was not seen.
    unseen: f32,
}

impl Prices {
    pub(super) fn of(config: &FootstepsConfig, limits: &StepLimits, cell_m: f64) -> Self {
        let straight_s = cell_m / limits.speed_mps();
        let rise_m = limits.careful_rise_m;
        let shortest_tread_m = config.foothold.least_bearing * limits.sole.length_m;
        let more_s = (limits.careful_s(0.0, rise_m) - limits.walked_s).max(0.0);
        let climb_s = more_s / rise_m;
        Self {
            way_s: [straight_s, std::f64::consts::SQRT_2 * straight_s].map(|cost_s| cost_s as f32),
            walk_m: config.walk_height as f32,
            rise_m: rise_m as f32,
            unseen_rise_m: (rise_m * (cell_m / shortest_tread_m).max(0.5)) as f32,
            climb_s: [climb_s, config.unseen_climb_cost * climb_s].map(|cost_s| cost_s as f32),
            poor: config.poor_cost as f32,
            unseen: config.unseen_cost as f32,
        }
    }

    /// What a climb of so much costs beside the way where nobody saw it, s.
    pub(super) fn unseen_climb_s(&self, rise_m: f32) -> f32 {
        rise_m * self.climb_s[1]
    }
}

/// The eight steps from a cell, with what each costs; those that lead nowhere left out.
pub(super) fn steps<'a>(
    (from, cols, rows): (u32, i32, i32),
    (levels_m, carries, not_seen): (&'a [f32], &'a [bool], &'a [bool]),
    prices: &'a Prices,
) -> impl Iterator<Item = (u32, f32)> + 'a {
    let (col, row) = (from as i32 % cols, from as i32 / cols);
    let around = (-1..=1).flat_map(|up| (-1..=1).map(move |right| [right, up]));
    around.filter_map(move |[right, up]: [i32; 2]| {
        let to = [col + right, row + up];
        let inside = (0..cols).contains(&to[0]) && (0..rows).contains(&to[1]);
        if !inside || right == 0 && up == 0 {
            return None;
        }
        let to = (to[1] * cols + to[0]) as usize;
        let rise_m = (levels_m[to] - levels_m[from as usize]).abs();
        let unseen = not_seen[to] || not_seen[from as usize];
        let climb_s = if unseen || rise_m > prices.walk_m {
            rise_m * prices.climb_s[usize::from(unseen)]
        } else {
            0.0
        };
        let diagonal = usize::from(right != 0 && up != 0);
        let times = match (not_seen[to], carries[to]) {
            (true, _) => prices.unseen,
            (false, true) => 1.0,
            (false, false) => prices.poor,
        };
        let way_s = prices.way_s[diagonal] * times;
        let most_m = if unseen {
            prices.unseen_rise_m
        } else {
            prices.rise_m
        };
        // What has no level has no rise.
        (rise_m <= most_m).then_some((to as u32, way_s + climb_s))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::footsteps::tests::LIMITS;

    #[test]
    fn a_climb_that_nobody_saw_is_dearer_than_one_that_was_seen_and_its_rise_counts_however_even() {
        let config = FootstepsConfig::default();
        let prices = Prices::of(&config, &LIMITS, config.field_cell);
        let cost_s = |rise_m: f32, exit: bool| {
            let (levels_m, carries, exits) = ([0.0, rise_m], [true; 2], [false, exit]);
            let mut steps = steps((0, 2, 1), (&levels_m, &carries, &exits), &prices);
            steps.next().map(|(_, cost_s)| cost_s)
        };
        let climb_s = |rise_m: f32, exit: bool| Some(cost_s(rise_m, exit)? - cost_s(0.0, exit)?);
        let [seen_s, unseen_s] = [false, true].map(|exit| climb_s(0.02, exit).unwrap());
        let times = config.unseen_climb_cost as f32;
        assert!((unseen_s - times * seen_s).abs() < 1e-5);
        assert_eq!(climb_s(0.004, false), Some(0.0));
        assert!((climb_s(0.004, true).unwrap() - 0.2 * unseen_s).abs() < 1e-5);
        assert_eq!(cost_s(0.1, false), None);
    }
}
