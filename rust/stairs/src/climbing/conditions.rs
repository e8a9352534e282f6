//! What must hold before a stair is stepped on (003, section V.C, Fig. 9).

use crate::{ClimbingConfig, Feet, Footing, Onward, Unfit};

/// A stair ahead, and what comes behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead {
    /// Height above the ground on which the robot stands, m; negative for a way down.
    pub rise_m: f64,
    /// What comes behind it.
    pub onward: Onward,
}

/// How the robot stands before the stair's front edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stand {
    /// The toes' place past the edge, m.
    pub toes_m: f64,
    /// Heading against square to the edge, rad.
    pub askew_rad: f64,
    /// From between the feet to the stair's left side, margin included, m.
    pub left_m: f64,
    /// From between the feet to the stair's right side, margin included, m.
    pub right_m: f64,
}

/// How exactly the robot must stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Of the toes' place, m.
    pub toes_m: f64,
    /// Of the heading, rad.
    pub askew_rad: f64,
}

/// Why a stair is not stepped on now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unready {
    /// The toes are not where they should be before the edge: their place and the right one, m.
    NotNear(f64, f64),
    /// The robot is not aligned with the edge, rad.
    NotAligned(f64),
    /// Too little room on the left: what there is and what is needed, m.
    NoRoomLeft(f64, f64),
    /// Too little room on the right: what there is and what is needed, m.
    NoRoomRight(f64, f64),
    /// The stair does not take the feet, wherever the robot stands.
    Unfit(Unfit),
}

