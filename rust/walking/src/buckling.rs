//! A listed step during which the leg that carries gives way: motors that are weaker than they are said to be, or a body that is heavier.
//!
//! A leg that cannot bear the robot shows it at once, while the other foot has hardly left: a joint falls behind what it is told, further
//! and further. Half a second later the robot lies. The foot goes back to where it left, both legs carry again, and the list is given up.

use behaviour::Misstep;
use nalgebra::Vector2;
use robot::{Body, Side};
use sensing::Observation;

use crate::dcm_walker::DcmWalker;
use crate::gait::Gait;
use crate::phase::{CarefulLanding, GaitPhase, Manner};
use crate::swing;
use crate::targets::JointTargets;

/// How far the joint of each leg that is furthest from what it was told is from that, rad.
fn behind_rad(body: &Body, told: &JointTargets, observation: &Observation) -> [f64; 2] {
    Side::BOTH.map(|side| {
        let joints = body.leg_joints(side).iter();
        let read_rad = &observation.joint_positions_rad;
        let off_rad = joints.map(|&joint| (told.positions_rad[joint] - read_rad[joint]).abs());
        off_rad.fold(0.0, f64::max)
    })
}

impl DcmWalker {
    /// Puts a careful foot down again because of the DCM's `error` or of a leg that buckles.
    pub(crate) fn put_down_in_time(&mut self, error: &Vector2<f64>, observation: &Observation) {
        self.gait.catch_tipping(error);
        let behind_rad = behind_rad(&self.body, &self.targets, observation);
        self.gait.catch_buckling(behind_rad);
    }
}

impl Gait {
    /// Puts a careful foot that has not gone anywhere yet back to where it left when the leg that carries gives way; `behind_rad` says how far the
    /// joint of each leg that is furthest from what it was told is from that.
    pub(crate) fn catch_buckling(&mut self, behind_rad: [f64; 2]) {
        let GaitPhase::Single {
            elapsed_s, swing, ..
        } = &self.phase
        else {
            return;
        };
        let carries: Side = swing.side.other();
        let share = elapsed_s / swing.in_air_s(&self.config);
        let tuning = &self.config.tuning;
        let gives_way = behind_rad[carries.index()] > tuning.buckling.behind;
        let has_left = swing::careful_travel(share, &tuning.swing) > tuning.tipping.gone_share
            || matches!(swing.landing, CarefulLanding::Found(_));
        if swing.manner != Manner::Careful || !gives_way || has_left {
            return;
        }
        self.listed.misstep = Some(Misstep::Buckled(carries));
        self.turn_round(Manner::Retreat);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::felt::KnownGround;
    use crate::phase::{FootPose, Swing};
    use crate::relief::Relief;
    use crate::task::Task;
    use crate::test_biped::{foot_at, on_its_way};

    /// The left foot on its way onto a stair, or in a walk, for this share of its time already.
    fn stepping(manner: Manner, share: f64) -> Gait {
        let (left, right) = (foot_at(0.0, 0.0425), foot_at(0.0, -0.0425));
        let to = FootPose {
            z_m: 0.04,
            ..foot_at(0.12, 0.0425)
        };
        on_its_way(Swing::new(Side::Left, manner, left, to), right, share)
    }

    #[test]
    fn a_foot_goes_back_to_where_it_left_and_the_list_is_given_up_when_the_other_leg_buckles() {
        let mut gait = stepping(Manner::Careful, 0.15);
        let height_m = gait.foot(Side::Left).z_m;
        gait.catch_buckling([0.0, 0.1]);
        assert_eq!(gait.stepping().misstep, Some(Misstep::Buckled(Side::Right)));
        assert!(height_m > 0.005 && gait.foot(Side::Left).z_m == height_m);
        for _ in 0..200 {
            gait.advance(0.01, Task::Stand(Relief::LEVEL), &KnownGround::AsTold);
        }
        assert!(gait.is_standing() && gait.gave_up());
        assert_eq!(gait.stepping().landed, 0);
        assert_eq!(gait.foot(Side::Left), foot_at(0.0, 0.0425));
    }

    #[test]
    fn legs_that_bear_feet_that_are_gone_and_walks_go_on() {
        for (manner, share, behind_rad) in [
            (Manner::Careful, 0.15, [0.0, 0.06]),
            (Manner::Careful, 0.15, [0.3, 0.0]),
            (Manner::Careful, 0.5, [0.0, 0.3]),
            (Manner::Placed, 0.15, [0.0, 0.3]),
            (Manner::Walk, 0.15, [0.0, 0.3]),
        ] {
            let mut gait = stepping(manner, share);
            let before = gait.phase;
            gait.catch_buckling(behind_rad);
            assert_eq!(gait.phase, before, "{manner:?} {share} {behind_rad:?}");
            assert_eq!(gait.stepping().misstep, None);
        }
    }
}
