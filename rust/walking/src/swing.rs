//! The path of the swing foot: minimum jerk over the ground, up and down once.

use geometry::PlanarPose;

use crate::tuning::SwingTuning;

/// Where a foot at `here` is after a share of the straight way to `place`, its heading kept.
pub fn part_way(here: &PlanarPose, place: &PlanarPose, share: f64) -> PlanarPose {
    PlanarPose {
        x_m: here.x_m + (place.x_m - here.x_m) * share,
        y_m: here.y_m + (place.y_m - here.y_m) * share,
        ..*here
    }
}

/// Minimum-jerk rise from 0 to 1 for a share of time in [0, 1]: 10 s^3 - 15 s^4 + 6 s^5 (Flash and Hogan, 1985). At rest at both ends.
pub fn minimum_jerk(share: f64) -> f64 {
    let s = share.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// Share of the way over the ground after a share of the time.
pub fn travel(share: f64, tuning: &SwingTuning) -> f64 {
    minimum_jerk(within(share, tuning.travel))
}

/// Height of the sole after a share of the time: from `from_m` up to `top_m` in the middle and down to `to_m`.
pub fn height_m(share: f64, from_m: f64, top_m: f64, to_m: f64) -> f64 {
    if share < 0.5 {
        from_m + (top_m - from_m) * minimum_jerk(2.0 * share)
    } else {
        top_m + (to_m - top_m) * minimum_jerk(2.0 * share - 1.0)
    }
}

/// Share of the way over the ground of a foot that goes back off something, and its height.
pub fn retreat(share: f64, from_m: f64, to_m: f64, tuning: &SwingTuning) -> (f64, f64) {
    let down = minimum_jerk(within(share, tuning.down));
    (
        minimum_jerk(within(share, tuning.off)),
        from_m + (to_m - from_m) * down,
    )
}

/// Share of the time in which a careful foot rises, and in which it sinks.
pub fn lifting(tuning: &SwingTuning) -> f64 {
    tuning.rise[1] - tuning.rise[0]
}

/// Share of the time after which a careful foot comes down on what it is told to land on.
pub const fn sinking(tuning: &SwingTuning) -> f64 {
    tuning.over[1]
}

/// Share of the way over the ground of a careful foot after a share of the time: only while it is high.
pub fn careful_travel(share: f64, tuning: &SwingTuning) -> f64 {
    minimum_jerk(within(share, tuning.over))
}

/// Height of a careful foot after a share of the time: straight up from the first of its ends to `top_m`, and straight down to the
/// other one.
pub fn careful_height_m(
    share: f64,
    [from_m, to_m]: [f64; 2],
    top_m: f64,
    tuning: &SwingTuning,
) -> f64 {
    let up = minimum_jerk(within(share, tuning.rise));
    let down = minimum_jerk(within(share, tuning.sink));
    from_m + (top_m - from_m) * up + (to_m - top_m) * down
}

fn within(share: f64, [from, to]: [f64; 2]) -> f64 {
    (share - from) / (to - from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn travel(share: f64) -> f64 {
        super::travel(share, &SwingTuning::default())
    }

    fn careful_travel(share: f64) -> f64 {
        super::careful_travel(share, &SwingTuning::default())
    }

    fn careful_height_m(share: f64, from_m: f64, top_m: f64, to_m: f64) -> f64 {
        super::careful_height_m(share, [from_m, to_m], top_m, &SwingTuning::default())
    }

    proptest! {
        #[test]
        fn the_foot_starts_and_ends_at_rest_where_it_should(from in -0.1..0.1f64, to in -0.1..0.1f64) {
            let top = from.max(to) + 0.02;
            let small = 1e-5;
            prop_assert_eq!(height_m(0.0, from, top, to), from);
            prop_assert!((height_m(1.0, from, top, to) - to).abs() < 1e-12);
            prop_assert!((height_m(small, from, top, to) - from).abs() < small * small);
            prop_assert!((height_m(1.0 - small, from, top, to) - to).abs() < small * small);
            prop_assert_eq!((travel(0.0), travel(1.0)), (0.0, 1.0));
        }

        #[test]
        fn the_foot_never_goes_below_both_ends(share in 0.0..1.0f64, from in -0.1..0.1f64, to in -0.1..0.1f64) {
            let top = from.max(to) + 0.02;
            let height = height_m(share, from, top, to);
            prop_assert!(height >= from.min(to) - 1e-12 && height <= top + 1e-12);
        }

        #[test]
        fn the_foot_only_goes_forward(share in 0.0..1.0f64, more in 0.0..0.5f64) {
            prop_assert!(travel(share + more) >= travel(share) - 1e-12);
        }
    }

    proptest! {
        #[test]
        fn a_careful_foot_starts_and_ends_at_rest_where_it_should(from in -0.1..0.1f64, to in -0.1..0.1f64) {
            let top = from.max(to) + 0.02;
            let small = 1e-5;
            prop_assert!((careful_height_m(0.0, from, top, to) - from).abs() < 1e-12);
            prop_assert!((careful_height_m(1.0, from, top, to) - to).abs() < 1e-12);
            prop_assert!((careful_height_m(small, from, top, to) - from).abs() < small * small);
            prop_assert!((careful_height_m(1.0 - small, from, top, to) - to).abs() < small * small);
            prop_assert_eq!((careful_travel(0.0), careful_travel(1.0)), (0.0, 1.0));
        }

        #[test]
        fn a_careful_foot_clears_the_edge_between_its_ends(
            share in 0.0..1.0f64, from in -0.05..0.05f64, to in -0.05..0.05f64,
        ) {
            // Table I of 003 leaves 15 mm between a toe and the riser in front: an eighth of a tread of 120 mm.
            let higher = from.max(to);
            let height = careful_height_m(share, from, higher + 0.02, to);
            let along = careful_travel(share);
            if along > 0.1 && along < 0.9 {
                prop_assert!(height > higher + 0.01, "{height} at {along} of the way");
            }
            prop_assert!(height >= from.min(to) - 1e-12 && height <= higher + 0.02 + 1e-12);
        }

        #[test]
        fn a_careful_foot_only_goes_forward_and_first_up_then_down(share in 0.0..1.0f64, more in 0.0..0.5f64) {
            let height = |share| careful_height_m(share, 0.0, 0.05, 0.03);
            prop_assert!(careful_travel(share + more) >= careful_travel(share) - 1e-12);
            if share + more < 0.5 {
                prop_assert!(height(share + more) >= height(share) - 1e-12);
            } else if share > 0.5 {
                prop_assert!(height(share + more) <= height(share) + 1e-12);
            }
        }
    }
}