/// Where the feet go if the stair can be stepped on as the robot stands now: a height within the limits, both feet placed
/// within `front_x_limit` of the stair's own set and `back_x_limit` of the next one's, the front edge near and aligned, room
/// on either side. What no other place would mend is told first.
pub fn conditions(
    config: &ClimbingConfig,
    feet: &Feet,
    ahead: &Ahead,
    stand: &Stand,
    tolerance: &Tolerance,
) -> Result<Footing, Unready> {
    let width_m = stand.left_m + stand.right_m;
    let footing = Footing::on_stair(config, feet, ahead.rise_m, width_m, ahead.onward);
    let footing = footing.map_err(Unready::Unfit)?;
    let toes_m = config.set_for(ahead.rise_m).approach_x;
    if (stand.toes_m - toes_m).abs() > tolerance.toes_m {
        return Err(Unready::NotNear(stand.toes_m, toes_m));
    }
    if stand.askew_rad.abs() > tolerance.askew_rad {
        return Err(Unready::NotAligned(stand.askew_rad));
    }
    let needed_m = 0.5 * feet.pair_width_m + config.side_room;
    if stand.left_m < needed_m {
        return Err(Unready::NoRoomLeft(stand.left_m, needed_m));
    }
    if stand.right_m < needed_m {
        return Err(Unready::NoRoomRight(stand.right_m, needed_m));
    }
    Ok(footing)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FEET: Feet = Feet {
        length_m: 0.105,
        pair_width_m: 0.16,
        stance_m: 0.085,
    };
    const TOLERANCE: Tolerance = Tolerance {
        toes_m: 0.012,
        askew_rad: 0.09,
    };

    fn check(ahead: Ahead, stand: Stand) -> &'static str {
        let config = ClimbingConfig::default();
        conditions(&config, &FEET, &ahead, &stand, &TOLERANCE).map_or_else(word, |_| "step")
    }

    const fn word(unready: Unready) -> &'static str {
        match unready {
            Unready::NotNear(..) => "not_near",
            Unready::NotAligned(_) => "not_aligned",
            Unready::NoRoomLeft(..) => "no_room_left",
            Unready::NoRoomRight(..) => "no_room_right",
            Unready::Unfit(unfit) => unfit.word(),
        }
    }

    /// S-M12: the stance before the edge, the room beside it and the depth of the tread, three cases each, up and down.
    #[test]
    fn every_combination_of_stance_room_and_depth_is_decided_right() {
        for (rise_m, toes_m, least_depth_m) in [(0.03, -0.015, 0.085), (-0.03, 0.015, 0.095)] {
            // The next step goes on the same way: heel limit of this set, toe limit of the next.
            for (depth_m, fits) in [
                (least_depth_m - 0.003, false),
                (least_depth_m + 0.002, true),
                (0.2, true),
            ] {
                for (off_m, near) in [(-0.02, false), (0.0, true), (0.02, false)] {
                    for (left_m, right_m, room) in [
                        (0.09, 0.24, "no_room_left"),
                        (0.165, 0.165, "step"),
                        (0.24, 0.09, "no_room_right"),
                    ] {
                        let ahead = Ahead {
                            rise_m,
                            onward: Onward::Edge { depth_m, rise_m },
                        };
                        let stand = Stand {
                            toes_m: toes_m + off_m,
                            askew_rad: 0.0,
                            left_m,
                            right_m,
                        };
                        let expected = match (fits, near) {
                            (false, _) => "tread_too_short",
                            (true, false) => "not_near",
                            (true, true) => room,
                        };
                        assert_eq!(check(ahead, stand), expected, "{ahead:?} {stand:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_set_of_the_next_step_limits_the_toes() {
        let stand = |toes_m| Stand {
            toes_m,
            askew_rad: 0.0,
            left_m: 0.2,
            right_m: 0.2,
        };
        // Up and down again over a sill: toes may hang over the edge by 25 mm, heels over the front edge by 25 mm.
        let sill = |depth_m| Ahead {
            rise_m: 0.038,
            onward: Onward::Edge {
                depth_m,
                rise_m: -0.038,
            },
        };
        assert_eq!(check(sill(0.056), stand(-0.015)), "step");
        assert_eq!(check(sill(0.052), stand(-0.015)), "tread_too_short");
        // Down and up again through a basin.
        let basin = |depth_m| Ahead {
            rise_m: -0.03,
            onward: Onward::Edge {
                depth_m,
                rise_m: 0.03,
            },
        };
        assert_eq!(check(basin(0.126), stand(0.015)), "step");
        assert_eq!(check(basin(0.122), stand(0.015)), "gap_too_short");
    }

    #[test]
    fn a_robot_that_is_not_aligned_waits_and_one_before_a_narrow_stair_refuses() {
        let level = Ahead {
            rise_m: 0.03,
            onward: Onward::Level,
        };
        let stand = Stand {
            toes_m: -0.015,
            askew_rad: 0.0,
            left_m: 0.16,
            right_m: 0.16,
        };
        assert_eq!(
            check(
                level,
                Stand {
                    askew_rad: 0.1,
                    ..stand
                }
            ),
            "not_aligned"
        );
        assert_eq!(
            check(
                level,
                Stand {
                    askew_rad: -0.1,
                    ..stand
                }
            ),
            "not_aligned"
        );
        assert_eq!(
            check(
                level,
                Stand {
                    left_m: 0.09,
                    right_m: 0.09,
                    ..stand
                }
            ),
            "too_narrow"
        );
    }

    #[test]
    fn heights_are_decided_within_the_error_of_their_measurement() {
        let stand = |rise_m: f64| Stand {
            toes_m: 0.015_f64.copysign(-rise_m),
            askew_rad: 0.0,
            left_m: 0.2,
            right_m: 0.2,
        };
        let decide = |rise_m| {
            check(
                Ahead {
                    rise_m,
                    onward: Onward::Level,
                },
                stand(rise_m),
            )
        };
        for sign in [1.0, -1.0] {
            for rise_m in [0.0105, 0.012, 0.015, 0.02, 0.03, 0.04, 0.05, 0.052] {
                assert_eq!(decide(sign * rise_m), "step", "{rise_m}");
            }
            for rise_m in [0.053, 0.055, 0.065] {
                assert_eq!(decide(sign * rise_m), "step_too_high", "{rise_m}");
            }
            assert_eq!(decide(sign * 0.009), "step_too_low", "that is floor");
        }
    }
}
