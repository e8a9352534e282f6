//! Whether and where both feet fit on a stair (003, section V.C, Fig. 9).

use crate::{ClimbingConfig, Unfit};

/// The feet of a robot, side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feet {
    /// Length of a sole, m.
    pub length_m: f64,
    /// Width of both soles side by side with the gap between them, m.
    pub pair_width_m: f64,
    /// Distance between the soles' centres, m.
    pub stance_m: f64,
}

/// What comes behind a stair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Onward {
    /// The surface goes on further than a sole needs, or nothing behind it is known yet.
    Level,
    /// An edge at this depth behind the front edge, with this change of height, both m.
    Edge {
        /// From the stair's front edge to it, m.
        depth_m: f64,
        /// Change of height there, m: the next step up or down, or a drop.
        rise_m: f64,
    },
}

/// Where the feet are put, measured square to the stair's front edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footing {
    /// The heels' place beyond the front edge, m.
    pub heel_m: f64,
}

impl Footing {
    /// Where the feet go on a stair that is `rise_m` higher than the ground before it and `width_m` wide.
    pub fn on_stair(
        config: &ClimbingConfig,
        feet: &Feet,
        rise_m: f64,
        width_m: f64,
        onward: Onward,
    ) -> Result<Self, Unfit> {
        let limit_m = if rise_m > 0.0 {
            config.ascend.step_max_z
        } else {
            -config.descend.step_min_z
        };
        if rise_m.abs() <= config.floor_max {
            return Err(Unfit::TooLow(rise_m));
        }
        if rise_m.abs() > limit_m + config.tolerance {
            return Err(Unfit::TooHigh(rise_m));
        }
        let needed_m = feet.pair_width_m + 2.0 * config.side_room;
        if width_m < needed_m {
            return Err(Unfit::TooNarrow(width_m, needed_m));
        }
        let set = config.set_for(rise_m);
        let least_heel_m = set.front_x_limit;
        let heel_m = match onward {
            Onward::Level if rise_m < 0.0 => {
                least_heel_m.max(config.level_x) + config.tuning.spare_below
            }
            Onward::Level => least_heel_m.max(config.level_x),
            Onward::Edge {
                depth_m,
                rise_m: next_m,
            } => {
                let next = config.set_for(next_m);
                let needed_m = least_heel_m + feet.length_m - next.back_x_limit;
                if depth_m < needed_m - config.tolerance {
                    let basin = rise_m < 0.0 && next_m > 0.0;
                    return Err(if basin {
                        Unfit::GapTooShort(depth_m, needed_m)
                    } else {
                        Unfit::TreadTooShort(depth_m, needed_m)
                    });
                }
                let desired_m = depth_m + next.back_x_desired - feet.length_m;
                desired_m.max(least_heel_m)
            }
        };
        Ok(Self { heel_m })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const FEET: Feet = Feet {
        length_m: 0.105,
        pair_width_m: 0.16,
        stance_m: 0.085,
    };

    fn on_stair(rise_m: f64, onward: Onward) -> Result<Footing, Unfit> {
        Footing::on_stair(&ClimbingConfig::default(), &FEET, rise_m, 0.33, onward)
    }

    fn edge(depth_m: f64, rise_m: f64) -> Onward {
        Onward::Edge { depth_m, rise_m }
    }

    #[test]
    fn the_heel_is_on_the_front_edge_of_a_tread_of_12_cm_and_of_a_sill_of_9() {
        let tread = on_stair(0.03, edge(0.12, 0.03)).unwrap();
        assert_relative_eq!(tread.heel_m, 0.0, epsilon = 1e-12);
        let sill = on_stair(0.038, edge(0.09, -0.038)).unwrap();
        assert_relative_eq!(sill.heel_m, 0.0, epsilon = 1e-12);
    }

    #[test]
    fn on_a_landing_the_heels_are_where_they_are_told_to_be() {
        let short = ClimbingConfig {
            level_x: -0.02,
            ..ClimbingConfig::default()
        };
        for (rise_m, heel_m, usual_m) in [(0.03, -0.02, 0.015), (-0.03, 0.025, 0.025)] {
            let told = Footing::on_stair(&short, &FEET, rise_m, 0.33, Onward::Level).unwrap();
            assert_relative_eq!(told.heel_m, heel_m);
            let usual = on_stair(rise_m, Onward::Level).unwrap();
            assert_relative_eq!(usual.heel_m, usual_m);
        }
    }

    #[test]
    fn a_basin_is_entered_from_125_mm_on() {
        assert!(on_stair(-0.03, edge(0.126, 0.03)).is_ok());
        let refused = on_stair(-0.03, edge(0.122, 0.03)).unwrap_err();
        assert!(matches!(refused, Unfit::GapTooShort(..)));
    }

    #[test]
    fn a_step_of_50_mm_is_taken_and_one_of_55_is_not() {
        for sign in [1.0, -1.0] {
            assert!(on_stair(sign * 0.05, Onward::Level).is_ok());
            assert!(matches!(
                on_stair(sign * 0.055, Onward::Level),
                Err(Unfit::TooHigh(_))
            ));
        }
    }
}
