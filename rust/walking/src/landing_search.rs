//! Where and when a foot has to land to catch a push.
//!
//! After Khadiv et al., "Walking control based on step timing adaptation" (IEEE T-RO 36, 2020): where the divergent component of
//! motion will be when the foot lands says where the foot has to land, and a step that comes sooner has less to catch. Place and
//! time are sought over a few times, not by a quadratic programme: there is one number to choose.

use geometry::PlanarPose;
use nalgebra::{Vector2, Vector3};

use crate::balance::Balance;
use crate::config::GaitConfig;
use crate::felt::Felt;
use crate::footsteps::FootstepPlanner;
use crate::gait::Gait;
use crate::phase::{FootPose, GaitReference, Swing};
use crate::support::Soles;
use crate::task::Task;

/// What a tick knows of the balance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Falling<'a> {
    /// The measured divergent component of motion, m.
    pub(crate) dcm: Vector2<f64>,
    /// The measured centre of mass over the ground, m.
    pub(crate) com: Vector2<f64>,
    /// Reference of the divergent component of motion, m.
    pub(crate) reference: Vector2<f64>,
    /// Natural frequency of the pendulum, 1/s.
    pub(crate) omega: f64,
    /// Where soles push.
    pub(crate) soles: &'a Soles,
    /// What the legs have to do.
    pub(crate) task: Task<'a>,
    /// Loads on the feet, N.
    pub(crate) loads_n: [f64; 2],
    /// Share of the weight that the feet carry.
    pub(crate) carried: f64,
    /// Where the soles are, m.
    pub(crate) soles_m: [Vector3<f64>; 2],
    /// Time since the last tick, s.
    pub(crate) passed_s: f64,
}

impl<'a> Falling<'a> {
    /// Where the robot is by `balance`, and where it was to be.
    pub(crate) fn new(
        balance: &Balance,
        reference: &GaitReference,
        felt: &Felt,
        soles: &'a Soles,
        task: Task<'a>,
        passed_s: f64,
    ) -> Self {
        Self {
            dcm: balance.dcm(),
            com: balance.com,
            reference: reference.dcm,
            omega: balance.omega,
            soles,
            task,
            loads_n: felt.loads_n,
            carried: balance.carried,
            soles_m: felt.soles_m,
            passed_s,
        }
    }
}

/// A step as it may be taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Catch {
    /// Where the foot lands.
    pub(crate) to: PlanarPose,
    /// Time until then, s.
    pub(crate) left_s: f64,
    /// How far the step misses what it had to catch, and what it takes, m.
    pub(crate) cost_m: f64,
    /// How far over the outer edge of the sole that stands the robot falls, whenever the foot lands, m.
    pub(crate) outwards_m: f64,
}

/// Seeks landings.
#[derive(Debug, Clone)]
pub(crate) struct LandingSearch {
    config: GaitConfig,
    pub(crate) planner: FootstepPlanner,
}

/// What a swing has to bring about, whenever it lands.
struct Sought<'a> {
    gait: &'a Gait,
    falling: &'a Falling<'a>,
    swing: &'a Swing,
    /// Time that the step has to go by its clock, s.
    left_s: f64,
    /// From the landing to where the divergent component of motion is to be then, m.
    ahead: Vector2<f64>,
}

impl LandingSearch {
    /// For this gait.
    pub(crate) fn new(config: &GaitConfig, planner: FootstepPlanner) -> Self {
        Self {
            config: config.clone(),
            planner,
        }
    }

