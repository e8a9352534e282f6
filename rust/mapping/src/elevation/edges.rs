//! Edges kept: a cell through which an edge runs has the height of what is above, as the handbook asks of interpolated heights, too
//! (004, section 36.3.1).

/// Ways through a cell: along columns, rows and both diagonals.
pub(crate) const WAYS: [[i32; 2]; 4] = [[1, 0], [0, 1], [1, 1], [1, -1]];

/// How a cell between two surfaces is told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EdgeRule {
    /// Surfaces that lie less than this apart are one, m.
    pub least_m: f32,
    /// Of the height between two surfaces, the share by which each of them may be uneven, and a cell of one may be off it.
    pub uneven: f32,
    /// Cells between the first whole ones of both surfaces, the one in between counted twice, at most.
    pub reach: i32,
}

impl EdgeRule {
    /// Cells two steps before and behind an edge are so far apart in height at least, m.
    pub(crate) fn least_seen_m(&self) -> f32 {
        (1.0 - 2.0 * self.uneven) * self.least_m
    }
}

/// Height of the upper one of two surfaces that a cell lies between: on either side of it, along one of the ways, two cells have
/// nearly the same height, the two pairs differ, and its own height is that of neither. `height` is that of the cell so many
/// columns and rows away, m. None for a cell of one surface or of a slope.
pub(crate) fn upper_surface(
    own_m: f32,
    height: impl Fn([i32; 2]) -> Option<f32>,
    rule: EdgeRule,
) -> Option<f32> {
    let along = |way: [i32; 2], steps: i32| height([steps * way[0], steps * way[1]]);
    // Every pair holds the cell two steps away, or one that is as high.
    let may_differ = |way: &&[i32; 2]| match (along(**way, -2), along(**way, 2)) {
        (Some(before), Some(behind)) => (before - behind).abs() >= rule.least_seen_m(),
        _ => false,
    };
    let uppers = WAYS.iter().filter(may_differ).filter_map(|&way| {
        let pair = |sign: i32, steps: i32| {
            Some([along(way, sign * steps)?, along(way, sign * (steps + 1))?])
        };
        let pairs =
            |sign: i32| (1..rule.reach).filter_map(move |steps| Some((steps, pair(sign, steps)?)));
        let mut both = pairs(-1).flat_map(|(far, before)| {
            let left = rule.reach - far;
            pairs(1)
                .filter(move |(far, _)| *far <= left)
                .map(move |(_, behind)| (before, behind))
        });
        both.find_map(|(before, behind)| between(own_m, before, behind, rule))
    });
    uppers.reduce(f32::max)
}

/// The upper one of two surfaces, each given by two cells side by side, where a height lies between them.
fn between(own_m: f32, before: [f32; 2], behind: [f32; 2], rule: EdgeRule) -> Option<f32> {
    let apart_m = (before[0] - behind[0]).abs();
    let off_m = rule.uneven * apart_m;
    let even = |pair: [f32; 2]| (pair[0] - pair[1]).abs() <= off_m;
    let low_m = before[0].min(behind[0]);
    let upper_m = before[0].max(behind[0]);
    let mixed = own_m > low_m + off_m && own_m < upper_m - off_m;
    (apart_m >= rule.least_m && even(before) && even(behind) && mixed).then_some(upper_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RULE: EdgeRule = EdgeRule {
        least_m: 0.01,
        uneven: 0.15,
        reach: 3,
    };

    fn upper(heights_m: impl Fn([i32; 2]) -> f32) -> Option<f32> {
        upper_surface(heights_m([0, 0]), |at| Some(heights_m(at)), RULE)
    }

    proptest! {
        #[test]
        fn slopes_and_level_ground_have_no_edge(
            rise in prop::array::uniform2(-0.02..0.02f32), waves in 0.0..0.001f32,
        ) {
            let ground = |[col, row]: [i32; 2]| {
                let uneven = waves * ((3 * col + 5 * row).rem_euclid(7) as f32 - 3.0) / 3.0;
                rise[0] * col as f32 + rise[1] * row as f32 + uneven
            };
            prop_assert_eq!(upper(ground), None);
        }

        #[test]
        fn a_mixed_cell_at_an_edge_of_any_direction_is_that_of_the_upper_surface(
            mixed in 0.3..0.7f32, rise in 0.015..0.2f32, way in 0..4usize, side in prop::bool::ANY,
        ) {
            let [across, along] = WAYS[way];
            let sign = if side { 1 } else { -1 };
            let ground = |[col, row]: [i32; 2]| match sign * (across * col + along * row) {
                0 => mixed * rise,
                1.. => rise,
                _ => 0.0,
            };
            prop_assert_eq!(upper(ground), Some(rise));
        }
    }
}
