//! How a list of footsteps goes.

use behaviour::Misstep;
use geometry::PlanarPose;

use crate::met::Met;

/// How the present or the last list goes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Listed {
    /// Steps landed.
    pub(crate) landed: usize,
    /// The robot's frame when the list was given, in the plan.
    pub(crate) origin: PlanarPose,
    /// Height from which the list's heights count, m: the ground then, corrected by what the landings found.
    pub(crate) ground_m: f64,
    /// How much higher than told the last landing was, m.
    pub(crate) height_error_m: f64,
    /// Why the list was given up.
    pub(crate) misstep: Option<Misstep>,
    /// How often a foot was put down again because the robot tipped.
    pub(crate) put_down: usize,
    /// How much sooner than planned a careful foot carries because the robot tips towards it, s.
    pub(crate) early_s: f64,
    /// Whether a walk has come upon a level that it was not told of.
    pub(crate) stumbled: bool,
    /// What it has come upon, in the plan, until that was told.
    pub(crate) met: Option<Met>,
    /// What a walk has come upon last, in the plan.
    pub(crate) met_last: Option<Met>,
}
