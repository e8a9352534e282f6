//! What a sole that stands tells of the short slope that is believed to be under it.

use super::bevels::{Bevels, ChangeOfHeight};
use crate::BevelMemoryTuning;

/// A sole that carries the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CarryingSole {
    /// Its middle in the map, m.
    pub middle_m: [f64; 2],
    /// How it rises a metre along the map's axes.
    pub gradient: [f64; 2],
    /// Half of its length, m.
    pub half_length_m: f64,
}

impl Bevels {
    /// A short slope on which a whole sole stands that is not tilted so is none, whatever the frames say: it was seen where treads are.
    pub(crate) fn stand_on(&mut self, sole: &CarryingSole, tuning: &BevelMemoryTuning) {
        for known in &mut self.known {
            known.refuted |= known.carries_whole(sole)
                && known.steeper_than(sole) > tuning.felt
                && known.better > tuning.sure;
        }
    }
}

impl ChangeOfHeight {
    /// Whether all of a sole lies on it.
    fn carries_whole(&self, sole: &CarryingSole) -> bool {
        let beyond_m = self.middle.beyond_m(sole.middle_m).abs();
        let aside_m = self.middle.aside_m(sole.middle_m).abs();
        beyond_m + sole.half_length_m < 0.5 * self.run_m
            && aside_m + sole.half_length_m < 0.5 * self.middle.length_m()
    }

    /// By how much more it rises a metre than a sole along its rise.
    fn steeper_than(&self, sole: &CarryingSole) -> f64 {
        let [near_m, far_m] = self.heights_m;
        let across = self.middle.across();
        let sole_rise = across.x * sole.gradient[0] + across.y * sole.gradient[1];
        let rise = (far_m - near_m) / self.run_m;
        (rise - sole_rise) * rise.signum()
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Point, Pose};

    use super::*;
    use crate::Edge;
    use crate::edges::edge_model::bevel::FittedBevel;

    /// How many short slopes are left of one that rises by 62 mm over 26 cm where a sole stands so far from its middle, tilted so along its rise.
    fn left_of(sole_m: f64, rise: f64) -> usize {
        let (mut bevels, tuning) = (Bevels::default(), BevelMemoryTuning::default());
        let end = |left_m: f64| Point::new(0.5, left_m, 0.0);
        let fitted = FittedBevel {
            middle: Edge {
                left: end(0.4),
                right: end(-0.4),
            },
            run_m: 0.26,
            better: 20.0,
        };
        let mut list = Vec::new();
        for _ in 0..8 {
            bevels.see(&fitted, [0.03, 0.092], (&Pose::identity(), 0.007), &tuning);
        }
        bevels.list(&mut list, &tuning);
        assert_eq!(list.len(), 1);
        bevels.stand_on(
            &CarryingSole {
                middle_m: [0.5 + sole_m, 0.1],
                gradient: [rise, 0.0],
                half_length_m: 0.05,
            },
            &tuning,
        );
        // Frames from there say the same as before.
        for _ in 0..20 {
            bevels.see(&fitted, [0.03, 0.092], (&Pose::identity(), 0.007), &tuning);
        }
        bevels.list(&mut list, &tuning);
        list.len()
    }

    #[test]
    fn a_slope_on_which_a_sole_stands_level_is_none_and_one_that_tilts_it_is() {
        assert_eq!(left_of(0.02, 0.01), 0);
        assert_eq!(left_of(0.02, 0.2), 1);
        // A sole that lies across its end may be level.
        assert_eq!(left_of(0.1, 0.01), 1);
    }
}
