//! What is asked for.

use geometry::PlanarPose;
use robot::Side;

use super::plan::PlannedFootstep;
use super::unseen::Unseen;

/// Where a plan begins, and what it makes of what was not seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootstepQuestion<'a> {
    /// Where the feet stand, left and right, in the map.
    pub feet: [PlanarPose; 2],
    /// The foot that moves first; `None`: either.
    pub first: Option<Side>,
    /// What is made of ground that was not seen.
    pub unseen: Unseen,
    /// Places, m, where it was looked in vain just where levels meet: no way leads over them.
    pub vain_m: &'a [[f64; 2]],
    /// The steps on from these feet that were planned before. They are kept while they are possible, unless others are better by more than a walked
    /// step.
    pub planned: &'a [PlannedFootstep],
}
