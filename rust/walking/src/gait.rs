//! The sequence of steps: which foot stands, which moves, and what comes next.

use behaviour::{Motion, Velocity};
use geometry::PlanarPose;
use nalgebra::Vector2;
use robot::Side;

use crate::footsteps::FootstepPlanner;
use crate::{GaitConfig, swing};

/// A level foot on the ground: its sole's centre in the walker's own plan frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FootPose {
    /// Place and heading.
    pub planar: PlanarPose,
    /// Height, m.
    pub z_m: f64,
}

/// A foot on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// The foot.
    pub side: Side,
    /// Where it left.
    pub from: FootPose,
    /// Where it lands.
    pub to: FootPose,
    /// Where it was to land before any push.
    pub planned: FootPose,
}

/// What the feet do at the moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Phase {
    /// Both stand, no step is due.
    Standing,
    /// Both carry while the weight moves; then comes the step, if any.
    Double {
        /// Time in it, s.
        elapsed_s: f64,
        /// How long it takes, s.
        duration_s: f64,
        /// ZMP at its beginning, m.
        from: Vector2<f64>,
        /// The step behind it; without one the robot comes to stand.
        next: Option<Swing>,
    },
    /// One stands, one moves.
    Single {
        /// Time in it, s.
        elapsed_s: f64,
        /// How long it takes, s.
        duration_s: f64,
        /// The foot that moves.
        swing: Swing,
    },
}

/// The reference at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Zero moment point, m.
    pub zmp: Vector2<f64>,
    /// Divergent component of motion, m.
    pub dcm: Vector2<f64>,
}

/// Where feet and weight are in the sequence of steps.
#[derive(Debug, Clone)]
pub struct Gait {
    pub(crate) config: GaitConfig,
    planner: FootstepPlanner,
    /// Where each foot stands, or left.
    pub feet: [FootPose; 2],
    /// What they do.
    pub phase: Phase,
    /// Steps landed so far.
    pub steps_taken: u64,
    listed: usize,
    list_origin: PlanarPose,
    last_swing: Side,
}

impl Gait {
    /// Standing on these feet.
    pub fn new(config: &GaitConfig, planner: FootstepPlanner, feet: [FootPose; 2]) -> Self {
        Self {
            config: config.clone(),
            planner,
            feet,
            phase: Phase::Standing,
            steps_taken: 0,
            listed: 0,
            list_origin: PlanarPose::default(),
            last_swing: Side::Right,
        }
    }

    /// Point under a foot where it is to carry: towards the other foot by `support_inward`.
    pub fn support_point(&self, foot: &FootPose, side: Side) -> Vector2<f64> {
        let (x, y) = foot
            .planar
            .apply(0.0, -side.sign() * self.config.support_inward);
        Vector2::new(x, y)
    }

    /// Midway between the feet's supporting points.
    pub fn middle(&self) -> Vector2<f64> {
        let points = Side::BOTH.map(|side| self.support_point(&self.feet[side.index()], side));
        0.5 * (points[0] + points[1])
    }

    /// Steps of the list that landed.
    pub const fn listed(&self) -> usize {
        self.listed
    }

    /// Frame between the places where the feet stand.
    pub fn center(&self) -> PlanarPose {
        Self::center_of(&self.feet)
    }

    /// Height of the ground that carries, m.
    pub fn ground_m(&self) -> f64 {
        match &self.phase {
            Phase::Single { swing, .. } => self.feet[swing.side.other().index()].z_m,
            Phase::Standing | Phase::Double { .. } => self.feet[0].z_m.min(self.feet[1].z_m),
        }
    }

    /// Frame between two feet.
    pub fn center_of(feet: &[FootPose; 2]) -> PlanarPose {
        let [left, right] = [feet[0].planar, feet[1].planar];
        let turn = geometry::angle_between(right.yaw_rad, left.yaw_rad);
        PlanarPose::new(
            0.5 * (left.x_m + right.x_m),
            0.5 * (left.y_m + right.y_m),
            right.yaw_rad + 0.5 * turn,
        )
    }

    /// Advances the sequence by `passed_s` of its own clock. A command takes effect when the next step is chosen.
    pub fn advance(&mut self, passed_s: f64, motion: &Motion) {
        match &mut self.phase {
            Phase::Standing => {
                if !matches!(motion, Motion::Footsteps(_)) {
                    self.listed = 0;
                }
                if let Some(next) = self.first_swing(motion) {
                    self.phase = Self::shift(self.middle(), Some(next), self.config.shift_time);
                }
            }
            Phase::Double {
                elapsed_s,
                duration_s,
                next,
                ..
            } => {
                *elapsed_s += passed_s;
                if *elapsed_s >= *duration_s {
                    let over_s = *elapsed_s - *duration_s;
                    self.phase = match *next {
                        None => Phase::Standing,
                        Some(swing) => Phase::Single {
                            elapsed_s: over_s,
                            duration_s: self.config.step_time - self.config.double_support,
                            swing,
                        },
                    };
                } else if next.is_none()
                    && let Some(swing) = self.first_swing(motion)
                {
                    let zmp = self.zmp();
                    self.phase = Self::shift(zmp, Some(swing), self.config.shift_time);
                }
            }
            Phase::Single {
                elapsed_s,
                duration_s,
                swing,
            } => {
                *elapsed_s += passed_s;
                if *elapsed_s >= *duration_s {
                    let swing = *swing;
                    self.land(&swing, motion);
                }
            }
        }
    }

