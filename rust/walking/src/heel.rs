//! The heel of the foot that is left behind on the upper of two levels lifts where its ankle bends no further: the sole turns about its front
//! edge instead of being pressed into the ground by it.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use robot::{Body, LinkPoses, Side};

use crate::config::GaitConfig;
use crate::error::WalkError;
use crate::gait::Gait;
use crate::leg::LegSolver;
use crate::phase::GaitPhase;
use crate::tuning::HeelTuning;

/// A sole that is to lie level.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LevelSole {
    pub(crate) side: Side,
    /// Where it is to be.
    pub(crate) torso_from_sole: Isometry3<f64>,
    /// Front end of what bears of it, m from its middle.
    pub(crate) front_m: f64,
}

/// How far the heel is lifted.
#[derive(Debug, Clone, Default)]
pub(crate) struct Heel {
    half_sole_m: f64,
    tuning: HeelTuning,
    angles_rad: Vec<f64>,
    poses: LinkPoses,
}

impl Heel {
    pub(crate) fn new(config: &GaitConfig, half_sole_m: f64) -> Self {
        Self {
            half_sole_m,
            tuning: config.tuning.heel.clone(),
            ..Self::default()
        }
    }

    /// The foot that stands higher than the other one by more than its ankle, and behind it, or has just left from there.
    pub(crate) fn behind(gait: &Gait, legs: &[LegSolver; 2]) -> Option<Side> {
        let [left, right] = &gait.feet;
        let side = if right.z_m > left.z_m {
            Side::Right
        } else {
            Side::Left
        };
        let (upper, lower) = (&gait.feet[side.index()], &gait.feet[side.other().index()]);
        let ahead_m = upper.planar.relative(&lower.planar).x_m;
        let carries = match &gait.phase {
            GaitPhase::Standing => false,
            GaitPhase::Double { .. } => true,
            GaitPhase::Single { swing, .. } => swing.side == side,
        };
        let high = upper.z_m - lower.z_m > legs[side.index()].ankle_height_m();
        (carries && high && ahead_m > 0.0).then_some(side)
    }

