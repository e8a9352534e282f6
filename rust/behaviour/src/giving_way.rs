//! What a robot does about what comes towards it, whatever it was about to do: it looks there, waits, and steps out of the way.

mod mover;
mod trail;

#[cfg(test)]
mod tests;

use std::f64::consts::TAU;

use geometry::{PlanarPose, distance_m};
use robot::Extent;
use settings::{ConfigError, NOT_NEGATIVE, POSITIVE, Table, settings, within};
use terrain::support::{is_level_floor, is_roomy};

pub use mover::Mover;
use trail::OwnTrail;

use crate::{Decision, Gaze, Motion, Situation, Velocity};

settings! {
    /// Giving way to what moves.
    pub struct GivingWayConfig("navigation.giving_way") {
        /// The robot steps out of the way of what comes with this speed.
        pace: f64 = 0.1, "m/s", POSITIVE;
        /// It steps so far at most; 0: it stands and waits.
        farthest: f64 = 0.4, "m", within(0.0, 10.0);
        /// It steps to where what comes will pass with so much more room than has to be.
        spare: f64 = 0.08, "m", NOT_NEGATIVE;
        /// It takes so long from the order to step until it moves.
        delay: f64 = 0.6, "s", NOT_NEGATIVE;
        /// It looks for places in so many directions.
        directions: u32 = 16, "1", within(1.0, 360.0);
        /// It looks at what may move and is no further away; 0: it looks where it was about to.
        look: f64 = 2.5, "m", NOT_NEGATIVE;
        /// It stands while what may move and is not known yet is no further away.
        wary: f64 = 1.2, "m", NOT_NEGATIVE;
        /// It looks no further to each side than this.
        look_aside: f64 = 1.3, "rad", NOT_NEGATIVE;
    }
}

/// Gives way to what moves.
#[derive(Debug, Clone)]
pub struct GivingWay {
    config: GivingWayConfig,
    radius_m: f64,
    foot_side_m: f64,
    /// Heights that differ by less are one level, m.
    same_m: f64,
    trail: OwnTrail,
    /// Where it steps to, m in the map frame.
    to_m: Option<[f64; 2]>,
    /// The last frame that it thought about.
    frame_ns: Option<u64>,
}

