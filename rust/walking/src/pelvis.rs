//! Height of the hips: over the ground that carries as the gait says, lower where a leg would get too long, and smooth.
//!
//! The coming steps are played ahead, so that the hips are down when a foot has to reach down.

use nalgebra::Vector2;
use robot::Side;

use crate::config::GaitConfig;
use crate::felt::KnownGround;
use crate::gait::Gait;
use crate::lean::Lean;
use crate::leg::LegSolver;
use crate::phase::{FootPose, GaitReference};
use crate::task::Task;
use crate::trunk::{Trunk, TrunkPlace};
use crate::tuning::PelvisTuning;

/// What the hips' height is for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Course<'a> {
    /// The steps.
    pub(crate) gait: &'a Gait,
    /// What is to be done.
    pub(crate) task: Task<'a>,
    /// Natural frequency of the pendulum, 1/s.
    pub(crate) omega: f64,
    /// Reference of the centre of mass, m.
    pub(crate) com: Vector2<f64>,
}

/// The height of the torso's origin over the plan's ground.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pelvis {
    hip_height_m: f64,
    hip_stretch_rad: Option<f64>,
    speed_mps: f64,
    tuning: PelvisTuning,
    goal_m: f64,
    height_m: f64,
    rate_mps: f64,
    started: bool,
    lean: Lean,
}

impl Pelvis {
    /// `half_sole_m`: half of a sole's length.
    pub(crate) fn new(config: &GaitConfig, half_sole_m: f64) -> Self {
        Self {
            lean: Lean::new(config, half_sole_m),
            hip_height_m: config.hip_height,
            hip_stretch_rad: config.hip_stretch,
            speed_mps: config.hip_speed,
            tuning: config.tuning.pelvis.clone(),
            ..Self::default()
        }
    }

    /// Height of the torso's origin, m, and how far the torso leans forward, rad, for this tick. `feet`: where the feet are put now.
    pub(crate) fn place(
        &mut self,
        course: &Course<'_>,
        legs: &[LegSolver; 2],
        trunk: &Trunk,
        feet: &[FootPose; 2],
        passed_s: f64,
    ) -> (f64, f64) {
        let (apart_s, smooth_s) = (self.tuning.apart, self.tuning.smooth_time);
        let place = trunk.place(self.lean.rad);
        let over = course.com + place.from_com;
        let now_m = self.limit_m(legs, &place, feet, course.gait.ground_m(), &over);
        let mut goal_m = now_m;
        let mut gait = course.gait.clone();
        let mut com = course.com;
        let mut lean_rad = self
            .lean
            .needed_rad(&gait, legs, trunk, &com, |_| self.height_m);
        for moment in 1..=self.tuning.moments {
            gait.advance(apart_s, course.task, &KnownGround::AsTold);
            let GaitReference { dcm, .. } = gait.reference(course.omega, course.task);
            com += (dcm - com) * (1.0 - libm::exp(-course.omega * apart_s));
            let feet = Side::BOTH.map(|side| gait.foot(side));
            let limit = |place: &TrunkPlace| {
                self.limit_m(legs, place, &feet, gait.ground_m(), &(com + place.from_com))
            };
            let then_s = moment as f64 * apart_s;
            let needed_rad = self.lean.needed_rad(&gait, legs, trunk, &com, limit);
            let left_s = (then_s - self.tuning.late * smooth_s).max(0.0);
            lean_rad = lean_rad.max(self.lean.before_rad(needed_rad, left_s));
            let limit_m = limit(&trunk.place(self.lean.after_rad(needed_rad, then_s)));
            goal_m = goal_m.min(limit_m + self.speed_mps * left_s);
        }
        if !self.started {
            self.started = true;
            (self.goal_m, self.height_m) = (goal_m, goal_m);
        }
        let most_m = self.speed_mps * passed_s;
        self.goal_m += (goal_m - self.goal_m).clamp(-self.tuning.fall * most_m, most_m);
        // Critically damped, implicit in the rate.
        let stiff = passed_s / smooth_s;
        let pull = (self.goal_m - self.height_m) / smooth_s;
        self.rate_mps = (self.rate_mps + stiff * pull) / ((1.0 + stiff) * (1.0 + stiff));
        self.height_m += self.rate_mps * passed_s;
        self.lean.go(lean_rad, passed_s);
        (self.height_m, self.lean.rad)
    }

    /// The greatest height at which both soles are reached, the hips no higher over the ground than the gait says.
    fn limit_m(
        &self,
        legs: &[LegSolver; 2],
        trunk: &TrunkPlace,
        feet: &[FootPose; 2],
        ground_m: f64,
        over: &Vector2<f64>,
    ) -> f64 {
        let mut limit_m = f64::INFINITY;
        for side in Side::BOTH {
            let (leg, foot) = (&legs[side.index()], &feet[side.index()]);
            let hip = &trunk.hips[side.index()];
            let across = over + hip.xy() - leg.ankle_in_plan(&foot.planar);
            let reach_m = leg.max_length_m;
            let mut rise_m = (reach_m * reach_m - across.norm_squared()).max(0.0).sqrt();
            if let Some(stretch_rad) = self.hip_stretch_rad {
                let back_m = across.dot(&trunk.forward);
                let aside_m = across.perp(&trunk.forward);
                rise_m = rise_m.min(leg.stretched_m(back_m, aside_m, stretch_rad));
            }
            limit_m = limit_m
                .min(foot.z_m + leg.ankle_height_m() + rise_m - hip.z)
                .min(ground_m + self.hip_height_m - hip.z);
        }
        limit_m
    }
}
