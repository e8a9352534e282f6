//! Footsteps, or why there are none.

use geometry::PlanarPose;
use robot::Side;
use terrain::footholds::Foothold;
use thiserror::Error;

/// How a step is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StepManner {
    /// As the robot walks.
    Walked,
    /// Up, over and down, from a stand.
    Careful,
}

impl StepManner {
    /// As it is written in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Walked => "walked",
            Self::Careful => "careful",
        }
    }
}

/// One step of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedFootstep {
    /// The foot that moves.
    pub side: Side,
    /// Where the middle of its sole is put, in the map.
    pub pose: PlanarPose,
    /// How it stands there.
    pub foothold: Foothold,
    /// How the step is taken.
    pub manner: StepManner,
    /// What it costs.
    pub cost: StepCost,
}

/// What a step costs, s, by what for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepCost {
    /// The time that it takes.
    pub time_s: f64,
    /// That the sole bears only in part, or on what is not even.
    pub partial_s: f64,
    /// That not all of the ground beside the foot is known and within reach.
    pub margin_s: f64,
    /// That the foot turns.
    pub turn_s: f64,
}

impl StepCost {
    /// All of it, s.
    pub fn total_s(&self) -> f64 {
        self.time_s + self.partial_s + self.margin_s + self.turn_s
    }
}

/// A way, step by step.
#[derive(Debug, Clone, PartialEq)]
pub struct FootstepPlan {
    /// The steps; at the goal the last one puts the foot beside the other.
    pub steps: Vec<PlannedFootstep>,
    /// Where the way leads on over ground that was not seen, m in the map: the steps end before it. `None` where they end at the goal.
    pub exit_m: Option<[f64; 2]>,
    /// What they cost, s.
    pub cost_s: f64,
    /// What the whole way costs, as far as the field knows, s: the steps, and what leads on over ground that was not seen.
    pub whole_s: f64,
    /// They cost no more than so many times the cheapest, as far as the field that leads the search is right.
    pub epsilon: f64,
    /// What the first plan cost, s, and after how many expansions it was found.
    pub first: (f64, usize),
    /// Places of a foot that were expanded.
    pub expanded: usize,
}

/// Why there are no footsteps.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoFootsteps {
    /// Start or goal is no place.
    #[error("start and goal must be finite")]
    NotFinite,
    /// The map's cells are too large for a sole, or needlessly small.
    #[error(
        "the map needs cells from {least_m} m (footsteps.sole_cells) to {most_m} m (half a sole's breadth): got {got_m} m"
    )]
    Cells {
        /// Smallest that a cell may be, m.
        least_m: f64,
        /// Largest that a cell may be, m.
        most_m: f64,
        /// How large it is, m.
        got_m: f64,
    },
    /// Nothing is known of the ground on which the robot stands.
    #[error("the ground under the {} foot at the start was not seen", side_word(*.0))]
    UnseenStart(Side),
    /// Nothing is known of the ground at the goal.
    #[error("the ground at the goal was not seen")]
    UnseenGoal,
    /// Not even the coarse field leads to the goal.
    #[error(
        "no way to the goal: a step higher than {rise_m:.3} m, something in the way of the body, or ground that was not seen"
    )]
    NoWay {
        /// Highest step, m.
        rise_m: f64,
    },
    /// Every sequence of steps ends before the goal.
    #[error(
        "no sequence of steps leads to the goal: all {0} places that feet can reach were tried"
    )]
    NoSteps(usize),
    /// The search was given up.
    #[error(
        "no sequence of steps was found after {0} places of a foot (footsteps.most_expansions)"
    )]
    GivenUp(usize),
}

const fn side_word(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}
