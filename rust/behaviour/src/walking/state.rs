//! The states of the behaviour `walking`, and which may follow which.

/// What the robot is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    /// Stands and turns the head, to know the ground around or a place on the path.
    LookAround,
    /// Follows the path.
    Walk,
    /// Turns on the spot.
    Turn,
    /// Walks sideways.
    Sidle,
    /// Stands because something appeared or the way is gone.
    Stop,
    /// Stands at the goal.
    Arrive,
    /// Stands, having given up.
    Refuse,
    /// Stands because nothing is seen.
    Blind,
    /// Turns and circles to find out where it is.
    Locate,
}

impl State {
    /// All of them.
    #[cfg(test)]
    pub(crate) const ALL: [Self; 9] = [
        Self::LookAround,
        Self::Walk,
        Self::Turn,
        Self::Sidle,
        Self::Stop,
        Self::Arrive,
        Self::Refuse,
        Self::Blind,
        Self::Locate,
    ];

    /// The name in the recording's lane.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::LookAround => "look_around",
            Self::Walk => "walk",
            Self::Turn => "turn",
            Self::Sidle => "sidle",
            Self::Stop => "stop",
            Self::Arrive => "arrive",
            Self::Refuse => "refuse",
            Self::Blind => "blind",
            Self::Locate => "locate",
        }
    }

    /// Whether the feet may move.
    pub(crate) const fn moves(self) -> bool {
        matches!(self, Self::Walk | Self::Turn | Self::Sidle | Self::Locate)
    }

    /// Whether `next` may follow. Refusing is final; one who has arrived can only have slipped out again.
    pub(crate) const fn may_become(self, next: Self) -> bool {
        match self {
            Self::LookAround => !matches!(next, Self::Stop),
            Self::Walk | Self::Turn | Self::Sidle | Self::Stop => true,
            Self::Arrive => matches!(next, Self::Stop),
            Self::Blind => matches!(
                next,
                Self::LookAround | Self::Refuse | Self::Arrive | Self::Locate
            ),
            Self::Locate => !matches!(next, Self::Arrive | Self::Blind),
            Self::Refuse => false,
        }
    }
}