impl GivingWay {
    /// Of a robot of this size, to which heights are one level that differ by less than `same_m`.
    pub fn new(config: GivingWayConfig, size: &Extent, same_m: f64) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            config,
            radius_m: size.radius,
            foot_side_m: size.foot_side,
            same_m,
            trail: OwnTrail::default(),
            to_m: None,
            frame_ns: None,
        })
    }

    /// Changes a decision where something comes: with the camera so high above the ground, m. Footsteps that were listed are taken, and who is at its last
    /// goal, or has given up, stays there.
    pub fn change(
        &mut self,
        decision: &mut Decision,
        situation: &Situation<'_>,
        (movers, eye_m): (&[Mover], f64),
    ) {
        let map_from_robot = &situation.estimate.map_from_robot;
        let origin = map_from_robot.origin().inner;
        let pose = PlanarPose::new(origin.x, origin.y, map_from_robot.yaw_rad());
        let ground_m = origin.z;
        let here_m = [pose.x_m, pose.y_m];
        let cell_m = situation.view.lattice.cell_m;
        let kept = (2.0 * self.config.farthest / cell_m).ceil() as usize + 1;
        (self.trail).note([pose.x_m, pose.y_m, ground_m], cell_m, kept);
        if movers.is_empty() || decision.outcome.is_some() {
            self.to_m = None;
            return;
        }
        if let Some(gaze) = self.look(movers, &pose, eye_m) {
            decision.command.gaze = gaze;
        }
        let coming: Vec<&Mover> = movers
            .iter()
            .filter(|mover| mover.is_sure && mover.comes(here_m))
            .collect();
        let walks = match decision.command.motion {
            Motion::Walk(velocity) => Some(velocity),
            Motion::Stand => None,
            Motion::Footsteps(_) => return,
        };
        let standing_m = self.clearance_m(&coming, &|_| here_m);
        let stepping_m = if self.to_m.is_some() {
            self.config.spare
        } else {
            0.0
        };
        if standing_m < stepping_m {
            self.step_aside(situation, (&pose, ground_m), &coming);
        } else {
            self.to_m = None;
        }
        let steps = self
            .to_m
            .and_then(|to_m| self.steps(&pose, to_m, cell_m / 2.0));
        let on = |velocity: Velocity, time_s: f64| {
            let (x_m, y_m) = pose.apply(velocity.x_mps * time_s, velocity.y_mps * time_s);
            [x_m, y_m]
        };
        if let Some(velocity) = steps {
            decision.command.motion = Motion::Walk(velocity);
            decision.state = "give_way";
        } else if let Some(velocity) = walks
            && (standing_m < stepping_m
                || self.clearance_m(&coming, &|time_s| on(velocity, time_s)) < 0.0
                || self.is_wary(movers, here_m))
        {
            decision.command.motion = Motion::Stand;
            decision.state = "stop";
        }
    }

    /// Whether something is near of which it is not known yet whether it moves.
    fn is_wary(&self, movers: &[Mover], here_m: [f64; 2]) -> bool {
        let wary_m = self.config.wary;
        let near = |mover: &Mover| distance_m(mover.places_m[0], here_m) < wary_m;
        movers.iter().any(|mover| !mover.is_sure && near(mover))
    }

    /// Thinks, once a frame, about where to step from what comes.
    fn step_aside(
        &mut self,
        situation: &Situation<'_>,
        (pose, ground_m): (&PlanarPose, f64),
        coming: &[&Mover],
    ) {
        let goal = situation.goal;
        let off_m = distance_m([pose.x_m, pose.y_m], [goal.x_m, goal.y_m]);
        if situation.last_goal && off_m <= goal.radius_m {
            self.to_m = None;
        } else if self.frame_ns != situation.last_frame_ns {
            self.to_m = self.best_place_m(situation, (pose, ground_m), coming);
            self.frame_ns = situation.last_frame_ns;
        }
    }

    /// How much room, beside what has to be, all that comes leaves to a robot that is at these places at these times, m.
    fn clearance_m(&self, coming: &[&Mover], at: &dyn Fn(f64) -> [f64; 2]) -> f64 {
        let nearest_m = coming.iter().map(|mover| mover.clearance_m(at));
        nearest_m.fold(f64::INFINITY, f64::min) - self.radius_m
    }

    /// The nearest place to step to that leaves room enough, or as much as there is; none where the robot is as well off, or would be touched all the same:
    /// who stands on both feet then falls less.
    fn best_place_m(
        &self,
        situation: &Situation<'_>,
        (pose, ground_m): (&PlanarPose, f64),
        coming: &[&Mover],
    ) -> Option<[f64; 2]> {
        let config = &self.config;
        let here_m = [pose.x_m, pose.y_m];
        let cell_m = situation.view.lattice.cell_m;
        let delay_s = if self.to_m.is_some() {
            0.0
        } else {
            config.delay
        };
        let room_m = |direction: [f64; 2], away_m: f64| {
            let at = |time_s: f64| {
                let gone_m = ((time_s - delay_s) * config.pace).clamp(0.0, away_m);
                [0, 1].map(|axis| here_m[axis] + gone_m * direction[axis])
            };
            self.clearance_m(coming, &at).min(config.spare)
        };
        let kept_m = coming.iter().map(|mover| mover.room_m);
        let kept_m = kept_m.fold(f64::INFINITY, f64::min);
        let mut best = (room_m([0.0; 2], 0.0).max(-kept_m), None);
        let pieces = (config.farthest / cell_m) as u32;
        for piece in 1..=pieces {
            let away_m = f64::from(piece) * cell_m;
            for number in 0..config.directions {
                let (sin, cos) =
                    libm::sincos(TAU * f64::from(number) / f64::from(config.directions));
                let place = |away_m: f64| [here_m[0] + away_m * cos, here_m[1] + away_m * sin];
                let free = || {
                    (1..=piece).all(|piece| {
                        let place_m = place(f64::from(piece) * cell_m);
                        self.may_stand(situation, place_m, (pose.yaw_rad, ground_m))
                    })
                };
                let found_m = room_m([cos, sin], away_m);
                if found_m > best.0 && free() {
                    best = (found_m, Some(place(away_m)));
                }
            }
        }
        best.1
    }

    /// Whether nothing stands at a place, m, and both feet have floor of the robot's level there, or had.
    fn may_stand(
        &self,
        situation: &Situation<'_>,
        place_m: [f64; 2],
        (heading_rad, ground_m): (f64, f64),
    ) -> bool {
        let view = situation.view;
        let middle = PlanarPose::new(place_m[0], place_m[1], heading_rad);
        let side_m = self.foot_side_m;
        let level_m = (ground_m, self.same_m);
        is_roomy(view, place_m, self.radius_m)
            && (self.trail.was_at(place_m, level_m, side_m)
                || [-side_m, 0.0, side_m].iter().all(|&aside_m| {
                    let (x_m, y_m) = middle.apply(0.0, aside_m);
                    is_level_floor(view, [x_m, y_m], ground_m, self.same_m)
                }))
    }

    /// Steps towards a place; none once it is no further away than this, m.
    fn steps(&self, pose: &PlanarPose, to_m: [f64; 2], reached_m: f64) -> Option<Velocity> {
        let (x_m, y_m) = pose.inverse().apply(to_m[0], to_m[1]);
        let away_m = geometry::hypot(x_m, y_m);
        let share = self.config.pace / away_m;
        (away_m > reached_m).then_some(Velocity {
            x_mps: share * x_m,
            y_mps: share * y_m,
            yaw_radps: 0.0,
        })
    }

    /// Where to look: at the foot of the nearest thing that comes, or of which it is not known yet.
    fn look(&self, movers: &[Mover], pose: &PlanarPose, eye_m: f64) -> Option<Gaze> {
        let here_m = [pose.x_m, pose.y_m];
        let gaze = |mover: &Mover| {
            let (x_m, y_m) = pose
                .inverse()
                .apply(mover.places_m[0][0], mover.places_m[0][1]);
            let away_m = geometry::hypot(x_m, y_m);
            let gaze = Gaze {
                pan_rad: libm::atan2(y_m, x_m),
                down_rad: libm::atan2(eye_m, away_m),
            };
            (away_m, gaze)
        };
        movers
            .iter()
            .filter(|mover| !mover.is_sure || mover.comes(here_m))
            .map(gaze)
            .filter(|(away_m, gaze)| {
                *away_m < self.config.look && gaze.pan_rad.abs() < self.config.look_aside
            })
            .min_by(|(one_m, _), (other_m, _)| one_m.total_cmp(other_m))
            .map(|(_, gaze)| gaze)
    }
}
