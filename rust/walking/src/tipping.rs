//! A careful step begun on a foot that does not lie flat: the sole rocks, and the robot tips over its inner edge.
//!
//! A step of a list is put where it was told, so that no landing can be moved to catch it, and the ankle cannot pull beyond the edge.
//! But such a tip shows while the foot has hardly left, and takes most of a second: time to put the foot down where it was, and to
//! begin again. One that shows later is over when the foot carries, which it does as soon as it has found the ground.

use geometry::PlanarPose;
use nalgebra::Vector2;

use crate::gait::Gait;
use crate::phase::{CarefulLanding, GaitPhase, Manner};
use crate::swing;

impl Gait {
    /// Where the DCM's `error` says that the robot tips towards a careful foot: one that has found the ground carries at once, and what that
    /// saves of its time is taken to shift the weight; one that has risen but not gone anywhere yet is put down again, and its step is
    /// taken anew after that.
    pub(crate) fn catch_tipping(&mut self, error: &Vector2<f64>) {
        let GaitPhase::Single {
            elapsed_s,
            duration_s,
            swing,
        } = &mut self.phase
        else {
            return;
        };
        let stance_yaw_rad = self.feet[swing.side.other().index()].planar.yaw_rad;
        let (ahead_m, left_m) = PlanarPose::new(0.0, 0.0, -stance_yaw_rad).apply(error.x, error.y);
        let towards_m = left_m * swing.side.sign();
        if !swing.manner.is_careful() || towards_m <= self.config.tip_error {
            return;
        }
        if matches!(swing.landing, CarefulLanding::Found(_)) {
            self.listed.early_s = (*duration_s - *elapsed_s).max(0.0);
            *elapsed_s = *duration_s;
            return;
        }
        let tuning = &self.config.tuning.tipping;
        let share = *elapsed_s / swing.in_air_s(&self.config);
        if swing.manner == Manner::Careful
            && swing::careful_travel(share, &self.config.tuning.swing) <= tuning.gone_share
            && self.listed.put_down < tuning.times
            && ahead_m.abs() < tuning.ahead_share * towards_m
        {
            self.listed.put_down += 1;
            self.turn_round(Manner::Retreat);
        }
    }
}

#[cfg(test)]
mod tests {
    use behaviour::{Footstep, StepManner};
    use robot::Side;

    use super::*;
    use crate::felt::KnownGround;
    use crate::phase::{FootPose, Swing};
    use crate::task::Task;
    use crate::test_biped::{foot_at, on_its_way};

    const STEP: [Footstep; 1] = [Footstep {
        side: Side::Left,
        manner: StepManner::Careful,
        pose: PlanarPose {
            x_m: 0.12,
            y_m: 0.0425,
            yaw_rad: 0.0,
        },
        height_m: 0.04,
        slope: [0.0; 2],
        bearing_m: [-0.05, 0.05],
    }];

    /// The left foot on its way onto a stair, for this share of its time already.
    fn climbing(share: f64) -> Gait {
        let (left, right) = (foot_at(0.0, 0.0425), foot_at(0.0, -0.0425));
        let to = FootPose {
            z_m: 0.04,
            ..foot_at(0.12, 0.0425)
        };
        let swing = Swing::new(Side::Left, Manner::Careful, left, to);
        on_its_way(swing, right, share)
    }

    fn manner(gait: &Gait) -> Option<Manner> {
        match &gait.phase {
            GaitPhase::Single { swing, .. } => Some(swing.manner),
            _ => None,
        }
    }

    #[test]
    fn a_foot_that_the_robot_tips_towards_is_put_down_where_it_was_and_the_step_begun_anew() {
        let mut gait = climbing(0.2);
        let height_m = gait.foot(Side::Left).z_m;
        gait.catch_tipping(&Vector2::new(0.0, 0.02));
        assert!(height_m > 0.01 && gait.foot(Side::Left).z_m == height_m);
        let mut down = false;
        for _ in 0..100 {
            gait.advance(0.01, Task::Steps(&STEP), &KnownGround::AsTold);
            if let GaitPhase::Double { next, .. } = &gait.phase {
                let next = next.unwrap();
                assert_eq!((next.side, next.manner), (Side::Left, Manner::Careful));
                assert_eq!((next.to.planar.x_m, next.to.z_m), (0.12, 0.04));
                down = true;
            }
        }
        assert!(down && manner(&gait) == Some(Manner::Careful));
        assert_eq!(gait.stepping().landed, 0);
        assert_eq!(gait.stepping().misstep, None);
    }

    #[test]
    fn a_foot_that_has_found_the_ground_carries_at_once_where_the_robot_tips_towards_it() {
        let carries_after_s = |y_m: f64| {
            let mut gait = climbing(0.9);
            let GaitPhase::Single {
                swing,
                elapsed_s,
                duration_s,
            } = &mut gait.phase
            else {
                panic!("the foot is on its way");
            };
            swing.landing = CarefulLanding::Found(0.04);
            let left_s = *duration_s - *elapsed_s;
            gait.catch_tipping(&Vector2::new(0.0, y_m));
            gait.advance(0.01, Task::Steps(&STEP), &KnownGround::AsTold);
            match gait.phase {
                GaitPhase::Double { duration_s, .. } => Some((left_s, duration_s)),
                _ => None,
            }
        };
        assert_eq!(carries_after_s(0.015), None);
        assert_eq!(carries_after_s(-0.03), None);
        let (left_s, shift_s) = carries_after_s(0.03).unwrap();
        let planned_s = crate::test_biped::config().shift_time;
        assert!(left_s > 0.1 && (shift_s - planned_s - left_s).abs() < 1e-9);
    }

    #[test]
    fn what_the_ankle_takes_back_and_what_the_foot_has_left_behind_let_the_step_go_on() {
        for (share, x_m, y_m) in [
            (0.2, 0.0, 0.015),
            (0.2, 0.0, -0.03),
            (0.2, 0.03, 0.0),
            (0.2, 0.02, 0.03),
            (0.5, 0.0, 0.03),
        ] {
            let mut gait = climbing(share);
            gait.catch_tipping(&Vector2::new(x_m, y_m));
            assert_eq!(manner(&gait), Some(Manner::Careful), "{share} {x_m} {y_m}");
        }
    }

    #[test]
    fn a_robot_that_tips_whatever_it_does_takes_the_step_at_last() {
        let mut gait = climbing(0.0);
        for _ in 0..1000 {
            gait.catch_tipping(&Vector2::new(0.0, 0.02));
            gait.advance(0.01, Task::Steps(&STEP), &KnownGround::AsTold);
        }
        assert_eq!(gait.stepping().landed, 1);
    }
}
