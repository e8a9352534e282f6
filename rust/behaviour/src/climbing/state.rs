//! The states of the behaviour, and which may follow which (003, section V).

/// What the robot is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    /// The behaviour `walking` decides; its states are shown.
    Walk,
    /// Stands, looks down and swings the head to find stairs, or the one that was lost.
    Search,
    /// Moves to the place before the first edge from which it is measured, and turns square to it.
    Align,
    /// Measures the first edge and moves up to it.
    Approach,
    /// Looks for what comes next and takes steps, or stands and waits until the next one is free.
    Climb,
    /// Moves back to where it came from, to look again.
    StepBack,
    /// Moves to a safe place behind the last step and is glad.
    Finish,
    /// Stands because nothing is seen.
    Blind,
    /// Stands, having given up.
    Refuse,
}

impl State {
    /// All of them.
    #[cfg(test)]
    pub(crate) const ALL: [Self; 9] = [
        Self::Walk,
        Self::Search,
        Self::Align,
        Self::Approach,
        Self::Climb,
        Self::StepBack,
        Self::Finish,
        Self::Blind,
        Self::Refuse,
    ];

    /// The name in the recording's lane.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Search => "search",
            Self::Align => "align",
            Self::Approach => "approach",
            Self::Climb => "climb",
            Self::StepBack => "step_back",
            Self::Finish => "finish",
            Self::Blind => "blind",
            Self::Refuse => "refuse",
        }
    }

    /// Whether `next` may follow.
    pub(crate) const fn may_become(self, next: Self) -> bool {
        match self {
            Self::Walk => matches!(next, Self::Search | Self::Align | Self::Refuse),
            Self::Search => matches!(next, Self::Walk | Self::Align | Self::Blind | Self::Refuse),
            Self::Align => matches!(
                next,
                Self::Search | Self::Approach | Self::Walk | Self::Blind | Self::Refuse
            ),
            Self::Approach => matches!(
                next,
                Self::Search
                    | Self::Climb
                    | Self::StepBack
                    | Self::Walk
                    | Self::Blind
                    | Self::Refuse
            ),
            Self::Climb => matches!(
                next,
                Self::StepBack | Self::Finish | Self::Blind | Self::Refuse
            ),
            Self::StepBack => matches!(
                next,
                Self::Search | Self::Climb | Self::Blind | Self::Refuse
            ),
            Self::Finish => matches!(next, Self::Walk | Self::Search | Self::Blind | Self::Refuse),
            Self::Blind => {
                matches!(next, Self::Walk | Self::Search | Self::Climb | Self::Refuse)
            }
            Self::Refuse => false,
        }
    }
}