    /// The best place and time for a foot to land that has `left_s` to go by its clock.
    pub(crate) fn best(
        &self,
        gait: &Gait,
        falling: &Falling<'_>,
        swing: &Swing,
        left_s: f64,
    ) -> Catch {
        let tuning = &self.config.tuning.catching;
        let middle = gait.carrying_point(&gait.feet, swing);
        let reference = gait.reference(falling.omega, falling.task).dcm;
        let grown = libm::exp(falling.omega * left_s);
        let sought = Sought {
            gait,
            falling,
            swing,
            left_s,
            ahead: middle + (reference - middle) * grown - point(&swing.to.planar),
        };
        let (soonest_s, latest_s) = (left_s / tuning.hurry, left_s + tuning.wait / falling.omega);
        let mut best = self.at(&sought, soonest_s);
        for index in 1..tuning.times {
            let share = index as f64 / (tuning.times - 1) as f64;
            let other = self.at(&sought, soonest_s + (latest_s - soonest_s) * share);
            let outwards_m = best.outwards_m.min(other.outwards_m);
            if other.cost_m < best.cost_m {
                best = other;
            }
            best.outwards_m = outwards_m;
        }
        best
    }

    /// The step that lands after `time_s`.
    fn at(&self, sought: &Sought<'_>, time_s: f64) -> Catch {
        let tuning = &self.config.tuning.catching;
        let &Sought {
            falling,
            swing,
            ahead,
            ..
        } = sought;
        let stance = swing.side.other();
        let foot = &sought.gait.feet[stance.index()];
        let growth = libm::exp(falling.omega * time_s);
        let planned = &swing.planned.planar;
        let wanted = (falling.dcm * growth - point(planned) - ahead)
            / (growth - 1.0).max(self.config.tuning.capture.least_growth);
        let zmp = falling.soles.nearest(foot, stance, &wanted);
        let goal = zmp + (falling.dcm - zmp) * growth - ahead;
        let (nearest_m, _) = self.planner.lateral_limits_m(0.0);
        let across_m = foot.planar.inverse().apply(goal.x, goal.y).1 * swing.side.sign();
        let place = PlanarPose::new(goal.x, goal.y, planned.yaw_rad);
        let mut place = self.planner.within_catch(&foot.planar, &place, swing.side);
        let here = falling.soles_m[swing.side.index()].xy();
        let way = point(&place) - here;
        let reach_m = self.speed_mps(falling, tuning.stride) * time_s;
        let short = (reach_m / way.norm().max(1e-9)).min(1.0);
        (place.x_m, place.y_m) = (here.x + way.x * short, here.y + way.y * short);
        let missed_m = (goal - point(&place)).norm();
        let moved_m = place.distance_m(planned);
        let shifted = (time_s - sought.left_s).abs() * falling.omega;
        Catch {
            to: place,
            left_s: time_s,
            cost_m: missed_m
                + tuning.moving * moved_m
                + tuning.shifting * shifted * self.planner.half_sole_m().x,
            outwards_m: nearest_m - tuning.out * self.planner.leg_m - across_m,
        }
    }

    /// Where a foot in the air that is `here` is as far out as this from where it stands beside the other one, and as much higher as a
    /// stretched leg has it then.
    pub(crate) fn far_out(
        &self,
        gait: &Gait,
        swing: &Swing,
        here: &FootPose,
        out_m: f64,
    ) -> FootPose {
        let leg_m = self.planner.leg_m;
        let stance = gait.feet[swing.side.other().index()].planar;
        let mut out = stance.relative(&here.planar);
        let across_m = (out.y_m * swing.side.sign()).max(self.config.stance_width + out_m);
        out.y_m = swing.side.sign() * across_m;
        let level_m = (leg_m * leg_m - out_m * out_m).max(0.0).sqrt();
        FootPose {
            planar: stance.compose(&out),
            z_m: swing.planned.z_m + leg_m - level_m,
            ..swing.planned
        }
    }

    /// A speed of so many heights of the hips for each time constant of the pendulum.
    pub(crate) fn speed_mps(&self, falling: &Falling<'_>, speed: f64) -> f64 {
        speed * falling.omega * self.planner.leg_m
    }
}

fn point(pose: &PlanarPose) -> Vector2<f64> {
    Vector2::new(pose.x_m, pose.y_m)
}