    fn land(&mut self, swing: &Swing, motion: &Motion) {
        self.feet[swing.side.index()] = swing.to;
        self.steps_taken += 1;
        self.last_swing = swing.side;
        if matches!(motion, Motion::Footsteps(_)) {
            self.listed += 1;
        }
        let stance = swing.side.other();
        let zmp = self.support_point(&self.feet[stance.index()], stance);
        let next = self.swing_of(stance, motion);
        let duration = match next {
            Some(_) => self.config.double_support,
            None => self.config.shift_time,
        };
        self.phase = Self::shift(zmp, next, duration);
    }

    const fn shift(from: Vector2<f64>, next: Option<Swing>, duration_s: f64) -> Phase {
        Phase::Double {
            elapsed_s: 0.0,
            duration_s,
            from,
            next,
        }
    }

    /// The first step out of a stand.
    fn first_swing(&mut self, motion: &Motion) -> Option<Swing> {
        match motion {
            Motion::Stand => None,
            Motion::Walk(velocity) => {
                let turning = velocity.y_mps + 0.1 * velocity.yaw_radps;
                let side = if turning > 0.0 {
                    Side::Left
                } else if turning < 0.0 {
                    Side::Right
                } else {
                    self.last_swing.other()
                };
                self.swing_of(side, motion)
            }
            Motion::Footsteps(steps) => {
                if self.listed == 0 {
                    self.list_origin = self.center();
                }
                let side = steps.get(self.listed)?.side;
                self.swing_of(side, motion)
            }
        }
    }

    /// The next step with this foot, if the motion asks for one.
    fn swing_of(&self, side: Side, motion: &Motion) -> Option<Swing> {
        let from = self.feet[side.index()];
        let stance = self.feet[side.other().index()];
        let to = self.landing(&stance, &from, side, motion, 0)?;
        Some(Swing {
            side,
            from,
            to,
            planned: to,
        })
    }

    /// Landing of the step after `ahead` others; `None` where the feet shall stay.
    pub(crate) fn landing(
        &self,
        stance: &FootPose,
        from: &FootPose,
        side: Side,
        motion: &Motion,
        ahead: usize,
    ) -> Option<FootPose> {
        match motion {
            Motion::Walk(velocity) => Some(self.on_level(stance, side, velocity)),
            Motion::Stand => {
                if self.planner.is_beside(&stance.planar, &from.planar, side) {
                    return None;
                }
                Some(FootPose {
                    planar: self.planner.beside(&stance.planar, side),
                    z_m: stance.z_m,
                })
            }
            Motion::Footsteps(steps) => {
                let step = steps.get(self.listed + ahead)?;
                if step.side != side {
                    return Some(*from);
                }
                let wanted = self.list_origin.compose(&step.pose);
                Some(FootPose {
                    planar: self.planner.keep_apart(&stance.planar, &wanted, side),
                    z_m: if step.height_m.is_finite() {
                        step.height_m
                    } else {
                        stance.z_m
                    },
                })
            }
        }
    }

    fn on_level(&self, stance: &FootPose, side: Side, velocity: &Velocity) -> FootPose {
        FootPose {
            planar: self.planner.next(&stance.planar, side, velocity),
            z_m: stance.z_m,
        }
    }

    /// The ZMP reference at the moment.
    pub fn zmp(&self) -> Vector2<f64> {
        match &self.phase {
            Phase::Standing => self.middle(),
            Phase::Single { swing, .. } => self.stance_point(swing.side.other()),
            Phase::Double {
                elapsed_s,
                duration_s,
                from,
                next,
            } => {
                let share = (elapsed_s / duration_s).clamp(0.0, 1.0);
                from + (self.shift_goal(next.as_ref()) - from) * share
            }
        }
    }

    pub(crate) fn stance_point(&self, side: Side) -> Vector2<f64> {
        self.support_point(&self.feet[side.index()], side)
    }

    pub(crate) fn shift_goal(&self, next: Option<&Swing>) -> Vector2<f64> {
        next.map_or_else(
            || self.middle(),
            |swing| self.stance_point(swing.side.other()),
        )
    }

    /// Where a foot is to be now, without what the stabiliser adds.
    pub fn foot(&self, side: Side) -> FootPose {
        let Phase::Single {
            elapsed_s,
            duration_s,
            swing,
        } = &self.phase
        else {
            return self.feet[side.index()];
        };
        if swing.side != side {
            return self.feet[side.index()];
        }
        let share = elapsed_s / duration_s;
        let along = swing::travel(share);
        let (from, to) = (&swing.from, &swing.to);
        let turn = geometry::angle_between(from.planar.yaw_rad, to.planar.yaw_rad);
        let top = from.z_m.max(to.z_m) + self.config.step_height;
        FootPose {
            planar: PlanarPose::new(
                from.planar.x_m + (to.planar.x_m - from.planar.x_m) * along,
                from.planar.y_m + (to.planar.y_m - from.planar.y_m) * along,
                from.planar.yaw_rad + turn * along,
            ),
            z_m: swing::height_m(share, from.z_m, top, to.z_m),
        }
    }
}
