//! What the walker is told to do.

use geometry::PlanarPose;
use planning::footsteps::StepManner;
use robot::Side;

/// Walking velocity in the robot's frame; the walker keeps it within what the gait can do.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Velocity {
    /// Forward, m/s.
    pub x_mps: f64,
    /// To the left, m/s.
    pub y_mps: f64,
    /// Counter-clockwise, rad/s.
    pub yaw_radps: f64,
}

/// Where to look.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gaze {
    /// To the left of straight ahead, rad.
    pub pan_rad: f64,
    /// Below the horizon, rad.
    pub down_rad: f64,
}

/// One step of a list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footstep {
    /// Foot that moves.
    pub side: Side,
    /// How it goes: carefully, straight up, over and straight down onto a surface that may be higher or lower; or as the robot walks,
    /// which is faster. A step that is to be walked but leads to another level, or farther than the robot walks, is taken carefully.
    pub manner: StepManner,
    /// Where the centre of its sole is put, relative to the robot's frame when the list was given.
    pub pose: PlanarPose,
    /// Height of the surface there above the robot's ground then, m.
    pub height_m: f64,
    /// Rise of that surface per metre, along the sole and to its left.
    pub slope: [f64; 2],
    /// Part of the sole that will bear load, from and to, from its middle forward, m: a sole may overhang an edge.
    pub bearing_m: [f64; 2],
}

/// Why a listed step was taken back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misstep {
    /// The foot found nothing to stand on where it was told to land.
    NoGround,
    /// The foot met something on its way.
    Obstructed,
    /// The leg on this side buckled when it was to carry the robot alone.
    Buckled(Side),
}

/// How the list of footsteps goes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stepping {
    /// Steps of the present or the last list that landed; 0 from the tick on in which the walker takes a new list.
    pub landed: usize,
    /// How much higher than told the last one landed, m, by joints and foot force; 0 where a walked one carried nothing yet.
    pub height_error_m: f64,
    /// Set when a step was taken back and the list was given up; until the next list.
    pub misstep: Option<Misstep>,
    /// Whether a walking foot came upon a level that nobody told it of: the robot comes to stand, and walks no more until it stands
    /// and was told anything but to walk.
    pub stumbled: bool,
}

/// What the arms do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Arms {
    /// As they hang while the legs walk.
    #[default]
    AtRest,
    /// Lifted: the robot is glad (003, section V.D).
    Raised,
}

/// What the feet do.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Motion {
    /// Stop in balance and stand on both soles.
    #[default]
    Stand,
    /// Walk with a velocity.
    Walk(Velocity),
    /// Take these steps, then stand. Given anew at every tick, the same numbers, until the walker says that all landed
    /// ([`Stepping::landed`]) or that it gave the list up ([`Stepping::misstep`]), and stands.
    ///
    /// A list is new in the first tick after any other motion, and when it differs from a list that is over while the robot
    /// stands; it counts from the robot's frame and ground of that tick. One that differs while another is on is left alone until
    /// that is over, unless it begins with the same steps up to the one under way, which then goes on as the new one says: longer,
    /// shorter, or with other steps behind that. One that is no more than a beginning of what was taken ends with the step under way,
    /// as another motion ends it. Out of a walk the robot comes to stand first. A list with a number that is none is not begun.
    /// Steps farther than the gait's `climb_forward` and `climb_rise` are shortened to that.
    Footsteps(Vec<Footstep>),
}

/// Everything that the walker is told.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Command {
    /// What the feet do.
    pub motion: Motion,
    /// Where the head looks.
    pub gaze: Gaze,
    /// What the arms do.
    pub arms: Arms,
    /// The foot that carries the weight during the first step of a walk out of a stand, for want of room on the other side; else
    /// the walker has it as the walk turns.
    pub carries_first: Option<Side>,
}
