//! The states of the behaviour `walking`, and which may follow which.

use geometry::PlanarPose;

use super::gaze::Sweep;
use crate::machine::{self, Idling};

/// What is known while the robot finds out where it is.
#[derive(Debug, Clone)]
pub(crate) struct Locating {
    /// The look around at its beginning.
    pub(super) sweep: Sweep,
    /// The odometry frame in the map when the robot lost its place.
    pub(super) lost_at: PlanarPose,
}

/// What a robot does that sees nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Blind {
    /// Stands and turns the head.
    Look(Sweep),
    /// Steps back to a place from which it came, m.
    StepBack { to_m: [f64; 2] },
    /// Turns on the spot to a heading, rad.
    Turn { to_rad: f64 },
}

/// What the robot is doing, and what it knows only while it does.
#[derive(Debug, Clone)]
pub(crate) enum State {
    /// Stands and turns the head, to know the ground around or a place on the path.
    LookAround(Sweep),
    /// Follows the path.
    Walk,
    /// Turns on the spot: to a heading, rad, to look around from there, or to where the path leads.
    Turn { to_rad: Option<f64> },
    /// Walks sideways.
    Sidle,
    /// Stands because something appeared or the way is gone.
    Stop,
    /// Steps back to a place off what a foot has met, m.
    StepOff { to_m: [f64; 2] },
    /// Stands at the goal.
    Arrive,
    /// Stands, having given up.
    Refuse { reason: String },
    /// Sees nothing, and tries what may change that.
    Blind(Blind),
    /// Turns and circles to find out where it is.
    Locate(Locating),
}

impl State {
    /// All of them.
    #[cfg(test)]
    pub(crate) fn all() -> [Self; 10] {
        let sweep = Sweep::through(&[], 2);
        let lost_at = PlanarPose::default();
        [
            Self::LookAround(sweep),
            Self::Walk,
            Self::Turn { to_rad: None },
            Self::Sidle,
            Self::Stop,
            Self::StepOff { to_m: [0.0; 2] },
            Self::Arrive,
            Self::Refuse {
                reason: String::new(),
            },
            Self::Blind(Blind::Look(sweep)),
            Self::Locate(Locating { sweep, lost_at }),
        ]
    }

    /// Whether the feet may move.
    pub(crate) const fn moves(&self) -> bool {
        matches!(
            self,
            Self::Walk
                | Self::Turn { .. }
                | Self::Sidle
                | Self::StepOff { .. }
                | Self::Locate(_)
                | Self::Blind(_)
        )
    }
}

impl machine::State for State {
    fn name(&self) -> &'static str {
        match self {
            Self::LookAround(_) => "look_around",
            Self::Walk => "walk",
            Self::Turn { .. } => "turn",
            Self::Sidle => "sidle",
            Self::Stop => "stop",
            Self::StepOff { .. } => "step_back",
            Self::Arrive => "arrive",
            Self::Refuse { .. } => "refuse",
            Self::Blind(_) => "blind",
            Self::Locate(_) => "locate",
        }
    }

    /// Refusing is final; a robot that has arrived can only have slipped out again.
    fn may_become(&self, next: &Self) -> bool {
        match self {
            Self::LookAround(_) => !matches!(next, Self::StepOff { .. }),
            Self::Walk | Self::Turn { .. } | Self::Sidle | Self::Stop | Self::StepOff { .. } => {
                true
            }
            Self::Arrive => matches!(next, Self::Stop),
            Self::Blind(_) => matches!(
                next,
                Self::LookAround(_)
                    | Self::Refuse { .. }
                    | Self::Arrive
                    | Self::Locate(_)
                    | Self::Stop
            ),
            Self::Locate(_) => !matches!(next, Self::Arrive | Self::Blind(_)),
            Self::Refuse { .. } => false,
        }
    }

    fn refuse(reason: String) -> Self {
        Self::Refuse { reason }
    }

    fn refusal(&self) -> Option<&str> {
        match self {
            Self::Refuse { reason } => Some(reason),
            _ => None,
        }
    }

    /// A robot that cannot tell where it is or what is around has limits of its own for that.
    fn idling(&self) -> Idling {
        match self {
            Self::Locate(_) | Self::Blind(_) => Idling::Pauses,
            Self::Walk => Idling::Ends,
            _ => Idling::Counts,
        }
    }

    fn ends_by_a_stumble(&self) -> bool {
        self.moves() || matches!(self, Self::LookAround(_))
    }

    fn is_interruptible(&self) -> bool {
        !matches!(self, Self::Refuse { .. } | Self::Arrive)
    }

    fn walks(&self) -> bool {
        matches!(self, Self::Walk | Self::Sidle)
    }

    /// A robot that stands and looks around may look where there is no ground for a while.
    fn is_patient(&self) -> bool {
        matches!(self, Self::LookAround(_))
    }
}