    /// Where the sole is put in the torso: turned about the front edge of what bears of it, as far as the leg's joints ask for.
    /// `rest_rad`: all joints, those of the other parts as they are.
    pub(crate) fn lifted(
        &mut self,
        body: &Body,
        leg: &LegSolver,
        level: &LevelSole,
        rest_rad: &[f64],
    ) -> Result<Isometry3<f64>, WalkError> {
        self.angles_rad.clear();
        self.angles_rad.extend_from_slice(rest_rad);
        let edge = Translation3::new(level.front_m.min(self.half_sole_m), 0.0, 0.0);
        let (mut lifted_rad, mut before) = (0.0, None);
        let mut sole = level.torso_from_sole;
        for _ in 0..self.tuning.times {
            let left_rad = self.left_rad(body, leg, level.side, &sole)?;
            if left_rad < self.tuning.least {
                break;
            }
            // Secant method, the first time with the slope of a foot that turns about its ankle.
            let slope = before.map_or(1.0, |(before_rad, before_left_rad): (f64, f64)| {
                ((before_left_rad - left_rad) / (lifted_rad - before_rad)).clamp(0.5, 1.0)
            });
            before = Some((lifted_rad, left_rad));
            lifted_rad = (lifted_rad + left_rad / slope).min(self.tuning.most);
            let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), lifted_rad);
            sole = level.torso_from_sole * edge * turn * edge.inverse();
        }
        Ok(sole)
    }

    /// By how much the joints turn the toes of a sole further down that is to be at `torso_from_sole`, rad.
    fn left_rad(
        &mut self,
        body: &Body,
        leg: &LegSolver,
        side: Side,
        torso_from_sole: &Isometry3<f64>,
    ) -> Result<f64, WalkError> {
        let mut near_rad = *leg.rest_rad();
        for (near, &joint) in near_rad.iter_mut().zip(leg.joints()) {
            *near = self.angles_rad[joint];
        }
        let solution = leg.solve(torso_from_sole, &near_rad);
        if solution.reached {
            return Ok(0.0);
        }
        for (&joint, &angle) in leg.joints().iter().zip(&solution.angles_rad) {
            self.angles_rad[joint] = angle;
        }
        body.pose_links(&self.angles_rad, &mut self.poses)?;
        let comes_to = body.torso_from_sole(&self.poses, side).rotation;
        Ok((torso_from_sole.rotation.inverse() * comes_to)
            .scaled_axis()
            .y)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::footsteps::FootstepPlanner;
    use crate::phase::{Manner, Swing};
    use crate::test_biped::{config, description, foot_at};

    const HALF_M: f64 = 0.05;
    const LEFT_ANKLE_PITCH: usize = 5;

    /// The biped with a left ankle that bends by 1 rad.
    fn biped() -> Body {
        let mut described = description();
        let joint = described.links[LEFT_ANKLE_PITCH].joint.as_mut().unwrap();
        joint.range = [-1.0, 1.0];
        Body::new(described).unwrap()
    }

    fn legs() -> [LegSolver; 2] {
        let (body, config) = (biped(), config());
        Side::BOTH.map(|side| {
            LegSolver::new(&body, side, config.max_extension, &config.tuning.leg).unwrap()
        })
    }

    #[test]
    fn only_a_foot_that_stays_behind_on_a_much_higher_level_lifts_its_heel() {
        let (body, config, legs) = (biped(), config(), legs());
        let side_of = |upper_x_m: f64, upper_m: f64, phase: Option<Side>| {
            let (mut left, right) = (foot_at(upper_x_m, 0.0425), foot_at(0.0, -0.0425));
            left.z_m = upper_m;
            let planner = FootstepPlanner::new(&config, &body);
            let mut gait = Gait::new(&config, planner, [left, right]);
            gait.phase = match phase {
                None => Gait::shift(gait.middle(), None, 1.0),
                Some(side) => GaitPhase::Single {
                    elapsed_s: 0.1,
                    duration_s: 1.0,
                    swing: Swing::new(side, Manner::Careful, gait.feet[side.index()], right),
                },
            };
            Heel::behind(&gait, &legs)
        };
        assert_eq!(side_of(-0.1, 0.08, None), Some(Side::Left));
        assert_eq!(side_of(-0.1, 0.08, Some(Side::Left)), Some(Side::Left));
        assert_eq!(side_of(-0.1, 0.08, Some(Side::Right)), None);
        assert_eq!(side_of(0.1, 0.08, None), None);
        assert_eq!(side_of(-0.1, 0.03, None), None);
    }

    /// Where a left sole that should lie level at this place is put, and where the leg's joints bring it.
    fn put(torso_from_sole: &Isometry3<f64>) -> (Isometry3<f64>, Isometry3<f64>) {
        let (body, [leg, _]) = (biped(), legs());
        let mut heel = Heel::new(&config(), HALF_M);
        let mut joints = body.description().stand.clone();
        let level = LevelSole {
            side: Side::Left,
            torso_from_sole: *torso_from_sole,
            front_m: f64::INFINITY,
        };
        let wanted = heel.lifted(&body, &leg, &level, &joints).unwrap();
        let found = leg.solve(&wanted, leg.rest_rad());
        for (&joint, &angle) in leg.joints().iter().zip(&found.angles_rad) {
            joints[joint] = angle;
        }
        let mut poses = LinkPoses::default();
        body.pose_links(&joints, &mut poses).unwrap();
        (wanted, body.torso_from_sole(&poses, Side::Left))
    }

    #[test]
    fn a_sole_that_the_ankle_cannot_hold_level_turns_about_its_front_edge() {
        let legs = legs();
        let hip = legs[0].hip();
        let under = |back_m: f64, below_m: f64| {
            Isometry3::translation(hip.x - back_m, hip.y, hip.z - below_m)
        };
        let level = under(0.0, 0.2);
        assert_eq!(put(&level).0, level);
        let far_behind = under(0.08, 0.18);
        let (wanted, comes_to) = put(&far_behind);
        let edge = Point3::new(HALF_M, 0.0, 0.0);
        assert!((wanted * edge - far_behind * edge).norm() < 1e-12);
        let missed_m = (comes_to * edge - far_behind * edge).norm();
        assert!(missed_m < 5e-4, "{missed_m}");
        assert!(wanted.rotation.angle() > 0.05, "{wanted}");
    }
}
