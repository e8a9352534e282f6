//! Feet on the ground and on their way.

use geometry::PlanarPose;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector2, Vector3};
use robot::Side;

use crate::{config::GaitConfig, swing};

/// The part of a sole that bears load, from and to, m from its middle forward. Nothing said: all of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bearing {
    /// Rear end, m.
    pub from_m: f64,
    /// Front end, m.
    pub to_m: f64,
}

impl Default for Bearing {
    fn default() -> Self {
        Self {
            from_m: f64::NEG_INFINITY,
            to_m: f64::INFINITY,
        }
    }
}

impl Bearing {
    /// The part of a sole of this half length that bears load and is `margin_m` from the part's ends: rear and front, m. Where
    /// nothing is left, the middle of what bears twice; where nothing bears at all, the sole's middle.
    pub fn on_sole_m(&self, half_length_m: f64, margin_m: f64) -> [f64; 2] {
        let rear = self.from_m.max(-half_length_m);
        let front = self.to_m.min(half_length_m);
        let middle = if rear <= front {
            0.5 * (rear + front)
        } else {
            0.0
        };
        [
            (rear + margin_m).min(middle),
            (front - margin_m).max(middle),
        ]
    }
}

/// A foot on the ground: its sole's centre in the walker's own plan frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FootPose {
    /// Place and heading.
    pub planar: PlanarPose,
    /// Height, m.
    pub z_m: f64,
    /// What of the sole stands on something.
    pub bearing: Bearing,
    /// Rise of the sole per metre along the plan's axes: nothing where it lies level.
    pub gradient: Vector2<f64>,
}

impl FootPose {
    /// The pose of the sole in the plan: turned by its heading, and then by as much as it is tilted.
    pub fn plan_from_sole(&self) -> Isometry3<f64> {
        let PlanarPose { x_m, y_m, yaw_rad } = self.planar;
        let level = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw_rad);
        let [x, y] = self.gradient.into();
        let turn = (self.gradient != Vector2::zeros())
            .then(|| UnitQuaternion::rotation_between(&Vector3::z(), &Vector3::new(-x, -y, 1.0)))
            .flatten();
        Isometry3::from_parts(
            Translation3::new(x_m, y_m, self.z_m),
            turn.map_or(level, |turn| turn * level),
        )
    }
}

/// How a foot goes from one place to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manner {
    /// A step of a walk on level ground.
    Walk,
    /// A step of a list, taken as in a walk.
    Placed,
    /// A step of a list: straight up, over and straight down, the landing verified.
    Careful,
    /// Back to where the foot came from, when a step of a list has failed.
    Back,
    /// Off what a foot of a walk has met, back along its way.
    Retreat,
}

impl Manner {
    /// Whether the landing is waited for.
    pub const fn is_careful(self) -> bool {
        matches!(self, Self::Careful | Self::Back)
    }

    /// Whether the foot goes as in a walk.
    pub const fn is_walked(self) -> bool {
        matches!(self, Self::Walk | Self::Placed)
    }

    /// Time on both feet between two steps when the coming one is of this kind, s.
    pub fn double_support_s(self, config: &GaitConfig) -> f64 {
        if self.is_careful() {
            config.climb_double_support
        } else {
            config.double_support
        }
    }
}

/// What a careful foot has found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CarefulLanding {
    /// No ground yet, this far below where it was told to be, m.
    Seeking(f64),
    /// None where it was told to be, and for this time, s, the leg has been too short to go further down.
    Short(f64),
    /// Ground: the foot stays at this height, m.
    Found(f64),
}

/// A foot on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// The foot.
    pub side: Side,
    /// How it goes.
    pub manner: Manner,
    /// Where it left.
    pub from: FootPose,
    /// Where it lands.
    pub to: FootPose,
    /// Where it was to land before any push.
    pub planned: FootPose,
    /// What a careful foot has found.
    pub landing: CarefulLanding,
}

impl Swing {
    /// A foot that has not left yet.
    pub const fn new(side: Side, manner: Manner, from: FootPose, to: FootPose) -> Self {
        Self {
            side,
            manner,
            from,
            to,
            planned: to,
            landing: CarefulLanding::Seeking(0.0),
        }
    }

    /// Time in which the foot is in the air, s; a long or high careful step takes longer, so that no joint has to turn faster
    /// than its motor.
    pub fn in_air_s(&self, config: &GaitConfig) -> f64 {
        let (from, to) = (&self.from, &self.to);
        match self.manner {
            Manner::Walk | Manner::Placed => config.step_time - config.double_support,
            Manner::Retreat => config.retreat_time,
            Manner::Careful | Manner::Back => {
                let way_m = from.planar.distance_m(&to.planar);
                let lift_m = (from.z_m - to.z_m).abs() + config.climb_clearance;
                (way_m / config.climb_speed)
                    .max(lift_m / (swing::lifting(&config.tuning.swing) * config.climb_lift_speed))
                    .max(config.climb_swing_time)
            }
        }
    }

    /// Time in which the other foot carries everything, s.
    pub fn single_support_s(&self, config: &GaitConfig) -> f64 {
        match self.manner {
            Manner::Walk | Manner::Placed | Manner::Retreat => self.in_air_s(config),
            Manner::Careful | Manner::Back => self.in_air_s(config) + config.climb_landing_time,
        }
    }

    /// Where the foot is to be after `elapsed_s`.
    pub fn foot(&self, elapsed_s: f64, config: &GaitConfig) -> FootPose {
        let (from, to) = (&self.from, &self.to);
        let higher_m = from.z_m.max(to.z_m);
        let share = elapsed_s / self.in_air_s(config);
        let times = &config.tuning.swing;
        let (along, mut z_m) = match self.manner {
            Manner::Walk | Manner::Placed => {
                let top_m = higher_m + config.step_height;
                let height_m = swing::height_m(share, from.z_m, top_m, to.z_m);
                (swing::travel(share, times), height_m)
            }
            Manner::Retreat => swing::retreat(share, from.z_m, to.z_m, times),
            Manner::Careful | Manner::Back => {
                let top_m = higher_m + config.climb_clearance;
                let ends_m = [from.z_m, to.z_m];
                let height_m = swing::careful_height_m(share, ends_m, top_m, times);
                (swing::careful_travel(share, times), height_m)
            }
        };
        match self.landing {
            CarefulLanding::Seeking(below_m) => z_m -= below_m,
            CarefulLanding::Short(_) => {}
            CarefulLanding::Found(height_m) => z_m = height_m,
        }
        let turn = geometry::angle_between(from.planar.yaw_rad, to.planar.yaw_rad);
        FootPose {
            planar: PlanarPose::new(
                from.planar.x_m + (to.planar.x_m - from.planar.x_m) * along,
                from.planar.y_m + (to.planar.y_m - from.planar.y_m) * along,
                from.planar.yaw_rad + turn * along,
            ),
            z_m,
            bearing: to.bearing,
            gradient: from.gradient + (to.gradient - from.gradient) * along,
        }
    }
}

/// What the feet do at the moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GaitPhase {
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
pub struct GaitReference {
    /// Zero moment point, m.
    pub zmp: Vector2<f64>,
    /// Divergent component of motion, m.
    pub dcm: Vector2<f64>,
}
